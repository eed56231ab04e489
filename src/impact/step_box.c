/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact/step_box.h"

#include "impact/footprint.h"

static const cp_box NOWHERE = {INFINITY, INFINITY, -INFINITY, -INFINITY};

static bool is_finite_state(const cp_vehicle_state *state)
{
    return isfinite(state->front_x_m) && isfinite(state->front_y_m) && isfinite(state->yaw_rad);
}

static cp_vec2 unit_of(double yaw_rad, const cp_kept_heading *kept)
{
    return yaw_rad == kept->yaw_rad ? kept->unit : cp_vec2_heading(yaw_rad);
}

// Box of the rectangle of one state.
static cp_box box_of(const cp_vehicle_state *state, cp_vec2 unit, double margin_m)
{
    double half_length_m = 0.5 * state->length_m, half_width_m = 0.5 * state->width_m;
    double x_m = state->front_x_m - unit.x * half_length_m;
    double y_m = state->front_y_m - unit.y * half_length_m;
    double along = fabs(unit.x), across = fabs(unit.y);
    double reach_x_m = along * half_length_m + across * half_width_m + margin_m;
    double reach_y_m = across * half_length_m + along * half_width_m + margin_m;
    return (cp_box){x_m - reach_x_m, y_m - reach_y_m, x_m + reach_x_m, y_m + reach_y_m};
}

static double smaller(double a, double b)
{
    return a < b ? a : b;
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

static cp_box box_of_both(const cp_box *one, const cp_box *other)
{
    return (cp_box){smaller(one->min_x_m, other->min_x_m), smaller(one->min_y_m, other->min_y_m),
                    larger(one->max_x_m, other->max_x_m), larger(one->max_y_m, other->max_y_m)};
}

cp_box cp_step_box(const cp_vehicle_motion *motion, double step_length_s, double margin_m,
                   cp_kept_heading *kept)
{
    const cp_vehicle_state *before = &motion->before, *after = &motion->after;
    if (!is_finite_state(after) || (motion->was_present && !is_finite_state(before)))
        return NOWHERE;
    cp_vec2 unit = unit_of(after->yaw_rad, kept);
    cp_vec2 unit_before = motion->was_present ? unit_of(before->yaw_rad, kept) : unit;
    *kept = (cp_kept_heading){after->yaw_rad, unit};
    if (!motion->was_present)
        return box_of(after, unit, margin_m);

    // The sum of both unit vectors points half way and is twice the cosine of half the turn long.
    // Between the two headings a corner swings out of the straight line by no more than its lever
    // times what that cosine lacks to 1.
    cp_vec2 sum = cp_vec2_add(unit, unit_before);
    double cosine = 0.5 * sqrt(cp_vec2_dot(sum, sum));
    margin_m += (after->length_m + after->width_m) * larger(0.0, 1.0 - cosine);

    // Few move far enough sideways to have jumped.
    cp_vec2 way_m = {after->front_x_m - before->front_x_m, after->front_y_m - before->front_y_m};
    double sideways_m_s = fabs(cp_vec2_cross(sum, way_m)) / (2.0 * cosine * step_length_s);
    cp_box at_end = box_of(after, unit, margin_m);
    if (sideways_m_s > 0.9 * CP_JUMP_SIDEWAYS_M_S && cp_motion_is_jump(motion, step_length_s))
        return at_end;
    cp_box at_begin = box_of(before, unit_before, margin_m);
    return box_of_both(&at_begin, &at_end);
}
