/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact/footprint.h"

static cp_vec2 chord_of(const cp_vehicle_motion *motion)
{
    return (cp_vec2){motion->after.front_x_m - motion->before.front_x_m,
                     motion->after.front_y_m - motion->before.front_y_m};
}

/* How a vehicle moves along its chord: share of the chord covered, its rate per fraction of the
 * step, and the speed. */
typedef struct progress {
    double share_1;
    double rate_1;
    double speed_m_s;
} progress;

// A vehicle that brakes to rest inside the step: its chord is shorter than half its first speed
// would make it. From v0^2 = 2 a d it stands after 2 d / v0.
static progress progress_to_rest(double speed_m_s, double rest_fraction, double fraction)
{
    double left_1 = fmax(0.0, 1.0 - fraction / rest_fraction);
    return (progress){.share_1 = 1.0 - left_1 * left_1,
                      .rate_1 = 2.0 * left_1 / rest_fraction,
                      .speed_m_s = speed_m_s * left_1};
}

static progress progress_at(const cp_vehicle_motion *motion, double step_length_s, double fraction)
{
    double v0_m_s = fmax(0.0, motion->before.speed_m_s),
           v1_m_s = fmax(0.0, motion->after.speed_m_s);
    double chord_m = cp_vec2_length(chord_of(motion));
    double rest_fraction = 2.0 * chord_m / (v0_m_s * step_length_s);
    if (v1_m_s < 1e-9 && v0_m_s > 1e-9 && rest_fraction > 1e-9 && rest_fraction < 1.0)
        return progress_to_rest(v0_m_s, rest_fraction, fraction);

    // Constant acceleration, scaled to the chord; even motion where the speeds are zero.
    double mean_m_s = 0.5 * (v0_m_s + v1_m_s), gain_m_s = v1_m_s - v0_m_s;
    double speed_m_s = v0_m_s + gain_m_s * fraction;
    if (mean_m_s < 1e-9)
        return (progress){fraction, 1.0, speed_m_s};
    return (progress){.share_1 = fraction * (v0_m_s + 0.5 * gain_m_s * fraction) / mean_m_s,
                      .rate_1 = speed_m_s / mean_m_s,
                      .speed_m_s = speed_m_s};
}

cp_vehicle_state cp_motion_at(const cp_vehicle_motion *motion, double step_length_s,
                              double fraction)
{
    // The ends are the states themselves, to the bit.
    const cp_vehicle_state *before = &motion->before, *after = &motion->after;
    if (!motion->was_present || fraction >= 1.0)
        return *after;
    if (fraction <= 0.0)
        return *before;

    progress moved = progress_at(motion, step_length_s, fraction);
    cp_vec2 chord_m = chord_of(motion);
    double turn_rad = cp_wrap_angle(after->yaw_rad - before->yaw_rad);
    cp_vehicle_state state = *after;
    state.front_x_m = before->front_x_m + moved.share_1 * chord_m.x;
    state.front_y_m = before->front_y_m + moved.share_1 * chord_m.y;
    state.yaw_rad = cp_wrap_angle(before->yaw_rad + fraction * turn_rad);
    state.speed_m_s = moved.speed_m_s;
    return state;
}

bool cp_motion_is_jump(const cp_vehicle_motion *motion, double step_length_s)
{
    if (!motion->was_present)
        return true;
    double yaw_rad = motion->before.yaw_rad;
    if (motion->after.yaw_rad != yaw_rad)
        yaw_rad += 0.5 * cp_wrap_angle(motion->after.yaw_rad - yaw_rad);
    cp_vec2 heading = cp_vec2_heading(yaw_rad);
    double sideways_m = fabs(cp_vec2_cross(heading, chord_of(motion)));
    return sideways_m > CP_JUMP_SIDEWAYS_M_S * step_length_s;
}

cp_vec2 cp_motion_front_velocity(const cp_vehicle_motion *motion, double step_length_s,
                                 double fraction)
{
    if (cp_motion_is_jump(motion, step_length_s))
        return cp_vec2_scale(cp_vec2_heading(motion->after.yaw_rad), motion->after.speed_m_s);
    progress moved = progress_at(motion, step_length_s, fraction);
    return cp_vec2_scale(chord_of(motion), moved.rate_1 / step_length_s);
}
