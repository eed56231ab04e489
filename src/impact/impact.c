/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact/impact.h"

#include "impact/footprint.h"

const char *cp_contact_verdict_text(cp_contact_verdict verdict)
{
    static const char *const TEXT[] = {
#define CP_CONTACT_VERDICT_ROW(name, text) [name] = text,
        CP_CONTACT_VERDICTS(CP_CONTACT_VERDICT_ROW)
#undef CP_CONTACT_VERDICT_ROW
    };
    return TEXT[verdict];
}

void cp_impact_swap_roles(cp_impact *impact)
{
    const cp_impact was = *impact;
    for (int role = 0; role < 2; role++) {
        impact->vehicle[role] = was.vehicle[1 - role];
        impact->state[role] = was.state[1 - role];
        impact->yaw_rate_rad_s[role] = was.yaw_rate_rad_s[1 - role];
        impact->front_velocity_m_s[role] = was.front_velocity_m_s[1 - role];
        impact->side[role] = was.side[1 - role];
    }
}

// Motion of the centre of gravity: it hangs behind the front bumper, whose velocity SUMO gives.
static cp_body_state body_state(const cp_impact *impact, int role, const cp_vehicle_model *model)
{
    const cp_vehicle_state *state = &impact->state[role];
    cp_vec2 lever_m = cp_vec2_scale(cp_vec2_heading(state->yaw_rad), -model->cg_to_front_m);
    cp_vec2 front_m = {state->front_x_m, state->front_y_m};
    return (cp_body_state){.cog_m = cp_vec2_add(front_m, lever_m),
                           .yaw_rad = state->yaw_rad,
                           .velocity_m_s = cp_point_velocity(impact->front_velocity_m_s[role],
                                                             impact->yaw_rate_rad_s[role], lever_m),
                           .yaw_rate_rad_s = impact->yaw_rate_rad_s[role]};
}

cp_crash_configuration cp_impact_configuration(const cp_impact *impact,
                                               const cp_vehicle_model *model_a,
                                               const cp_vehicle_model *model_b)
{
    return (cp_crash_configuration){
        .vehicle = {body_state(impact, 0, model_a), body_state(impact, 1, model_b)},
        .side = {impact->side[0], impact->side[1]},
        .barrier = cp_barrier_default()};
}

cp_crash_description cp_impact_describe(const cp_impact *impact, const cp_vehicle_model *model_a,
                                        const cp_vehicle_model *model_b)
{
    // The models with the outlines SUMO drove with.
    cp_vehicle_model outline[2] = {*model_a, *model_b};
    for (int role = 0; role < 2; role++) {
        outline[role].length_m = impact->state[role].length_m;
        outline[role].width_m = impact->state[role].width_m;
    }
    cp_crash_configuration configuration =
        cp_impact_configuration(impact, &outline[0], &outline[1]);
    return cp_crash_describe(&outline[0], &outline[1], &configuration, impact->contact_m);
}
