/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/ttc.h"

#include "core/units.h"
#include "traffic/vehicle_rectangle.h"

bool cp_turns_too_fast(const cp_vehicle_motion *motion)
{
    return fabs(motion->yaw_rate_rad_s * motion->after.speed_m_s) > CP_G0_M_S2;
}

cp_moving_rectangle cp_moving_rectangle_of(const cp_vehicle_motion *motion)
{
    const cp_vehicle_state *state = &motion->after;
    cp_vec2 heading = cp_vec2_heading(state->yaw_rad);
    cp_moving_rectangle moving = {
        .rectangle = cp_vehicle_rectangle(state),
        .velocity_m_s = cp_vec2_scale(heading, state->speed_m_s),
        .yaw_rate_rad_s = motion->yaw_rate_rad_s,
    };
    if (cp_turns_too_fast(motion))
        moving.yaw_rate_rad_s = 0.0;
    return moving;
}

cp_moving_rectangle cp_moving_rectangle_inside(const cp_vehicle_motion *motion, double fraction)
{
    if (fraction >= 1.0)
        return cp_moving_rectangle_of(motion);
    const cp_vehicle_state *before = &motion->before, *after = &motion->after;
    cp_vehicle_motion inside = *motion;
    double gain_m_s = after->speed_m_s - before->speed_m_s;
    double mean_m_s = before->speed_m_s + 0.5 * gain_m_s;
    double share_1 = fraction;
    if (mean_m_s > 1e-9)
        share_1 = fraction * (before->speed_m_s + 0.5 * gain_m_s * fraction) / mean_m_s;
    double turn_rad = cp_wrap_angle(after->yaw_rad - before->yaw_rad);
    inside.after.front_x_m = before->front_x_m + share_1 * (after->front_x_m - before->front_x_m);
    inside.after.front_y_m = before->front_y_m + share_1 * (after->front_y_m - before->front_y_m);
    inside.after.yaw_rad = before->yaw_rad + fraction * turn_rad;
    inside.after.speed_m_s = before->speed_m_s + fraction * gain_m_s;
    return cp_moving_rectangle_of(&inside);
}

cp_rectangle cp_moving_rectangle_at(const cp_moving_rectangle *moving, double time_s)
{
    // Chord of the arc: half the turn away from the tangent, shorter by sin(x)/x.
    double half_turn_rad = 0.5 * moving->yaw_rate_rad_s * time_s;
    double shortening = fabs(half_turn_rad) < 1e-8 ? 1.0 : sin(half_turn_rad) / half_turn_rad;
    cp_vec2 chord_m =
        cp_vec2_scale(cp_vec2_rotate(moving->velocity_m_s, half_turn_rad), time_s * shortening);
    cp_rectangle there = moving->rectangle;
    there.centre_m = cp_vec2_add(there.centre_m, chord_m);
    there.yaw_rad += 2.0 * half_turn_rad;
    return there;
}

// Half the extent of a rectangle along a unit vector.
static double half_extent_m(const cp_rectangle *rectangle, cp_vec2 axis)
{
    cp_vec2 along = cp_vec2_heading(rectangle->yaw_rad);
    return 0.5 * (rectangle->length_m * fabs(cp_vec2_dot(along, axis)) +
                  rectangle->width_m * fabs(cp_vec2_cross(along, axis)));
}

// Both move straight: on each of the four face normals they overlap during an interval of time; the
// rectangles overlap while all four do (separating axes).
static double straight_ttc_s(const cp_moving_rectangle *a, const cp_moving_rectangle *b,
                             double horizon_s)
{
    cp_vec2 apart_m = cp_vec2_sub(b->rectangle.centre_m, a->rectangle.centre_m);
    cp_vec2 relative_m_s = cp_vec2_sub(b->velocity_m_s, a->velocity_m_s);
    double first_s = 0.0, last_s = horizon_s;
    for (int k = 0; k < 4; k++) {
        cp_vec2 axis = cp_vec2_heading(k < 2 ? a->rectangle.yaw_rad : b->rectangle.yaw_rad);
        if (k % 2)
            axis = (cp_vec2){-axis.y, axis.x};
        double reach_m = half_extent_m(&a->rectangle, axis) + half_extent_m(&b->rectangle, axis);
        double gap_m = cp_vec2_dot(apart_m, axis), speed_m_s = cp_vec2_dot(relative_m_s, axis);
        if (fabs(speed_m_s) < 1e-12) {
            if (fabs(gap_m) >= reach_m)
                return INFINITY;
            continue;
        }
        double one_s = (-reach_m - gap_m) / speed_m_s, other_s = (reach_m - gap_m) / speed_m_s;
        first_s = fmax(first_s, fmin(one_s, other_s));
        last_s = fmin(last_s, fmax(one_s, other_s));
    }
    return first_s < last_s ? first_s : INFINITY;
}

// Conservative advancement: no point of one body nears the other faster than the relative speed of
// the centres, which itself changes at most by their centripetal accelerations, plus what the spins
// add at the corners. So the gap cannot close before speed*h + acceleration*h^2/2 reaches it.
static double turning_ttc_s(const cp_moving_rectangle *a, const cp_moving_rectangle *b,
                            double horizon_s)
{
    const double contact_m = 1e-3;
    double spin_m_s = fabs(a->yaw_rate_rad_s) * cp_rectangle_half_diagonal_m(&a->rectangle) +
                      fabs(b->yaw_rate_rad_s) * cp_rectangle_half_diagonal_m(&b->rectangle);
    double acceleration_m_s2 = fabs(a->yaw_rate_rad_s) * cp_vec2_length(a->velocity_m_s) +
                               fabs(b->yaw_rate_rad_s) * cp_vec2_length(b->velocity_m_s);
    double time_s = 0.0;
    while (time_s <= horizon_s) {
        cp_rectangle there_a = cp_moving_rectangle_at(a, time_s);
        cp_rectangle there_b = cp_moving_rectangle_at(b, time_s);
        double gap_m = cp_rectangle_separation(&there_a, &there_b);
        if (gap_m <= contact_m)
            return time_s;
        cp_vec2 velocity_a_m_s = cp_vec2_rotate(a->velocity_m_s, a->yaw_rate_rad_s * time_s);
        cp_vec2 velocity_b_m_s = cp_vec2_rotate(b->velocity_m_s, b->yaw_rate_rad_s * time_s);
        double speed_m_s = cp_vec2_length(cp_vec2_sub(velocity_b_m_s, velocity_a_m_s)) + spin_m_s;
        double root_m_s = sqrt(speed_m_s * speed_m_s + 2.0 * acceleration_m_s2 * gap_m);
        if (!(speed_m_s + root_m_s > 0.0))
            return INFINITY; // nothing moves
        time_s += 2.0 * gap_m / (speed_m_s + root_m_s);
    }
    return INFINITY;
}

double cp_ttc_s(const cp_moving_rectangle *a, const cp_moving_rectangle *b, double horizon_s)
{
    // Most pairs are too far apart to meet at all.
    double distance_m = cp_vec2_length(cp_vec2_sub(b->rectangle.centre_m, a->rectangle.centre_m));
    double speed_m_s = cp_vec2_length(a->velocity_m_s) + cp_vec2_length(b->velocity_m_s);
    double reach_m =
        cp_rectangle_half_diagonal_m(&a->rectangle) + cp_rectangle_half_diagonal_m(&b->rectangle);
    if (distance_m > reach_m + speed_m_s * horizon_s)
        return INFINITY;
    if (a->yaw_rate_rad_s == 0.0 && b->yaw_rate_rad_s == 0.0)
        return straight_ttc_s(a, b, horizon_s);
    return turning_ttc_s(a, b, horizon_s);
}
