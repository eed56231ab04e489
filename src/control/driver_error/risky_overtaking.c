/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control_types.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A seeded share of drivers overtakes on the opposite lane with less room than it takes: their
 * lane-change model's lcOpposite (SUMO: eagerness to overtake through the opposite direction; 1
 * keeps a safe gap, higher accepts smaller ones) is raised when they enter. */

enum { PROBABILITY_1, OPPOSITE_1 };

static const cp_control_parameter PARAMETERS[] = {
    [PROBABILITY_1] =
        {"probability_1", 0.1, 0.0, 1.0,
         "share of drivers who overtake riskily, drawn once per vehicle (assumed; not "
         "calibrated to accident statistics)"},
    [OPPOSITE_1] = {"opposite_1", 3.0, 1.0, 10.0,
                    "their lcOpposite; the room they accept falls with it (assumed)"},
};

typedef struct risky_overtaking {
    const cp_traffic *traffic;
    bool *is_risky; /* by vehicle number */
    size_t numbers;
    size_t drivers;
    size_t risky;
} risky_overtaking;

static cp_status create(const cp_control_context *context, void **state, cp_error *error)
{
    risky_overtaking *created = calloc(1, sizeof *created);
    if (!created)
        return cp_fail_memory(error, "risky_overtaking");
    created->traffic = context->traffic;
    *state = created;
    return CP_OK;
}

static void destroy(void *state)
{
    risky_overtaking *self = state;
    free(self->is_risky);
    free(self);
}

static cp_status reserve(risky_overtaking *self, uint32_t vehicle, cp_error *error)
{
    if (vehicle < self->numbers)
        return CP_OK;
    size_t numbers = 2 * ((size_t)vehicle + 1);
    bool *is_risky = realloc(self->is_risky, numbers * sizeof *is_risky);
    if (!is_risky)
        return cp_fail_memory(error, "risky_overtaking");
    memset(&is_risky[self->numbers], 0, (numbers - self->numbers) * sizeof *is_risky);
    self->is_risky = is_risky;
    self->numbers = numbers;
    return CP_OK;
}

static cp_status step(void *state, const cp_control_context *context, cp_error *error)
{
    risky_overtaking *self = state;
    char opposite[32];
    snprintf(opposite, sizeof opposite, "%.17g", context->parameter[OPPOSITE_1]);
    size_t count;
    const uint32_t *departed = cp_traffic_departed(self->traffic, &count);
    for (size_t k = 0; k < count; k++) {
        uint32_t vehicle = departed[k];
        if (!cp_traffic_motion_of(self->traffic, vehicle))
            continue; // gone again within the step
        cp_status status = reserve(self, vehicle, error);
        if (status != CP_OK)
            return status;
        self->drivers++;
        cp_rng_key key =
            cp_rng_key_text(context->seed_key, cp_traffic_vehicle_id(self->traffic, vehicle));
        if (cp_rng_uniform(key, 0) >= context->parameter[PROBABILITY_1])
            continue;
        self->is_risky[vehicle] = true;
        self->risky++;
        status = cp_traffic_commands(self->traffic)
                     ->set_parameter(vehicle, "laneChangeModel.lcOpposite", opposite, error);
        if (status != CP_OK)
            return status;
    }
    return CP_OK;
}

// At fault now: risky and driving against its lane's direction (SUMO then gives the opposite lane,
// along which the position falls).
static bool is_at_fault(const void *state, uint32_t vehicle)
{
    const risky_overtaking *self = state;
    const cp_vehicle_motion *motion = cp_traffic_motion_of(self->traffic, vehicle);
    return motion && vehicle < self->numbers && self->is_risky[vehicle] && motion->was_present &&
           motion->before.lane == motion->after.lane &&
           motion->after.lane_position_m < motion->before.lane_position_m;
}

static size_t counters(const void *state, const char **names, double *values, size_t room)
{
    const risky_overtaking *self = state;
    if (room < 2)
        return 0;
    names[0] = "drivers";
    values[0] = (double)self->drivers;
    names[1] = "risky_drivers";
    values[1] = (double)self->risky;
    return 2;
}

const cp_control_type CP_CONTROL_RISKY_OVERTAKING = {
    .name = "risky_overtaking",
    .kind = CP_CONTROL_DRIVER_ERROR,
    .what = "a share of drivers overtakes on the opposite lane with too little room",
    .parameters = PARAMETERS,
    .parameter_count = sizeof PARAMETERS / sizeof *PARAMETERS,
    .create = create,
    .step = step,
    .is_at_fault = is_at_fault,
    .counters = counters,
    .destroy = destroy,
};
