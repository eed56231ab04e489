/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TRAFFIC_LATERAL_OVERLAY_H
#define TRAFFIC_LATERAL_OVERLAY_H

#include "core/error.h"
#include "traffic/vehicle_state.h"

/* Vehicles that are not where SUMO drives them: an offset across SUMO's path that changes as a car
 * drives along with its heading turned off the path. SUMO carries the car along and knows nothing
 * of it (it can neither cross the centre line of an ordinary road nor say so); contacts, sensors
 * and everything else that reads states see the drifted pose. A car that nobody steers keeps its
 * heading off the path and drifts on; a standing car stays where it is. */

typedef struct cp_lateral_overlay {
    double offset_m; /* of the front, to the left of SUMO's path, across SUMO's heading */
    double slope_1;  /* metres to the left a metre driven: tangent of the heading off the path */
} cp_lateral_overlay;

/* Of all vehicles; few have one. */
typedef struct cp_lateral_overlays cp_lateral_overlays;

CP_MUST_CHECK cp_status cp_lateral_overlays_create(cp_lateral_overlays **overlays, cp_error *error);
void cp_lateral_overlays_destroy(cp_lateral_overlays *overlays); /* NULL is fine */

/* Overlay of a vehicle now; zero without one. */
cp_lateral_overlay cp_lateral_overlay_get(const cp_lateral_overlays *overlays, uint32_t vehicle);

/* Steer through the coming step: mean slope over its way and slope at its end. The last call of a
 * step holds, so that a driver assistance function overrules a driver. A lateral acceleration of a
 * at speed v is a change of slope of a * step / v. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_lateral_overlay_steer(cp_lateral_overlays *overlays, uint32_t vehicle,
                                                 double mean_slope_1, double end_slope_1,
                                                 cp_error *error);
/* Back on SUMO's path, at once: for a car that has come back to within millimetres of it. */
void cp_lateral_overlay_end(cp_lateral_overlays *overlays, uint32_t vehicle);

/* Steering that brings an overlay to zero offset and slope within left_m metres, along a cubic:
 * what to ask for the next way_m of them (mean and end slope). */
void cp_lateral_overlay_return(cp_lateral_overlay now, double left_m, double way_m,
                               double *mean_slope_1, double *end_slope_1);

/* A step has been made and way_m driven in it: lay the overlay of its end over a vehicle's state as
 * SUMO has it. */
void cp_lateral_overlay_apply(cp_lateral_overlays *overlays, cp_vehicle_state *state, double way_m);
/* Forget the vehicles that were not applied since the last call: gone. */
void cp_lateral_overlays_prune(cp_lateral_overlays *overlays);

#endif
