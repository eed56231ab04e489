/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/study_data.h"

#include "report/query_json.h"
#include "store/query.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Where the rows of one query go. */
typedef struct reader {
    cp_study_data *data;
    size_t room; /* of the array being filled */
} reader;

// Room for one more row of an array that doubles; the new row is zeroed.
static cp_status grow(void **array, size_t count, size_t *room, size_t size, cp_error *error)
{
    if (count >= *room) {
        size_t larger = *room ? 2 * *room : 64;
        void *moved = realloc(*array, larger * size);
        if (!moved)
            return cp_fail_memory(error, "the rows of a study");
        *array = moved;
        *room = larger;
    }
    memset((char *)*array + count * size, 0, size);
    return CP_OK;
}

static cp_status copy_text(const char *text, char **copy, cp_error *error)
{
    *copy = strdup(text);
    return *copy ? CP_OK : cp_fail_memory(error, "a name");
}

static cp_status copy_json(const char *text, json_t **value, cp_error *error)
{
    json_error_t place;
    *value = json_loads(text, JSON_DECODE_ANY, &place);
    return *value ? CP_OK : cp_fail(error, CP_STORE_FAILED, "stored JSON: %s", place.text);
}

static cp_status read_scenario(void *context, const cp_row *row, cp_error *error)
{
    reader *r = context;
    cp_study_data *data = r->data;
    cp_status status = grow((void **)&data->scenario, data->scenario_count, &r->room,
                            sizeof *data->scenario, error);
    if (status != CP_OK)
        return status;
    cp_study_scenario *scenario = &data->scenario[data->scenario_count++];
    status = copy_text(row->cell[0].text, &scenario->name, error);
    return status == CP_OK ? copy_json(row->cell[1].text, &scenario->driver_errors, error) : status;
}

static cp_status read_variant(void *context, const cp_row *row, cp_error *error)
{
    reader *r = context;
    cp_study_data *data = r->data;
    cp_status status =
        grow((void **)&data->variant, data->variant_count, &r->room, sizeof *data->variant, error);
    if (status != CP_OK)
        return status;
    cp_study_variant *variant = &data->variant[data->variant_count++];
    variant->is_baseline = row->cell[1].integer != 0;
    status = copy_text(row->cell[0].text, &variant->name, error);
    return status == CP_OK ? copy_json(row->cell[2].text, &variant->functions, error) : status;
}

static cp_status read_replication(void *context, const cp_row *row, cp_error *error)
{
    reader *r = context;
    cp_study_data *data = r->data;
    cp_status status = grow((void **)&data->replication, data->replication_count, &r->room,
                            sizeof *data->replication, error);
    if (status != CP_OK)
        return status;
    data->replication[data->replication_count++] = (cp_study_replication){
        .scenario = (size_t)row->cell[0].integer,
        .variant = (size_t)row->cell[1].integer,
        .number = row->cell[2].integer,
        .seed = row->cell[3].integer,
        .vehicle_km = row->cell[4].real,
        .vehicle_h = row->cell[5].real,
    };
    return CP_OK;
}

static cp_status read_text(void *context, const cp_row *row, char ***texts, size_t *count,
                           cp_error *error)
{
    reader *r = context;
    cp_status status = grow((void **)texts, *count, &r->room, sizeof **texts, error);
    return status == CP_OK ? copy_text(row->cell[0].text, &(*texts)[(*count)++], error) : status;
}

static cp_status read_crash_type(void *context, const cp_row *row, cp_error *error)
{
    cp_study_data *data = ((reader *)context)->data;
    return read_text(context, row, &data->crash_type, &data->crash_type_count, error);
}

static cp_status read_validity(void *context, const cp_row *row, cp_error *error)
{
    cp_study_data *data = ((reader *)context)->data;
    return read_text(context, row, &data->validity, &data->validity_count, error);
}

static cp_status read_crash(void *context, const cp_row *row, cp_error *error)
{
    reader *r = context;
    cp_study_data *data = r->data;
    cp_status status =
        grow((void **)&data->crash, data->crash_count, &r->room, sizeof *data->crash, error);
    if (status != CP_OK)
        return status;
    data->crash[data->crash_count++] = (cp_study_crash){
        .replication = (size_t)row->cell[0].integer,
        .crash_type = (size_t)row->cell[1].integer,
        .frontal = row->cell[2].integer != 0,
        .inside = row->cell[3].integer != 0,
    };
    return CP_OK;
}

static cp_status read_vehicle(void *context, const cp_row *row, cp_error *error)
{
    reader *r = context;
    cp_study_data *data = r->data;
    cp_status status =
        grow((void **)&data->vehicle, data->vehicle_count, &r->room, sizeof *data->vehicle, error);
    if (status != CP_OK)
        return status;
    data->vehicle[data->vehicle_count++] = (cp_study_vehicle){
        .crash = (size_t)row->cell[0].integer,
        .role = row->cell[1].text[0],
        .olc = (cp_olc_known)row->cell[2].integer,
        .olc_g = row->cell[3].real,
        .delta_v_m_s = row->cell[4].real,
        .closing_speed_m_s = row->cell[5].real,
        .lateral_offset_m = row->cell[6].real,
        .angle_rad = row->cell[7].real,
        .validity = (size_t)row->cell[8].integer,
    };
    return CP_OK;
}

/* Places (from 0) of scenarios, variants, replications and crashes in the order they are read in.
 * A variant with a sweep counts as one variant a sweep point. */
#define PLACES                                                                                     \
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
    " AS place FROM (SELECT validity FROM crash_vehicle WHERE frontal = 1"                         \
    " UNION SELECT 'inside')) "

static cp_status read_rows(cp_store *store, cp_study_data *data, cp_error *error)
{
    const struct {
        const char *sql;
        cp_status (*row)(void *context, const cp_row *row, cp_error *error);
    } queries[] = {
        {PLACES "SELECT name, driver_errors FROM s ORDER BY place", read_scenario},
        {PLACES "SELECT name, is_baseline, functions FROM v ORDER BY place", read_variant},
        {PLACES "SELECT scenario, variant, number, seed, vehicle_km, vehicle_h FROM r"
                " ORDER BY place",
         read_replication},
        {PLACES "SELECT crash_type FROM t ORDER BY place", read_crash_type},
        {PLACES "SELECT validity FROM o ORDER BY place", read_validity},
        {PLACES "SELECT replication, type, frontal, validity = 'inside' FROM c ORDER BY place",
         read_crash},
        {PLACES "SELECT c.place, w.role, CASE w.olc_status WHEN 'value' THEN 0 WHEN "
                "'simulation_failed' THEN 2 ELSE 1 END, w.olc_g, w.delta_v_m_s,"
                " c.closing_speed_m_s, c.lateral_offset_m, c.angle_rad, o.place"
                " FROM crash_vehicle AS w JOIN c ON c.id = w.crash_id"
                " JOIN o ON o.validity = w.validity WHERE w.frontal = 1 ORDER BY c.place, w.role",
         read_vehicle},
    };
    for (size_t k = 0; k < sizeof queries / sizeof *queries; k++) {
        reader r = {.data = data};
        cp_query_handler handler = {.row = queries[k].row, .context = &r};
        cp_status status = cp_query(store, queries[k].sql, NULL, 0, &handler, error);
        if (status != CP_OK)
            return status;
    }
    return CP_OK;
}

// The study's own row and what the results were made with, as JSON for reports.
static cp_status read_about(cp_store *store, cp_study_data *data, cp_error *error)
{
    const struct {
        const char *name;
        const char *sql;
    } parts[] = {
        {"study", "SELECT * FROM study"},
        {"versions", "SELECT crashpulse_version, sumo_version, count(*) AS replications"
                     " FROM replication WHERE status = 'done' GROUP BY 1, 2 ORDER BY 1, 2"},
        {"vehicle_models", "SELECT name, hash FROM vehicle_model ORDER BY name"},
        {"scenarios", "SELECT name, sumocfg, sumo_options, driver_errors FROM scenario"
                      " ORDER BY number"},
        {"variants", "SELECT name, is_baseline, functions FROM variant ORDER BY number"},
        {"replications",
         "SELECT s.name AS scenario, v.name AS variant, r.sweep, r.number, r.seed, r.status,"
         " r.vehicle_km, r.vehicle_h, r.configuration_hash FROM replication AS r"
         " JOIN scenario AS s ON s.id = r.scenario_id JOIN variant AS v ON v.id = r.variant_id"
         " ORDER BY s.number, v.number, r.sweep, r.number"},
        {"sumo_collision_check", "SELECT * FROM sumo_collision_check"},
    };
    data->about = json_object();
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
        json_t *rows = NULL;
        cp_status status = cp_query_json(store, parts[k].sql, &rows, error);
        if (status != CP_OK)
            return status;
        if (json_object_set_new(data->about, parts[k].name, rows) != 0)
            return cp_fail_memory(error, "the description of a study");
    }

    const json_t *study = json_array_get(json_object_get(data->about, "study"), 0);
    if (!study)
        return cp_fail(error, CP_BAD_INPUT, "the database holds no study yet");
    const char *design = json_string_value(json_object_get(study, "design"));
    data->paired = design && strcmp(design, "paired_seeds") == 0;
    data->seed = (uint64_t)json_integer_value(json_object_get(study, "seed"));
    return copy_text(json_string_value(json_object_get(study, "name")), &data->name, error);
}

cp_status cp_study_data_read(cp_store *store, cp_study_data *data, cp_error *error)
{
    *data = (cp_study_data){0};
    cp_status status = read_about(store, data, error);
    if (status == CP_OK)
        status = read_rows(store, data, error);
    double unfinished = 0.0;
    if (status == CP_OK)
        status = cp_query_number(store, "SELECT count(*) FROM replication WHERE status <> 'done'",
                                 &unfinished, error);
    data->unfinished = (size_t)unfinished;
    return status == CP_OK ? CP_OK : cp_error_prefix(error, "%s: ", cp_store_path(store));
}

void cp_study_data_destroy(cp_study_data *data)
{
    json_decref(data->about);
    free(data->name);
    for (size_t k = 0; k < data->scenario_count; k++) {
        free(data->scenario[k].name);
        json_decref(data->scenario[k].driver_errors);
    }
    for (size_t k = 0; k < data->variant_count; k++) {
        free(data->variant[k].name);
        json_decref(data->variant[k].functions);
    }
    for (size_t k = 0; k < data->crash_type_count; k++)
        free(data->crash_type[k]);
    for (size_t k = 0; k < data->validity_count; k++)
        free(data->validity[k]);
    free(data->scenario);
    free(data->variant);
    free(data->replication);
    free(data->crash_type);
    free(data->crash);
    free(data->vehicle);
    free(data->validity);
    *data = (cp_study_data){0};
}

cp_status cp_study_data_variant(const cp_study_data *data, const char *name, size_t *variant,
                                cp_error *error)
{
    for (size_t k = 0; k < data->variant_count; k++) {
        if (name ? strcmp(name, data->variant[k].name) == 0 : data->variant[k].is_baseline) {
            *variant = k;
            return CP_OK;
        }
    }

    // Say what there is to choose from.
    char names[512] = "";
    size_t used = 0;
    for (size_t k = 0; k < data->variant_count && used + 1 < sizeof names; k++) {
        int more = snprintf(names + used, sizeof names - used, "%s%s", k ? ", " : "",
                            data->variant[k].name);
        used += more > 0 ? (size_t)more : 0;
    }
    if (name)
        return cp_fail(error, CP_BAD_INPUT, "there is no variant '%s'; the study has: %s", name,
                       names);
    return cp_fail(error, CP_BAD_INPUT,
                   "no variant is marked as the baseline; name one with --baseline: %s", names);
}
