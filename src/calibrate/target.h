/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_TARGET_H
#define CALIBRATE_TARGET_H

#include "crash/vehicle_model.h"

#include <stdbool.h>
#include <stddef.h>

/* What a fit asks of a vehicle beside its reference: one crash, against a wall or pole or a car
 * like itself, and quantities of it that must lie inside corridors known from tests. */

enum { CP_TARGETS_MAX = 24, CP_TARGET_BOUNDS_MAX = 24 };

typedef enum cp_target_quantity {
    CP_TARGET_OLC,         /* g; 0 where left-censored */
    CP_TARGET_PEAK,        /* largest deceleration, CFC60, g */
    CP_TARGET_CRUSH,       /* largest forward displacement of the centre of gravity, m */
    CP_TARGET_T_V0,        /* first v_x <= 0, s */
    CP_TARGET_REBOUND,     /* largest backward speed, m/s */
    CP_TARGET_LOSS_X,      /* of v_x since first contact (an accelerometer's integral), m/s */
    CP_TARGET_GAIN_AWAY,   /* of v_y away from the side of the offset, likewise, m/s */
    CP_TARGET_YAW_RATE,    /* towards the side of the offset, rad/s */
    CP_TARGET_RESTITUTION, /* of the closing speed, 1; by whole cars */
    CP_TARGET_QUANTITIES
} cp_target_quantity;

/* Key in the fit file, its unit there, SI per that unit, and whether it is taken at an instant. */
typedef struct cp_target_kind {
    const char *key;
    const char *unit;
    double si_per_unit;
    bool at_instant;
} cp_target_kind;

extern const cp_target_kind CP_TARGET_KIND[CP_TARGET_QUANTITIES];

/* A corridor, SI. */
typedef struct cp_target_bounds {
    cp_target_quantity quantity;
    double at_s; /* instant after first contact; 0 for quantities of the whole crash */
    double min;
    double max; /* > min */
    double aim; /* inside; where a vehicle is drawn to */
} cp_target_bounds;

typedef struct cp_target {
    char name[64];
    char source[512];
    bool against_itself; /* a car like itself as fast, else the barrier */
    double speed_km_h;
    double offset_mm;
    double angle_deg;
    bool has_barrier; /* false: that of the vehicle's reference study */
    cp_barrier barrier;
    double weight; /* of its corridors among the residuals, default 1 */
    size_t bound_count;
    cp_target_bounds bound[CP_TARGET_BOUNDS_MAX];
} cp_target;

/* The quantities of a model in every target's crash, on threads threads: value[t *
 * CP_TARGET_BOUNDS_MAX + b], NAN where there is none or the crash failed. Errors: CP_NO_MEMORY,
 * CP_RUN_FAILED. */
CP_MUST_CHECK cp_status cp_target_values(const cp_target *targets, size_t count,
                                         const cp_vehicle_model *model, double time_step_s,
                                         int threads, double *value, cp_error *error);

/* How far a value lies outside its corridor, in widths of it, signed (negative: below); 0 inside. A
 * value that does not exist is outside by 5 widths. */
double cp_target_excess(const cp_target_bounds *bounds, double value);
/* Where a value lies inside: distance from the aim in widths, signed, at most that of the bound. */
double cp_target_distance(const cp_target_bounds *bounds, double value);

#endif
