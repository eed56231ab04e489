/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_FUNCTION_VIEW_H
#define CONTROL_FUNCTION_VIEW_H

#include "control/control.h"
#include "control/lookout.h"

/* What a function is told of the world (crashpulse/function.h): its host's sensor and road, and the
 * car in hand. */
typedef struct cp_function_senses {
    const cp_traffic *traffic;
    cp_road_view *view;
    cp_lookout lookout;
    double stepped_s;           /* the lookout has gone round in the step that ends then */
    crashpulse_object *objects; /* last told */
    size_t object_room;

    const cp_vehicle_motion *own; /* of the car in hand, */
    bool has_looked;              /* and in this step; */
    cp_threat threat;             /* last told */
    bool has_threat;
    cp_status status; /* of what it asked */
    cp_error error;
} cp_function_senses;

cp_function_senses cp_function_senses_create(const cp_lookout_settings *settings,
                                             const cp_control_context *context);
void cp_function_senses_destroy(cp_function_senses *senses);

/* The view of a car; valid until senses_end, which the host calls after the function's step. end:
 * the tracks of a car that has not looked are dropped. Errors: of what it asked. */
crashpulse_view cp_function_view(cp_function_senses *senses, const cp_vehicle_motion *motion);
CP_MUST_CHECK cp_status cp_function_senses_end(cp_function_senses *senses, cp_error *error);

/* Class of a target: as the threat last told to this car says, else by how the two move now. */
cp_target_class cp_function_class_of(const cp_function_senses *senses, const cp_vehicle_motion *own,
                                     uint32_t target);

#endif
