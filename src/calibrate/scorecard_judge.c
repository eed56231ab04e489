/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/scorecard.h"

#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *cp_scorecard_verdict_text(cp_scorecard_verdict verdict)
{
    static const char *const TEXT[] = {
#define TEXT_OF(name, text) text,
        CP_SCORECARD_VERDICTS(TEXT_OF)
#undef TEXT_OF
    };
    return TEXT[verdict];
}

// ---- the bar in words --------------------------------------------------------------------------

// Append to the bar, parts apart.
static void say(cp_scorecard_row *row, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
static void say(cp_scorecard_row *row, const char *format, ...)
{
    size_t used = strlen(row->bar);
    if (used > 0)
        used += (size_t)snprintf(row->bar + used, sizeof row->bar - used, ", ");
    va_list arguments;
    va_start(arguments, format);
    if (used < sizeof row->bar)
        vsnprintf(row->bar + used, sizeof row->bar - used, format, arguments);
    va_end(arguments);
}

static void say_corridor(cp_scorecard_row *row)
{
    const cp_suite_comparison *comparison = row->comparison;
    double share_1 = comparison->bar.inside_1;
    char all[32] = "all";
    if (share_1 < 1.0)
        snprintf(all, sizeof all, "%g %%", 100.0 * share_1);
    if (comparison->population[0] != '\0')
        say(row, "%s inside 5-95 %%", all);
    else if (comparison->low.count > 1 || comparison->high.count > 1)
        say(row, "%s inside their range", all);
    else if (comparison->low.count == 0)
        say(row, "%s <= %g", all, comparison->high.value[0]);
    else if (comparison->high.count == 0)
        say(row, "%s >= %g", all, comparison->low.value[0]);
    else
        say(row, "%s in %g to %g", all, comparison->low.value[0], comparison->high.value[0]);
}

static void say_bar(cp_scorecard_row *row)
{
    const cp_suite_bar *bar = &row->comparison->bar;
    const char *unit = row->comparison->relative ? " %" : "";
    row->bar[0] = '\0';
    if (!isnan(bar->inside_1))
        say_corridor(row);
    if (!isnan(bar->mean_abs))
        say(row, "mean <= %g%s", bar->mean_abs, unit);
    if (!isnan(bar->median_abs))
        say(row, "median <= %g%s", bar->median_abs, unit);
    if (!isnan(bar->p90_abs))
        say(row, "90 %% <= %g%s", bar->p90_abs, unit);
    if (!isnan(bar->max_abs))
        say(row, "largest <= %g%s", bar->max_abs, unit);
    if (!isnan(bar->max_step))
        say(row, "step <= %g", bar->max_step);
    if (bar->falling)
        say(row, "falling");
    if (bar->last_is_highest)
        say(row, "none above the last");
}

// ---- figures -----------------------------------------------------------------------------------

static double mean_of(const double *values, size_t count)
{
    return count > 0 ? gsl_stats_mean(values, 1, count) : NAN;
}

// Figures of the errors: room holds twice the number of cases.
static void sum_up_errors(cp_scorecard_row *row, double *room)
{
    double *errors = room, *amounts = room + row->case_count;
    size_t count = 0;
    for (size_t k = 0; k < row->case_count; k++)
        if (!isnan(row->cases[k].error)) {
            errors[count] = row->cases[k].error;
            amounts[count++] = fabs(row->cases[k].error);
        }
    row->bias = mean_of(errors, count);
    row->mean_abs = mean_of(amounts, count);
    row->median_abs = row->p90_abs = row->max_abs = NAN;
    if (count == 0)
        return;
    gsl_sort(amounts, 1, count);
    row->median_abs = gsl_stats_quantile_from_sorted_data(amounts, 1, count, 0.5);
    row->p90_abs = gsl_stats_quantile_from_sorted_data(amounts, 1, count, 0.9);
    row->max_abs = amounts[count - 1];
}

static void sum_up_values(cp_scorecard_row *row, double *room)
{
    double *models = room, *references = room + row->case_count;
    size_t count = 0, reference_count = 0, corridor_count = 0, inside_count = 0;
    row->max_step = NAN;
    for (size_t k = 0; k < row->case_count; k++) {
        const cp_scorecard_case *one = &row->cases[k];
        if (!isnan(one->reference))
            references[reference_count++] = one->reference;
        corridor_count += one->has_corridor;
        inside_count += one->inside;
        if (isnan(one->model))
            continue;
        if (count > 0)
            row->max_step = fmax(isnan(row->max_step) ? 0.0 : row->max_step,
                                 fabs(one->model - models[count - 1]));
        models[count++] = one->model;
    }
    row->failed_count = row->case_count - count;
    row->model = mean_of(models, count);
    row->reference = mean_of(references, reference_count);
    row->inside_1 = corridor_count > 0 ? (double)inside_count / (double)corridor_count : NAN;
}

// ---- verdict -----------------------------------------------------------------------------------

static bool is_falling(const cp_scorecard_row *row)
{
    for (size_t k = 1; k < row->case_count; k++)
        if (row->cases[k].model > row->cases[k - 1].model)
            return false;
    return true;
}

static bool is_last_highest(const cp_scorecard_row *row)
{
    for (size_t k = 0; k + 1 < row->case_count; k++)
        if (row->cases[k].model > row->cases[row->case_count - 1].model)
            return false;
    return true;
}

// Whether a figure keeps its limit, if there is one; what could not be computed keeps none.
static bool keeps(double limit, double figure)
{
    return isnan(limit) || figure <= limit;
}

static bool keeps_bar(const cp_scorecard_row *row)
{
    const cp_suite_bar *bar = &row->comparison->bar;
    return row->failed_count == 0 && (isnan(bar->inside_1) || row->inside_1 >= bar->inside_1) &&
           keeps(bar->mean_abs, row->mean_abs) && keeps(bar->median_abs, row->median_abs) &&
           keeps(bar->p90_abs, row->p90_abs) && keeps(bar->max_abs, row->max_abs) &&
           keeps(bar->max_step, row->max_step) && (!bar->falling || is_falling(row)) &&
           (!bar->last_is_highest || is_last_highest(row));
}

// What the means of a row do not show: its worst step, or its extreme value where there is no
// reference.
static void note_extreme(cp_scorecard_row *row)
{
    const cp_suite_comparison *comparison = row->comparison;
    const cp_suite_bar *bar = &comparison->bar;
    const cp_scorecard_case *cases = row->cases;
    size_t step = 0, highest = 0, lowest = 0;
    for (size_t k = 1; k < row->case_count; k++) {
        if (step == 0 || fabs(cases[k].model - cases[k - 1].model) >
                             fabs(cases[step].model - cases[step - 1].model))
            step = k;
        if (cases[k].model > cases[highest].model)
            highest = k;
        if (cases[k].model < cases[lowest].model)
            lowest = k;
    }
    if (row->note[0] != '\0' || row->case_count < 2)
        return;
    if (!isnan(bar->max_step))
        snprintf(row->note, sizeof row->note, "largest step %.3g, to %s", row->max_step,
                 cases[step].label);
    else if (bar->last_is_highest)
        snprintf(row->note, sizeof row->note, "highest %.3g, %s; last %.3g", cases[highest].model,
                 cases[highest].label, cases[row->case_count - 1].model);
    else if (comparison->high.count > 0 && comparison->low.count == 0)
        snprintf(row->note, sizeof row->note, "highest %.4g, %s", cases[highest].model,
                 cases[highest].label);
    else if (comparison->low.count > 0 && comparison->high.count == 0)
        snprintf(row->note, sizeof row->note, "lowest %.4g, %s", cases[lowest].model,
                 cases[lowest].label);
}

// Error and place of one case.
static void judge_case(const cp_suite_comparison *comparison, cp_scorecard_case *one)
{
    one->error = one->model - one->reference;
    if (comparison->relative)
        one->error *= 100.0 / fabs(one->reference);
    one->has_corridor = !isnan(one->low) || !isnan(one->high);
    double judged = one->is_range ? one->reference : one->model;
    one->inside = one->has_corridor && !isnan(judged) && (isnan(one->low) || judged >= one->low) &&
                  (isnan(one->high) || judged <= one->high);
}

cp_status cp_scorecard_judge(cp_scorecard_row *row, cp_error *error)
{
    double *room = calloc(2 * row->case_count + 1, sizeof *room);
    if (room == NULL)
        return cp_fail_memory(error, "scorecard");
    for (size_t k = 0; k < row->case_count; k++)
        judge_case(row->comparison, &row->cases[k]);
    sum_up_errors(row, room);
    sum_up_values(row, room);
    free(room);
    say_bar(row);
    note_extreme(row);
    row->verdict = row->bar[0] == '\0' ? CP_SCORECARD_NO_BAR
                   : keeps_bar(row)    ? CP_SCORECARD_KEPT
                                       : CP_SCORECARD_MISSED;
    return CP_OK;
}
