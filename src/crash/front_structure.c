/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/front_structure.h"

#include "crash/crush_law.h"

#include <string.h>

// ---- plane views of ODE ----------------------------------------------------------------------

cp_pose cp_body_pose(dBodyID body)
{
    const dReal *p = dBodyGetPosition(body), *r = dBodyGetRotation(body);
    return (cp_pose){{p[0], p[1]}, atan2(r[4], r[0])};
}

// Turn a vector of the body's frame into the world without computing an angle.
static cp_vec2 body_direction(dBodyID body, cp_vec2 local)
{
    const dReal *r = dBodyGetRotation(body);
    return (cp_vec2){r[0] * local.x + r[1] * local.y, r[4] * local.x + r[5] * local.y};
}

static cp_vec2 body_point(dBodyID body, cp_vec2 local_m)
{
    const dReal *p = dBodyGetPosition(body);
    return cp_vec2_add((cp_vec2){p[0], p[1]}, body_direction(body, local_m));
}

cp_vec2 cp_body_velocity_at(dBodyID body, cp_vec2 world_m)
{
    const dReal *p = dBodyGetPosition(body), *v = dBodyGetLinearVel(body),
                *w = dBodyGetAngularVel(body);
    return cp_point_velocity((cp_vec2){v[0], v[1]}, w[2],
                             cp_vec2_sub(world_m, (cp_vec2){p[0], p[1]}));
}

// Equal and opposite forces at one point: momentum and angular momentum stay exactly.
static void push_apart(dBodyID one, dBodyID other, cp_vec2 force_n, cp_vec2 point_m)
{
    dBodyAddForceAtPos(one, force_n.x, force_n.y, 0.0, point_m.x, point_m.y, 0.0);
    dBodyAddForceAtPos(other, -force_n.x, -force_n.y, 0.0, point_m.x, point_m.y, 0.0);
}

// ---- building --------------------------------------------------------------------------------

// Where the parts of the undeformed car lie, x from its centre of gravity.
typedef struct layout {
    double front_m;        /* bumper */
    double cross_member_m; /* middle of the cross member */
    double crash_box_m;    /* middle of the crash boxes */
    double longitudinal_m; /* middle of the longitudinals */
    double firewall_m;     /* their feet */
    double engine_m;       /* middle of the engine */
    double engine_length_m;
    double corner_length_m;
    double upper_length_m;
    double upper_width_m;
} layout;

static layout layout_of(const cp_vehicle_model *m)
{
    layout at = {.front_m = m->cg_to_front_m};
    at.cross_member_m = at.front_m - 0.5 * m->cross_member_depth_m;
    double box_front_m = at.front_m - m->cross_member_depth_m;
    at.crash_box_m = box_front_m - 0.5 * m->crash_box_length_m;
    double longitudinal_front_m = box_front_m - m->crash_box_length_m;
    at.longitudinal_m = longitudinal_front_m - 0.5 * m->longitudinal_length_m;
    at.firewall_m = longitudinal_front_m - m->longitudinal_length_m;
    double engine_back_m = at.firewall_m + m->engine_gap_firewall_m;
    double engine_front_m = box_front_m - m->engine_gap_front_m;
    at.engine_m = 0.5 * (engine_back_m + engine_front_m);
    at.engine_length_m = engine_front_m - engine_back_m;
    double corner_front_m = at.front_m - m->corner_gap_m;
    at.corner_length_m = corner_front_m - at.firewall_m;
    double upper_front_m = at.front_m - m->upper_gap_m;
    at.upper_length_m = upper_front_m - at.firewall_m;
    at.upper_width_m = 0.5 * m->width_m - m->corner_width_m;
    return at;
}

// A slender or boxy part about its own centre.
static double box_inertia(double mass_kg, double length_m, double width_m)
{
    return mass_kg * (length_m * length_m + width_m * width_m) / 12.0;
}

// Masses, places and inertias of all bodies; the root gets what is left of the whole car, so that
// mass, centre of gravity and yaw inertia are the car's.
static cp_status distribute_mass(cp_car *car, const layout *at, cp_vec2 place[CP_BODY_COUNT],
                                 cp_error *error)
{
    const cp_vehicle_model *m = car->model;
    const double thickness_m = 0.1;
    for (int side = 0; side < 2; side++) {
        double sign = side == 0 ? 1.0 : -1.0;
        int longitudinal = CP_BODY_LONGITUDINAL_LEFT + side, box = CP_BODY_CRASH_BOX_LEFT + side;
        int cross = CP_BODY_CROSS_MEMBER_LEFT + side;
        place[longitudinal] = (cp_vec2){at->longitudinal_m, sign * m->longitudinal_y_m};
        place[box] = (cp_vec2){at->crash_box_m, sign * m->longitudinal_y_m};
        place[cross] = (cp_vec2){at->cross_member_m, sign * 0.5 * m->cross_member_half_width_m};
        car->mass_kg[longitudinal] = m->longitudinal_mass_kg;
        car->mass_kg[box] = m->crash_box_mass_kg;
        car->mass_kg[cross] = m->cross_member_mass_kg;
        car->inertia_kg_m2[longitudinal] =
            box_inertia(m->longitudinal_mass_kg, m->longitudinal_length_m, thickness_m);
        car->inertia_kg_m2[box] =
            box_inertia(m->crash_box_mass_kg, m->crash_box_length_m, thickness_m);
        car->inertia_kg_m2[cross] = box_inertia(m->cross_member_mass_kg, m->cross_member_depth_m,
                                                m->cross_member_half_width_m);
    }
    place[CP_BODY_ENGINE] = (cp_vec2){at->engine_m, 0.0};
    car->mass_kg[CP_BODY_ENGINE] = m->engine_mass_kg;
    car->inertia_kg_m2[CP_BODY_ENGINE] =
        box_inertia(m->engine_mass_kg, at->engine_length_m, m->engine_width_m);

    double mass_kg = m->mass_kg, moment_kg_m = 0.0, inertia_kg_m2 = m->yaw_inertia_kg_m2;
    for (int k = CP_BODY_ROOT + 1; k < CP_BODY_COUNT; k++) {
        mass_kg -= car->mass_kg[k];
        moment_kg_m -= car->mass_kg[k] * place[k].x;
        inertia_kg_m2 -= car->inertia_kg_m2[k] + car->mass_kg[k] * cp_vec2_dot(place[k], place[k]);
    }
    place[CP_BODY_ROOT] = (cp_vec2){moment_kg_m / mass_kg, 0.0};
    inertia_kg_m2 -= moment_kg_m * moment_kg_m / mass_kg;
    if (inertia_kg_m2 < 0.05 * m->yaw_inertia_kg_m2)
        return cp_fail(error, CP_BAD_INPUT,
                       "vehicle %s: yaw_inertia_kg_m2 = %g leaves %g for what lies behind the "
                       "firewall, at least 5 %% are needed",
                       m->name, m->yaw_inertia_kg_m2, inertia_kg_m2);
    car->mass_kg[CP_BODY_ROOT] = mass_kg;
    car->inertia_kg_m2[CP_BODY_ROOT] = inertia_kg_m2;
    car->cog_m = (cp_vec2){-place[CP_BODY_ROOT].x, 0.0};
    return CP_OK;
}

void cp_car_place_body(cp_car *car, int index, cp_vec2 place_m, dWorldID world,
                       const cp_body_state *state)
{
    dBodyID body = dBodyCreate(world);
    dMass mass;
    double i = car->inertia_kg_m2[index];
    dMassSetParameters(&mass, car->mass_kg[index], 0, 0, 0, i, i, i, 0, 0, 0);
    dBodySetMass(body, &mass);
    cp_vec2 at = cp_pose_to_world((cp_pose){state->cog_m, state->yaw_rad}, place_m);
    cp_vec2 velocity = cp_point_velocity(state->velocity_m_s, state->yaw_rate_rad_s,
                                         cp_vec2_sub(at, state->cog_m));
    dQuaternion turn = {cos(0.5 * state->yaw_rad), 0, 0, sin(0.5 * state->yaw_rad)};
    dBodySetPosition(body, at.x, at.y, 0.0);
    dBodySetQuaternion(body, turn);
    dBodySetLinearVel(body, velocity.x, velocity.y, 0.0);
    dBodySetAngularVel(body, 0.0, 0.0, state->yaw_rate_rad_s);
    dBodySetGyroscopicMode(body, 0);
    dBodySetAutoDisableFlag(body, 0);
    car->body[index] = body;
}

// Prismatic joint in the plane. ODE's piston also allows a turn about its axis, which nothing in
// the plane excites, and costs a row less than its slider; so does a ball for a hinge about z.
static void slide_along(dWorldID world, dBodyID one, dBodyID other, cp_vec2 axis)
{
    dJointID joint = dJointCreatePiston(world, 0);
    dJointAttach(joint, one, other);
    const dReal *p = dBodyGetPosition(one);
    dJointSetPistonAnchor(joint, p[0], p[1], 0.0);
    dJointSetPistonAxis(joint, axis.x, axis.y, 0.0);
}

static void join_bodies(cp_car *car, dWorldID world, const layout *at,
                        const cp_vec2 place[CP_BODY_COUNT])
{
    dBodyID root = car->body[CP_BODY_ROOT];
    cp_vec2 ahead = body_direction(root, (cp_vec2){1, 0}), left = {-ahead.y, ahead.x};
    for (int side = 0; side < 2; side++) {
        dBodyID longitudinal = car->body[CP_BODY_LONGITUDINAL_LEFT + side];
        dBodyID box = car->body[CP_BODY_CRASH_BOX_LEFT + side];
        dBodyID cross = car->body[CP_BODY_CROSS_MEMBER_LEFT + side];

        // The longitudinal slides along its own axis through its foot on the root and turns there.
        cp_vec2 foot = {at->firewall_m - place[CP_BODY_ROOT].x,
                        place[CP_BODY_LONGITUDINAL_LEFT + side].y};
        cp_vec2 foot_world = body_point(root, foot);
        dJointID joint = dJointCreatePR(world, 0);
        dJointAttach(joint, longitudinal, root);
        dJointSetPRAxis1(joint, ahead.x, ahead.y, 0.0);
        dJointSetPRAxis2(joint, 0.0, 0.0, 1.0);
        dJointSetPRAnchor(joint, foot_world.x, foot_world.y, 0.0);

        // Crash box along the longitudinal.
        slide_along(world, box, longitudinal, ahead);

        // The cross member half turns on the front end of its crash box.
        cp_vec2 tip = body_point(box, (cp_vec2){at->cross_member_m - at->crash_box_m, 0.0});
        joint = dJointCreateBall(world, 0);
        dJointAttach(joint, cross, box);
        dJointSetBallAnchor(joint, tip.x, tip.y, 0.0);
        dJointSetFeedback(joint, &car->hinge_feedback[side]);
        car->hinge[side] = joint;
    }

    // The two halves telescope.
    slide_along(world, car->body[CP_BODY_CROSS_MEMBER_LEFT], car->body[CP_BODY_CROSS_MEMBER_RIGHT],
                left);
}

// Compression zero in the undeformed car.
static void set_axial(cp_car *car, int index, int front, int rear, int axis, cp_vec2 front_point_m,
                      cp_vec2 rear_point_m, bool at_rear, cp_crush_law law)
{
    cp_axial_element *element = &car->axial[index];
    *element = (cp_axial_element){.front = front,
                                  .rear = rear,
                                  .axis = axis,
                                  .front_point_m = front_point_m,
                                  .rear_point_m = rear_point_m,
                                  .force_at_rear_point = at_rear,
                                  .law = law,
                                  .rate_gain_1 = car->model->strain_rate_gain_1};
    cp_vec2 reach = cp_vec2_sub(body_point(car->body[front], front_point_m),
                                body_point(car->body[rear], rear_point_m));
    element->rest_m = cp_vec2_dot(reach, body_direction(car->body[axis], (cp_vec2){1, 0}));
}

static void set_force_elements(cp_car *car, const layout *at, const cp_vec2 place[CP_BODY_COUNT])
{
    const cp_vehicle_model *m = car->model;
    const cp_vec2 centre = {0.0, 0.0};
    cp_crush_law longitudinal_law = cp_longitudinal_law(m), box_law = cp_crash_box_law(m),
                 bay_law = cp_engine_bay_law(m);

    for (int side = 0; side < 2; side++) {
        double sign = side == 0 ? 1.0 : -1.0;
        int longitudinal = CP_BODY_LONGITUDINAL_LEFT + side, box = CP_BODY_CRASH_BOX_LEFT + side;
        int cross = CP_BODY_CROSS_MEMBER_LEFT + side;
        cp_vec2 foot = {at->firewall_m - place[CP_BODY_ROOT].x, place[longitudinal].y};
        cp_vec2 engine_back = {-0.5 * at->engine_length_m, sign * 0.5 * m->engine_width_m};
        cp_vec2 firewall = {at->firewall_m - place[CP_BODY_ROOT].x, engine_back.y};
        set_axial(car, side, longitudinal, CP_BODY_ROOT, longitudinal, centre, foot, true,
                  longitudinal_law);
        set_axial(car, 2 + side, box, longitudinal, longitudinal, centre, centre, false, box_law);
        set_axial(car, 4 + side, CP_BODY_ENGINE, CP_BODY_ROOT, CP_BODY_ROOT, engine_back, firewall,
                  false, bay_law);
        car->axial[4 + side].rate_gain_1 = 0.0;

        car->bending[side] = (cp_bending_element){
            .outer = longitudinal,
            .inner = CP_BODY_ROOT,
            .law = {1e3 * m->longitudinal_bending_kn_m,
                    1e3 * m->longitudinal_bending_kn_m / m->longitudinal_bending_begin_rad}};
        car->bending[2 + side] = (cp_bending_element){
            .outer = cross,
            .inner = box,
            .law = {1e3 * m->cross_member_bending_kn_m,
                    1e3 * m->cross_member_bending_kn_m / m->cross_member_bending_begin_rad}};
        car->tie[side] =
            (cp_tie_element){.member = longitudinal,
                             .member_point_m = {at->engine_m - at->longitudinal_m, 0.0},
                             .engine_point_m = {0.0, place[longitudinal].y}};
    }
}

// A part that collapses in strips side by side, each a share of it: what meets half of its width
// meets half of its force.
typedef struct stripped_part {
    int strips;
    cp_crush_law law; /* of the whole */
    double front_m;   /* x in the root's frame */
    double rear_m;
    double inner_m; /* from the centre line */
    double outer_m;
    double radius_m; /* rounding of a strip */
} stripped_part;

static void set_strips(cp_car *car, const stripped_part *part, double sign)
{
    const cp_vehicle_model *m = car->model;
    double share = 1.0 / part->strips, width_m = share * (part->outer_m - part->inner_m);
    cp_crush_law law = cp_crush_law_share(part->law, share);
    cp_crush_law side_law = cp_crush_law_share(cp_corner_side_law(m), share);
    for (int k = 0; k < part->strips; k++) {
        int block = car->block_count++;
        car->block[block] =
            (cp_crush_block){.law = law,
                             .side_law = side_law,
                             .full_width_m = width_m - 2.0 * fmin(part->radius_m, 0.5 * width_m) +
                                             CP_CONTACT_PATCH_M,
                             .rate_gain_1 = m->strain_rate_gain_1,
                             .share_1 = 1.0};
        car->outline[CP_OUTLINE_BLOCKS + block] =
            (cp_car_outline){.body = CP_BODY_ROOT,
                             .block = block,
                             .centre_m = {0.5 * (part->front_m + part->rear_m),
                                          sign * (part->inner_m + (k + 0.5) * width_m)},
                             .half_length_m = 0.5 * (part->front_m - part->rear_m),
                             .half_width_m = 0.5 * width_m,
                             .radius_m = part->radius_m,
                             .stiffness_n_m = share * 1e3 * m->contact_stiffness_kn_m};
    }
}

// Corners and upper load path.
static void set_blocks(cp_car *car, const layout *at, double root_m)
{
    const cp_vehicle_model *m = car->model;
    double rear_m = at->firewall_m - root_m;
    stripped_part corner = {.strips = (int)m->corner_strips_1,
                            .law = cp_corner_law(m),
                            .front_m = rear_m + at->corner_length_m,
                            .rear_m = rear_m,
                            .inner_m = at->upper_width_m,
                            .outer_m = 0.5 * m->width_m,
                            .radius_m = m->corner_edge_radius_m};
    stripped_part upper = {.strips = (int)m->upper_strips_1,
                           .law = cp_upper_law(m),
                           .front_m = rear_m + at->upper_length_m,
                           .rear_m = rear_m,
                           .inner_m = 0.0,
                           .outer_m = at->upper_width_m,
                           .radius_m = m->corner_radius_m};
    set_strips(car, &corner, 1.0);
    set_strips(car, &corner, -1.0);
    set_strips(car, &upper, 1.0);
    set_strips(car, &upper, -1.0);
    car->front_block_count = car->block_count;
    car->outline_count = CP_OUTLINE_BLOCKS + car->block_count;

    // The passenger cell yields at its edges too, where nothing of the front lies before them.
    car->block[CP_BLOCK_CELL] = (cp_crush_block){
        .law = cp_cell_edge_law(m), .full_width_m = m->corner_width_m, .share_1 = 1.0};
}

int cp_car_part_of_block(const cp_car *car, int block)
{
    int corner_strips = (int)car->model->corner_strips_1;
    if (block >= car->front_block_count)
        return 4 + block - car->front_block_count;
    if (block < 2 * corner_strips)
        return block / corner_strips;
    return 2 + (block - 2 * corner_strips) / (int)car->model->upper_strips_1;
}

static void set_outlines(cp_car *car, const layout *at, const cp_vec2 place[CP_BODY_COUNT])
{
    // Bodies in front are stiff shells around what collapses behind them; sides and rear give way.
    const cp_vehicle_model *m = car->model;
    const double contact_mass_kg = m->cross_member_mass_kg;
    double front_n_m = 1e3 * m->contact_stiffness_kn_m, body_n_m = 1e3 * m->body_stiffness_kn_m;
    double front_n_s_m = 2.0 * m->contact_damping_1 * sqrt(front_n_m * contact_mass_kg);
    double body_n_s_m = 2.0 * m->body_damping_1 * sqrt(body_n_m * 0.5 * m->mass_kg);
    for (int side = 0; side < 2; side++) {
        // A half swept back keeps its inner end in front.
        double sign = side == 0 ? 1.0 : -1.0, sweep_rad = sign * m->cross_member_sweep_rad;
        double back_m = 0.5 * m->cross_member_half_width_m * sin(m->cross_member_sweep_rad);
        car->outline[side] = (cp_car_outline){.body = CP_BODY_CROSS_MEMBER_LEFT + side,
                                              .block = -1,
                                              .centre_m = {-back_m, 0.0},
                                              .along = cp_vec2_heading(sweep_rad),
                                              .half_length_m = 0.5 * m->cross_member_depth_m,
                                              .half_width_m = 0.5 * m->cross_member_half_width_m};
    }
    car->outline[CP_OUTLINE_ENGINE] = (cp_car_outline){.body = CP_BODY_ENGINE,
                                                       .block = -1,
                                                       .half_length_m = 0.5 * at->engine_length_m,
                                                       .half_width_m = 0.5 * m->engine_width_m};
    double rear_m = m->cg_to_front_m - m->length_m;
    car->outline[CP_OUTLINE_BODY] =
        (cp_car_outline){.body = CP_BODY_ROOT,
                         .block = CP_BLOCK_CELL,
                         .centre_m = {0.5 * (rear_m + at->firewall_m) - place[CP_BODY_ROOT].x, 0.0},
                         .half_length_m = 0.5 * (at->firewall_m - rear_m),
                         .half_width_m = 0.5 * m->width_m};
    for (int k = 0; k < car->outline_count; k++) {
        cp_car_outline *outline = &car->outline[k];
        if (k >= 2)
            outline->along = (cp_vec2){1.0, 0.0};
        bool body = k == CP_OUTLINE_BODY, block = outline->block >= 0 && !body;
        double radius_m = block ? outline->radius_m : body ? m->cell_radius_m : m->corner_radius_m;
        outline->radius_m = fmin(radius_m, fmin(outline->half_length_m, outline->half_width_m));
        if (!block)
            outline->stiffness_n_m = body ? body_n_m : front_n_m;
        outline->damping_n_s_m = block ? 0.0 : body ? body_n_s_m : front_n_s_m;
    }
}

bool cp_car_is_struck(const cp_car *car)
{
    return car->struck_block >= 0;
}

cp_status cp_car_build(cp_car *car, const cp_vehicle_model *model, dWorldID world,
                       const cp_body_state *state, cp_error *error)
{
    *car = (cp_car){.model = model, .body_count = CP_BODY_COUNT, .struck_block = -1};
    layout at = layout_of(model);
    cp_vec2 place[CP_BODY_COUNT];
    cp_status status = distribute_mass(car, &at, place, error);
    if (status != CP_OK)
        return status;
    for (int k = 0; k < CP_BODY_COUNT; k++)
        cp_car_place_body(car, k, place[k], world, state);
    join_bodies(car, world, &at, place);
    set_force_elements(car, &at, place);
    set_blocks(car, &at, place[CP_BODY_ROOT].x);
    set_outlines(car, &at, place);
    return CP_OK;
}

// ---- forces ----------------------------------------------------------------------------------

// Present compression of an axial element, its rate, direction and common point.
typedef struct axial_view {
    double s_m;
    double rate_m_s;
    cp_vec2 direction;
    cp_vec2 point_m;
} axial_view;

static axial_view view_axial(const cp_car *car, const cp_axial_element *element)
{
    dBodyID front = car->body[element->front], rear = car->body[element->rear];
    cp_vec2 front_m = body_point(front, element->front_point_m);
    cp_vec2 rear_m = body_point(rear, element->rear_point_m);
    axial_view view = {.direction = body_direction(car->body[element->axis], (cp_vec2){1, 0}),
                       .point_m = element->force_at_rear_point ? rear_m : front_m};
    view.s_m = element->rest_m - cp_vec2_dot(cp_vec2_sub(front_m, rear_m), view.direction);
    cp_vec2 relative = cp_vec2_sub(cp_body_velocity_at(front, view.point_m),
                                   cp_body_velocity_at(rear, view.point_m));
    view.rate_m_s = -cp_vec2_dot(relative, view.direction);
    return view;
}

static void apply_axial(cp_car *car, cp_axial_element *element)
{
    axial_view view = view_axial(car, element);
    double force_n = cp_crush_force(&element->law, &element->state, view.s_m);

    // The rate adds to the force of a collapse, not to a stop's, and only while it goes on.
    element->rate_m_s = view.rate_m_s;
    double collapse_n = fmax(0.0, fmin(force_n, cp_crush_collapse_force(&element->law)));
    double factor = cp_strain_rate_factor(element->rate_gain_1, view.rate_m_s);
    element->rate_n = (factor - 1.0) * collapse_n;
    force_n += element->rate_n;
    push_apart(car->body[element->front], car->body[element->rear],
               cp_vec2_scale(view.direction, force_n), view.point_m);
    car->elastic_j += cp_crush_elastic_energy(&element->law, &element->state, view.s_m);
}

static double bending_rotation(const cp_car *car, const cp_bending_element *element)
{
    double outer_rad = cp_body_pose(car->body[element->outer]).yaw_rad;
    double inner_rad = cp_body_pose(car->body[element->inner]).yaw_rad;
    return cp_wrap_angle(outer_rad - inner_rad);
}

static void apply_bending(cp_car *car, cp_bending_element *element)
{
    double rotation_rad = bending_rotation(car, element);
    double moment_nm = cp_bending_moment(&element->law, &element->state, rotation_rad);
    car->elastic_j += cp_bending_elastic_energy(&element->law, &element->state, rotation_rad);
    dBodyAddTorque(car->body[element->outer], 0.0, 0.0, -moment_nm);
    dBodyAddTorque(car->body[element->inner], 0.0, 0.0, moment_nm);
}

// Displacement of the longitudinal's end of a tie from the engine's end, in the engine's frame.
static cp_vec2 tie_displacement(const cp_car *car, const cp_tie_element *tie)
{
    cp_pose engine = cp_body_pose(car->body[CP_BODY_ENGINE]);
    cp_vec2 member_m = body_point(car->body[tie->member], tie->member_point_m);
    return cp_vec2_sub(cp_pose_to_local(engine, member_m), tie->engine_point_m);
}

static cp_vec2 tie_rate(const cp_car *car, const cp_tie_element *tie, cp_vec2 point_m)
{
    return cp_vec2_sub(cp_body_velocity_at(car->body[tie->member], point_m),
                       cp_body_velocity_at(car->body[CP_BODY_ENGINE], point_m));
}

static void apply_tie(cp_car *car, cp_tie_element *tie)
{
    // Elastic up to the yield force, then the permanent displacement follows.
    double stiffness_n_m = 1e3 * car->model->engine_mount_kn_m;
    double yield_n = 1e3 * car->model->engine_mount_yield_kn;
    cp_vec2 elastic_m = cp_vec2_sub(tie_displacement(car, tie), tie->plastic_m);
    double force_n = stiffness_n_m * cp_vec2_length(elastic_m);
    if (force_n > yield_n) {
        double share = yield_n / force_n;
        cp_vec2 slip_m = cp_vec2_scale(elastic_m, 1.0 - share);
        tie->plastic_m = cp_vec2_add(tie->plastic_m, slip_m);
        tie->plastic_j += yield_n * cp_vec2_length(slip_m);
        elastic_m = cp_vec2_scale(elastic_m, share);
    }

    car->elastic_j += 0.5 * stiffness_n_m * cp_vec2_dot(elastic_m, elastic_m);

    // On the engine towards the longitudinal, and back, at the engine's end.
    dBodyID engine = car->body[CP_BODY_ENGINE];
    cp_vec2 point_m = body_point(engine, tie->engine_point_m);
    tie->rate_m_s = tie_rate(car, tie, point_m);
    tie->damping_n = cp_vec2_scale(tie->rate_m_s, 1e3 * car->model->engine_mount_damping_kn_s_m);
    cp_vec2 pull_n = body_direction(engine, cp_vec2_scale(elastic_m, stiffness_n_m));
    push_apart(engine, car->body[tie->member], cp_vec2_add(pull_n, tie->damping_n), point_m);
}

// ODE puts a hinge's force on each body at that body's own anchor. The anchors drift apart by some
// micrometres between its corrections, and that lever times the force would be angular momentum
// from nowhere. It is given back to the two bodies as a common turn.
static void mend_hinge(cp_car *car, int side, double time_step_s)
{
    const dJointFeedback *feedback = &car->hinge_feedback[side];
    cp_vec2 force_n = {feedback->f1[0], feedback->f1[1]};
    double couple_nm = cp_vec2_cross(car->hinge_gap_m[side], force_n);
    int cross = CP_BODY_CROSS_MEMBER_LEFT + side, box = CP_BODY_CRASH_BOX_LEFT + side;
    double turn_rad_s =
        couple_nm * time_step_s / (car->inertia_kg_m2[cross] + car->inertia_kg_m2[box]);
    const dReal *w_cross = dBodyGetAngularVel(car->body[cross]);
    dBodySetAngularVel(car->body[cross], 0.0, 0.0, w_cross[2] - turn_rad_s);
    const dReal *w_box = dBodyGetAngularVel(car->body[box]);
    dBodySetAngularVel(car->body[box], 0.0, 0.0, w_box[2] - turn_rad_s);
}

static cp_vec2 hinge_gap(dJointID hinge)
{
    dVector3 one, other;
    dJointGetBallAnchor(hinge, one);
    dJointGetBallAnchor2(hinge, other);
    return (cp_vec2){one[0] - other[0], one[1] - other[1]};
}

// How far a block's face can go before what is left of it moves on as a whole; a rest stays.
static double usable_length(const cp_car *car, int block)
{
    const double rest_m = 0.02;
    const cp_crush_law *law = &car->block[block].law;
    double length_m = 2.0 * car->outline[CP_OUTLINE_BLOCKS + block].half_length_m - rest_m;
    return fmax(0.0, fmin(length_m, law->s_m[law->points - 1]));
}

static double block_intrusion(const cp_car *car, int block)
{
    return fmax(0.0, car->block[block].s_m - usable_length(car, block));
}

void cp_car_apply_forces(cp_car *car)
{
    if (car->model->is_barrier)
        return;
    for (int k = 0; k < CP_HINGE_COUNT; k++)
        car->hinge_gap_m[k] = hinge_gap(car->hinge[k]);
    car->elastic_j = 0.0;
    for (int k = 0; k < CP_AXIAL_COUNT; k++)
        apply_axial(car, &car->axial[k]);
    for (int k = 0; k < CP_BENDING_COUNT; k++)
        apply_bending(car, &car->bending[k]);
    for (int k = 0; k < CP_TIE_COUNT; k++)
        apply_tie(car, &car->tie[k]);
}

void cp_car_after_step(cp_car *car, double time_step_s)
{
    if (car->model->is_barrier)
        return;
    for (int k = 0; k < CP_HINGE_COUNT; k++)
        mend_hinge(car, k, time_step_s);

    // Work over the step: the force times the mean of the rates before and after.
    double compression_m[CP_AXIAL_COUNT];
    for (int k = 0; k < CP_AXIAL_COUNT; k++) {
        cp_axial_element *element = &car->axial[k];
        axial_view after = view_axial(car, element);
        double rate_m_s = 0.5 * (element->rate_m_s + after.rate_m_s);
        element->rate_j += element->rate_n * rate_m_s * time_step_s;
        compression_m[k] = after.s_m;
    }
    for (int k = 0; k < CP_TIE_COUNT; k++) {
        const cp_tie_element *tie = &car->tie[k];
        cp_vec2 point_m = body_point(car->body[CP_BODY_ENGINE], tie->engine_point_m);
        cp_vec2 rate = cp_vec2_scale(cp_vec2_add(tie->rate_m_s, tie_rate(car, tie, point_m)), 0.5);
        car->mount_damping_j += cp_vec2_dot(tie->damping_n, rate) * time_step_s;
    }

    // Shortening of each side: longitudinal and crash box together.
    for (int side = 0; side < 2; side++)
        car->crush_m = fmax(car->crush_m, compression_m[side] + compression_m[2 + side]);
    car->intrusion_m = fmax(car->intrusion_m, car->block[CP_BLOCK_CELL].s_m);
    for (int k = 0; k < car->front_block_count; k++)
        car->intrusion_m = fmax(car->intrusion_m, block_intrusion(car, k));
    car->block[CP_BLOCK_CELL].s_m = car->intrusion_m;
}

// ---- views -----------------------------------------------------------------------------------

cp_outline cp_car_outline_now(const cp_car *car, int index)
{
    const cp_car_outline *outline = &car->outline[index];
    dBodyID body = car->body[outline->body];
    cp_vec2 centre_m = outline->centre_m;
    double half_length_m = outline->half_length_m;

    // A block's face has been pushed in; its rear stays until it is used up, then what is left of
    // it goes on into the passenger cell, whose front is pushed back as far.
    if (index >= CP_OUTLINE_BLOCKS) {
        const cp_crush_block *block = &car->block[outline->block];
        half_length_m -= 0.5 * fmin(block->s_m, usable_length(car, outline->block));
        double moved_m = outline->half_length_m - block->s_m - half_length_m;
        cp_vec2 left = {-outline->along.y, outline->along.x};
        centre_m = cp_vec2_add(centre_m, cp_vec2_add(cp_vec2_scale(outline->along, moved_m),
                                                     cp_vec2_scale(left, block->side_m)));
    } else if (index == CP_OUTLINE_BODY) {
        half_length_m -= 0.5 * fmin(car->intrusion_m, half_length_m);
        centre_m.x -= outline->half_length_m - half_length_m;
    }
    return (cp_outline){.centre_m = body_point(body, centre_m),
                        .along = body_direction(body, outline->along),
                        .half_length_m = half_length_m,
                        .half_width_m = outline->half_width_m,
                        .radius_m = fmin(outline->radius_m, half_length_m)};
}

cp_body_state cp_car_cog_state(const cp_car *car)
{
    dBodyID root = car->body[CP_BODY_ROOT];
    cp_vec2 cog_m = body_point(root, car->cog_m);
    return (cp_body_state){.cog_m = cog_m,
                           .yaw_rad = cp_body_pose(root).yaw_rad,
                           .velocity_m_s = cp_body_velocity_at(root, cog_m),
                           .yaw_rate_rad_s = dBodyGetAngularVel(root)[2]};
}

double cp_car_kinetic_energy(const cp_car *car)
{
    double energy_j = 0.0;
    for (int k = 0; k < car->body_count; k++) {
        const dReal *v = dBodyGetLinearVel(car->body[k]);
        double w = dBodyGetAngularVel(car->body[k])[2];
        energy_j += 0.5 * car->mass_kg[k] * (v[0] * v[0] + v[1] * v[1]) +
                    0.5 * car->inertia_kg_m2[k] * w * w;
    }
    return energy_j;
}

double cp_car_elastic_energy(const cp_car *car)
{
    double energy_j = 0.0;
    if (car->model->is_barrier)
        return energy_j;
    for (int k = 0; k < CP_AXIAL_COUNT; k++)
        energy_j += cp_crush_elastic_energy(&car->axial[k].law, &car->axial[k].state,
                                            view_axial(car, &car->axial[k]).s_m);
    for (int k = 0; k < CP_BENDING_COUNT; k++)
        energy_j += cp_bending_elastic_energy(&car->bending[k].law, &car->bending[k].state,
                                              bending_rotation(car, &car->bending[k]));
    for (int k = 0; k < CP_TIE_COUNT; k++) {
        cp_vec2 elastic_m = cp_vec2_sub(tie_displacement(car, &car->tie[k]), car->tie[k].plastic_m);
        energy_j += 0.5e3 * car->model->engine_mount_kn_m * cp_vec2_dot(elastic_m, elastic_m);
    }
    return energy_j;
}

cp_car_absorbed cp_car_energy_absorbed(const cp_car *car)
{
    cp_car_absorbed absorbed = {.engine_j = car->mount_damping_j};
    for (int side = 0; side < 2 && !car->model->is_barrier; side++) {
        const cp_axial_element *rail = &car->axial[side], *box = &car->axial[2 + side],
                               *bay = &car->axial[4 + side];
        absorbed.longitudinal_j += cp_crush_plastic_energy(&rail->law, &rail->state);
        absorbed.crash_box_j += cp_crush_plastic_energy(&box->law, &box->state);
        absorbed.engine_j += cp_crush_plastic_energy(&bay->law, &bay->state);
        absorbed.engine_j += car->tie[side].plastic_j;
        absorbed.rate_j += rail->rate_j + box->rate_j;
    }
    for (int k = 0; k < CP_BENDING_COUNT; k++) // of a barrier 0
        absorbed.bending_j += car->bending[k].state.plastic_j;
    absorbed.corner_j += car->block[CP_BLOCK_CELL].plastic_j;
    for (int k = 0; k < car->block_count; k++) {
        int part = cp_car_part_of_block(car, k);
        *(part < 2   ? &absorbed.corner_j
          : part < 4 ? &absorbed.upper_j
                     : &absorbed.struck_j) += car->block[k].plastic_j;
        absorbed.rate_j += car->block[k].rate_j;
    }
    return absorbed;
}

double cp_car_block_energy(const cp_car *car)
{
    double energy_j = car->block[CP_BLOCK_CELL].plastic_j;
    for (int k = 0; k < car->block_count; k++)
        energy_j += car->block[k].plastic_j + car->block[k].rate_j;
    return energy_j;
}

cp_vec2 cp_car_momentum(const cp_car *car, double *angular_kg_m2_s)
{
    cp_vec2 linear = {0.0, 0.0};
    *angular_kg_m2_s = 0.0;
    for (int k = 0; k < car->body_count; k++) {
        const dReal *p = dBodyGetPosition(car->body[k]), *v = dBodyGetLinearVel(car->body[k]);
        cp_vec2 momentum = cp_vec2_scale((cp_vec2){v[0], v[1]}, car->mass_kg[k]);
        linear = cp_vec2_add(linear, momentum);
        *angular_kg_m2_s += cp_vec2_cross((cp_vec2){p[0], p[1]}, momentum) +
                            car->inertia_kg_m2[k] * dBodyGetAngularVel(car->body[k])[2];
    }
    return linear;
}
