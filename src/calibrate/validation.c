/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/validation.h"

#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics.h>
#include <math.h>
#include <stdlib.h>

static double grouping_value(const cp_reference_case *row, int variable)
{
    const double value[3] = {row->speed_km_h, row->offset_mm, row->angle_deg};
    return value[variable];
}

// Add one error to the group of its level, groups kept in rising order of level.
static cp_status add_to_group(cp_validation *validation, int variable, double value,
                              double abs_error_g, cp_error *error)
{
    cp_validation_group *groups = validation->group[variable];
    size_t count = validation->group_count[variable], at = 0;
    while (at < count && groups[at].value < value)
        at++;
    if (at == count || groups[at].value > value) {
        if (count == CP_VALIDATION_GROUPS_MAX)
            return cp_fail(error, CP_BAD_INPUT,
                           "the reference has more than %d levels of speed, offset or angle",
                           CP_VALIDATION_GROUPS_MAX);
        for (size_t k = count; k > at; k--)
            groups[k] = groups[k - 1];
        groups[at] = (cp_validation_group){.value = value};
        validation->group_count[variable]++;
    }
    groups[at].count++;
    groups[at].mean_abs_error_g +=
        (abs_error_g - groups[at].mean_abs_error_g) / (double)groups[at].count;
    return CP_OK;
}

cp_status cp_validate_olc(const cp_reference_case *cases, const double *olc_g, size_t count,
                          cp_validation *validation, cp_error *error)
{
    *validation =
        (cp_validation){.count = count, .lowest_error_g = INFINITY, .highest_error_g = -INFINITY};
    double *errors_g = malloc((count > 0 ? count : 1) * sizeof *errors_g);
    if (errors_g == NULL)
        return cp_fail_memory(error, "validation");
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < count; k++) {
        if (isnan(olc_g[k])) {
            status = cp_fail(error, CP_RUN_FAILED,
                             "%g km/h, offset %g mm, angle %g deg could not be simulated",
                             cases[k].speed_km_h, cases[k].offset_mm, cases[k].angle_deg);
            break;
        }
        double error_g = olc_g[k] - cases[k].olc_g;
        errors_g[k] = fabs(error_g);
        validation->lowest_error_g = fmin(validation->lowest_error_g, error_g);
        validation->highest_error_g = fmax(validation->highest_error_g, error_g);
        for (int variable = 0; status == CP_OK && variable < 3; variable++)
            status = add_to_group(validation, variable, grouping_value(&cases[k], variable),
                                  errors_g[k], error);
    }
    if (status == CP_OK && count > 0) {
        gsl_sort(errors_g, 1, count);
        validation->mean_abs_error_g = gsl_stats_mean(errors_g, 1, count);
        validation->max_abs_error_g = errors_g[count - 1];
        for (int q = 0; q < 3; q++)
            validation->quartile_g[q] =
                gsl_stats_quantile_from_sorted_data(errors_g, 1, count, 0.25 * (q + 1));
    }
    free(errors_g);
    return status;
}
