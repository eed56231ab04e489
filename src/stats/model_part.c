/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/model_part.h"

#include <gsl/gsl_cdf.h>

#include <math.h>

// Whether every figure is known exactly.
static cp_interval_status status_of(cp_estimate estimate, const cp_estimate *of_set, size_t sets)
{
    cp_interval_status status = CP_INTERVAL_VALUE;
    for (size_t k = 0; k <= sets; k++) {
        cp_relation relation = k < sets ? of_set[k].relation : estimate.relation;
        if (relation == CP_NO_VALUE)
            return CP_INTERVAL_UNDEFINED;
        if (relation != CP_EXACTLY)
            status = CP_INTERVAL_CENSORED;
    }
    return status;
}

static cp_interval combine(const cp_model_part *part)
{
    cp_interval_status status = part->replications.status;
    if (status != CP_INTERVAL_VALUE || part->status != CP_INTERVAL_VALUE)
        return (cp_interval){status != CP_INTERVAL_VALUE ? status : part->status, NAN, NAN};
    double value = part->estimate.value;
    double below = fmax(0.0, value - part->replications.low);
    double above = fmax(0.0, part->replications.high - value);
    return (cp_interval){CP_INTERVAL_VALUE, value - hypot(below, part->half_width),
                         value + hypot(above, part->half_width)};
}

cp_model_part cp_model_part_of(cp_estimate estimate, cp_interval replications,
                               const cp_estimate *of_set, size_t sets)
{
    cp_model_part part = {.sets = sets,
                          .estimate = estimate,
                          .replications = replications,
                          .status = status_of(estimate, of_set, sets),
                          .mean = NAN,
                          .sd = NAN,
                          .half_width = NAN};
    if (part.status == CP_INTERVAL_VALUE && sets >= 2) {
        double sum = 0.0, squares = 0.0, freedom = (double)sets - 1.0;
        for (size_t k = 0; k < sets; k++)
            sum += of_set[k].value;
        part.mean = sum / (double)sets;
        for (size_t k = 0; k < sets; k++)
            squares += (of_set[k].value - part.mean) * (of_set[k].value - part.mean);
        part.sd = sqrt(squares / freedom);
        part.half_width = part.sd * gsl_cdf_tdist_Pinv(0.975, freedom);
    }
    part.combined = combine(&part);
    return part;
}
