/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/struck_structure.h"

#include "crash/crush_law.h"

#include <math.h>

// Blocks after those of the front.
enum { LEFT, RIGHT, REAR };

// A face resists by at least this share of its whole force wherever it is pressed on.
static const double LEAST_SHARE_1 = 0.05;

// Depth of a side's block, of the car's width: both leave a core between them.
static const double SIDE_DEPTH_1 = 0.42;

// What is left of the rear structure when all of it has collapsed, m.
static const double REAR_REST_M = 0.1;

static void add_block(cp_car *car, cp_crush_block block, cp_car_outline outline)
{
    int index = car->block_count++;
    outline.body = CP_BODY_ROOT;
    outline.block = index;
    outline.stiffness_n_m = 1e3 * car->model->contact_stiffness_kn_m;
    outline.radius_m = fmin(outline.radius_m, fmin(outline.half_length_m, outline.half_width_m));
    block.rate_gain_1 = car->model->strain_rate_gain_1;
    block.share_1 = 1.0;
    block.full_width_m = 2.0 * outline.half_width_m;
    car->block[index] = block;
    car->outline[CP_OUTLINE_BLOCKS + index] = outline;
}

void cp_struck_build(cp_car *car)
{
    const cp_vehicle_model *m = car->model;
    cp_car_outline *body = &car->outline[CP_OUTLINE_BODY];
    double firewall_m = body->centre_m.x + body->half_length_m;
    double rear_m = body->centre_m.x - body->half_length_m;
    double rear_depth_m = m->rear_collapse_end_m + REAR_REST_M,
           rear_front_m = rear_m + rear_depth_m;
    double side_depth_m = SIDE_DEPTH_1 * m->width_m, side_length_m = firewall_m - rear_front_m;
    car->struck_block = car->block_count;

    // Zones of a side by their distance from its front end.
    car->zone_end_m[CP_ZONE_FRONT_WHEEL] = m->side_front_wheel_1 * side_length_m;
    car->zone_end_m[CP_ZONE_DOOR] = (1.0 - m->side_rear_wheel_1) * side_length_m;
    car->zone_end_m[CP_ZONE_REAR_WHEEL] = side_length_m;
    for (int z = 0; z < CP_SIDE_ZONES; z++)
        car->zone_law[z] = cp_side_zone_law(m, z);

    for (int side = LEFT; side <= RIGHT; side++) {
        double sign = side == LEFT ? 1.0 : -1.0;
        cp_car_outline outline = {.centre_m = {0.5 * (firewall_m + rear_front_m),
                                               sign * 0.5 * (m->width_m - side_depth_m)},
                                  .along = {0.0, sign},
                                  .half_length_m = 0.5 * side_depth_m,
                                  .half_width_m = 0.5 * side_length_m,
                                  .radius_m = m->corner_radius_m};
        add_block(car, (cp_crush_block){.law = car->zone_law[CP_ZONE_DOOR]}, outline);
    }
    add_block(car, (cp_crush_block){.law = cp_rear_law(m), .side_law = cp_rear_side_law(m)},
              (cp_car_outline){.centre_m = {0.5 * (rear_m + rear_front_m), 0.0},
                               .along = {-1.0, 0.0},
                               .half_length_m = 0.5 * rear_depth_m,
                               .half_width_m = 0.5 * m->width_m,
                               .radius_m = m->cell_radius_m});
    car->outline_count = CP_OUTLINE_BLOCKS + car->block_count;
    for (int face = LEFT; face <= REAR; face++)
        cp_struck_cover(car, car->struck_block + face, INFINITY, -INFINITY, 0.0);

    // The core between them.
    body->centre_m.x = 0.5 * (firewall_m + rear_front_m);
    body->half_length_m = 0.5 * side_length_m;
    body->half_width_m = 0.5 * m->width_m - side_depth_m;
    body->radius_m = fmin(body->radius_m, fmin(body->half_length_m, body->half_width_m));
}

// Half of the spread is there where something presses a sixth of that inside the nearer end.
static const double SPREAD_RISE_1 = 6.0;

// Where a face yields, along its own left; nothing pressed on: from > to.
typedef struct stretch {
    double from_m;
    double to_m;
} stretch;

static stretch yielding_stretch(double right_m, double left_m, double inside_m, double spread_m)
{
    double beyond_m = fmin(0.5 * spread_m, SPREAD_RISE_1 * inside_m);
    return (stretch){right_m - beyond_m, left_m + beyond_m};
}

static void cover_side(cp_car *car, int side, stretch yields)
{
    // Seen from the front end of the side: the left of a left face looks back.
    double half_m = car->outline[CP_OUTLINE_BLOCKS + car->struck_block + side].half_width_m;
    double from_m = half_m + (side == LEFT ? yields.from_m : -yields.to_m);
    double to_m = half_m + (side == LEFT ? yields.to_m : -yields.from_m);
    double begin_m = -INFINITY, covered_m = 0.0, *width_m = car->zone_width_m[side];
    for (int z = 0; z < CP_SIDE_ZONES; z++) {
        // Beyond its ends the side goes on in what holds it there.
        double end_m = z + 1 < CP_SIDE_ZONES ? car->zone_end_m[z] : (double)INFINITY;
        width_m[z] = fmax(0.0, fmin(to_m, end_m) - fmax(from_m, begin_m));
        covered_m += width_m[z];
        begin_m = end_m;
    }

    // What grazes an end still meets a little of the zone that lies there.
    double least_m = LEAST_SHARE_1 * 2.0 * half_m;
    if (covered_m < least_m) {
        int zone = !(from_m <= to_m)                      ? CP_ZONE_DOOR
                   : 0.5 * (from_m + to_m) < 0.5 * half_m ? CP_ZONE_FRONT_WHEEL
                   : 0.5 * (from_m + to_m) > 1.5 * half_m ? CP_ZONE_REAR_WHEEL
                                                          : CP_ZONE_DOOR;
        width_m[zone] += least_m - covered_m;
    }
    car->block[car->struck_block + side].law = cp_side_law(car->zone_law, width_m);
}

void cp_struck_cover(cp_car *car, int block, double right_m, double left_m, double inside_m)
{
    int face = block - car->struck_block;
    const cp_vehicle_model *m = car->model;
    if (face != REAR) {
        cover_side(car, face, yielding_stretch(right_m, left_m, inside_m, m->side_spread_m));
        return;
    }
    stretch yields = yielding_stretch(right_m, left_m, inside_m, m->rear_spread_m);
    double share_1 = fmax(0.0, yields.to_m - yields.from_m) / m->width_m;
    car->block[block].share_1 = fmin(1.0, fmax(LEAST_SHARE_1, share_1));
}

void cp_struck_after_step(cp_car *car)
{
    for (int side = LEFT; side <= RIGHT && cp_car_is_struck(car); side++) {
        double s_m = car->block[car->struck_block + side].s_m, before_m = car->zone_s_m[side];
        if (s_m <= before_m)
            continue;
        for (int z = 0; z < CP_SIDE_ZONES; z++)
            car->zone_j[side][z] +=
                car->zone_width_m[side][z] * (cp_crush_loading_work(&car->zone_law[z], s_m) -
                                              cp_crush_loading_work(&car->zone_law[z], before_m));
        car->zone_s_m[side] = s_m;
    }
}

// The outboard corner of a side and the rear overhang, pushed aside towards the middle.
static double pushed_in(const cp_crush_block *block, cp_contact_side side)
{
    return side == CP_SIDE_LEFT ? -block->side_m : block->side_m;
}

static cp_struck struck_side(const cp_car *car, cp_contact_side side)
{
    int face = side == CP_SIDE_LEFT ? LEFT : RIGHT;
    const cp_crush_block *block = &car->block[car->struck_block + face];
    const double *zone_j = car->zone_j[face];
    cp_struck struck = {block->s_m, CP_STRUCK_DOOR};
    if (zone_j[CP_ZONE_FRONT_WHEEL] > fmax(zone_j[CP_ZONE_DOOR], zone_j[CP_ZONE_REAR_WHEEL]))
        struck.zone = CP_STRUCK_FRONT_WHEEL;
    else if (zone_j[CP_ZONE_REAR_WHEEL] > zone_j[CP_ZONE_DOOR])
        struck.zone = CP_STRUCK_REAR_WHEEL;
    for (int k = 0; k < car->struck_block; k++)
        if (cp_car_part_of_block(car, k) == face &&
            pushed_in(&car->block[k], side) > struck.depth_m)
            struck = (cp_struck){pushed_in(&car->block[k], side), CP_STRUCK_FRONT_WHEEL};
    // The rear's own left looks to the car's right.
    double rear_m = -pushed_in(&car->block[car->struck_block + REAR], side);
    return rear_m > struck.depth_m ? (cp_struck){rear_m, CP_STRUCK_REAR} : struck;
}

cp_struck cp_struck_of(const cp_car *car, cp_contact_side side)
{
    if (side == CP_SIDE_FRONT || !cp_car_is_struck(car))
        return (cp_struck){car->intrusion_m, CP_STRUCK_FRONT};
    if (side == CP_SIDE_REAR)
        return (cp_struck){car->block[car->struck_block + REAR].s_m, CP_STRUCK_REAR};
    return struck_side(car, side);
}
