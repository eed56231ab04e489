/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pulse/olc.h"

#include "core/units.h"

#include <gsl/gsl_poly.h>
#include <math.h>
#include <stdbool.h>

const char *cp_olc_status_text(cp_olc_status status)
{
    static const char *const TEXT[] = {
#define CP_OLC_STATUS_ROW(name, text) [name] = text,
        CP_OLC_STATUSES(CP_OLC_STATUS_ROW)
#undef CP_OLC_STATUS_ROW
    };
    return TEXT[status];
}

/* A stretch of the record with linear velocity: begin_s <= t <= begin_s + length_s, and
 *   lag(t)  = V0 - v = lag_m_s + lag_rate_m_s2 * (t - begin_s)
 *   s(t)    = s_m + lag_m_s * (t - begin_s) + lag_rate_m_s2 / 2 * (t - begin_s)^2 */
typedef struct stretch {
    double begin_s;
    double length_s;
    double s_m;
    double lag_m_s;
    double lag_rate_m_s2;
} stretch;

// Where c0 + c1 u + c2 u^2 first is at least zero, from <= u <= to.
static bool first_reached(double c0, double c1, double c2, double from, double to, double *u)
{
    if (c0 + from * (c1 + from * c2) >= 0.0) {
        *u = from;
        return true;
    }
    double root[2];
    int count = gsl_poly_solve_quadratic(c2, c1, c0, &root[0], &root[1]);
    for (int k = 0; k < count; k++)
        if (root[k] > from && root[k] <= to) {
            *u = root[k];
            return true;
        }

    // A root that rounding pushed just past the end of the stretch is still this stretch's.
    *u = to;
    return c0 + to * (c1 + to * c2) >= 0.0;
}

// t1 in this stretch: s = 65 mm.
static bool find_t1(const stretch *part, double *t1_s)
{
    double u;
    if (!first_reached(part->s_m - CP_OLC_FREE_FLIGHT_M, part->lag_m_s, 0.5 * part->lag_rate_m_s2,
                       0.0, part->length_s, &u))
        return false;
    *t1_s = part->begin_s + u;
    return true;
}

// t2 in this stretch: with OLC put in, s - (V0 - v)(t - t1)/2 = 300 mm, linear in t.
static bool find_t2(const stretch *part, double t1_s, cp_olc *olc)
{
    double since_t1_s = part->begin_s - t1_s;
    double c0 = part->s_m - 0.5 * part->lag_m_s * since_t1_s - CP_OLC_TOTAL_M;
    double c1 = 0.5 * part->lag_m_s - 0.5 * part->lag_rate_m_s2 * since_t1_s;
    double from = fmax(0.0, -since_t1_s), u;
    if (!first_reached(c0, c1, 0.0, from, part->length_s, &u))
        return false;

    // A car faster than at the start has no occupant to slow down.
    double lag_m_s = part->lag_m_s + part->lag_rate_m_s2 * u;
    if (lag_m_s <= 0.0)
        return false;
    olc->t1_s = t1_s;
    olc->t2_s = part->begin_s + u;
    olc->olc_g = lag_m_s / (olc->t2_s - t1_s) / CP_G0_M_S2;
    olc->status = CP_OLC_VALUE;
    return true;
}

// Stretch number k: between samples k and k + 1, or after the last sample coasting to the horizon.
static stretch stretch_of(const double *vx_m_s, size_t count, double interval_s, size_t k,
                          double s_m)
{
    double begin_s = (double)k * interval_s;
    double left_s = CP_OLC_HORIZON_S - begin_s;
    double lag_m_s = vx_m_s[0] - vx_m_s[k];
    if (k + 1 == count)
        return (stretch){begin_s, left_s, s_m, lag_m_s, 0.0};
    return (stretch){begin_s, fmin(interval_s, left_s), s_m, lag_m_s,
                     (vx_m_s[k] - vx_m_s[k + 1]) / interval_s};
}

// Whether the velocity ever falls below its start by more than rounding, and is finite throughout.
static cp_olc_status judge_record(const double *vx_m_s, size_t count, double interval_s)
{
    double rounding_m_s = 1e-9 * fmax(1.0, fabs(vx_m_s[0]));
    cp_olc_status status = CP_OLC_NO_DECELERATION;
    for (size_t k = 0; k < count && (double)k * interval_s <= CP_OLC_HORIZON_S; k++) {
        if (!isfinite(vx_m_s[k]))
            return CP_OLC_SIMULATION_FAILED;
        if (vx_m_s[k] < vx_m_s[0] - rounding_m_s)
            status = CP_OLC_BEYOND_HORIZON;
    }
    return status;
}

cp_olc cp_olc_from_velocity(const double *vx_m_s, size_t count, double interval_s)
{
    cp_olc olc = {.olc_g = NAN, .t1_s = NAN, .t2_s = NAN};
    olc.status = judge_record(vx_m_s, count, interval_s);
    if (olc.status != CP_OLC_BEYOND_HORIZON)
        return olc;

    // Walk the stretches; t2 may lie in the one that holds t1.
    double s_m = 0.0, t1_s = NAN;
    for (size_t k = 0; k < count && (double)k * interval_s < CP_OLC_HORIZON_S; k++) {
        stretch part = stretch_of(vx_m_s, count, interval_s, k, s_m);
        bool has_t1 = !isnan(t1_s) || find_t1(&part, &t1_s);
        if (has_t1 && find_t2(&part, t1_s, &olc))
            return olc;
        s_m += part.length_s * (part.lag_m_s + 0.5 * part.lag_rate_m_s2 * part.length_s);
    }
    return olc;
}

bool cp_olc_is_decided(const cp_olc *olc, double end_s, double separation_s)
{
    // Rounding of times in files.
    const double tolerance_s = 1e-6;
    bool reached = olc->status == CP_OLC_VALUE && olc->t2_s <= end_s + tolerance_s;
    return reached || end_s >= CP_OLC_HORIZON_S - tolerance_s ||
           separation_s <= end_s + tolerance_s;
}

double cp_olc_sd(const cp_olc *olc, size_t count)
{
    if (count < 2)
        return NAN;
    double sum_g = 0.0, square_g2 = 0.0;
    for (size_t k = 0; k < count; k++) {
        if (olc[k].status == CP_OLC_SIMULATION_FAILED || olc[k].status == CP_OLC_NOT_FRONT_CONTACT)
            return NAN;
        sum_g += olc[k].status == CP_OLC_VALUE ? olc[k].olc_g : 0.0;
    }
    double mean_g = sum_g / (double)count;
    for (size_t k = 0; k < count; k++) {
        double value_g = olc[k].status == CP_OLC_VALUE ? olc[k].olc_g : 0.0;
        square_g2 += (value_g - mean_g) * (value_g - mean_g);
    }
    return sqrt(square_g2 / (double)(count - 1));
}
