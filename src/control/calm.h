/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_CALM_H
#define CONTROL_CALM_H

#include <math.h>
#include <stdbool.h>

/* Whether it has been calm for hold_s up to now; *since_s, INFINITY at first, keeps since when. */
static inline bool cp_is_calm_for(double *since_s, double now_s, bool is_calm, double hold_s)
{
    if (!is_calm)
        *since_s = INFINITY;
    else if (*since_s == INFINITY)
        *since_s = now_s;
    return is_calm && now_s - *since_s >= hold_s;
}

#endif
