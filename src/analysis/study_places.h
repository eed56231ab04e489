/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_STUDY_PLACES_H
#define ANALYSIS_STUDY_PLACES_H

/* Places (from 0) of scenarios, variants, replications and crashes in the order they are read in.
 * A variant with a sweep counts as one variant a sweep point. */
#define CP_STUDY_PLACES                                                                            \
    "WITH point AS (SELECT DISTINCT variant_id, sweep FROM replication),"                          \
    " s AS (SELECT *, row_number() OVER (ORDER BY number, name) - 1 AS place FROM scenario),"      \
    " v AS (SELECT variant.id AS id, coalesce(point.sweep, '') AS sweep, is_baseline, functions,"  \
    " name || CASE WHEN coalesce(point.sweep, '') = '' THEN '' ELSE ' [' || point.sweep || ']'"    \
    " END AS name, row_number() OVER (ORDER BY number, name, point.sweep) - 1 AS place"            \
    " FROM variant LEFT JOIN point ON point.variant_id = variant.id),"                             \
    " r AS (SELECT x.*, s.place AS scenario, v.place AS variant,"                                  \
    " row_number() OVER (ORDER BY s.place, x.number, v.place) - 1 AS place"                        \
    " FROM replication AS x JOIN s ON s.id = x.scenario_id"                                        \
    " JOIN v ON v.id = x.variant_id AND v.sweep = x.sweep WHERE x.status = 'done'),"               \
    " t AS (SELECT crash_type, row_number() OVER (ORDER BY crash_type) - 1 AS place"               \
    " FROM (SELECT DISTINCT crash_type FROM crash)),"                                              \
    " c AS (SELECT x.*, r.place AS replication, t.place AS type, x.crash_type LIKE 'front-%'"      \
    " AS frontal, row_number() OVER (ORDER BY r.place, x.number) - 1 AS place"                     \
    " FROM crash AS x JOIN r ON r.id = x.replication_id JOIN t USING (crash_type)),"               \
    " o AS (SELECT validity, row_number() OVER (ORDER BY validity <> 'inside', validity) - 1"      \
    " AS place FROM (SELECT validity FROM crash_vehicle UNION SELECT validity FROM"                \
    " counterfactual_vehicle UNION SELECT 'inside')) "

#endif
