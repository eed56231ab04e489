/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_CRASH_SIMULATION_H
#define CRASH_CRASH_SIMULATION_H

#include "crash/crash_configuration.h"
#include "crash/crash_film.h"
#include "crash/crash_outcome.h"
#include "pulse/severity.h"

/* One crash on the multibody surrogate. */

typedef struct cp_crash_options {
    double time_step_s;        /* default 0.0005 */
    double duration_s;         /* at least this long, default 0.2 */
    double longest_duration_s; /* at most, default 0.4 */
    double coast_after_s;      /* free of contact this long: coast analytically; once duration_s is
                                  over and every OLC decided, pressing on each other with less than
                                  1 kN this long counts as free; default 0.01 */
    bool until_olc;            /* end as soon as every OLC is decided, even in contact: what comes
                                  later does not change it. Default false: the whole crash */
    cp_crash_film *film;       /* filled with what happens; default NULL: nobody films. Borrowed */
} cp_crash_options;

cp_crash_options cp_crash_options_default(void);

/* Energies of all bodies together at the end, J; start = kinetic at first contact. For two cars in
 * the frame of their common centre of mass: what the crash can turn into anything. */
typedef struct cp_crash_energy {
    double start_j;
    double kinetic_j;
    double elastic_j;
    double plastic_j;
    double friction_j;
    double contact_damping_j;
    double rate_j;               /* what strain rate adds to the collapse forces */
    double mount_damping_j;      /* dampers of the engine's ties */
    double highest_mechanical_j; /* largest kinetic + elastic over the run; kinetic as the mean of
                                  * before and after the step that the elastic forces make */
} cp_crash_energy;

/* Momentum of all bodies together, and angular momentum about the middle between the two centres
 * of gravity at first contact (moving with the common centre of mass), in a's frame at first
 * contact. Two cars keep both; a barrier takes them. */
typedef struct cp_crash_momentum {
    cp_vec2 linear_kg_m_s;
    double angular_kg_m2_s;
} cp_crash_momentum;

/* What the crash did to a car as a whole, all its parts together. */
typedef struct cp_crash_whole {
    cp_vec2 delta_v_m_s; /* change of its momentum over its mass, in the axes of its first pose; up
                          * to the end of contact, which is the last that changes it */
    double absorbed_j;   /* by its own parts, and of what friction and contact took all (barrier) or
                          * half (another car) */
    double ees_m_s;      /* energy equivalent speed: sqrt(2 absorbed / mass) */
    cp_car_absorbed part; /* absorbed_j by part, without friction and contact */
} cp_crash_whole;

typedef struct cp_crash_result {
    int vehicle_count;       /* 1 (barrier) or 2 */
    cp_pulse pulse[2];       /* raw, owned */
    cp_severity severity[2]; /* of the pulses; delta-v and PDOF those of the whole cars, x and y in
                              * the axes of their first poses */
    cp_crash_whole whole[2];
    double crush_m[2];   /* largest shortening of the longer-pushed side, bumper to firewall */
    cp_struck struck[2]; /* where it was struck */
    double separation_s; /* last contact force */
    double t_common_s;   /* two cars: first zero of relative velocity along its first direction */
    double shift_m;      /* moved along the relative velocity until the outlines just touched */
    bool touched;        /* false: the outlines never met; pulses are of undisturbed motion */
    cp_crash_energy energy;
    cp_crash_momentum momentum_start;
    cp_crash_momentum momentum_end;
} cp_crash_result;

/* Simulate. model_b is NULL against a barrier. The result is the caller's to destroy (also after
 * an error, when it is zeroed). Threads: call cp_crash_thread_begin/_end in each. Errors:
 * CP_NO_MEMORY, CP_CRASH_FAILED (a state that is not finite, or energy of more than 1 % and 10 J
 * above that at first contact, with the time). */
CP_MUST_CHECK cp_status cp_crash_simulate(const cp_vehicle_model *model_a,
                                          const cp_vehicle_model *model_b,
                                          const cp_crash_configuration *configuration,
                                          const cp_crash_options *options, cp_crash_result *result,
                                          cp_error *error);
void cp_crash_result_destroy(cp_crash_result *result);

/* Process-wide: once before the first simulation, and once after the last. Where ODE gets
 * no memory the process ends with a message and exit code 1: it writes through what it is given. */
CP_MUST_CHECK cp_status cp_crash_library_begin(cp_error *error);
void cp_crash_library_end(void);
/* Whether the ODE that was loaded computes in double precision, as it must. */
bool cp_crash_library_is_double(void);
/* In every further thread that simulates. */
CP_MUST_CHECK cp_status cp_crash_thread_begin(cp_error *error);
void cp_crash_thread_end(void);

#endif
