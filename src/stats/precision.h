/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STATS_PRECISION_H
#define STATS_PRECISION_H

#include "stats/bootstrap.h"

/* How sharp a result is, and how many replications it would take to make it sharper. */
typedef struct cp_precision {
    double half_width;          /* of the interval, in the estimate's unit */
    double relative_1;          /* half_width / |estimate| */
    double replications_needed; /* for a relative half width of target_1, rounded up */
} cp_precision;

/* All NAN without a closed interval or for an estimate of 0. Half widths fall with the square root
 * of the replications: needed = replications (relative_1 / target_1)^2. target_1 > 0, e.g. 0.1. */
cp_precision cp_precision_of(double estimate, cp_interval interval, size_t replications,
                             double target_1);

#endif
