/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STATS_BAND_H
#define STATS_BAND_H

#include "stats/bootstrap.h"
#include "stats/sample.h"

/* Band around an empirical distribution function that holds the true one over its whole length
 * with the given confidence: ecdf +- half_width, cut at 0 and 1. The half width is the quantile,
 * over resamples of whole clusters, of the largest distance between the resample's function and
 * the sample's, times sqrt(n / (n - strata)) because resampled variances are too small. For
 * independent values and one value a cluster it comes to Kolmogorov's 1.358 / sqrt(n) at 95 %. */
typedef struct cp_band {
    cp_interval_status status;
    double half_width_1; /* NAN unless status is CP_INTERVAL_VALUE */
} cp_band;

/* resampling: cluster_count[0] is the sample's; too few clusters as for every interval. Undefined
 * without an observation. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_band_of_ecdf(const cp_sample *sample, const cp_resampling *resampling,
                                        cp_band *band, cp_error *error);

#endif
