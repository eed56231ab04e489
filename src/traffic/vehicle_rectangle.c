/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "traffic/vehicle_rectangle.h"

cp_rectangle cp_vehicle_rectangle(const cp_vehicle_state *state)
{
    cp_vec2 front_m = {state->front_x_m, state->front_y_m};
    cp_vec2 back = cp_vec2_scale(cp_vec2_heading(state->yaw_rad), -0.5 * state->length_m);
    return (cp_rectangle){.centre_m = cp_vec2_add(front_m, back),
                          .yaw_rad = state->yaw_rad,
                          .length_m = state->length_m,
                          .width_m = state->width_m};
}
