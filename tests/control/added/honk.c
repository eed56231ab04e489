/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control.h"

#include <math.h>
#include <stdlib.h>

/* The function that test_added.c adds: a car that has it slows down, gently and for good. */

enum { PENETRATION_1, DECELERATION_M_S2 };

static const cp_control_parameter PARAMETERS[] = {
    [PENETRATION_1] = CP_CONTROL_PENETRATION,
    [DECELERATION_M_S2] = {"deceleration_m_s2", 1.0, 0.1, 3.0, "how gently, m/s^2 (assumed)"},
};

static cp_status create(const cp_control_context *context, void **state, cp_error *error)
{
    (void)context;
    *state = calloc(1, 1);
    return *state ? CP_OK : cp_fail_memory(error, "honk");
}

static cp_status step(void *state, const cp_control_context *context, cp_error *error)
{
    (void)state;
    size_t count;
    const cp_vehicle_motion *motions = cp_traffic_motions(context->traffic, &count);
    cp_status status = CP_OK;
    for (size_t k = 0; k < count && status == CP_OK; k++) {
        uint32_t vehicle = motions[k].after.vehicle;
        double deceleration_m_s2 = context->parameter[DECELERATION_M_S2];
        double loss_m_s = deceleration_m_s2 * cp_traffic_step_length_s(context->traffic);
        bool has = false;
        status = cp_equipment_has(context->equipment, context->traffic, vehicle, &has, error);
        if (status == CP_OK && has)
            status = cp_actuation_request(context->actuation, vehicle,
                                          fmax(motions[k].after.speed_m_s - loss_m_s, 0.0),
                                          deceleration_m_s2, error);
    }
    return status;
}

extern const cp_control_type CP_CONTROL_HONK; /* as the table declares it */
const cp_control_type CP_CONTROL_HONK = {
    .name = "honk",
    .kind = CP_CONTROL_FUNCTION,
    .what = "slows down",
    .parameters = PARAMETERS,
    .parameter_count = sizeof PARAMETERS / sizeof *PARAMETERS,
    .create = create,
    .step = step,
    .destroy = free,
};
