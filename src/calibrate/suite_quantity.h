/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_SUITE_QUANTITY_H
#define CALIBRATE_SUITE_QUANTITY_H

#include "crash/crash_simulation.h"

/* What a suite compares and a fit aims at (target.h): a figure of one simulated crash that a crash
 * test has too. Losses of
 * velocity are positive, sideways is positive away from the barrier, yaw towards it. X(name, unit,
 * label for people, what it is). Separation is the end of the crash of pulse/severity.h. */
#define CP_SUITE_QUANTITIES(X)                                                                     \
    X(olc_g, "g", "OLC", "occupant load criterion; 0 where it is left-censored")                   \
    X(peak_g, "g", "peak", "largest deceleration along x, CFC60")                                  \
    X(cell_force_kn, "kN", "force on the cell", "the same times the mass behind the firewall")     \
    X(crush_mm, "mm", "crush", "integral of v_x while it is positive, at most 300 ms")             \
    X(struck_mm, "mm", "static crush",                                                             \
      "how far the struck side or rear has been pushed in for good; of a front: into the cell")    \
    X(t_v0_ms, "ms", "end of the approach", "first instant without forward speed")                 \
    X(rebound_m_s, "m/s", "rebound", "largest backward speed along the car's x axis")              \
    X(dvx_m_s, "m/s", "loss of v_x",                                                               \
      "loss of velocity along the car's x axis at an instant; the axes turn with "                 \
      "the car, as those of an accelerometer")                                                     \
    X(dvy_away_m_s, "m/s", "v_y away", "velocity gained sideways at an instant, likewise")         \
    X(yaw_rate_at_deg_s, "deg/s", "yaw rate at", "yaw rate at an instant")                         \
    X(separation_dvx_m_s, "m/s", "loss of v_x at separation",                                      \
      "loss of velocity at separation, axes of the first heading")                                 \
    X(separation_dvy_m_s, "m/s", "v_y away at separation",                                         \
      "velocity gained sideways at separation, likewise")                                          \
    X(separation_vx_m_s, "m/s", "v_x left at separation", "velocity left at separation, likewise") \
    X(yaw_rate_deg_s, "deg/s", "yaw rate", "change of yaw rate until separation")                  \
    X(delta_v_m_s, "m/s", "delta-v", "amount of the change of velocity")                           \
    X(restitution_1, "1", "restitution",                                                           \
      "velocity of separation over velocity of approach, along x")                                 \
    X(momentum_ratio_1, "1", "ratio of m delta-v",                                                 \
      "m delta-v of the first car over that of the second")                                        \
    X(wall_difference_pct, "%", "difference to the wall",                                          \
      "equal cars against a wall: largest difference of v_x, "                                     \
      "rebound included, of the speed")

typedef enum cp_suite_quantity {
#define CP_SUITE_QUANTITY_NAME(name, unit, label, what) CP_SUITE_##name,
    CP_SUITE_QUANTITIES(CP_SUITE_QUANTITY_NAME)
#undef CP_SUITE_QUANTITY_NAME
        CP_SUITE_QUANTITY_COUNT
} cp_suite_quantity;

extern const char *const CP_SUITE_QUANTITY_TEXT[CP_SUITE_QUANTITY_COUNT];
extern const char *const CP_SUITE_QUANTITY_UNIT[CP_SUITE_QUANTITY_COUNT];
extern const char *const CP_SUITE_QUANTITY_LABEL[CP_SUITE_QUANTITY_COUNT];

/* By name; CP_SUITE_QUANTITY_COUNT when there is none. */
cp_suite_quantity cp_suite_quantity_find(const char *name);
/* Whether it is taken at given instants. */
bool cp_suite_quantity_is_timed(cp_suite_quantity quantity);
/* Whether it needs a second car. */
bool cp_suite_quantity_is_of_pair(cp_suite_quantity quantity);

/* Where and of what a quantity is taken. */
typedef struct cp_suite_look {
    cp_suite_quantity quantity;
    int car;       /* 0 or 1 */
    double time_s; /* of a timed one */
    double side_1; /* +1: barrier to the left of car 0, -1: to the right */
    double mass_kg[2];
    double cell_mass_kg[2];      /* cp_vehicle_model_cell_mass() */
    const cp_crash_result *wall; /* the same car against a wall, for wall_difference_pct */
} cp_suite_look;

/* The quantity of a simulated crash, NAN where it has none. */
double cp_suite_quantity_of(const cp_suite_look *look, const cp_crash_result *result);

#endif
