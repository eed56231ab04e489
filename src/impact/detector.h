/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef IMPACT_DETECTOR_H
#define IMPACT_DETECTOR_H

#include "impact/impact.h"

/* What the detector looks at: one step of any traffic, simulated or made up. */
typedef struct cp_detector_scene {
    const cp_vehicle_motion *motions; /* each vehicle at most once */
    size_t count;
    double step_length_s;
    double time_s; /* clock at the end of the step */
    const char *(*vehicle_id)(const void *context, uint32_t vehicle);
    const void *id_context;
    bool (*is_at_fault)(void *context, uint32_t vehicle); /* may be NULL */
    void *fault_context;
    /* Fill in where a vehicle is on the road at the end of the step; NULL: states tell it. */
    cp_status (*place)(const void *context, cp_vehicle_state *state, cp_error *error);
    /* Whether two that touch in the plane can do so on the ground; NULL: all can. */
    cp_status (*road_relation)(const void *context, const cp_vehicle_state *one,
                               const cp_vehicle_state *other, cp_road_relation *relation,
                               cp_error *error);
    /* Where lanes run; NULL, or *map set to NULL: nobody knows. */
    cp_status (*lane_map)(const void *context, const cp_lane_map **map, cp_error *error);
    const void *road_context;
} cp_detector_scene;

/* cp_detector_step (impact.h) on a scene. */
CP_MUST_CHECK cp_status cp_detector_scan(cp_detector *detector, const cp_detector_scene *scene,
                                         const cp_impact **impacts, size_t *count, cp_error *error);

#endif
