/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact/approach.h"

/* Least movement between two looks: what an overlap can hide in is half of it. */
#define LEAST_MOVE_M 1e-3

static double separation_at(const cp_approach *approach, double time_s)
{
    cp_rectangle rectangle[2];
    approach->rectangles_at(approach->context, time_s, rectangle);
    return cp_rectangle_separation(&rectangle[0], &rectangle[1]);
}

// The moment in (early, late] at which the separation reaches the level: halve until no double
// lies between.
static double halve(const cp_approach *approach, double level_m, double early_s, double late_s)
{
    for (;;) {
        double middle_s = early_s + 0.5 * (late_s - early_s);
        if (middle_s <= early_s || middle_s >= late_s)
            return late_s;
        if (separation_at(approach, middle_s) <= level_m)
            late_s = middle_s;
        else
            early_s = middle_s;
    }
}

bool cp_approach_reaches(const cp_approach *approach, double level_m, double *time_s)
{
    double now_s = 0.0, gap_m = separation_at(approach, 0.0) - level_m;
    double last_gap_m = separation_at(approach, approach->duration_s) - level_m;
    *time_s = 0.0;
    while (!(gap_m <= 0.0)) {
        // Too far apart, seen from here and from the end, to meet in between? (Or not a number.)
        double left_s = approach->duration_s - now_s;
        if (left_s <= 0.0 || !(gap_m + last_gap_m <= approach->rate_m_s * left_s))
            return false;

        // Go as far as the gap allows; a little further finds the moment in between.
        double step_s = fmax(gap_m, LEAST_MOVE_M) / approach->rate_m_s;
        double next_s = step_s < left_s ? now_s + step_s : approach->duration_s;
        gap_m = separation_at(approach, next_s) - level_m;
        if (gap_m <= 0.0)
            *time_s = halve(approach, level_m, now_s, next_s);
        now_s = next_s;
    }
    return true;
}

double cp_approach_rate(const cp_rectangle rectangle[2], double relative_speed_m_s,
                        const double yaw_rate_rad_s[2], double duration_s)
{
    // A face normal that turns sweeps over the distance between the bodies; a body that turns
    // moves its corners, and its centre about its reference point.
    double reach_m = 0.0;
    for (int k = 0; k < 2; k++)
        reach_m += 2.0 * cp_rectangle_half_diagonal_m(&rectangle[k]);
    double centres_m = cp_vec2_length(cp_vec2_sub(rectangle[0].centre_m, rectangle[1].centre_m));
    double turning_rad_s = fabs(yaw_rate_rad_s[0]) + fabs(yaw_rate_rad_s[1]);
    double span_m = centres_m + relative_speed_m_s * duration_s + 2.0 * reach_m;
    return relative_speed_m_s + turning_rad_s * span_m;
}

/* Two motions through one step. */
typedef struct step_pair {
    const cp_vehicle_motion *motion[2];
    double step_length_s;
} step_pair;

static void footprints_in_step(const void *context, double time_s, cp_rectangle rectangle[2])
{
    const step_pair *pair = context;
    for (int k = 0; k < 2; k++) {
        cp_vehicle_state state =
            cp_motion_at(pair->motion[k], pair->step_length_s, time_s / pair->step_length_s);
        rectangle[k] = cp_vehicle_rectangle(&state);
    }
}

// Largest relative speed of the fronts in the step. Both velocities are linear in time, so it is
// at one end; only a vehicle that comes to rest half-way adds the ends of each alone.
static double fastest_approach(const step_pair *pair)
{
    double fastest_m_s = 0.0;
    bool rests = false;
    for (int end = 0; end < 2; end++) {
        cp_vec2 velocity[2];
        for (int k = 0; k < 2; k++) {
            velocity[k] = cp_motion_front_velocity(pair->motion[k], pair->step_length_s, end);
            rests |= end == 1 && velocity[k].x == 0.0 && velocity[k].y == 0.0;
        }
        fastest_m_s = fmax(fastest_m_s, cp_vec2_length(cp_vec2_sub(velocity[0], velocity[1])));
    }
    for (int k = 0; rests && k < 2; k++)
        for (int end = 0; end < 2; end++)
            fastest_m_s = fmax(fastest_m_s, cp_vec2_length(cp_motion_front_velocity(
                                                pair->motion[k], pair->step_length_s, end)));
    return fastest_m_s;
}

bool cp_first_contact(const cp_vehicle_motion *one, const cp_vehicle_motion *other,
                      double step_length_s, double *fraction)
{
    step_pair pair = {{one, other}, step_length_s};
    cp_rectangle rectangle[2];
    footprints_in_step(&pair, 0.0, rectangle);
    double yaw_rate_rad_s[2], time_s;
    for (int k = 0; k < 2; k++)
        yaw_rate_rad_s[k] =
            cp_wrap_angle(pair.motion[k]->after.yaw_rad - pair.motion[k]->before.yaw_rad) /
            step_length_s;
    double speed_m_s = fastest_approach(&pair);
    cp_approach approach = {
        .rectangles_at = footprints_in_step,
        .context = &pair,
        .duration_s = step_length_s,
        .rate_m_s = cp_approach_rate(rectangle, speed_m_s, yaw_rate_rad_s, step_length_s)};
    if (!cp_approach_reaches(&approach, 0.0, &time_s))
        return false;
    *fraction = fmin(1.0, time_s / step_length_s);
    return true;
}
