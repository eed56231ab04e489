/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact/confirmation.h"

#include "impact/approach.h"

cp_rectangle cp_touching_body_later(const cp_touching_body *body, double time_s)
{
    // The front moves along an arc: its chord is turned by half the angle and shorter than the arc.
    double half_turn_rad = 0.5 * body->yaw_rate_rad_s * time_s;
    double chord_1 = half_turn_rad == 0.0 ? 1.0 : sin(half_turn_rad) / half_turn_rad;
    cp_vec2 chord_m =
        cp_vec2_rotate(cp_vec2_scale(body->front_velocity_m_s, time_s * chord_1), half_turn_rad);

    // The centre hangs half a length behind the front.
    cp_rectangle later = body->rectangle;
    cp_vec2 half_m = {0.5 * later.length_m, 0.0};
    cp_vec2 front_m = cp_vec2_add(later.centre_m, cp_vec2_rotate(half_m, later.yaw_rad));
    later.yaw_rad += 2.0 * half_turn_rad;
    later.centre_m =
        cp_vec2_sub(cp_vec2_add(front_m, chord_m), cp_vec2_rotate(half_m, later.yaw_rad));
    return later;
}

static void bodies_later(const void *context, double time_s, cp_rectangle rectangle[2])
{
    const cp_touching_body *body = context;
    for (int k = 0; k < 2; k++)
        rectangle[k] = cp_touching_body_later(&body[k], time_s);
}

// How long they go on. Slower than what goes deep straight on in the time is no crash at any angle.
static double duration_of(double speed_m_s)
{
    if (speed_m_s < CP_CONFIRMATION_DEPTH_M / CP_CONFIRMATION_TIME_S)
        return CP_CONFIRMATION_TIME_S;
    return fmax(CP_CONFIRMATION_TIME_S, CP_CONFIRMATION_PATH_M / speed_m_s);
}

bool cp_contact_goes_deep(const cp_touching_body body[2])
{
    // The relative speed of now, and what turning the velocities can add to it.
    double speed_m_s =
        cp_vec2_length(cp_vec2_sub(body[0].front_velocity_m_s, body[1].front_velocity_m_s));
    double duration_s = duration_of(speed_m_s);
    for (int k = 0; k < 2; k++)
        speed_m_s +=
            fabs(body[k].yaw_rate_rad_s) * duration_s * cp_vec2_length(body[k].front_velocity_m_s);
    cp_rectangle rectangle[2] = {body[0].rectangle, body[1].rectangle};
    double yaw_rate_rad_s[2] = {body[0].yaw_rate_rad_s, body[1].yaw_rate_rad_s};
    cp_approach approach = {.rectangles_at = bodies_later,
                            .context = body,
                            .duration_s = duration_s,
                            .rate_m_s =
                                cp_approach_rate(rectangle, speed_m_s, yaw_rate_rad_s, duration_s)};
    double time_s;
    return cp_approach_reaches(&approach, -CP_CONFIRMATION_DEPTH_M, &time_s);
}

double cp_width_in_way_m(const cp_rectangle *moving, const cp_rectangle *other)
{
    cp_vec2 corners_m[4];
    cp_rectangle_corners(other, corners_m);
    double low_m = INFINITY, high_m = -INFINITY;
    for (int k = 0; k < 4; k++) {
        double y_m = cp_pose_to_local((cp_pose){moving->centre_m, moving->yaw_rad}, corners_m[k]).y;
        low_m = fmin(low_m, y_m);
        high_m = fmax(high_m, y_m);
    }
    double half_m = 0.5 * moving->width_m;
    return fmin(high_m, half_m) - fmax(low_m, -half_m);
}

double cp_front_edges_overlap_m(const cp_touching_body body[2])
{
    cp_vec2 relative_m_s = cp_vec2_sub(body[1].front_velocity_m_s, body[0].front_velocity_m_s);
    double speed_m_s = cp_vec2_length(relative_m_s);
    if (!(speed_m_s > 0.0))
        return -INFINITY;
    cp_vec2 across = {-relative_m_s.y / speed_m_s, relative_m_s.x / speed_m_s};
    double low_m[2], high_m[2];
    for (int k = 0; k < 2; k++) {
        cp_pose pose = {body[k].rectangle.centre_m, body[k].rectangle.yaw_rad};
        double half_m = 0.5 * body[k].rectangle.width_m, front_m = 0.5 * body[k].rectangle.length_m;
        double left_m = cp_vec2_dot(cp_pose_to_world(pose, (cp_vec2){front_m, half_m}), across);
        double right_m = cp_vec2_dot(cp_pose_to_world(pose, (cp_vec2){front_m, -half_m}), across);
        low_m[k] = fmin(left_m, right_m);
        high_m[k] = fmax(left_m, right_m);
    }
    return fmin(high_m[0], high_m[1]) - fmax(low_m[0], low_m[1]);
}

bool cp_contact_is_crash(const cp_touching_body body[2], const cp_first_touch *touch)
{
    bool front_on_front = touch->side[0] == CP_SIDE_FRONT && touch->side[1] == CP_SIDE_FRONT;
    double speed_m_s =
        cp_vec2_length(cp_vec2_sub(body[0].front_velocity_m_s, body[1].front_velocity_m_s));
    double narrower_m = fmin(body[0].rectangle.width_m, body[1].rectangle.width_m);
    if (front_on_front && speed_m_s >= CP_CONFIRMATION_DEPTH_M / CP_CONFIRMATION_TIME_S &&
        cp_front_edges_overlap_m(body) >= CP_CONFIRMATION_OVERLAP_1 * narrower_m)
        return true;
    return cp_contact_goes_deep(body);
}

cp_touching_body cp_touching_body_possible(const cp_touching_body *body)
{
    cp_touching_body possible = *body;
    cp_vec2 heading = cp_vec2_heading(body->rectangle.yaw_rad);
    possible.front_velocity_m_s =
        cp_vec2_scale(heading, cp_vec2_dot(heading, body->front_velocity_m_s));
    possible.yaw_rate_rad_s = 0.0;
    return possible;
}

bool cp_motion_is_impossible(const cp_touching_body *body)
{
    const double slip_tangent = 0.364, slip_m_s = 1.5; // 20 degrees
    cp_vec2 front_m_s = cp_vec2_rotate(body->front_velocity_m_s, -body->rectangle.yaw_rad);
    double length_m = body->rectangle.length_m;
    double sideways_m_s = fabs(front_m_s.y - 0.5 * body->yaw_rate_rad_s * length_m);
    bool slides = sideways_m_s > fmax(slip_m_s, slip_tangent * fabs(front_m_s.x));

    // A standing car whose heading creeps by rounding turns about nothing.
    double speed_m_s = cp_vec2_length(body->front_velocity_m_s);
    bool turns =
        fabs(body->yaw_rate_rad_s) > 0.1 && fabs(body->yaw_rate_rad_s) * 0.5 * length_m > speed_m_s;
    return slides || turns;
}
