/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/class_error.h"

#include <math.h>
#include <stdlib.h>

double cp_class_error_difference(const double *mean_a_g, const double *mean_b_g, size_t classes)
{
    double sum = 0.0;
    for (size_t c = 0; c < classes; c++)
        sum += (mean_a_g[c] - mean_b_g[c]) * (mean_a_g[c] - mean_b_g[c]);
    return sqrt(sum);
}

// Mean error by class over one arm.
static void mean_errors(const cp_study_data *data, const cp_replication_set *set, cp_slice slice,
                        double *mean_g, size_t *vehicles, size_t *without)
{
    for (size_t k = 0; k < data->vehicle_count; k++) {
        const cp_study_vehicle *vehicle = &data->vehicle[k];
        const cp_study_crash *crash = &data->crash[vehicle->crash];
        if (!vehicle->frontal || vehicle->olc == CP_OLC_FAILED ||
            (slice.chosen && !slice.chosen[k]) || !cp_slice_has_crash(data, slice, crash) ||
            cp_replication_set_cluster(set, crash->replication) == SIZE_MAX)
            continue;
        ++*vehicles;
        if (isnan(vehicle->class_error_g))
            ++*without;
        else
            mean_g[vehicle->evidence] += vehicle->class_error_g;
    }
    for (size_t c = 0; c<data->evidence_count && * vehicles> 0; c++)
        mean_g[c] /= (double)*vehicles;
}

cp_status cp_class_error_of(const cp_study_data *data, const cp_replication_set set[2],
                            cp_slice slice, cp_class_error *figures, cp_error *error)
{
    *figures = (cp_class_error){.error_g = NAN};
    size_t classes = data->evidence_count;
    double *mean_g = calloc(2 * classes + 1, sizeof *mean_g);
    if (mean_g == NULL)
        return cp_fail_memory(error, "errors of classes");
    for (size_t g = 0; g < 2; g++)
        mean_errors(data, &set[g], slice, &mean_g[g * classes], &figures->vehicles[g],
                    &figures->without[g]);
    bool known =
        figures->without[0] < figures->vehicles[0] || figures->without[1] < figures->vehicles[1];
    if (figures->vehicles[0] > 0 && figures->vehicles[1] > 0 && known)
        figures->error_g = cp_class_error_difference(mean_g, &mean_g[classes], classes);
    free(mean_g);
    return CP_OK;
}
