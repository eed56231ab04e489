/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef FMU_TEST_RULE_H
#define FMU_TEST_RULE_H

#include <math.h>

/* What the unit of the test and the function that it is compared with both decide: brake for the
 * nearest object when it is in the way and the gap closes within ttc_s, and on for half a second.
 */

typedef struct rule_state {
    double left_s; /* goes on braking for so long */
} rule_state;

static inline double rule_brake_m_s2(rule_state *state, double ttc_s, double step_s,
                                     double own_speed_m_s, double ahead_m, double left_m,
                                     double heading_rad, double speed_m_s)
{
    double closing_m_s = own_speed_m_s - speed_m_s * cos(heading_rad);
    int is_in_the_way = ahead_m > 0.0 && fabs(left_m) < 2.0 && closing_m_s > 0.0;
    state->left_s = is_in_the_way && ahead_m < ttc_s * closing_m_s ? 0.5 : state->left_s - step_s;
    return state->left_s > 0.0 ? 7.0 : 0.0;
}

#endif
