/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_FILM_CAMERA_H
#define CRASH_FILM_CAMERA_H

#include "crash/crash_film.h"
#include "crash/front_structure.h"

/* Records a film from the cars of a running simulation. */
typedef struct cp_film_camera {
    cp_crash_film *film; /* NULL: nobody films, every call returns at once */
    size_t every;        /* samples from frame to frame */
    cp_pose origin;      /* of the film's plane in the frame of the poses given to it */
} cp_film_camera;

/* Start an empty film with room for samples 0 ... last_sample. barrier is NULL between two cars.
 * Errors: CP_NO_MEMORY; CP_BAD_INPUT for a film interval that is not positive. */
CP_MUST_CHECK cp_status cp_film_camera_begin(cp_film_camera *camera, cp_crash_film *film,
                                             size_t last_sample, double time_step_s, cp_pose origin,
                                             const cp_outline *barrier, cp_error *error);

/* Take sample number sample if a frame is due: cars as they are now, ground the poses of their
 * centres of gravity on the ground. */
void cp_film_camera_take(const cp_film_camera *camera, size_t sample, double time_step_s,
                         const cp_car *car, const cp_pose ground[2], int car_count);

/* The same for cars that coast: parts as in the frame before. */
void cp_film_camera_take_coasting(const cp_film_camera *camera, size_t sample, double time_step_s,
                                  const cp_pose ground[2], int car_count);

#endif
