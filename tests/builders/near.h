/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BUILDERS_NEAR_H
#define BUILDERS_NEAR_H

#include <math.h>

/* Two doubles within a tolerance; cmocka's own assert_float_equal compares floats. Include after
 * cmocka.h. */
#define assert_near(actual, expected, tolerance)                                                   \
    do {                                                                                           \
        double actual_ = (actual), expected_ = (expected);                                         \
        if (!(fabs(actual_ - expected_) <= (tolerance)))                                           \
            fail_msg("%s: found %.17g, expected %.17g within %g", #actual, actual_, expected_,     \
                     (double)(tolerance));                                                         \
    } while (0)

#endif
