/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STATS_ASSERT_NEAR_H
#define STATS_ASSERT_NEAR_H

#include <math.h>

/* Fails, naming both numbers, unless they differ by at most tolerance. Include after cmocka.h. */
#define assert_near(found, expected, tolerance)                                                    \
    do {                                                                                           \
        double near_found = (found), near_expected = (expected);                                   \
        if (!(fabs(near_found - near_expected) <= (tolerance)))                                    \
            fail_msg("%s = %.17g, expected %.17g within %g", #found, near_found, near_expected,    \
                     (double)(tolerance));                                                         \
    } while (0)

#endif
