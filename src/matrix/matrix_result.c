/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "matrix/matrix_result.h"

#include "matrix/matrix_study.h"
#include "store/query.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Crashes of the two cars of one cell; between others there can be none.
static const char OUTCOMES[] =
    "SELECT v.name, cv.sumo_id, cv.speed_m_s, c.closing_speed_m_s, cv.delta_v_m_s, cv.olc_g, "
    "c.overlap_1, cv.contact_side, cv.validity = 'inside' "
    "FROM crash AS c JOIN replication AS r ON r.id = c.replication_id "
    "JOIN variant AS v ON v.id = r.variant_id JOIN crash_vehicle AS cv ON cv.crash_id = c.id "
    "WHERE cv.sumo_id LIKE 'c%\\_own' ESCAPE '\\' ORDER BY c.id";

// Contacts that are no crashes, a graze for one (impact.h).
static const char TOUCHES[] =
    "SELECT v.name, CASE WHEN t.vehicle_1 LIKE 'c%\\_own' ESCAPE '\\' THEN t.vehicle_1 "
    "ELSE t.vehicle_2 END, t.verdict FROM contact AS t "
    "JOIN replication AS r ON r.id = t.replication_id JOIN variant AS v ON v.id = r.variant_id";

// The outcome of the cell and variant that a row names first.
static cp_status outcome_of(cp_matrix_result *result, const cp_row *row, cp_cell_outcome **outcome,
                            cp_error *error)
{
    const cp_cell *cell = row->cell;
    size_t number = strtoul(cell[1].text + 1, NULL, 10);
    if (number >= result->count)
        return cp_fail(error, CP_RUN_FAILED, "vehicle '%s' is of no cell of this matrix",
                       cell[1].text);
    bool is_treated = strcmp(cell[0].text, CP_MATRIX_TREATED) == 0;
    *outcome = is_treated ? &result->with[number] : &result->without[number];
    return CP_OK;
}

static cp_status take_touch(void *context, const cp_row *row, cp_error *error)
{
    cp_cell_outcome *outcome;
    cp_status status = outcome_of(context, row, &outcome, error);
    if (status == CP_OK)
        snprintf(outcome->touch, sizeof outcome->touch, "%s", row->cell[2].text);
    return status;
}

static cp_status take_row(void *context, const cp_row *row, cp_error *error)
{
    const cp_cell *cell = row->cell;
    cp_cell_outcome *outcome;
    cp_status status = outcome_of(context, row, &outcome, error);
    if (status != CP_OK)
        return status;
    *outcome = (cp_cell_outcome){.is_impact = true,
                                 .impact_m_s = cell[2].real,
                                 .closing_m_s = cell[3].real,
                                 .delta_v_m_s = cell[4].real,
                                 .olc_g = cell[5].real,
                                 .overlap_1 = cell[6].real,
                                 .is_inside = cell[8].integer != 0};
    snprintf(outcome->contact_side, sizeof outcome->contact_side, "%s", cell[7].text);
    return CP_OK;
}

cp_status cp_matrix_result_read(cp_store *store, const cp_matrix *matrix, cp_matrix_result *result,
                                cp_error *error)
{
    double open = 0.0;
    const cp_query_handler handler = {.row = take_row, .context = result};
    const cp_query_handler touches = {.row = take_touch, .context = result};
    const cp_cell_outcome nothing = {
        .impact_m_s = NAN, .closing_m_s = NAN, .delta_v_m_s = NAN, .olc_g = NAN, .overlap_1 = NAN};
    *result = (cp_matrix_result){.count = cp_matrix_cells(matrix)};
    result->without = malloc(result->count * sizeof *result->without);
    result->with = malloc(result->count * sizeof *result->with);
    if (result->without == NULL || result->with == NULL)
        return cp_fail_memory(error, "matrix");
    for (size_t k = 0; k < result->count; k++)
        result->without[k] = result->with[k] = nothing;
    cp_status status = cp_query_number(
        store, "SELECT count(*) FROM replication WHERE status <> 'done'", &open, error);
    if (status == CP_OK && open > 0.0)
        return cp_fail(error, CP_RUN_FAILED, "the matrix's study is not done");
    if (status == CP_OK)
        status = cp_query(store, TOUCHES, NULL, 0, &touches, error);
    return status == CP_OK ? cp_query(store, OUTCOMES, NULL, 0, &handler, error) : status;
}

void cp_matrix_result_destroy(cp_matrix_result *result)
{
    free(result->without);
    free(result->with);
    *result = (cp_matrix_result){0};
}
