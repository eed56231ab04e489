/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/precision.h"

#include <math.h>

cp_precision cp_precision_of(double estimate, cp_interval interval, size_t replications,
                             double target_1)
{
    cp_precision precision = {NAN, NAN, NAN};
    if (interval.status != CP_INTERVAL_VALUE || !isfinite(interval.low) ||
        !isfinite(interval.high) || !isfinite(estimate) || estimate == 0.0)
        return precision;
    precision.half_width = 0.5 * (interval.high - interval.low);
    precision.relative_1 = precision.half_width / fabs(estimate);
    double ratio = precision.relative_1 / target_1;
    // A hair less, so that rounding does not add a replication.
    precision.replications_needed = ceil((double)replications * ratio * ratio * (1.0 - 1e-12));
    return precision;
}
