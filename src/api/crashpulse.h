/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASHPULSE_H
#define CRASHPULSE_H

#include <stddef.h>

/* The crash library of crashpulse: one crash of two cars, or of a car against a barrier, on the
 * multibody surrogate, and what its pulses say. C17 and C++; SI units.
 *
 * Functions that can fail return CRASHPULSE_OK or the reason, and put words for the user into
 * *error where it is not NULL. Constant objects may be shared between threads; every crash may be
 * simulated in any thread. The same inputs give the same bits.
 *
 * Link with find_package(crashpulse) and crashpulse::crashpulse, or pkg-config crashpulse. */

#ifdef __cplusplus
extern "C" {
#endif

#define CRASHPULSE_API __attribute__((visibility("default")))

/* Version of this interface; a change that old programs do not stand raises the first number and
 * the library's soname with it. */
#define CRASHPULSE_API_MAJOR 0
#define CRASHPULSE_API_MINOR 1

typedef enum crashpulse_status {
    CRASHPULSE_OK = 0,
    CRASHPULSE_FAILED = 1,   /* the simulation failed, or memory is gone */
    CRASHPULSE_BAD_INPUT = 2 /* a file or a value; also two cars that miss each other */
} crashpulse_status;

/* Owned by the caller; zero-initialise. */
typedef struct crashpulse_error {
    char text[1024]; /* "" after success */
} crashpulse_error;

/* ---- beginning and end --------------------------------------------------------------------- */

/* Once in the process before the first crash, and once after the last. The physics engine (ODE)
 * writes through what the system gives it: where that is no memory, the process ends with a message
 * and exit code 1. */
CRASHPULSE_API crashpulse_status crashpulse_begin(crashpulse_error *error);
CRASHPULSE_API void crashpulse_end(void);
/* In every further thread that simulates, first and last. */
CRASHPULSE_API crashpulse_status crashpulse_thread_begin(crashpulse_error *error);
CRASHPULSE_API void crashpulse_thread_end(void);

/* ---- vehicles ------------------------------------------------------------------------------ */

/* A vehicle model, constant once loaded. */
typedef struct crashpulse_vehicle crashpulse_vehicle;

/* name_or_file: the name of a shipped model ("honda_accord_2014", ...), or, with a '/' or a '.' in
 * it, the path of a vehicle file (db/vehicles/README.md). *vehicle is the caller's to free; NULL
 * after a failure. Errors: CRASHPULSE_BAD_INPUT with file, line and field. */
CRASHPULSE_API crashpulse_status crashpulse_vehicle_load(const char *name_or_file,
                                                         crashpulse_vehicle **vehicle,
                                                         crashpulse_error *error);
CRASHPULSE_API void crashpulse_vehicle_free(crashpulse_vehicle *vehicle); /* NULL is fine */
/* Text of the vehicle, freed with it. */
CRASHPULSE_API const char *crashpulse_vehicle_name(const crashpulse_vehicle *vehicle);
CRASHPULSE_API double crashpulse_vehicle_mass_kg(const crashpulse_vehicle *vehicle);

/* ---- a crash ------------------------------------------------------------------------------- */

/* How the two meet: both drive along their headings until they touch. */
typedef struct crashpulse_meeting {
    double speed_m_s;          /* of a; >= 0 */
    double opponent_speed_m_s; /* of b; >= 0; not used against a barrier */
    double offset_m;   /* lateral, of the middle of b's front edge (of the barrier's face) in
                          a's frame, to the left; default 0 */
    double angle_rad;  /* heading of b against exactly oncoming, counter-clockwise; default 0 */
    double duration_s; /* simulated at least this long; default 0.2, (0, 0.4] */
} crashpulse_meeting;

/* Everything 0 but the duration. */
CRASHPULSE_API crashpulse_meeting crashpulse_meeting_default(void);

/* What a crash did to one car. What does not exist is NAN. */
typedef struct crashpulse_severity {
    const char *olc_status; /* "value"; "no_deceleration", "beyond_0_5_s": too mild, below every
                               value; "not_front_contact" */
    double olc_g;           /* occupant load criterion (Kuebler et al. 2009) */
    double delta_v_m_s;     /* of the whole car, >= 0; x and y in the axes of its first pose */
    double delta_v_x_m_s;
    double delta_v_y_m_s;
    double peak_g;      /* largest -a_x, CFC60 */
    double max_50ms_g;  /* largest 50 ms mean of -a_x */
    double asi_1;       /* acceleration severity index */
    double pdof_rad;    /* principal direction of force, vehicle frame */
    double ees_m_s;     /* energy equivalent speed */
    double crush_m;     /* largest dynamic crush of the front */
    char validity[128]; /* "inside", or what lies outside the calibrated range: "speed,angle" */
} crashpulse_severity;

/* Channels of a pulse: ISO 8855 axes of the turning vehicle (x forward, y left, yaw
 * counter-clockwise), without a filter; velocities are integrals of the accelerations; x, y and yaw
 * from the first pose. */
typedef enum crashpulse_channel {
    CRASHPULSE_AX_M_S2,
    CRASHPULSE_AY_M_S2,
    CRASHPULSE_VX_M_S,
    CRASHPULSE_VY_M_S,
    CRASHPULSE_X_M,
    CRASHPULSE_Y_M,
    CRASHPULSE_YAW_RAD,
    CRASHPULSE_YAW_RATE_RAD_S,
    CRASHPULSE_YAW_ACC_RAD_S2
} crashpulse_channel;

/* A simulated crash. */
typedef struct crashpulse_crash crashpulse_crash;

/* b NULL: the barrier of a's reference study. Vehicles are borrowed for the call only. *crash is
 * the caller's to free; NULL after a failure. */
CRASHPULSE_API crashpulse_status crashpulse_simulate(const crashpulse_vehicle *a,
                                                     const crashpulse_vehicle *b,
                                                     const crashpulse_meeting *meeting,
                                                     crashpulse_crash **crash,
                                                     crashpulse_error *error);
CRASHPULSE_API void crashpulse_crash_free(crashpulse_crash *crash); /* NULL is fine */

/* Cars of a crash: 1 (barrier) or 2. car below is 0 for a, 1 for b. */
CRASHPULSE_API int crashpulse_crash_cars(const crashpulse_crash *crash);
CRASHPULSE_API crashpulse_severity crashpulse_crash_severity(const crashpulse_crash *crash,
                                                             int car);
/* Samples of a channel, crashpulse_crash_samples of them, the first at first contact, the others
 * crashpulse_crash_interval_s apart; freed with the crash. NULL: no such car or channel. */
CRASHPULSE_API const double *crashpulse_crash_pulse(const crashpulse_crash *crash, int car,
                                                    crashpulse_channel channel);
CRASHPULSE_API size_t crashpulse_crash_samples(const crashpulse_crash *crash);
CRASHPULSE_API double crashpulse_crash_interval_s(const crashpulse_crash *crash);

/* ---- pulses from elsewhere ----------------------------------------------------------------- */

/* OLC, g, of a longitudinal velocity (count >= 2 samples at interval_s > 0 from first contact,
 * linear between them, constant behind the last); NAN where it has none. status (may be NULL)
 * receives olc_status as above, static text. */
CRASHPULSE_API double crashpulse_olc_g(const double *vx_m_s, size_t count, double interval_s,
                                       const char **status);

#ifdef __cplusplus
}
#endif

#endif
