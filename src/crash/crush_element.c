/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/crush_element.h"

#include <math.h>
#include <stdbool.h>

// One straight piece of the loading curve; the last ones are endless.
typedef struct piece {
    double from_m;
    double from_n;
    double slope_n_m;
    double to_m;
} piece;

// Piece number index: up to every point, then the stop, then the plateau.
static piece piece_of(const cp_crush_law *law, int index)
{
    if (index < law->points) {
        double from_m = index > 0 ? law->s_m[index - 1] : 0.0;
        double from_n = index > 0 ? law->force_n[index - 1] : 0.0;
        double slope_n_m = (law->force_n[index] - from_n) / (law->s_m[index] - from_m);
        return (piece){from_m, from_n, slope_n_m, law->s_m[index]};
    }
    double end_m = law->s_m[law->points - 1], end_n = law->force_n[law->points - 1];
    double yield_m = law->stop_n_m > 0.0 && isfinite(law->plateau_n)
                         ? end_m + (law->plateau_n - end_n) / law->stop_n_m
                         : (double)INFINITY;
    if (index == law->points)
        return (piece){end_m, end_n, law->stop_n_m, yield_m};
    return (piece){yield_m, law->plateau_n, 0.0, INFINITY};
}

// The piece that a compression lies on.
static piece piece_at(const cp_crush_law *law, double s_m)
{
    int index = 0;
    while (index < law->points && s_m >= law->s_m[index])
        index++;
    piece at = piece_of(law, index);
    return s_m >= at.to_m ? piece_of(law, index + 1) : at;
}

cp_crush_loading cp_crush_loading_at(const cp_crush_law *law, double s_m)
{
    if (s_m < 0.0)
        return (cp_crush_loading){0.0, 0.0};
    piece at = piece_at(law, s_m);
    return (cp_crush_loading){at.from_n + at.slope_n_m * (s_m - at.from_m), at.slope_n_m};
}

double cp_crush_loading_force(const cp_crush_law *law, double s_m)
{
    return cp_crush_loading_at(law, s_m).force_n;
}

double cp_crush_loading_work(const cp_crush_law *law, double s_m)
{
    // Area under the straight pieces up to there.
    double work_j = 0.0;
    for (int index = 0; index <= law->points + 1; index++) {
        piece at = piece_of(law, index);
        if (s_m <= at.from_m)
            break;
        double length_m = fmin(s_m, at.to_m) - at.from_m;
        work_j += length_m * (at.from_n + 0.5 * at.slope_n_m * length_m);
    }
    return work_j;
}

double cp_crush_collapse_force(const cp_crush_law *law)
{
    double largest_n = 0.0;
    for (int k = 0; k < law->points; k++)
        largest_n = fmax(largest_n, law->force_n[k]);
    return largest_n;
}

double cp_crush_unloading_slope(const cp_crush_law *law, double s_m)
{
    double begin_m = law->s_m[0], end_m = law->s_m[law->points - 1];
    double share = end_m > begin_m ? (s_m - begin_m) / (end_m - begin_m) : 0.0;
    share = fmin(1.0, fmax(0.0, share));
    return law->unload_n_m + share * (law->unload_end_n_m - law->unload_n_m);
}

// Force the element was crushed with, its unloading slope, and the force that slope gives at s_m.
typedef struct elastic_view {
    double peak_n;
    double slope_n_m;
    double free_m; /* compression without force */
    double force_n;
} elastic_view;

static elastic_view view_elastic(const cp_crush_law *law, const cp_crush_state *state, double s_m)
{
    elastic_view view = {.peak_n = cp_crush_loading_force(law, state->largest_m),
                         .slope_n_m = cp_crush_unloading_slope(law, state->largest_m)};
    view.free_m = state->largest_m - view.peak_n / view.slope_n_m - state->pulled_m;
    view.force_n = view.slope_n_m * (s_m - view.free_m);
    return view;
}

double cp_crush_force(const cp_crush_law *law, cp_crush_state *state, double s_m)
{
    if (s_m >= state->largest_m && state->pulled_m <= 0.0) {
        state->largest_m = s_m;
        return cp_crush_loading_force(law, s_m);
    }

    // Along the unloading line, within the forces at which it yields either way.
    elastic_view view = view_elastic(law, state, s_m);
    double force_n = fmin(view.peak_n, fmax(-law->pull_n, view.force_n));
    if (law->pull_n > 0.0 && force_n != view.force_n) {
        double moved_m = view.free_m - (s_m - force_n / view.slope_n_m);
        double pulled_m = fmax(0.0, state->pulled_m + moved_m);
        state->pulled_j += fabs(force_n * (pulled_m - state->pulled_m));
        state->pulled_m = pulled_m;
    }
    if (s_m < state->largest_m)
        return force_n;

    // Pressed together as far as ever: on along the loading curve.
    state->pulled_m = 0.0;
    state->largest_m = s_m;
    return cp_crush_loading_force(law, s_m);
}

double cp_crush_elastic_energy(const cp_crush_law *law, const cp_crush_state *state, double s_m)
{
    elastic_view view = view_elastic(law, state, s_m);
    double force_n = fmin(view.peak_n, fmax(-law->pull_n, view.force_n));
    return 0.5 * force_n * force_n / view.slope_n_m;
}

double cp_crush_plastic_energy(const cp_crush_law *law, const cp_crush_state *state)
{
    double peak_n = cp_crush_loading_force(law, state->largest_m);
    double slope_n_m = cp_crush_unloading_slope(law, state->largest_m);
    return cp_crush_loading_work(law, state->largest_m) - 0.5 * peak_n * peak_n / slope_n_m +
           state->pulled_j;
}

static const double RATE_REFERENCE_M_S = 10.0, RATE_STRAIGHT_BELOW_M_S = 1.0;

cp_strain_rate cp_strain_rate_at(double gain_1, double rate_m_s)
{
    if (rate_m_s < 0.0)
        return (cp_strain_rate){1.0, 0.0};
    double rate_1 = fmax(rate_m_s, RATE_STRAIGHT_BELOW_M_S) / RATE_REFERENCE_M_S;
    double gain = gain_1 * pow(rate_1, 0.2);
    bool straight = rate_m_s < RATE_STRAIGHT_BELOW_M_S;
    double slope_s_m = straight ? gain / RATE_STRAIGHT_BELOW_M_S : 0.2 * gain / rate_m_s;
    if (straight)
        gain *= rate_m_s / RATE_STRAIGHT_BELOW_M_S;
    if (1.0 + gain >= CP_STRAIN_RATE_LARGEST)
        return (cp_strain_rate){CP_STRAIN_RATE_LARGEST, 0.0};
    return (cp_strain_rate){1.0 + gain, slope_s_m};
}

double cp_strain_rate_factor(double gain_1, double rate_m_s)
{
    return cp_strain_rate_at(gain_1, rate_m_s).factor_1;
}

double cp_bending_moment(const cp_bending_law *law, cp_bending_state *state, double rotation_rad)
{
    double moment_nm = law->stiffness_nm_rad * (rotation_rad - state->plastic_rad);
    if (fabs(moment_nm) <= law->yield_nm)
        return moment_nm;

    // The hinge yields: the permanent rotation follows so that the moment stays at its limit.
    double limit_nm = copysign(law->yield_nm, moment_nm);
    double plastic_rad = rotation_rad - limit_nm / law->stiffness_nm_rad;
    state->plastic_j += limit_nm * (plastic_rad - state->plastic_rad);
    state->plastic_rad = plastic_rad;
    return limit_nm;
}

double cp_bending_elastic_energy(const cp_bending_law *law, const cp_bending_state *state,
                                 double rotation_rad)
{
    double elastic_rad = rotation_rad - state->plastic_rad;
    return 0.5 * law->stiffness_nm_rad * elastic_rad * elastic_rad;
}
