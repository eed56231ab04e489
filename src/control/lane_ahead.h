/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_LANE_AHEAD_H
#define CONTROL_LANE_AHEAD_H

#include "control/ttc.h"

/* The way of a vehicle that keeps to its lane: from its front on the centre line of its lane,
 * corner by corner as the network has it, shifted by as much as the front is off it now. At the
 * lane's end it goes on along the lanes that follow, at the last one straight on. Behind it are the
 * lanes on which its rear is still, where that is known. A car that drifts
 * (traffic/lateral_overlay.h) goes on drifting: to the side by its slope for every metre along the
 * lane. */

#define CP_LANE_AHEAD_POINTS 128
#define CP_LANE_AHEAD_WAITS 6

/* A corner of the way. */
typedef struct cp_way_point {
    cp_vec2 point_m;
    double way_m;     /* from where the front is now; negative behind it */
    uint32_t lane;    /* on which it goes on from here; */
    double lane_at_m; /* the place on that lane, */
    double z_m;       /* and how high it lies */
} cp_way_point;

typedef struct cp_lane_ahead {
    cp_way_point corner[CP_LANE_AHEAD_POINTS];
    size_t count;
    size_t front;       /* the corner at which the front is now */
    double lane_step_1; /* of lane_at_m by a metre of way: 1, or -1 against the lane */
    bool is_inside;     /* the front is in a junction */
    double ends_m; /* its route ends there, and SUMO takes it off the road; INFINITY: it does not */
    double wait_m[CP_LANE_AHEAD_WAITS]; /* where it waits, by the signs, if others go first: before
                                           junctions and inside them */
    size_t wait_count;
} cp_lane_ahead;

/* Lay out the way of a vehicle for reach_m before its front. next_lanes: the lanes of edges on its
 * route, next_count of them; without, it goes straight on. is_route: behind the last of them it
 * goes nowhere. False when its lane is not known or the vehicle is nowhere near it (more than 8 m
 * off). */
bool cp_lane_ahead_lay(const cp_lane_map *map, const cp_vehicle_motion *motion, double slope_1,
                       const uint32_t *next_lanes, size_t next_count, bool is_route, double reach_m,
                       cp_lane_ahead *ahead);

/* Whether SUMO has put it into the next lane in one step, as lane changes without a duration do: no
 * body moves like that, and the way of this step is none. */
bool cp_is_put_aside(const cp_vehicle_motion *motion);

/* Where a vehicle of that length and width stands when its front has come way_m further (negative:
 * has still to go): front and rear are both on the way. */
cp_rectangle cp_lane_ahead_at(const cp_lane_ahead *ahead, double way_m, double length_m,
                              double width_m);

/* The middle between front and rear there: nearer than half a metre to the centre of the rectangle
 * of anything that keeps to a road, and told a good deal faster. */
cp_vec2 cp_lane_ahead_middle(const cp_lane_ahead *ahead, double way_m, double length_m);

/* Lane, place along it and height of the front there: of state those three are set, lengths stay.
 */
void cp_lane_ahead_place(const cp_lane_ahead *ahead, double way_m, cp_vehicle_state *state);

/* Way until the front of the vehicle comes to a place on a lane in the direction of that lane;
 * INFINITY when the way does not lead there. */
double cp_lane_ahead_way_to_m(const cp_lane_ahead *ahead, uint32_t lane, double lane_at_m);

#endif
