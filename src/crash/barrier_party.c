/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/barrier_party.h"

#include "crash/crush_law.h"

#include <math.h>

// The face's strips, the left one first.
static void set_face(cp_car *car)
{
    const cp_vehicle_model *m = car->model;
    const cp_barrier *barrier = &m->barrier;
    const double share_1 = 1.0 / CP_BARRIER_STRIPS, width_m = share_1 * barrier->width_m;
    cp_crush_law law = cp_crush_law_share(cp_barrier_face_law(barrier), share_1);
    double front_m = 0.5 * barrier->depth_m, half_m = 0.5 * barrier->face_m;
    for (int k = 0; k < CP_BARRIER_STRIPS; k++) {
        bool outer = k == 0 || k == CP_BARRIER_STRIPS - 1;
        double radius_m = fmin(outer ? barrier->corner_radius_m : 0.0, fmin(half_m, 0.5 * width_m));
        car->block[k] =
            (cp_crush_block){.law = law,
                             .full_width_m = width_m - 2.0 * radius_m + CP_CONTACT_PATCH_M,
                             .share_1 = 1.0};
        car->outline[CP_OUTLINE_BLOCKS + k] = (cp_car_outline){
            .body = CP_BODY_ROOT,
            .block = k,
            .centre_m = {front_m - half_m, 0.5 * barrier->width_m - (k + 0.5) * width_m},
            .along = {1.0, 0.0},
            .half_length_m = half_m,
            .half_width_m = 0.5 * width_m,
            .radius_m = radius_m,
            .stiffness_n_m = 2.0 * share_1 * 1e3 * m->contact_stiffness_kn_m};
    }
    car->block_count = CP_BARRIER_STRIPS;
}

void cp_barrier_party_build(cp_car *car, const cp_vehicle_model *model, dWorldID world,
                            const cp_body_state *state)
{
    const cp_barrier *barrier = &model->barrier;
    *car = (cp_car){.model = model, .body_count = 1, .struck_block = -1};
    car->mass_kg[CP_BODY_ROOT] = car->model->mass_kg;
    car->inertia_kg_m2[CP_BODY_ROOT] = car->model->yaw_inertia_kg_m2;
    cp_car_place_body(car, CP_BODY_ROOT, (cp_vec2){0.0, 0.0}, world, state);
    for (int k = 0; k < CP_OUTLINE_BLOCKS; k++)
        car->outline[k] = (cp_car_outline){
            .absent = k != CP_OUTLINE_BODY, .body = CP_BODY_ROOT, .block = -1, .along = {1.0, 0.0}};
    double half_length_m = 0.5 * (barrier->depth_m - barrier->face_m);
    cp_car_outline *body = &car->outline[CP_OUTLINE_BODY];
    body->centre_m.x = -0.5 * barrier->face_m;
    body->half_length_m = half_length_m;
    body->half_width_m = 0.5 * barrier->width_m;
    body->radius_m = fmin(barrier->corner_radius_m, fmin(body->half_length_m, body->half_width_m));
    body->stiffness_n_m = 1e3 * car->model->contact_stiffness_kn_m;
    if (barrier->face_m > 0.0)
        set_face(car);
    car->outline_count = CP_OUTLINE_BLOCKS + car->block_count;
}
