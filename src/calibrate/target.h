/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_TARGET_H
#define CALIBRATE_TARGET_H

#include "calibrate/suite_quantity.h"
#include "crash/vehicle_model.h"

#include <stdbool.h>
#include <stddef.h>

/* What a fit asks of a vehicle beside its reference: one crash, against a wall or pole or a car
 * like itself, and quantities of it that must lie inside corridors known from tests. */

enum { CP_TARGETS_MAX = 24, CP_TARGET_BOUNDS_MAX = 24 };

/* A quantity that a fit may aim at: its key in the fit file, which of the quantities of a crash
 * that is (suite_quantity.h has its unit in the file, whether it is taken at an instant, and how it
 * is measured), and SI per that unit. Sideways and yaw are away from and towards the side of the
 * offset, +1 where there is none. */
typedef struct cp_target_kind {
    const char *key;
    cp_suite_quantity quantity;
    double si_per_unit;
} cp_target_kind;

/* By the key in the fit file; NULL when there is none. */
const cp_target_kind *cp_target_kind_find(const char *key);
/* Of a quantity that a target has. */
const cp_target_kind *cp_target_kind_of(cp_suite_quantity quantity);
/* All keys, "olc_g, peak_g, ... or restitution_1". Returns text. */
#define CP_TARGET_KEYS_SIZE 256
const char *cp_target_keys(char text[CP_TARGET_KEYS_SIZE]);

/* A corridor, SI. */
typedef struct cp_target_bounds {
    cp_suite_quantity quantity; /* one that fits may aim at */
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
