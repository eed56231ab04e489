/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_CRUSH_ELEMENT_H
#define CRASH_CRUSH_ELEMENT_H

/* Axial crush element (force over compression): linear up to (s_begin, F_begin), where collapse
 * starts; linear to (s_end, F_end), where nothing is left to collapse; beyond, a stiff stop.
 * Below the largest compression so far it unloads and reloads along a line of slope k_unload; it
 * never pulls. Constant parameters: */
typedef struct cp_crush_law {
    double begin_m;
    double begin_n;
    double end_m;
    double end_n;
    double unload_n_m; /* >= begin_n / begin_m and >= stop_n_m */
    double stop_n_m;
} cp_crush_law;

/* ... and state: the largest compression so far. */
typedef struct cp_crush_state {
    double largest_m;
} cp_crush_state;

/* Force on the loading curve at compression s_m (0 for s_m <= 0). */
double cp_crush_loading_force(const cp_crush_law *law, double s_m);
/* Slope of the loading curve just beyond s_m. */
double cp_crush_loading_slope(const cp_crush_law *law, double s_m);
/* Work of loading from 0 to s_m. */
double cp_crush_loading_work(const cp_crush_law *law, double s_m);

/* Force at compression s_m; remembers a new largest compression. */
double cp_crush_force(const cp_crush_law *law, cp_crush_state *state, double s_m);
/* Energy stored recoverably at compression s_m, and energy dissipated so far, J. */
double cp_crush_elastic_energy(const cp_crush_law *law, const cp_crush_state *state, double s_m);
double cp_crush_plastic_energy(const cp_crush_law *law, const cp_crush_state *state);

/* Plastic hinge: moment over rotation, linear with stiffness_nm_rad up to +-yield_nm, then
 * constant; unloads elastically. */
typedef struct cp_bending_law {
    double yield_nm;
    double stiffness_nm_rad;
} cp_bending_law;

typedef struct cp_bending_state {
    double plastic_rad; /* permanent rotation */
    double plastic_j;   /* dissipated so far */
} cp_bending_state;

/* Moment that resists the rotation (same sign as the elastic part of it). */
double cp_bending_moment(const cp_bending_law *law, cp_bending_state *state, double rotation_rad);
double cp_bending_elastic_energy(const cp_bending_law *law, const cp_bending_state *state,
                                 double rotation_rad);

#endif
