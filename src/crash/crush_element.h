/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_CRUSH_ELEMENT_H
#define CRASH_CRUSH_ELEMENT_H

/* Axial crush element, force over compression: straight lines from the origin through the points
 * of the law, the first of them where collapse begins, the last where nothing is left to collapse;
 * beyond, a stiff stop, until what carries the element yields at a plateau. Below the largest
 * compression so far it unloads and reloads along a line, the steeper the deeper it has been
 * crushed. Pulled, it goes on along that line up to a limit and is then drawn out at that force;
 * pressed together again it yields at the force it was crushed with. A limit of 0 never pulls.
 * Constant parameters: */
enum { CP_CRUSH_POINTS_MAX = 5 };

typedef struct cp_crush_law {
    int points;                          /* 1 to CP_CRUSH_POINTS_MAX */
    double s_m[CP_CRUSH_POINTS_MAX];     /* > 0, rising */
    double force_n[CP_CRUSH_POINTS_MAX]; /* >= 0 */
    double stop_n_m;                     /* slope beyond the last point, >= 0 */
    double plateau_n;      /* where the stop yields, at least the last force; INFINITY: never */
    double unload_n_m;     /* where collapse begins; at least every slope of the law */
    double unload_end_n_m; /* at the last point and beyond, linear between; >= unload_n_m */
    double pull_n;         /* force at which it is drawn out, >= 0 */
} cp_crush_law;

/* ... and state. */
typedef struct cp_crush_state {
    double largest_m; /* compression so far */
    double pulled_m;  /* of its permanent compression, drawn out again */
    double pulled_j;  /* dissipated by that, and by pressing it together again */
} cp_crush_state;

/* Force on the loading curve at compression s_m (0 for s_m <= 0). */
double cp_crush_loading_force(const cp_crush_law *law, double s_m);
/* The same, and the slope of the loading curve just beyond s_m. */
typedef struct cp_crush_loading {
    double force_n;
    double slope_n_m;
} cp_crush_loading;
cp_crush_loading cp_crush_loading_at(const cp_crush_law *law, double s_m);
/* Work of loading from 0 to s_m. */
double cp_crush_loading_work(const cp_crush_law *law, double s_m);
/* Largest force of the collapse: of any point, without stop and plateau. */
double cp_crush_collapse_force(const cp_crush_law *law);
/* Slope of unloading from a largest compression of s_m. */
double cp_crush_unloading_slope(const cp_crush_law *law, double s_m);

/* Force at compression s_m, negative when it pulls; remembers what is permanent. */
double cp_crush_force(const cp_crush_law *law, cp_crush_state *state, double s_m);
/* Energy stored recoverably at compression s_m, and energy dissipated so far, J. */
double cp_crush_elastic_energy(const cp_crush_law *law, const cp_crush_state *state, double s_m);
double cp_crush_plastic_energy(const cp_crush_law *law, const cp_crush_state *state);

/* Strain rate: factor on a collapse force at a crush rate. 1 at rest and where the compression
 * shrinks; gain_1 is what it adds at 10 m/s, growing by the fifth root of the rate (Cowper and
 * Symonds 1957, exponent of steel) and straight below 1 m/s, where the root would be a step;
 * at most 1.4 (dynamic over static crush force of steel: 1.2 to 1.4). */
#define CP_STRAIN_RATE_LARGEST 1.4
double cp_strain_rate_factor(double gain_1, double rate_m_s);
/* The factor, and its slope over the rate, s/m. */
typedef struct cp_strain_rate {
    double factor_1;
    double slope_s_m;
} cp_strain_rate;
cp_strain_rate cp_strain_rate_at(double gain_1, double rate_m_s);

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
