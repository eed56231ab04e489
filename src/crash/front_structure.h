/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_FRONT_STRUCTURE_H
#define CRASH_FRONT_STRUCTURE_H

#include "crash/contact.h"
#include "crash/crash_configuration.h"
#include "crash/crash_outcome.h"
#include "crash/crush_block.h"
#include "crash/crush_element.h"
#include "crash/crush_law.h"

#include <ode/ode.h>

_Static_assert(sizeof(dReal) == 8, "ODE must be built with double precision");

/* One car as planar rigid bodies in an ODE world: bodies, joints, force elements, outlines.
 * Everything stays exactly in the plane z = 0, because nothing ever pushes out of it. */

enum {
    CP_BODY_ROOT, /* everything behind the firewall */
    CP_BODY_LONGITUDINAL_LEFT,
    CP_BODY_LONGITUDINAL_RIGHT,
    CP_BODY_CRASH_BOX_LEFT,
    CP_BODY_CRASH_BOX_RIGHT,
    CP_BODY_CROSS_MEMBER_LEFT,
    CP_BODY_CROSS_MEMBER_RIGHT,
    CP_BODY_ENGINE,
    CP_BODY_COUNT
};

/* Crush force along a direction fixed in one body, between a body pushed forward and a body
 * pushed back, at one common point. */
typedef struct cp_axial_element {
    int front;                /* body in front */
    int rear;                 /* body behind */
    int axis;                 /* body whose x axis is the direction of compression */
    cp_vec2 front_point_m;    /* on the front body, its frame */
    cp_vec2 rear_point_m;     /* on the rear body, its frame: compression = rest - distance */
    bool force_at_rear_point; /* where the common point is */
    double rest_m;
    cp_crush_law law;
    cp_crush_state state;
    double rate_gain_1; /* of cp_strain_rate_factor */
    double rate_n;      /* what the rate adds to the force of the present step, and the rate */
    double rate_m_s;
    double rate_j; /* dissipated by it so far */
} cp_axial_element;

/* Plastic hinge between two bodies. */
typedef struct cp_bending_element {
    int outer;
    int inner;
    cp_bending_law law;
    cp_bending_state state;
} cp_bending_element;

/* Engine mount: elastic-plastic point-to-point tie with damping. */
typedef struct cp_tie_element {
    int member; /* the longitudinal */
    cp_vec2 member_point_m;
    cp_vec2 engine_point_m;
    cp_vec2 plastic_m; /* permanent displacement, engine's frame */
    double plastic_j;
    cp_vec2 damping_n;
    cp_vec2 rate_m_s;
} cp_tie_element;

enum {
    CP_AXIAL_COUNT = 6, /* 2 longitudinals, 2 crash boxes, 2 engine-to-firewall */
    CP_BENDING_COUNT = 4,
    CP_TIE_COUNT = 2,
    CP_STRIPS_MAX = 4,                     /* of a corner, of half of the upper load path */
    CP_BLOCKS_MAX = 4 * CP_STRIPS_MAX + 3, /* and sides and rear */
    CP_BLOCK_CELL = CP_BLOCKS_MAX,         /* edges of the passenger cell */
    CP_OUTLINE_ENGINE = 2,                 /* after the halves of the cross member */
    CP_OUTLINE_BODY,
    CP_OUTLINE_BLOCKS, /* and one for every block */
    CP_OUTLINES_MAX = CP_OUTLINE_BLOCKS + CP_BLOCKS_MAX,
    CP_HINGE_COUNT = 2
};

/* A contact outline: which body carries it, where on it, how stiff it is. */
typedef struct cp_car_outline {
    bool absent; /* a barrier has only its body and its face */
    int body;
    int block;        /* crush block it is the outline of, -1: none */
    cp_vec2 centre_m; /* in the body's frame */
    cp_vec2 along;    /* unit vector of its length, likewise */
    double half_length_m;
    double half_width_m;
    double radius_m;
    double stiffness_n_m;
    double damping_n_s_m;
} cp_car_outline;

typedef struct cp_car {
    const cp_vehicle_model *model;
    int body_count; /* 1: a barrier, its root alone */
    dBodyID body[CP_BODY_COUNT];
    double mass_kg[CP_BODY_COUNT];
    double inertia_kg_m2[CP_BODY_COUNT];
    cp_vec2 cog_m; /* undeformed car's centre of gravity in the root's frame */
    cp_axial_element axial[CP_AXIAL_COUNT];
    cp_bending_element bending[CP_BENDING_COUNT];
    cp_tie_element tie[CP_TIE_COUNT];
    cp_crush_block block[CP_BLOCKS_MAX + 1]; /* strips of the corners left, right, of the upper load
                                              * path left, right; from the middle outwards; then the
                                              * struck sides and rear; at CP_BLOCK_CELL the cell */
    int block_count;
    int front_block_count;
    int struck_block; /* number of the left side's, then right side's, rear's; -1: none */
    double zone_end_m[CP_SIDE_ZONES]; /* of a side, from its front end */
    cp_crush_law zone_law[CP_SIDE_ZONES];
    double zone_width_m[2][CP_SIDE_ZONES]; /* of the left and right side that yields in this step */
    double zone_j[2][CP_SIDE_ZONES];       /* taken so far, without what strain rate adds */
    double zone_s_m[2];                    /* crush up to which that counts */
    cp_car_outline outline[CP_OUTLINES_MAX];
    int outline_count;
    dJointID hinge[CP_HINGE_COUNT];
    dJointFeedback hinge_feedback[CP_HINGE_COUNT];
    cp_vec2 hinge_gap_m[CP_HINGE_COUNT]; /* between its two anchors at the step's beginning */
    double elastic_j;       /* stored in its parts at the beginning of the present step */
    double mount_damping_j; /* dissipated by the dampers of the engine's ties so far */
    double intrusion_m; /* deepest that a used up block has been pushed into the passenger cell */
    double crush_m;     /* largest shortening bumper to firewall so far */
} cp_car;

/* Build the car in the world at a state, with its front alone. The world owns bodies and joints,
 * and knows where the car is: it must stay there until the world has gone. Errors: CP_BAD_INPUT
 * when masses and inertia do not fit together (naming the field). */
CP_MUST_CHECK cp_status cp_car_build(cp_car *car, const cp_vehicle_model *model, dWorldID world,
                                     const cp_body_state *state, cp_error *error);

/* Create body number index at a place, x forward from the centre of gravity, moving with the car.
 */
void cp_car_place_body(cp_car *car, int index, cp_vec2 place_m, dWorldID world,
                       const cp_body_state *state);

/* Whether it has sides and rear (crash/struck_structure.h). */
bool cp_car_is_struck(const cp_car *car);

/* Put all forces of the coming step on the bodies, and take elastic_j. */
void cp_car_apply_forces(cp_car *car);
/* After the step: what the dampers took, how far it is crushed; angular momentum mended where a
 * hinge's two anchors have drifted apart. */
void cp_car_after_step(cp_car *car, double time_step_s);

/* Part a block belongs to: 0, 1 the left and right corner, 2, 3 the halves of the upper load path,
 * 4, 5, 6 the left and right side and the rear. */
int cp_car_part_of_block(const cp_car *car, int block);

/* Outline number index where it is now. */
cp_outline cp_car_outline_now(const cp_car *car, int index);

/* Motion of the material point at the undeformed centre of gravity. */
cp_body_state cp_car_cog_state(const cp_car *car);

double cp_car_kinetic_energy(const cp_car *car);
double cp_car_elastic_energy(const cp_car *car);
/* What its parts have dissipated so far. The blocks' is part of the contact's work. */
cp_car_absorbed cp_car_energy_absorbed(const cp_car *car);
/* Of rate_j, corner_j and upper_j what the blocks have taken. */
double cp_car_block_energy(const cp_car *car);
/* Linear momentum, and angular momentum about the world's origin (z). */
cp_vec2 cp_car_momentum(const cp_car *car, double *angular_kg_m2_s);

/* Plane views of an ODE body. */
cp_pose cp_body_pose(dBodyID body);
cp_vec2 cp_body_velocity_at(dBodyID body, cp_vec2 world_m);

#endif
