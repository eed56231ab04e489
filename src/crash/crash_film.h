/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_CRASH_FILM_H
#define CRASH_CRASH_FILM_H

#include "core/error.h"
#include "core/geometry.h"

#include <stdbool.h>
#include <stddef.h>

/* What a camera above the crash would see: where every part of both cars is, frame by frame. A
 * picture only; recording one changes nothing in a simulation. */

/* The parts of a car that can be seen. X(name, text). Longitudinals and crash boxes are
 * drawn from their rear to their front end as they are at the moment, so they shorten. */
#define CP_FILM_PARTS(X)                                                                           \
    X(CP_FILM_BODY, "body")                                                                        \
    X(CP_FILM_LONGITUDINAL_LEFT, "longitudinal_left")                                              \
    X(CP_FILM_LONGITUDINAL_RIGHT, "longitudinal_right")                                            \
    X(CP_FILM_CRASH_BOX_LEFT, "crash_box_left")                                                    \
    X(CP_FILM_CRASH_BOX_RIGHT, "crash_box_right")                                                  \
    X(CP_FILM_CROSS_MEMBER_LEFT, "cross_member_left")                                              \
    X(CP_FILM_CROSS_MEMBER_RIGHT, "cross_member_right")                                            \
    X(CP_FILM_CORNER_LEFT, "corner_left")                                                          \
    X(CP_FILM_CORNER_RIGHT, "corner_right")                                                        \
    X(CP_FILM_ENGINE, "engine")                                                                    \
    X(CP_FILM_UPPER_LEFT, "upper_left")                                                            \
    X(CP_FILM_UPPER_RIGHT, "upper_right")

typedef enum cp_film_part {
#define CP_FILM_PART_NAME(name, text) name,
    CP_FILM_PARTS(CP_FILM_PART_NAME)
#undef CP_FILM_PART_NAME
        CP_FILM_PART_COUNT
} cp_film_part;

/* "body", "engine", ... */
extern const char *const CP_FILM_PART_TEXT[CP_FILM_PART_COUNT];

/* A rectangle with rounded corners, rounding included in length and width. */
typedef struct cp_film_shape {
    cp_vec2 centre_m;
    double yaw_rad;
    double length_m; /* along yaw */
    double width_m;
    double radius_m;
} cp_film_shape;

/* One car in one frame: pose of the undeformed car's centre of gravity, parts in that pose's
 * frame (a car that nothing touches any more keeps its parts and changes its pose only). */
typedef struct cp_film_car {
    cp_pose pose;
    cp_film_shape part[CP_FILM_PART_COUNT];
} cp_film_car;

typedef struct cp_film_frame {
    double time_s;
    cp_film_car car[2]; /* [1] unused against a barrier */
} cp_film_frame;

/* Positions are seen from the ground, in a's axes at first contact: origin at its centre of gravity
 * then, x along its heading, y left. */
typedef struct cp_crash_film {
    double interval_s; /* between frames, rounded to whole time steps, at least one */
    bool against_barrier;
    cp_film_shape barrier; /* against a barrier */
    size_t frame_count;    /* the first at first contact, the last at or just before the end */
    size_t frame_room;
    cp_film_frame *frame; /* owned */
} cp_crash_film;

/* An empty film for cp_crash_options.film: a frame every millisecond. */
cp_crash_film cp_crash_film_default(void);
/* A film that never was recorded is fine too. It may be recorded again. */
void cp_crash_film_destroy(cp_crash_film *film);

#endif
