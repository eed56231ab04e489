/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/film_camera.h"

#include <stdlib.h>

static cp_film_shape shape_of_outline(const cp_outline *outline)
{
    return (cp_film_shape){.centre_m = outline->centre_m,
                           .yaw_rad = atan2(outline->along.y, outline->along.x),
                           .length_m = 2.0 * outline->half_length_m,
                           .width_m = 2.0 * outline->half_width_m,
                           .radius_m = outline->radius_m};
}

static cp_film_shape seen_from(cp_pose frame, cp_film_shape shape)
{
    shape.centre_m = cp_pose_to_local(frame, shape.centre_m);
    shape.yaw_rad = cp_wrap_angle(shape.yaw_rad - frame.yaw_rad);
    return shape;
}

cp_status cp_film_camera_begin(cp_film_camera *camera, cp_crash_film *film, size_t last_sample,
                               double time_step_s, cp_pose origin, const cp_outline *barrier,
                               cp_error *error)
{
    *camera = (cp_film_camera){.film = film, .origin = origin};
    if (film == NULL)
        return CP_OK;
    if (!(film->interval_s > 0.0))
        return cp_fail(error, CP_BAD_INPUT, "interval_s of a film must be > 0, found %g",
                       film->interval_s);
    cp_crash_film_destroy(film);
    camera->every = (size_t)fmax(1.0, round(film->interval_s / time_step_s));
    film->frame_room = last_sample / camera->every + 1;
    film->frame = calloc(film->frame_room, sizeof *film->frame);
    if (film->frame == NULL)
        return cp_fail_memory(error, "a film");
    film->against_barrier = barrier != NULL;
    if (barrier != NULL)
        film->barrier = seen_from(origin, shape_of_outline(barrier));
    return CP_OK;
}

// ---- parts -----------------------------------------------------------------------------------

static cp_vec2 ahead_of(dBodyID body, double ahead_m)
{
    cp_pose pose = cp_body_pose(body);
    return cp_pose_to_world(pose, (cp_vec2){ahead_m, 0.0});
}

// A member seen from above: a bar from one point to another.
static cp_film_shape bar(cp_vec2 rear_m, cp_vec2 front_m, double yaw_rad, double width_m)
{
    cp_vec2 reach = cp_vec2_sub(front_m, rear_m);
    double length_m = cp_vec2_dot(reach, cp_vec2_heading(yaw_rad));
    return (cp_film_shape){.centre_m = cp_vec2_scale(cp_vec2_add(rear_m, front_m), 0.5),
                           .yaw_rad = yaw_rad,
                           .length_m = fmax(0.0, length_m),
                           .width_m = width_m,
                           .radius_m = 0.01};
}

// Longitudinal from its foot on the root to its front end, crash box from there to the cross
// member: what the axial elements leave of them.
static void take_members(const cp_car *car, int side, cp_film_shape part[CP_FILM_PART_COUNT])
{
    const cp_vehicle_model *m = car->model;
    dBodyID longitudinal = car->body[CP_BODY_LONGITUDINAL_LEFT + side];
    dBodyID box = car->body[CP_BODY_CRASH_BOX_LEFT + side];
    cp_pose root = cp_body_pose(car->body[CP_BODY_ROOT]);
    double yaw_rad = cp_body_pose(longitudinal).yaw_rad;
    cp_vec2 foot_m = cp_pose_to_world(root, car->axial[side].rear_point_m);
    cp_vec2 joint_m = ahead_of(longitudinal, 0.5 * m->longitudinal_length_m);
    cp_vec2 front_m = ahead_of(box, 0.5 * m->crash_box_length_m);
    part[CP_FILM_LONGITUDINAL_LEFT + side] = bar(foot_m, joint_m, yaw_rad, 0.1);
    part[CP_FILM_CRASH_BOX_LEFT + side] = bar(joint_m, front_m, yaw_rad, 0.14);
}

static cp_film_shape shape_of(const cp_car *car, int outline)
{
    cp_outline now = cp_car_outline_now(car, outline);
    return shape_of_outline(&now);
}

// A corner, or half of the upper load path: as wide as its strips together, as long as they are on
// average.
static void take_blocks(const cp_car *car, cp_film_shape part[CP_FILM_PART_COUNT])
{
    static const cp_film_part PART[4] = {CP_FILM_CORNER_LEFT, CP_FILM_CORNER_RIGHT,
                                         CP_FILM_UPPER_LEFT, CP_FILM_UPPER_RIGHT};
    int strips[4] = {0};
    for (int k = 0; k < car->front_block_count; k++) {
        int place = cp_car_part_of_block(car, k);
        cp_film_shape strip = shape_of(car, CP_OUTLINE_BLOCKS + k), *whole = &part[PART[place]];
        double share = 1.0 / ++strips[place];
        whole->centre_m = cp_vec2_add(cp_vec2_scale(whole->centre_m, 1.0 - share),
                                      cp_vec2_scale(strip.centre_m, share));
        whole->length_m = (1.0 - share) * whole->length_m + share * strip.length_m;
        whole->width_m += strip.width_m;
        whole->yaw_rad = strip.yaw_rad;
        whole->radius_m = strip.radius_m;
    }
}

// The body of a car with sides and rear of their own: what lies between their faces.
static cp_film_shape struck_body(const cp_car *car)
{
    cp_pose root = cp_body_pose(car->body[CP_BODY_ROOT]);
    cp_film_shape shape = shape_of(car, CP_OUTLINE_BODY);
    double reach_m[3]; // of the faces left, right, rear from the middle of the root
    for (int face = 0; face < 3; face++) {
        cp_outline part = cp_car_outline_now(car, CP_OUTLINE_BLOCKS + car->struck_block + face);
        cp_vec2 middle = cp_vec2_add(part.centre_m, cp_vec2_scale(part.along, part.half_length_m));
        cp_vec2 local = cp_pose_to_local(root, middle);
        reach_m[face] = face < 2 ? local.y : local.x;
    }
    double front_m = cp_pose_to_local(root, shape.centre_m).x + 0.5 * shape.length_m;
    shape.length_m = front_m - reach_m[2];
    shape.width_m = reach_m[0] - reach_m[1];
    cp_vec2 centre = {0.5 * (front_m + reach_m[2]), 0.5 * (reach_m[0] + reach_m[1])};
    shape.centre_m = cp_pose_to_world(root, centre);
    shape.radius_m = fmin(car->model->cell_radius_m, 0.5 * fmin(shape.length_m, shape.width_m));
    return shape;
}

static void take_parts(const cp_car *car, cp_film_car *seen)
{
    for (int side = 0; side < 2 && !car->model->is_barrier; side++)
        seen->part[CP_FILM_CROSS_MEMBER_LEFT + side] = shape_of(car, side);
    if (!car->model->is_barrier)
        seen->part[CP_FILM_ENGINE] = shape_of(car, CP_OUTLINE_ENGINE);
    seen->part[CP_FILM_BODY] =
        cp_car_is_struck(car) ? struck_body(car) : shape_of(car, CP_OUTLINE_BODY);
    take_blocks(car, seen->part);
    for (int side = 0; side < 2 && !car->model->is_barrier; side++)
        take_members(car, side, seen->part);

    // In the plane of the simulation so far; now from the car itself.
    cp_body_state cog = cp_car_cog_state(car);
    for (int k = 0; k < CP_FILM_PART_COUNT; k++)
        if (!car->model->is_barrier || k == CP_FILM_BODY) // a barrier has no other parts
            seen->part[k] = seen_from((cp_pose){cog.cog_m, cog.yaw_rad}, seen->part[k]);
}

// ---- frames ----------------------------------------------------------------------------------

// The next frame of the film with the poses of the cars in it; NULL when none is due.
static cp_film_frame *next_frame(const cp_film_camera *camera, size_t sample, double time_step_s,
                                 const cp_pose ground[2], int car_count)
{
    cp_crash_film *film = camera->film;
    if (film == NULL || sample % camera->every != 0 || film->frame_count == film->frame_room)
        return NULL;
    cp_film_frame *frame = &film->frame[film->frame_count++];
    frame->time_s = time_step_s * (double)sample;
    for (int c = 0; c < car_count; c++)
        frame->car[c].pose = (cp_pose){cp_pose_to_local(camera->origin, ground[c].position_m),
                                       cp_wrap_angle(ground[c].yaw_rad - camera->origin.yaw_rad)};
    return frame;
}

void cp_film_camera_take(const cp_film_camera *camera, size_t sample, double time_step_s,
                         const cp_car *car, const cp_pose ground[2], int car_count)
{
    cp_film_frame *frame = next_frame(camera, sample, time_step_s, ground, car_count);
    for (int c = 0; frame != NULL && c < car_count; c++)
        take_parts(&car[c], &frame->car[c]);
}

void cp_film_camera_take_coasting(const cp_film_camera *camera, size_t sample, double time_step_s,
                                  const cp_pose ground[2], int car_count)
{
    cp_film_frame *frame = next_frame(camera, sample, time_step_s, ground, car_count);
    for (int c = 0; frame != NULL && c < car_count; c++)
        for (int k = 0; k < CP_FILM_PART_COUNT; k++)
            frame->car[c].part[k] = frame[-1].car[c].part[k];
}
