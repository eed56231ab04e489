/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/false_activations.h"

#include "analysis/query_json.h"
#include "core/array.h"
#include "stats/rates.h"
#include "store/query.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define HOURS 1000.0 /* that rates are given for */

enum { SCENARIO, VARIANT, FUNCTION, HAS_ERRORS, VEHICLE_H, ACTIVATIONS, WITHOUT_ERROR };

// A row a replication and function, those of one scenario, variant and function together.
static const char SQL[] =
    "SELECT s.name, v.name, f.column1, json_array_length(s.driver_errors) > 0, r.vehicle_h, "
    "json_extract(r.counters, '$.\"' || f.column2 || '\"') AS activations, "
    "json_extract(r.counters, '$.\"' || f.column3 || '\"') "
    "FROM replication AS r JOIN scenario AS s ON s.id = r.scenario_id "
    "JOIN variant AS v ON v.id = r.variant_id "
    "JOIN (VALUES ('aeb', 'aeb.activations', 'aeb.activations_without_error'), "
    "('elk', 'elk.interventions', NULL), "
    "('fcw', 'fcw.warnings', 'fcw.warnings_without_error')) AS f "
    "WHERE r.status = 'done' AND r.vehicle_h > 0 AND activations IS NOT NULL "
    "ORDER BY s.number, v.number, f.column1, r.number, r.id";

/* What is being gathered: the replications of one row of the table. */
typedef struct gathering {
    json_t *rows;
    json_t *head; /* names of the row in hand; NULL before the first */
    double *hours, *activations, *without_error;
    size_t count, room;
    bool knows_errors; /* all of them have counted */
} gathering;

// Rate per 1000 h under the names; null where it is not known. False when memory is gone.
static bool add_rate(json_t *row, const gathering *g, const double *events,
                     const char *const name[3])
{
    cp_exposure exposure = {g->count, events, g->hours};
    cp_widening widening;
    double figures[3] = {NAN, NAN, NAN};
    if (events != NULL) {
        cp_interval interval = cp_rate_widened(&exposure, NULL, 0.95, &widening);
        figures[0] = HOURS * cp_rate(&exposure);
        figures[1] = HOURS * interval.low;
        figures[2] = HOURS * interval.high;
    }
    for (int k = 0; k < 3; k++)
        if (json_object_set_new(row, name[k], cp_number_json(figures[k])) != 0)
            return false;
    return true;
}

static double sum(const double *values, size_t count)
{
    double total = 0.0;
    for (size_t k = 0; k < count; k++)
        total += values[k];
    return total;
}

// The row in hand is complete.
static cp_status finish_row(gathering *g, cp_error *error)
{
    static const char *const all[] = {"per_1000_h", "low", "high"};
    static const char *const without[] = {"without_error_per_1000_h", "without_error_low",
                                          "without_error_high"};
    if (g->head == NULL)
        return CP_OK;
    json_t *row = g->head;
    const double *known = g->knows_errors ? g->without_error : NULL;
    bool good =
        json_object_set_new(row, "vehicle_h", json_real(sum(g->hours, g->count))) == 0 &&
        json_object_set_new(row, "activations", json_real(sum(g->activations, g->count))) == 0 &&
        json_object_set_new(row, "without_error",
                            known ? json_real(sum(known, g->count)) : json_null()) == 0 &&
        add_rate(row, g, g->activations, all) && add_rate(row, g, known, without);
    g->head = NULL;
    g->count = 0;
    if (!good)
        json_decref(row);
    return good && json_array_append_new(g->rows, row) == 0
               ? CP_OK
               : cp_fail_memory(error, "activations of functions");
}

static bool is_of(const json_t *head, const char *name, const cp_cell *cell)
{
    return strcmp(json_string_value(json_object_get(head, name)), cell->text) == 0;
}

static cp_status reserve(gathering *g, cp_error *error)
{
    static const char WHAT[] = "activations of functions";
    double **lists[] = {&g->hours, &g->activations, &g->without_error};
    size_t room = g->room;
    cp_status status = CP_OK;
    for (int k = 0; k < 3 && status == CP_OK; k++) {
        room = g->room;
        status = cp_array_reserve(*lists[k], room, g->count + 1, WHAT, error);
    }
    if (status == CP_OK)
        g->room = room;
    return status;
}

static cp_status read_row(void *context, const cp_row *row, cp_error *error)
{
    gathering *g = context;
    const cp_cell *cell = row->cell;
    cp_status status = CP_OK;
    if (g->head != NULL &&
        !(is_of(g->head, "scenario", &cell[SCENARIO]) &&
          is_of(g->head, "variant", &cell[VARIANT]) && is_of(g->head, "function", &cell[FUNCTION])))
        status = finish_row(g, error);
    if (status != CP_OK)
        return status;
    if (g->head == NULL) {
        g->head = json_pack("{s:s, s:s, s:s, s:b}", "scenario", cell[SCENARIO].text, "variant",
                            cell[VARIANT].text, "function", cell[FUNCTION].text, "has_errors",
                            cell[HAS_ERRORS].integer != 0);
        g->knows_errors = true;
    }
    if (g->head == NULL)
        return cp_fail_memory(error, "activations of functions");
    status = reserve(g, error);
    if (status != CP_OK)
        return status;
    g->hours[g->count] = cell[VEHICLE_H].real;
    g->activations[g->count] = cell[ACTIVATIONS].real;
    g->without_error[g->count++] = cell[WITHOUT_ERROR].real;
    g->knows_errors = g->knows_errors && cell[WITHOUT_ERROR].type != CP_CELL_NULL;
    return CP_OK;
}

cp_status cp_false_activations_json(cp_store *store, json_t **rows, cp_error *error)
{
    gathering g = {.rows = json_array()};
    cp_query_handler handler = {.row = read_row, .context = &g};
    *rows = NULL;
    if (g.rows == NULL)
        return cp_fail_memory(error, "activations of functions");
    cp_status status = cp_query(store, SQL, NULL, 0, &handler, error);
    if (status == CP_OK)
        status = finish_row(&g, error);
    free(g.hours);
    free(g.activations);
    free(g.without_error);
    json_decref(g.head);
    if (status == CP_OK)
        *rows = g.rows;
    else
        json_decref(g.rows);
    return status;
}
