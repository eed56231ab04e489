/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_FIELD_UNITS_H
#define ANALYSIS_FIELD_UNITS_H

#include "analysis/field_figures.h"
#include "analysis/slice_sample.h"

/* Frontally struck vehicles of a study as units that are weighted. */

/* The field's margins that are raked, in the order of cp_field_margin. */
typedef struct cp_field_margins {
    cp_raking raking;
    cp_field_margin of[CP_FIELD_MARGIN_COUNT]; /* of each margin of the raking */
    cp_field_share share[CP_FIELD_MARGIN_COUNT][CP_FIELD_CLASSES_MAX]; /* of every margin */
} cp_field_margins;

/* without: a margin that is left out though asked for; CP_FIELD_MARGIN_COUNT: none. A raking of no
 * margin is left where the table knows none. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_field_margins_of(const cp_field_request *request,
                                            cp_field_margin without, cp_field_margins *margins,
                                            cp_error *error);

/* What units are made of. */
typedef struct cp_field_source {
    const cp_study_data *data;
    const cp_field_request *request;
    const cp_field_margins *margins;
    const cp_replication_set *set;
    cp_slice slice;
    const double *above; /* CP_EXCEEDED_COUNT */
} cp_field_source;

typedef struct cp_field_units {
    size_t count;
    size_t *vehicle; /* of the study, by ascending OLC, failed simulations last */
    size_t *pair;    /* of the study, with pairs */
    size_t *fronts;  /* units of the same crash */
    size_t *cluster;
    cp_raking_classes *classes;
    double *event;
    double *treated; /* with pairs: the events of what became of it */
    double *severity;
    size_t severities;
} cp_field_units;

/* variant: SIZE_MAX: the set's own crashes; else the valid pairs of that treatment. The caller
 * destroys, also after an error. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_field_units_create(const cp_field_source *source, size_t variant,
                                              cp_field_units *units, cp_error *error);
void cp_field_units_destroy(cp_field_units *units);

/* Events of one unit. */
size_t cp_field_events(const cp_study_data *data);

/* The units as an arm, all borrowed; treated: with the events of the pairs. */
cp_raked_arm cp_field_units_arm(const cp_field_source *source, const cp_field_units *units,
                                bool treated);

/* Weighted sum of a risk function over the units and its gradient; weight NULL: 1. */
cp_injury_sum cp_field_units_injured(const cp_field_source *source, const cp_field_units *units,
                                     const double *weight, size_t risk, bool treated);

/* Class of a vehicle of the study. */
unsigned char cp_field_study_class(const cp_study_data *data, const cp_field_study *study,
                                   size_t vehicle, cp_field_margin margin);

#endif
