/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/weighted.h"

#include <math.h>

double cp_weighted_effective(const double *weight, size_t count)
{
    double sum = 0.0, squares = 0.0;
    for (size_t k = 0; k < count; k++) {
        sum += weight[k];
        squares += weight[k] * weight[k];
    }
    return squares > 0.0 ? sum * sum / squares : 0.0;
}

static double copies_of(const unsigned *times, size_t k)
{
    return times ? times[k] : 1.0;
}

// From the first copy of the first value to the last of the last.
static double length_of(const double *weight, const unsigned *times, size_t count)
{
    double length = 0.0, before = -1.0;
    for (size_t k = 0; k < count; k++) {
        double copies = copies_of(times, k);
        if (copies < 1.0 || !(weight[k] > 0.0))
            continue;
        length += (copies - 1.0) * weight[k] + (before >= 0.0 ? 0.5 * (before + weight[k]) : 0.0);
        before = weight[k];
    }
    return before >= 0.0 ? length : NAN;
}

double cp_weighted_quantile(const double *value, const double *weight, const unsigned *times,
                            size_t count, double p)
{
    double place = p * length_of(weight, times, count), passed = 0.0, before = -1.0, low = NAN;
    if (isnan(place))
        return NAN;
    for (size_t k = 0; k < count; k++) {
        double copies = copies_of(times, k);
        if (copies < 1.0 || !(weight[k] > 0.0))
            continue;
        // The way from the value before to this one, then along its copies.
        if (before >= 0.0) {
            double step = 0.5 * (before + weight[k]);
            if (place <= passed)
                return low;
            if (place < passed + step)
                return isinf(low) ? low : low + (place - passed) / step * (value[k] - low);
            passed += step;
        }
        passed += (copies - 1.0) * weight[k];
        before = weight[k];
        low = value[k];
        if (place <= passed)
            return low;
    }
    return low;
}

cp_weighted_distance cp_weighted_distance_of(const double *a, const double *weight_a,
                                             size_t count_a, const double *b,
                                             const double *weight_b, size_t count_b)
{
    double total_a = 0.0, total_b = 0.0, of_a = 0.0, of_b = 0.0, at = NAN;
    for (size_t k = 0; k < count_a; k++)
        total_a += weight_a[k];
    for (size_t k = 0; k < count_b; k++)
        total_b += weight_b[k];
    if (!(total_a > 0.0 && total_b > 0.0))
        return (cp_weighted_distance){NAN, NAN};

    // One walk over both, from value to value.
    cp_weighted_distance d = {0.0, 0.0};
    for (size_t i = 0, j = 0; i < count_a || j < count_b;) {
        double next = i < count_a && (j == count_b || a[i] <= b[j]) ? a[i] : b[j];
        if (!isnan(at))
            d.mean += fabs(of_a - of_b) * (next - at);
        for (; i < count_a && a[i] <= next; i++)
            of_a += weight_a[i] / total_a;
        for (; j < count_b && b[j] <= next; j++)
            of_b += weight_b[j] / total_b;
        at = next;
        d.largest_1 = fmax(d.largest_1, fabs(of_a - of_b));
    }
    return d;
}
