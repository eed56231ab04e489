/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/crush_element.h"

#include <math.h>

double cp_crush_loading_force(const cp_crush_law *law, double s_m)
{
    if (s_m <= 0.0)
        return 0.0;
    if (s_m <= law->begin_m)
        return law->begin_n * s_m / law->begin_m;
    if (s_m <= law->end_m)
        return law->begin_n +
               (law->end_n - law->begin_n) * (s_m - law->begin_m) / (law->end_m - law->begin_m);
    return law->end_n + law->stop_n_m * (s_m - law->end_m);
}

double cp_crush_loading_slope(const cp_crush_law *law, double s_m)
{
    if (s_m < 0.0)
        return 0.0;
    if (s_m < law->begin_m)
        return law->begin_n / law->begin_m;
    if (s_m < law->end_m)
        return (law->end_n - law->begin_n) / (law->end_m - law->begin_m);
    return law->stop_n_m;
}

double cp_crush_loading_work(const cp_crush_law *law, double s_m)
{
    // Area under the three straight pieces.
    if (s_m <= 0.0)
        return 0.0;
    double force_n = cp_crush_loading_force(law, s_m);
    if (s_m <= law->begin_m)
        return 0.5 * force_n * s_m;
    double work_j = 0.5 * law->begin_n * law->begin_m;
    if (s_m <= law->end_m)
        return work_j + 0.5 * (law->begin_n + force_n) * (s_m - law->begin_m);
    work_j += 0.5 * (law->begin_n + law->end_n) * (law->end_m - law->begin_m);
    return work_j + 0.5 * (law->end_n + force_n) * (s_m - law->end_m);
}

double cp_crush_force(const cp_crush_law *law, cp_crush_state *state, double s_m)
{
    if (s_m >= state->largest_m) {
        state->largest_m = s_m;
        return cp_crush_loading_force(law, s_m);
    }
    double peak_n = cp_crush_loading_force(law, state->largest_m);
    return fmax(0.0, peak_n - law->unload_n_m * (state->largest_m - s_m));
}

double cp_crush_elastic_energy(const cp_crush_law *law, const cp_crush_state *state, double s_m)
{
    double peak_n = cp_crush_loading_force(law, state->largest_m);
    double force_n = fmax(0.0, peak_n - law->unload_n_m * (state->largest_m - s_m));
    return 0.5 * force_n * force_n / law->unload_n_m;
}

double cp_crush_plastic_energy(const cp_crush_law *law, const cp_crush_state *state)
{
    double peak_n = cp_crush_loading_force(law, state->largest_m);
    return cp_crush_loading_work(law, state->largest_m) - 0.5 * peak_n * peak_n / law->unload_n_m;
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
