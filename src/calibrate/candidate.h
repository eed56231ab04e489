/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_CANDIDATE_H
#define CALIBRATE_CANDIDATE_H

#include "crash/vehicle_model.h"

#include <stddef.h>

/* The unknowns of a fit: vehicle parameters, and the geometry of the reference study's barrier
 * ("barrier.width_m", "barrier.depth_m", "barrier.corner_radius_m", "barrier.pivot_m"), each within
 * bounds. A candidate is a point of 0..1 per unknown. */
typedef struct cp_unknown {
    char name[64];
    double min;
    double max;
} cp_unknown;

/* Whether name is a vehicle parameter or a barrier field. */
bool cp_unknown_exists(const char *name);
double cp_unknown_get(const cp_vehicle_model *model, const char *name);
void cp_unknown_set(cp_vehicle_model *model, const char *name, double value);

/* base with the unknowns of point. What depends on another length is cut to fit it: a collapse ends
 * within its element, the engine leaves its bay 0.15 m, corner rounding fits the barrier. */
cp_vehicle_model cp_candidate_model(const cp_vehicle_model *base, const cp_unknown *unknowns,
                                    size_t count, const double *point);

/* Where base itself lies, cut to 0..1. */
void cp_candidate_point(const cp_vehicle_model *base, const cp_unknown *unknowns, size_t count,
                        double *point);

#endif
