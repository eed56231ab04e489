/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_LOOKOUT_H
#define CONTROL_LOOKOUT_H

#include "control/neighbourhood.h"
#include "control/road_view.h"
#include "control/sensor.h"
#include "control/ttc.h"
#include "control/vehicle_table.h"
#include "core/rng.h"

/* What a forward-looking function knows of the traffic before its car, and which of the vehicles it
 * has in view is a threat.
 *
 * A target is known when the sensor has had it in view (range, field of view, not hidden behind
 * another vehicle) without a break for confirmation_s; some are never detected: one seeded draw for
 * each pair of vehicles.
 *
 * Where both will be is foretold along their lanes (lane_ahead.h): the own car follows its route,
 * the other stays in its lane and goes straight on where roads branch, unless it drifts. Without a
 * lane (a scripted road, a car far off any lane) a vehicle keeps velocity and yaw rate (ttc.h).
 *
 * A known target is a threat when
 *   1. its class is switched on, by the headings at the contact to come;
 *   2. TTC < ttc_s, both at the speeds they have;
 *   3. the deceleration it takes is at least required_m_s2: v^2/(2 d) = v/(2 TTC) with v the own
 *      speed, less the target's along the own axis at the contact in same-direction traffic;
 *   4. the driver does not see to it: he does not brake that hard already, nor brakes for something
 *      that braking at ease will do for (an oncoming target comes all the same);
 *   5. it holds too when the target takes the turn that its route has next, which its signal shows;
 *      and, of one without a lane, where one of the two turns or TTC is above
 *      CP_LOOKOUT_TURN_HOLDS_S, if either of them drove straight on from now;
 *   6. of a target that does not head the same way: it holds too if the target goes on braking or
 *      gaining speed as it does. One that is about to stop beside the own way, or to be past it in
 *      time, is none;
 *   7. neither of the two, heading apart, can still come to rest at ease where it has to wait,
 *      before the junction or in it, for those who go first or for a light that is red now, and is
 *      out of the other's way there;
 *   8. none of the two, without a lane, turns faster than 1 g of lateral acceleration allows, as
 *      cars of SUMO do in tight corners and where lanes change: there its heading does not say
 * where it goes;
 *   9. their roads meet where the contact would be (traffic.h): a bridge does not meet the road
 *      below. */

#define CP_LOOKOUT_TURN_HOLDS_S 1.5 /* assumed */

/* At ease: as SUMO's drivers brake when they see what is ahead (its default decel). Whatever can be
 * met like that is met without a function: a driver of SUMO who errs not waits until it takes this
 * and then brakes so. */
#define CP_LOOKOUT_EASY_BRAKING_M_S2 4.5

typedef enum cp_target_class {
    CP_TARGET_REAR_END, /* headings within 45 degrees */
    CP_TARGET_ONCOMING, /* headings apart by more than 135 degrees, nobody turns */
    CP_TARGET_CROSSING, /* in between, nobody turns */
    CP_TARGET_TURNING,  /* not in the same direction, and one of the two turns, > 0.1 rad/s (on a
                           lane: within a junction) */
    CP_TARGET_CLASSES
} cp_target_class;

cp_target_class cp_target_class_of(const cp_moving_rectangle *own,
                                   const cp_moving_rectangle *target);

typedef struct cp_lookout_settings {
    cp_sensor sensor;
    double confirmation_s;
    double detection_probability_1;
    bool has_occlusion;
    bool has_class[CP_TARGET_CLASSES];
    double ttc_s;
    double required_m_s2;
    double horizon_s;   /* tracks whatever can be met within this; >= ttc_s */
    cp_rng_key key;     /* of the draws of detection */
    cp_road_view *view; /* the road, borrowed; NULL: nobody knows it */
} cp_lookout_settings;

/* A target of one car. */
typedef struct cp_track {
    uint32_t vehicle;
    bool is_seen;       /* in this step */
    bool is_detectable; /* its draw */
    double seen_since_s;
} cp_track;

/* The targets of one car. Zero-initialised: none. */
typedef struct cp_tracks {
    cp_track *track;
    size_t count;
    size_t room;
} cp_tracks;

/* Of all cars that have the function. */
typedef struct cp_lookout {
    cp_lookout_settings settings;
    const cp_traffic *traffic;
    cp_neighbourhood neighbourhood;
    cp_vehicle_table tracks;          /* a cp_tracks of each */
    cp_rectangle *outlines;           /* of all vehicles, in the order of the traffic's motions */
    const cp_vehicle_motion **around; /* vehicles near the car in hand, and their outlines */
    const cp_rectangle **screens;
    size_t around_count;
    size_t around_room; /* of all three */
} cp_lookout;

/* The most urgent threat. */
typedef struct cp_threat {
    uint32_t vehicle;
    cp_target_class class;
    double ttc_s;     /* at the end of the step */
    double instant_s; /* SUMO clock inside the step at which it became a threat */
} cp_threat;

cp_lookout cp_lookout_create(const cp_lookout_settings *settings, const cp_traffic *traffic);
void cp_lookout_destroy(cp_lookout *lookout);

/* In every step: once for the traffic, then for cars that have the function, with their motion as
 * the traffic holds it. A car left out in a step keeps the tracks it has; forget drops them. */
CP_MUST_CHECK cp_status cp_lookout_step(cp_lookout *lookout, cp_error *error);
CP_MUST_CHECK cp_status cp_lookout_track(cp_lookout *lookout, const cp_vehicle_motion *own,
                                         cp_error *error);

void cp_lookout_forget(cp_lookout *lookout, uint32_t vehicle);
/* The targets a car has in view, in no particular order; valid until the next car is tracked. */
cp_tracks cp_lookout_tracks_of(const cp_lookout *lookout, uint32_t vehicle);

/* Whether a target is detectable and has been in view long enough. */
bool cp_lookout_is_known(const cp_lookout *lookout, const cp_track *track);

/* The threat that came first in this step, if there is one. Needs cp_lookout_track. */
CP_MUST_CHECK cp_status cp_lookout_threat(const cp_lookout *lookout, const cp_vehicle_motion *own,
                                          bool *found, cp_threat *threat, cp_error *error);
/* Whether a known target of a class switched on is met within horizon_s. */
CP_MUST_CHECK cp_status cp_lookout_is_danger(const cp_lookout *lookout,
                                             const cp_vehicle_motion *own, double horizon_s,
                                             bool *is_danger, cp_error *error);

#endif
