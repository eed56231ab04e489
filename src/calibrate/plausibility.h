/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_PLAUSIBILITY_H
#define CALIBRATE_PLAUSIBILITY_H

#include "crash/vehicle_model.h"

#include <stdbool.h>

/* Guard against a right OLC from a wrong pulse: marks of one pulse against a rigid barrier that
 * must lie inside bounds known from elsewhere. */
typedef enum cp_mark {
    CP_MARK_T_V0,    /* time of v_x = 0, s */
    CP_MARK_CRUSH,   /* largest forward displacement of the centre of gravity, m */
    CP_MARK_PEAK,    /* largest deceleration, CFC60, g */
    CP_MARK_REBOUND, /* largest backward speed, m/s */
    CP_MARK_COUNT
} cp_mark;

/* Key in the fit file, unit it is given in there, SI per that unit. */
typedef struct cp_mark_kind {
    const char *key;
    const char *unit;
    double si_per_unit;
} cp_mark_kind;

extern const cp_mark_kind CP_MARK_KIND[CP_MARK_COUNT];

/* Bounds, SI; a mark without bounds is not looked at. */
typedef struct cp_plausibility {
    bool given;
    double speed_km_h; /* of the barrier run it is about */
    double offset_mm;
    double angle_deg;
    bool bounded[CP_MARK_COUNT];
    double min[CP_MARK_COUNT];
    double max[CP_MARK_COUNT];
    char source[512];
} cp_plausibility;

/* The marks of a model's pulse; NAN where there is none (never stopped). Errors: CP_BAD_INPUT,
 * CP_CRASH_FAILED. */
CP_MUST_CHECK cp_status cp_plausibility_marks(const cp_plausibility *guard,
                                              const cp_vehicle_model *model, double time_step_s,
                                              double mark[CP_MARK_COUNT], cp_error *error);

/* How far each mark lies outside its bounds, in widths of the bounds, signed (negative: below);
 * 0 inside and where there are none. A mark that does not exist is outside by 5 widths. */
void cp_plausibility_excess(const cp_plausibility *guard, const double mark[CP_MARK_COUNT],
                            double excess_1[CP_MARK_COUNT]);

#endif
