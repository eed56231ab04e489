/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PULSE_CFC_FILTER_H
#define PULSE_CFC_FILTER_H

#include "core/error.h"

#include <stddef.h>

/* Channel frequency class filter of SAE J211-1 / ISO 6487: four-pole phaseless Butterworth, a
 * two-pole pass forward and one backward over the signal continued at both ends by its
 * point-mirrored image.
 *
 * values: count samples at sample_interval_s, filtered in place. cfc > 0, e.g. 60 (corner near
 * 100 Hz). The corner must lie below a quarter of the sampling rate (cfc * 2.0775 * interval <
 * 0.25), else CP_BAD_INPUT. */
CP_MUST_CHECK cp_status cp_cfc_filter(double *values, size_t count, double sample_interval_s,
                                      double cfc, cp_error *error);

#endif
