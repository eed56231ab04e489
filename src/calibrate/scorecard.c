/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/scorecard.h"

#include "calibrate/parallel.h"
#include "calibrate/suite_cases.h"
#include "core/csv_table.h"
#include "crash/validity.h"

#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Cases of one class for one vehicle, and the rows they fill.
typedef struct block {
    const cp_suite_class *class;
    cp_suite_cases cases;
    size_t first_row;
} block;

typedef struct task {
    const block *of;
    size_t index; /* of the case */
    char problem[200];
} task;

typedef struct maker {
    const cp_scorecard_request *request;
    cp_scorecard *scorecard;
    cp_csv_table quantiles;
    block *block;
    size_t block_count;
    task *task;
    size_t task_count;
    cp_error *error;
} maker;

// ---- rows and their references -----------------------------------------------------------------

// 5, 50 and 95 % of a population.
static cp_status find_population(const maker *make, const cp_suite_comparison *comparison,
                                 double time_ms, cp_scorecard_case *one)
{
    const cp_csv_table *table = &make->quantiles;
    const char *quantity = CP_SUITE_QUANTITY_TEXT[comparison->quantity];
    for (size_t k = 0; k < table->row_count; k++) {
        const char *population = NULL, *name = NULL;
        double at_ms = NAN;
        cp_status status = cp_csv_table_text(table, k, "population", &population, make->error);
        if (status == CP_OK)
            status = cp_csv_table_text(table, k, "quantity", &name, make->error);
        if (status == CP_OK)
            status = cp_csv_table_number(table, k, "time_ms", 0, 1000, true, &at_ms, make->error);
        if (status != CP_OK)
            return status;
        if (strcmp(population, comparison->population) != 0 || strcmp(name, quantity) != 0 ||
            !(at_ms == time_ms || (isnan(at_ms) && isnan(time_ms))))
            continue;
        status = cp_csv_table_number(table, k, "p05", -1e6, 1e6, false, &one->low, make->error);
        if (status == CP_OK)
            status = cp_csv_table_number(table, k, "p50", -1e6, 1e6, false, &one->reference,
                                         make->error);
        return status == CP_OK
                   ? cp_csv_table_number(table, k, "p95", -1e6, 1e6, false, &one->high, make->error)
                   : status;
    }
    char at[32] = "";
    if (!isnan(time_ms))
        snprintf(at, sizeof at, " at %g ms", time_ms);
    return cp_fail(make->error, CP_BAD_INPUT, "%s: no %s of population %s%s",
                   table->path != NULL ? table->path : make->request->suite->path, quantity,
                   comparison->population, at);
}

// Number k of a list that holds one value for all cases, or one each; NAN when there is none.
static double listed(const cp_suite_numbers *numbers, size_t k)
{
    return numbers->count == 0 ? NAN : numbers->value[numbers->count == 1 ? 0 : k];
}

static cp_status check_list(const maker *make, const block *of, const char *key,
                            const cp_suite_numbers *numbers)
{
    if (numbers->count <= 1 || numbers->count == of->cases.count)
        return CP_OK;
    return cp_fail(make->error, CP_BAD_INPUT,
                   "%s: class %s: %s must have one value, or one for each of its %zu cases, "
                   "found %zu",
                   make->request->suite->path, of->class->name, key, of->cases.count,
                   numbers->count);
}

// What a case is held against.
static cp_status set_reference(const maker *make, const cp_suite_comparison *comparison,
                               const cp_suite_case *row, size_t k, int car, cp_scorecard_case *one)
{
    one->reference = row->reference[car][comparison->quantity];
    one->low = listed(&comparison->low, k);
    one->high = listed(&comparison->high, k);
    one->model = one->error = NAN;
    if (comparison->population[0] != '\0')
        return find_population(make, comparison, one->time_ms, one);
    if (comparison->reference.count > 0)
        one->reference = listed(&comparison->reference, k);
    else if (isnan(one->reference))
        one->reference = 0.5 * (one->low + one->high);
    return CP_OK;
}

// Cases of a row: every case of the class, each of its cars, each instant.
static cp_status fill_row(const maker *make, const block *of, cp_scorecard_row *row)
{
    const cp_suite_comparison *comparison = row->comparison;
    int cars = cp_suite_case_cars(of->class, comparison);
    size_t times = comparison->times_ms.count > 0 ? comparison->times_ms.count : 1;
    cp_status status = check_list(make, of, "reference", &comparison->reference);
    if (status == CP_OK)
        status = check_list(make, of, "low", &comparison->low);
    if (status == CP_OK)
        status = check_list(make, of, "high", &comparison->high);
    if (status != CP_OK)
        return status;
    row->case_count = of->cases.count * (size_t)cars * times;
    row->cases = calloc(row->case_count + 1, sizeof *row->cases);
    if (row->cases == NULL)
        return cp_fail_memory(make->error, "scorecard");
    for (size_t n = 0; status == CP_OK && n < row->case_count; n++) {
        size_t k = n / times / (size_t)cars;
        int car = comparison->car > 0 ? comparison->car - 1 : (int)(n / times % (size_t)cars);
        cp_scorecard_case *one = &row->cases[n];
        one->time_ms = comparison->times_ms.count > 0 ? comparison->times_ms.value[n % times] : NAN;
        snprintf(one->label, sizeof one->label, "%s%s", of->cases.row[k].label,
                 cars == 1 && comparison->car == 0 ? ""
                 : car == 0                        ? ", car 1"
                                                   : ", car 2");
        status = set_reference(make, comparison, &of->cases.row[k], k, car, one);
    }
    return status;
}

// ---- which vehicle is judged by which class ----------------------------------------------------

// A class that has its own vehicles and not this one.
static bool is_foreign(const cp_suite_class *class, const char *name)
{
    for (size_t k = 0; k < class->vehicles.count; k++)
        if (strcmp(class->vehicles.text[k], name) == 0)
            return false;
    return class->vehicles.count > 0;
}

static cp_status add_rows(maker *make, block *of, const char *vehicle)
{
    cp_scorecard *scorecard = make->scorecard;
    of->first_row = scorecard->count;
    for (size_t c = 0; c < of->class->comparison_count; c++) {
        cp_scorecard_row *row = &scorecard->row[scorecard->count++];
        const cp_suite_comparison *comparison = &of->class->comparison[c];
        *row = (cp_scorecard_row){
            .class = of->class,
            .comparison = comparison,
            .quantity = CP_SUITE_QUANTITY_TEXT[comparison->quantity],
            .error_unit = comparison->relative ? "%" : CP_SUITE_QUANTITY_UNIT[comparison->quantity],
            .verdict = CP_SCORECARD_SKIPPED};
        snprintf(row->vehicle, sizeof row->vehicle, "%s", vehicle);
        snprintf(row->note, sizeof row->note, "%s", of->cases.skipped);
        cp_status status = of->cases.skipped[0] == '\0' ? fill_row(make, of, row) : CP_OK;
        if (status != CP_OK)
            return status;
    }
    return CP_OK;
}

static cp_status add_block(maker *make, const cp_suite_class *class, const char *base,
                           const char *text)
{
    cp_vehicle_model vehicle;
    cp_status status = cp_suite_vehicle(base, text, &vehicle, make->error);
    if (status != CP_OK)
        return status;
    block *of = &make->block[make->block_count++];
    of->class = class;
    if (is_foreign(class, vehicle.name))
        snprintf(of->cases.skipped, sizeof of->cases.skipped, "the reference is of %.100s",
                 class->vehicles.text[0]);
    else
        status = cp_suite_cases_of(make->request->suite, class, &vehicle, make->request->references,
                                   &of->cases, make->error);
    make->task_count += of->cases.count;
    return status == CP_OK ? add_rows(make, of, vehicle.name) : status;
}

// Room for every class with every vehicle.
static cp_status make_room(maker *make)
{
    const cp_suite *suite = make->request->suite;
    size_t blocks = 0, rows = 0;
    for (size_t k = 0; k < suite->class_count; k++) {
        const cp_suite_class *class = &suite->class[k];
        size_t vehicles = make->request->vehicle_count > 0 ? make->request->vehicle_count
                          : class->vehicles.count > 0      ? class->vehicles.count
                                                           : suite->vehicles.count;
        blocks += vehicles;
        rows += vehicles * class->comparison_count;
    }
    make->block = calloc(blocks + 1, sizeof *make->block);
    make->scorecard->row = calloc(rows + 1, sizeof *make->scorecard->row);
    return make->block != NULL && make->scorecard->row != NULL
               ? CP_OK
               : cp_fail_memory(make->error, "scorecard");
}

static cp_status add_blocks(maker *make)
{
    const cp_scorecard_request *request = make->request;
    const cp_suite *suite = request->suite;
    cp_status status = make_room(make);
    for (size_t k = 0; status == CP_OK && k < suite->class_count; k++) {
        const cp_suite_class *class = &suite->class[k];
        const cp_suite_texts *own = class->vehicles.count > 0 ? &class->vehicles : &suite->vehicles;
        size_t count = request->vehicle_count > 0 ? request->vehicle_count : own->count;
        for (size_t v = 0; status == CP_OK && v < count; v++)
            status = request->vehicle_count > 0 ? add_block(make, class, NULL, request->vehicles[v])
                                                : add_block(make, class, suite->path, own->text[v]);
    }
    return status;
}

// ---- simulating --------------------------------------------------------------------------------

// The quantities of one simulation, added to those of the other offsets.
static void look_at(const maker *make, const task *work, size_t offset,
                    const cp_crash_result *result, const cp_crash_result *wall, double *values)
{
    const block *of = work->of;
    const cp_suite_case *row = &of->cases.row[work->index];
    for (size_t c = 0, place = 0; c < of->class->comparison_count; c++) {
        const cp_scorecard_row *target = &make->scorecard->row[of->first_row + c];
        size_t each = target->case_count / of->cases.count;
        int cars = cp_suite_case_cars(of->class, target->comparison);
        for (size_t n = 0; n < each; n++, place++) {
            const cp_scorecard_case *one = &target->cases[work->index * each + n];
            cp_suite_look look = {.quantity = target->comparison->quantity,
                                  .car = target->comparison->car > 0
                                             ? target->comparison->car - 1
                                             : (int)(n / (each / (size_t)cars)),
                                  .time_s = 1e-3 * one->time_ms,
                                  .side_1 = row->side_1,
                                  .mass_kg = {row->model[0].mass_kg, row->model[1].mass_kg},
                                  .cell_mass_kg = {cp_vehicle_model_cell_mass(&row->model[0]),
                                                   cp_vehicle_model_cell_mass(&row->model[1])},
                                  .wall = wall};
            values[place * CP_SUITE_OFFSETS_MAX + offset] = cp_suite_quantity_of(&look, result);
        }
    }
}

// One simulation: its value. Several: their median and range.
static void keep_values(const maker *make, const task *work, size_t count, double *values)
{
    const block *of = work->of;
    bool is_range = of->cases.row[work->index].offset_count > 1;
    for (size_t c = 0, place = 0; c < of->class->comparison_count; c++) {
        cp_scorecard_row *target = &make->scorecard->row[of->first_row + c];
        size_t each = target->case_count / of->cases.count;
        for (size_t n = 0; n < each; n++, place++) {
            cp_scorecard_case *one = &target->cases[work->index * each + n];
            double *found = values + place * CP_SUITE_OFFSETS_MAX;
            gsl_sort(found, 1, count);
            one->model = gsl_stats_quantile_from_sorted_data(found, 1, count, 0.5);
            one->is_range = is_range;
            if (one->is_range) {
                one->low = found[0];
                one->high = found[count - 1];
            }
        }
    }
}

static size_t values_of(const maker *make, const block *of)
{
    size_t total = 0;
    for (size_t c = 0; c < of->class->comparison_count; c++)
        total += make->scorecard->row[of->first_row + c].case_count / of->cases.count;
    return total;
}

static cp_status run_task(void *context, size_t k)
{
    const maker *make = context;
    task *work = &make->task[k];
    const cp_suite_case *row = &work->of->cases.row[work->index];
    double *values = calloc(values_of(make, work->of) * CP_SUITE_OFFSETS_MAX, sizeof *values);
    cp_status status = values != NULL ? CP_OK : CP_NO_MEMORY;
    cp_error error = {0};
    size_t met = 0;
    for (size_t offset = 0; status == CP_OK && offset < row->offset_count; offset++) {
        cp_crash_result result, wall;
        status = cp_suite_case_simulate(row, offset, &result, &wall, &error);
        if (status == CP_OK && result.touched)
            look_at(make, work, met++, &result, &wall, values);
        cp_crash_result_destroy(&result);
        cp_crash_result_destroy(&wall);
    }
    // Where the two would have passed each other the test was not; everywhere it cannot be.
    if (status == CP_OK && met == 0)
        status = cp_fail(&error, CP_RUN_FAILED, CP_NO_CONTACT_TEXT);
    if (status == CP_OK)
        keep_values(make, work, met, values);
    else
        snprintf(work->problem, sizeof work->problem, "%.60s: %.130s", row->label, error.text);
    free(values);
    return status == CP_NO_MEMORY ? status : CP_OK;
}

static cp_status run_tasks(maker *make)
{
    make->task = calloc(make->task_count + 1, sizeof *make->task);
    if (make->task == NULL)
        return cp_fail_memory(make->error, "scorecard");
    size_t count = 0;
    for (size_t b = 0; b < make->block_count; b++)
        for (size_t k = 0; k < make->block[b].cases.count; k++)
            make->task[count++] = (task){.of = &make->block[b], .index = k};
    return cp_parallel_simulate(make->task_count, make->request->threads, run_task, make,
                                make->error);
}

// The first thing that went wrong in a row's cases is its note.
static void note_problems(maker *make)
{
    for (size_t k = make->task_count; k-- > 0;) {
        const task *work = &make->task[k];
        for (size_t c = 0; work->problem[0] != '\0' && c < work->of->class->comparison_count; c++) {
            cp_scorecard_row *row = &make->scorecard->row[work->of->first_row + c];
            snprintf(row->note, sizeof row->note, "%s", work->problem);
        }
    }
}

static cp_status judge_rows(maker *make)
{
    note_problems(make);
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < make->scorecard->count; k++) {
        cp_scorecard_row *row = &make->scorecard->row[k];
        if (row->case_count > 0)
            status = cp_scorecard_judge(row, make->error);
    }
    return status;
}

cp_status cp_scorecard_make(const cp_scorecard_request *request, cp_scorecard *scorecard,
                            cp_error *error)
{
    *scorecard = (cp_scorecard){0};
    maker make = {.request = request, .scorecard = scorecard, .error = error};
    cp_status status = CP_OK;
    if (request->suite->quantiles_path != NULL)
        status = cp_csv_table_load(request->suite->quantiles_path, &make.quantiles, error);
    if (status == CP_OK)
        status = add_blocks(&make);
    if (status == CP_OK)
        status = run_tasks(&make);
    if (status == CP_OK)
        status = judge_rows(&make);
    for (size_t b = 0; b < make.block_count; b++)
        cp_suite_cases_destroy(&make.block[b].cases);
    free(make.block);
    free(make.task);
    cp_csv_table_destroy(&make.quantiles);
    return status;
}

void cp_scorecard_destroy(cp_scorecard *scorecard)
{
    for (size_t k = 0; k < scorecard->count; k++)
        free(scorecard->row[k].cases);
    free(scorecard->row);
    *scorecard = (cp_scorecard){0};
}
