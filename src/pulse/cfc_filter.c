/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pulse/cfc_filter.h"

#include "core/units.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Ratio of design corner to class, Hz per CFC (SAE J211-1). */
#define CORNER_PER_CLASS 2.0775

/* Length of the mirrored ends in units of 1 / corner (rad/s): the two-pole's own motion dies as
 * exp(-t * corner / sqrt 2), to 1e-9 within 30. */
#define MIRROR_CORNERS 30.0

/* y_k = a0 x_k + a1 x_(k-1) + a2 x_(k-2) + b1 y_(k-1) + b2 y_(k-2) */
typedef struct two_pole {
    double a0, a1, a2, b1, b2;
} two_pole;

// Digital Butterworth low-pass by the bilinear transform, SAE J211-1 appendix C.
static two_pole design_two_pole(double cfc, double sample_interval_s)
{
    double corner_rad_s = 2.0 * CP_PI * cfc * CORNER_PER_CLASS;
    double warped = tan(0.5 * corner_rad_s * sample_interval_s);
    double divisor = 1.0 + sqrt(2.0) * warped + warped * warped;
    double a0 = warped * warped / divisor;
    return (two_pole){.a0 = a0,
                      .a1 = 2.0 * a0,
                      .a2 = a0,
                      .b1 = -2.0 * (warped * warped - 1.0) / divisor,
                      .b2 = (-1.0 + sqrt(2.0) * warped - warped * warped) / divisor};
}

// One pass over count values, stride +1 from the first or -1 from the last; starts at rest on
// the first value met.
static void run_two_pole(const two_pole *filter, double *value, size_t count, ptrdiff_t stride)
{
    double x1 = *value, x2 = *value, y1 = *value, y2 = *value;
    for (size_t k = 0; k < count; k++, value += stride) {
        double x = *value;
        double y =
            filter->a0 * x + filter->a1 * x1 + filter->a2 * x2 + filter->b1 * y1 + filter->b2 * y2;
        x2 = x1;
        x1 = x;
        y2 = y1;
        y1 = y;
        *value = y;
    }
}

cp_status cp_cfc_filter(double *values, size_t count, double sample_interval_s, double cfc,
                        cp_error *error)
{
    double corner_1 = cfc * CORNER_PER_CLASS * sample_interval_s;
    if (!(cfc > 0.0) || !(sample_interval_s > 0.0) || !(corner_1 < 0.25))
        return cp_fail(error, CP_BAD_INPUT,
                       "CFC %g filter at a sample interval of %g s: the corner must lie above zero "
                       "and below a quarter of the sampling rate (interval < %g s)",
                       cfc, sample_interval_s, 0.25 / (cfc * CORNER_PER_CLASS));
    if (count < 2)
        return CP_OK;

    // Continue the signal at both ends by its point-mirrored image.
    double wanted = ceil(MIRROR_CORNERS / (2.0 * CP_PI * corner_1));
    size_t mirror = wanted < (double)(count - 1) ? (size_t)wanted : count - 1;
    double *longer = malloc((count + 2 * mirror) * sizeof *longer);
    if (longer == NULL)
        return cp_fail_memory(error, "CFC filter");
    memcpy(longer + mirror, values, count * sizeof *values);
    for (size_t k = 1; k <= mirror; k++) {
        longer[mirror - k] = 2.0 * values[0] - values[k];
        longer[mirror + count - 1 + k] = 2.0 * values[count - 1] - values[count - 1 - k];
    }

    // Forward, then backward: the phase shifts cancel.
    two_pole filter = design_two_pole(cfc, sample_interval_s);
    run_two_pole(&filter, longer, count + 2 * mirror, 1);
    run_two_pole(&filter, longer + count + 2 * mirror - 1, count + 2 * mirror, -1);
    memcpy(values, longer + mirror, count * sizeof *values);
    free(longer);
    return CP_OK;
}
