/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/crash_configuration.h"

#include "core/units.h"
#include "crash/barrier.h"

#include <string.h>

const char *cp_contact_side_text(cp_contact_side side)
{
    static const char *const TEXT[] = {"front", "left", "right", "rear"};
    return TEXT[side];
}

const char *cp_crash_type_text(cp_contact_side a, cp_contact_side b)
{
    // front before side before rear, whoever is a.
    static const int RANK[] = {0, 1, 1, 2};
    static const char *const TEXT[3][3] = {{"front-front", "front-side", "front-rear"},
                                           {"front-side", "side-side", "side-rear"},
                                           {"front-rear", "side-rear", "rear-rear"}};
    return TEXT[RANK[a]][RANK[b]];
}

static cp_outline car_outline(const cp_vehicle_model *model, const cp_body_state *state)
{
    cp_vec2 along = cp_vec2_heading(state->yaw_rad);
    double forward_m = model->cg_to_front_m - 0.5 * model->length_m;
    return (cp_outline){.centre_m = cp_vec2_add(state->cog_m, cp_vec2_scale(along, forward_m)),
                        .along = along,
                        .half_length_m = 0.5 * model->length_m,
                        .half_width_m = 0.5 * model->width_m,
                        .radius_m = 0.0};
}

static cp_vec2 front_middle(const cp_vehicle_model *model, const cp_body_state *state)
{
    return cp_vec2_add(state->cog_m,
                       cp_vec2_scale(cp_vec2_heading(state->yaw_rad), model->cg_to_front_m));
}

// Opponent's outline when the middle of its front (or face) is at (x, y) in a's plane.
static cp_outline opponent_outline(const cp_vehicle_model *model_b, const cp_barrier *barrier,
                                   double x_m, double y_m, double angle_rad)
{
    if (model_b == NULL)
        return cp_barrier_outline(barrier, (cp_pose){{x_m, y_m}, angle_rad});
    double yaw_rad = cp_wrap_angle(angle_rad + CP_PI);
    cp_vec2 back = cp_vec2_scale(cp_vec2_heading(yaw_rad), -model_b->cg_to_front_m);
    cp_body_state state = {.cog_m = cp_vec2_add((cp_vec2){x_m, y_m}, back), .yaw_rad = yaw_rad};
    return car_outline(model_b, &state);
}

// x of the opponent's front middle at which it first touches a, coming from far ahead; false when
// it passes by.
static bool find_touch(const cp_outline *a, const cp_vehicle_model *model_b,
                       const cp_barrier *barrier, double y_m, double angle_rad, double *x_m)
{
    // Step towards a by the distance left; a translation by it cannot overshoot.
    double x = 40.0;
    for (int k = 0; k < 100000 && x > -40.0; k++) {
        cp_outline b = opponent_outline(model_b, barrier, x, y_m, angle_rad);
        double distance_m = cp_outline_distance(a, &b);
        if (distance_m <= 1e-10) {
            *x_m = x;
            return true;
        }
        x -= fmax(distance_m, 1e-10);
    }
    return false;
}

// A vector in the frame of an outline.
static cp_vec2 to_outline(const cp_outline *outline, cp_vec2 vector)
{
    return (cp_vec2){cp_vec2_dot(outline->along, vector), cp_vec2_cross(outline->along, vector)};
}

// Struck side of an outline: the face that holds the point; at a corner the one more opposed to
// the other body's relative velocity.
static cp_contact_side struck_side(const cp_outline *outline, cp_vec2 point_m,
                                   cp_vec2 velocity_of_other_m_s)
{
    cp_vec2 local = to_outline(outline, cp_vec2_sub(point_m, outline->centre_m));
    cp_vec2 velocity = to_outline(outline, velocity_of_other_m_s);
    double gap_m[4] = {outline->half_length_m - local.x, outline->half_width_m - local.y,
                       outline->half_width_m + local.y, outline->half_length_m + local.x};
    double opposed[4] = {-velocity.x, -velocity.y, velocity.y, velocity.x};
    double nearest_m = fmin(fmin(gap_m[0], gap_m[1]), fmin(gap_m[2], gap_m[3]));
    int best = -1;
    for (int side = 0; side < 4; side++)
        if (gap_m[side] <= nearest_m + 1e-6 && (best < 0 || opposed[side] > opposed[best]))
            best = side;
    return (cp_contact_side)best;
}

static cp_outline outline_of_b(const cp_vehicle_model *model_b,
                               const cp_crash_configuration *configuration)
{
    return configuration->against_barrier
               ? cp_barrier_outline(&configuration->barrier, configuration->barrier_pose)
               : car_outline(model_b, &configuration->vehicle[1]);
}

double cp_crash_contact_gap(const cp_vehicle_model *model_a, const cp_vehicle_model *model_b,
                            const cp_crash_configuration *configuration)
{
    cp_outline a = car_outline(model_a, &configuration->vehicle[0]);
    cp_outline b = outline_of_b(model_b, configuration);
    return cp_outline_distance(&a, &b);
}

cp_vec2 cp_crash_contact_point(const cp_vehicle_model *model_a, const cp_vehicle_model *model_b,
                               const cp_crash_configuration *configuration)
{
    cp_outline a = car_outline(model_a, &configuration->vehicle[0]);
    cp_outline b = outline_of_b(model_b, configuration);
    cp_manifold touch = cp_outline_contact(&a, &b, 1e-6);
    if (touch.count == 2)
        return cp_vec2_scale(cp_vec2_add(touch.point[0].position_m, touch.point[1].position_m),
                             0.5);
    return touch.count == 1 ? touch.point[0].position_m
                            : front_middle(model_a, &configuration->vehicle[0]);
}

cp_status cp_crash_configuration_from_description(
    const cp_vehicle_model *model_a, const cp_vehicle_model *model_b, const cp_barrier *barrier,
    double speed_a_m_s, double speed_b_m_s, double lateral_offset_m, double angle_rad,
    cp_crash_configuration *configuration, cp_error *error)
{
    *configuration =
        (cp_crash_configuration){.against_barrier = model_b == NULL,
                                 .barrier = barrier != NULL ? *barrier : model_a->barrier};
    cp_status status = cp_barrier_validate(&configuration->barrier, error);
    if (status != CP_OK)
        return status;
    cp_body_state *a = &configuration->vehicle[0], *b = &configuration->vehicle[1];
    a->velocity_m_s.x = speed_a_m_s;

    // Slide the opponent towards a until they touch; the barrier turns about its pivot.
    double y_m = lateral_offset_m;
    if (model_b == NULL)
        y_m += configuration->barrier.pivot_m * sin(angle_rad);
    cp_outline outline_a = car_outline(model_a, a);
    double x_m = 0.0;
    if (!find_touch(&outline_a, model_b, &configuration->barrier, y_m, angle_rad, &x_m))
        return cp_fail(error, CP_BAD_INPUT,
                       "offset %g mm with angle %g deg: car and opponent miss each other",
                       1e3 * lateral_offset_m, cp_deg_from_rad(angle_rad));
    if (model_b == NULL) {
        configuration->barrier_pose = (cp_pose){{x_m, y_m}, angle_rad};
        configuration->side[0] = CP_SIDE_FRONT;
        return CP_OK;
    }

    // Car b heads the other way; the sides come from the first contact point.
    b->yaw_rad = cp_wrap_angle(angle_rad + CP_PI);
    cp_vec2 heading = cp_vec2_heading(b->yaw_rad);
    b->cog_m = cp_vec2_sub((cp_vec2){x_m, y_m}, cp_vec2_scale(heading, model_b->cg_to_front_m));
    b->velocity_m_s = cp_vec2_scale(heading, speed_b_m_s);
    cp_outline outline_b = car_outline(model_b, b);
    cp_vec2 point_m = cp_crash_contact_point(model_a, model_b, configuration);
    cp_vec2 approach = cp_vec2_sub(b->velocity_m_s, a->velocity_m_s);
    configuration->side[0] = struck_side(&outline_a, point_m, approach);
    configuration->side[1] = struck_side(&outline_b, point_m, cp_vec2_scale(approach, -1.0));
    return CP_OK;
}

cp_status cp_crash_configuration_struck(const cp_vehicle_model *model_a,
                                        const cp_vehicle_model *model_b, cp_contact_side side,
                                        double at_m, double angle_rad, double speed_a_m_s,
                                        double speed_b_m_s, cp_crash_configuration *configuration,
                                        cp_error *error)
{
    if (side == CP_SIDE_FRONT)
        return cp_fail(error, CP_BAD_INPUT, "a struck side must be left, right or rear");
    *configuration = (cp_crash_configuration){.side = {side, CP_SIDE_FRONT}};
    cp_body_state *a = &configuration->vehicle[0], *b = &configuration->vehicle[1];
    a->velocity_m_s.x = speed_a_m_s;

    // Where the middle of b's front would lie on a, and where b heads to.
    double half_m = 0.5 * model_a->width_m, inwards_rad = side == CP_SIDE_LEFT    ? -0.5 * CP_PI
                                                          : side == CP_SIDE_RIGHT ? 0.5 * CP_PI
                                                                                  : 0.0;
    cp_vec2 aim_m = side == CP_SIDE_REAR
                        ? (cp_vec2){model_a->cg_to_front_m - model_a->length_m, at_m}
                        : (cp_vec2){at_m, side == CP_SIDE_LEFT ? half_m : -half_m};
    b->yaw_rad = cp_wrap_angle(inwards_rad + angle_rad);
    cp_vec2 heading = cp_vec2_heading(b->yaw_rad);
    b->velocity_m_s = cp_vec2_scale(heading, speed_b_m_s);

    // From well behind onwards by the distance left; that cannot overshoot.
    cp_outline outline_a = car_outline(model_a, a);
    double way_m = -20.0;
    for (int k = 0; k < 100000 && way_m < 20.0; k++) {
        b->cog_m = cp_vec2_add(aim_m, cp_vec2_scale(heading, way_m - model_b->cg_to_front_m));
        cp_outline outline_b = car_outline(model_b, b);
        double distance_m = cp_outline_distance(&outline_a, &outline_b);
        if (distance_m <= 1e-10)
            return CP_OK;
        way_m += fmax(distance_m, 1e-10);
    }
    return cp_fail(error, CP_BAD_INPUT,
                   "struck at %g mm with angle %g deg: the two miss each other", 1e3 * at_m,
                   cp_deg_from_rad(angle_rad));
}

// Share of a's width that the opponent's outline covers, projected on a's y axis.
static double overlap_share(const cp_outline *a, const cp_outline *b)
{
    cp_vec2 centre = to_outline(a, cp_vec2_sub(b->centre_m, a->centre_m));
    cp_vec2 turned = to_outline(a, b->along);
    double reach_m = fabs(turned.y) * b->half_length_m + fabs(turned.x) * b->half_width_m;
    double low_m = fmax(-a->half_width_m, centre.y - reach_m);
    double high_m = fmin(a->half_width_m, centre.y + reach_m);
    return fmax(0.0, high_m - low_m) / (2.0 * a->half_width_m);
}

// The same of b's front edge alone: what of a's front it meets, not what its flank hides.
static double front_overlap_share(const cp_outline *a, cp_vec2 front_m, const cp_outline *b)
{
    double middle_m = to_outline(a, cp_vec2_sub(front_m, a->centre_m)).y;
    double reach_m = fabs(to_outline(a, b->along).x) * b->half_width_m;
    double low_m = fmax(-a->half_width_m, middle_m - reach_m);
    double high_m = fmin(a->half_width_m, middle_m + reach_m);
    return fmax(0.0, high_m - low_m) / (2.0 * a->half_width_m);
}

// Angle of a relative velocity against the own x axis, 0 = straight ahead.
static double velocity_angle(cp_vec2 relative_m_s, double yaw_rad)
{
    if (cp_vec2_length(relative_m_s) <= 0.0)
        return 0.0;
    cp_vec2 local = cp_vec2_rotate(relative_m_s, -yaw_rad);
    return atan2(local.y, local.x);
}

cp_crash_description cp_crash_describe(const cp_vehicle_model *model_a,
                                       const cp_vehicle_model *model_b,
                                       const cp_crash_configuration *configuration,
                                       cp_vec2 contact_m)
{
    const cp_body_state *a = &configuration->vehicle[0], *b = &configuration->vehicle[1];
    cp_crash_description description = {0};
    description.speed_m_s[0] = cp_vec2_dot(a->velocity_m_s, cp_vec2_heading(a->yaw_rad));
    cp_vec2 point_velocity =
        cp_point_velocity(a->velocity_m_s, a->yaw_rate_rad_s, cp_vec2_sub(contact_m, a->cog_m));
    cp_pose frame = {a->cog_m, a->yaw_rad};
    cp_outline outline_a = car_outline(model_a, a);

    if (configuration->against_barrier) {
        description.angle_rad = cp_wrap_angle(configuration->barrier_pose.yaw_rad - a->yaw_rad);
        cp_vec2 face = cp_pose_to_local(frame, configuration->barrier_pose.position_m);
        description.lateral_offset_m =
            face.y - configuration->barrier.pivot_m * sin(description.angle_rad);
        description.closing_speed_m_s = cp_vec2_length(point_velocity);
        description.velocity_angle_rad[0] = velocity_angle(point_velocity, a->yaw_rad);
        cp_outline outline_b =
            cp_barrier_outline(&configuration->barrier, configuration->barrier_pose);
        description.overlap_1 = overlap_share(&outline_a, &outline_b);
        return description;
    }

    description.speed_m_s[1] = cp_vec2_dot(b->velocity_m_s, cp_vec2_heading(b->yaw_rad));
    description.angle_rad = cp_wrap_angle(b->yaw_rad - a->yaw_rad - CP_PI);
    description.lateral_offset_m = cp_pose_to_local(frame, front_middle(model_b, b)).y;
    cp_vec2 relative =
        cp_vec2_sub(point_velocity, cp_point_velocity(b->velocity_m_s, b->yaw_rate_rad_s,
                                                      cp_vec2_sub(contact_m, b->cog_m)));
    description.closing_speed_m_s = cp_vec2_length(relative);
    description.velocity_angle_rad[0] = velocity_angle(relative, a->yaw_rad);
    description.velocity_angle_rad[1] = velocity_angle(cp_vec2_scale(relative, -1.0), b->yaw_rad);
    cp_outline outline_b = car_outline(model_b, b);
    description.overlap_1 =
        configuration->side[0] != CP_SIDE_FRONT ? (double)NAN
        : configuration->side[1] == CP_SIDE_FRONT
            ? front_overlap_share(&outline_a, front_middle(model_b, b), &outline_b)
            : overlap_share(&outline_a, &outline_b);
    return description;
}
