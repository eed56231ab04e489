/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/suite_validation.h"

#include "calibrate/scorecard.h"
#include "calibrate/suite_file.h"
#include "core/file.h"
#include "crash/crash_simulation.h"

#include <math.h>
#include <stdlib.h>

// A number: all its digits for programs, four for people.
static void add_real(cp_table *table, cp_format format, double value)
{
    char text[32];
    snprintf(text, sizeof text, "%.4g", value);
    if (format != CP_FORMAT_TABLE)
        cp_table_real(table, value);
    else
        cp_table_text(table, isnan(value) ? "" : text);
}

// ---- a row a class, vehicle and quantity -------------------------------------------------------

static const char *const ROW_COLUMNS[] = {
    "class",    "vehicle", "quantity",   "unit",     "cases", "reference", "model", "bias",
    "mean_abs", "max_abs", "error_unit", "inside_1", "bar",   "result",    "note"};

static const char *unit_of(const cp_scorecard_row *row)
{
    return CP_SUITE_QUANTITY_UNIT[row->comparison->quantity];
}

static cp_status print_rows(const cp_scorecard *scorecard, cp_format format, cp_error *error)
{
    cp_table table = {0};
    cp_table_begin(&table, ROW_COLUMNS, sizeof ROW_COLUMNS / sizeof *ROW_COLUMNS);
    for (size_t k = 0; k < scorecard->count; k++) {
        const cp_scorecard_row *row = &scorecard->row[k];
        bool empty = row->case_count == 0;
        const double figures[] = {row->reference, row->model,   row->bias,
                                  row->mean_abs,  row->max_abs, row->inside_1};
        cp_table_text(&table, row->class->name);
        cp_table_text(&table, row->vehicle);
        cp_table_text(&table, row->quantity);
        cp_table_text(&table, unit_of(row));
        cp_table_integer(&table, (int64_t)row->case_count);
        for (size_t f = 0; f < 5; f++)
            add_real(&table, format, empty ? NAN : figures[f]);
        cp_table_text(&table, row->error_unit);
        add_real(&table, format, empty ? NAN : figures[5]);
        cp_table_text(&table, row->bar);
        cp_table_text(&table, cp_scorecard_verdict_text(row->verdict));
        cp_table_text(&table, row->note);
    }
    cp_status status = cp_table_print(&table, format, stdout, error);
    cp_table_destroy(&table);
    return status;
}

// ---- a row a case ------------------------------------------------------------------------------

static const char *const CASE_COLUMNS[] = {"class",   "vehicle",    "quantity", "unit", "case",
                                           "time_ms", "reference",  "low",      "high", "model",
                                           "error",   "error_unit", "inside"};

static void add_case(cp_table *table, cp_format format, const cp_scorecard_row *row,
                     const cp_scorecard_case *one)
{
    cp_table_text(table, row->class->name);
    cp_table_text(table, row->vehicle);
    cp_table_text(table, row->quantity);
    cp_table_text(table, unit_of(row));
    cp_table_text(table, one->label);
    add_real(table, format, one->time_ms);
    add_real(table, format, one->reference);
    add_real(table, format, one->low);
    add_real(table, format, one->high);
    add_real(table, format, one->model);
    add_real(table, format, one->error);
    cp_table_text(table, row->error_unit);
    cp_table_text(table, !one->has_corridor ? "" : one->inside ? "yes" : "no");
}

static cp_status print_cases(const cp_scorecard *scorecard, cp_format format, cp_error *error)
{
    cp_table table = {0};
    cp_table_begin(&table, CASE_COLUMNS, sizeof CASE_COLUMNS / sizeof *CASE_COLUMNS);
    for (size_t k = 0; k < scorecard->count; k++)
        for (size_t c = 0; c < scorecard->row[k].case_count; c++)
            add_case(&table, format, &scorecard->row[k], &scorecard->row[k].cases[c]);
    cp_status status = cp_table_print(&table, format, stdout, error);
    cp_table_destroy(&table);
    return status;
}

// ---- JSON --------------------------------------------------------------------------------------

static json_t *real_json(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *cases_json(const cp_scorecard_row *row)
{
    json_t *cases = json_array();
    for (size_t c = 0; c < row->case_count; c++) {
        const cp_scorecard_case *one = &row->cases[c];
        json_t *inside = one->has_corridor ? json_boolean(one->inside) : json_null();
        json_array_append_new(cases, json_pack("{s:s, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "case",
                                               one->label, "time_ms", real_json(one->time_ms),
                                               "reference", real_json(one->reference), "low",
                                               real_json(one->low), "high", real_json(one->high),
                                               "model", real_json(one->model), "error",
                                               real_json(one->error), "inside", inside));
    }
    return cases;
}

static json_t *row_json(const cp_scorecard_row *row, bool list_cases)
{
    bool empty = row->case_count == 0;
    json_t *json = json_pack(
        "{s:s, s:s, s:s, s:s, s:s, s:s, s:I, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:s, s:s, "
        "s:s, "
        "s:s}",
        "class", row->class->name, "title", row->class->title, "vehicle", row->vehicle, "quantity",
        row->quantity, "label", CP_SUITE_QUANTITY_LABEL[row->comparison->quantity], "unit",
        unit_of(row), "cases", (json_int_t)row->case_count, "reference",
        real_json(empty ? NAN : row->reference), "model", real_json(empty ? NAN : row->model),
        "bias", real_json(empty ? NAN : row->bias), "mean_abs",
        real_json(empty ? NAN : row->mean_abs), "median_abs",
        real_json(empty ? NAN : row->median_abs), "p90_abs", real_json(empty ? NAN : row->p90_abs),
        "max_abs", real_json(empty ? NAN : row->max_abs), "inside_1",
        real_json(empty ? NAN : row->inside_1), "error_unit", row->error_unit, "bar", row->bar,
        "result", cp_scorecard_verdict_text(row->verdict), "note", row->note);
    if (list_cases)
        json_object_set_new(json, "list", cases_json(row));
    return json;
}

static cp_status print_json(const cp_scorecard *scorecard, bool list_cases, cp_error *error)
{
    json_t *rows = json_array();
    for (size_t k = 0; k < scorecard->count; k++)
        json_array_append_new(rows, row_json(&scorecard->row[k], list_cases));
    return cp_json_print(rows, stdout, error);
}

// ---- all of it ---------------------------------------------------------------------------------

static cp_status print(const cp_scorecard *scorecard, bool list_cases, cp_format format,
                       cp_error *error)
{
    if (format == CP_FORMAT_JSON)
        return print_json(scorecard, list_cases, error);
    return list_cases ? print_cases(scorecard, format, error)
                      : print_rows(scorecard, format, error);
}

static cp_status make_and_print(const cp_suite_validation *what, const cp_suite *suite,
                                const char *references, cp_format format, cp_error *error)
{
    const cp_scorecard_request request = {.suite = suite,
                                          .vehicles = what->vehicles,
                                          .vehicle_count = what->vehicle_count,
                                          .references = references,
                                          .threads = what->threads};
    cp_scorecard scorecard = {0};
    cp_status status = cp_crash_library_begin(error);
    if (status != CP_OK)
        return status;
    status = cp_scorecard_make(&request, &scorecard, error);
    cp_crash_library_end();
    if (status == CP_OK)
        status = print(&scorecard, what->list_cases, format, error);
    cp_scorecard_destroy(&scorecard);
    return status;
}

cp_status cp_suite_validate(const cp_suite_validation *what, cp_format format, cp_error *error)
{
    cp_suite suite = {0};
    cp_status status = cp_suite_load(what->path, &suite, error);
    char *beside = cp_file_beside(what->path, "../../../shared/reference");
    if (status == CP_OK && beside == NULL)
        status = cp_fail_memory(error, what->path);
    if (status == CP_OK)
        status = make_and_print(what, &suite, what->references != NULL ? what->references : beside,
                                format, error);
    free(beside);
    cp_suite_destroy(&suite);
    return status;
}
