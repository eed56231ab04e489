/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_ROAD_VIEW_H
#define CONTROL_ROAD_VIEW_H

#include "control/lane_ahead.h"
#include "control/vehicle_table.h"

/* What everybody who looks round knows of the road: the ways of vehicles along their lanes, and
 * whether the roads of two vehicles meet. One for all controls of a replication; ways are laid out
 * when they are first asked for in a step. Where nobody knows lanes (a scripted road of a test) it
 * knows none. */
typedef struct cp_road_view cp_road_view;

CP_MUST_CHECK cp_status cp_road_view_create(const cp_traffic *traffic, cp_road_view **view,
                                            cp_error *error);
void cp_road_view_destroy(cp_road_view *view); /* NULL is fine */

/* How another's way is taken to go on where roads branch. */
typedef enum cp_way_choice {
    CP_WAY_STRAIGHT, /* in its lane, straight on: of somebody whose route is not known */
    CP_WAY_ROUTE,    /* along its route: the own way, or one that is shown by a signal */
} cp_way_choice;

/* The way of a vehicle on the road, valid until the next step; NULL when it is not known (view may
 * be NULL). Errors: CP_NO_MEMORY, those of the traffic. */
CP_MUST_CHECK cp_status cp_road_view_way(cp_road_view *view, const cp_vehicle_motion *motion,
                                         cp_way_choice choice, const cp_lane_ahead **way,
                                         cp_error *error);

/* A vehicle and where it will be: along its way, or, without one, as it moves now (ttc.h). */
typedef struct cp_mover {
    cp_moving_rectangle now;
    const cp_lane_ahead *way; /* NULL: none */
    double begin_m;           /* where its front is on the way at time 0: 0, or negative inside the
                                 step that has ended */
} cp_mover;

/* The mover at the end of the step, or inside it (fraction 0 = beginning, 1 = end). */
cp_mover cp_mover_inside(const cp_vehicle_motion *motion, const cp_lane_ahead *way,
                         double fraction);
/* Where it is time_s later at its present speed. */
cp_rectangle cp_mover_at(const cp_mover *mover, double time_s);
/* Time until the two first overlap at their present speeds, as cp_ttc_s; contact counts from 1 mm
 * on where one has a way. INFINITY when not within horizon_s. */
double cp_mover_ttc_s(const cp_mover *one, const cp_mover *other, double horizon_s);

/* Whether the two can touch on the ground where they are time_s later (traffic.h): not at different
 * levels, nor on roads that have nothing to do with each other. */
CP_MUST_CHECK cp_status cp_road_view_meet(cp_road_view *view, const cp_vehicle_motion *one,
                                          const cp_mover *one_moves, const cp_vehicle_motion *other,
                                          const cp_mover *other_moves, double time_s, bool *meet,
                                          cp_error *error);

/* Whether, and when, one vehicle on its route and another that keeps to its lane would touch within
 * horizon_s (without a way: goes straight on): what a driver sees coming. INFINITY when not, or
 * when their roads do not meet. */
CP_MUST_CHECK cp_status cp_road_view_ttc_s(cp_road_view *view, const cp_vehicle_motion *own,
                                           const cp_vehicle_motion *other, double horizon_s,
                                           double *ttc_s, cp_error *error);

#endif
