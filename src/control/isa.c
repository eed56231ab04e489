/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control_types.h"

#include <stdlib.h>
#include <string.h>

/* Intelligent speed assistance: a car that has it is driven no faster than the speed limits of its
 * lanes plus a tolerance. In SUMO's terms its speed factor, which the driver brings along, is
 * limited once, when the car enters; it acts all the way and belongs to whole-traffic designs. */

enum { PENETRATION_1, TOLERANCE_1 };

static const cp_control_parameter PARAMETERS[] = {
    [PENETRATION_1] = CP_CONTROL_PENETRATION,
    [TOLERANCE_1] = {"tolerance_1", 0.0, 0.0, 1.0,
                     "how much faster than the limit a car may go, as a share of it (assumed)"},
};

typedef struct isa {
    const cp_traffic *traffic;
    bool *is_known; /* by vehicle number */
    size_t numbers;
    size_t limited;
} isa;

static cp_status create(const cp_control_context *context, void **state, cp_error *error)
{
    isa *created = calloc(1, sizeof *created);
    if (!created)
        return cp_fail_memory(error, "isa");
    created->traffic = context->traffic;
    *state = created;
    return CP_OK;
}

static void destroy(void *state)
{
    isa *self = state;
    free(self->is_known);
    free(self);
}

static cp_status reserve(isa *self, uint32_t vehicle, cp_error *error)
{
    if (vehicle < self->numbers)
        return CP_OK;
    size_t numbers = 2 * ((size_t)vehicle + 1);
    bool *is_known = realloc(self->is_known, numbers * sizeof *is_known);
    if (!is_known)
        return cp_fail_memory(error, "isa");
    memset(&is_known[self->numbers], 0, (numbers - self->numbers) * sizeof *is_known);
    self->is_known = is_known;
    self->numbers = numbers;
    return CP_OK;
}

static cp_status limit(isa *self, const cp_control_context *context, uint32_t vehicle,
                       cp_error *error)
{
    const cp_traffic_source *commands = cp_traffic_commands(self->traffic);
    double factor_1, highest_1 = 1.0 + context->parameter[TOLERANCE_1];
    cp_status status = commands->speed_factor(vehicle, &factor_1, error);
    if (status != CP_OK || factor_1 <= highest_1)
        return status;
    self->limited++;
    status = cp_acts_note(context->acts, vehicle, CP_ACT_LIMITING, cp_traffic_time_s(self->traffic),
                          error);
    return status == CP_OK ? commands->set_speed_factor(vehicle, highest_1, error) : status;
}

static cp_status step(void *state, const cp_control_context *context, cp_error *error)
{
    isa *self = state;
    if (!cp_equipment_is_any(context->equipment))
        return CP_OK;
    size_t count;
    const cp_vehicle_motion *motions = cp_traffic_motions(self->traffic, &count);
    cp_status status = CP_OK;
    for (size_t k = 0; k < count && status == CP_OK; k++) {
        bool has = false;
        uint32_t vehicle = motions[k].after.vehicle;
        status = reserve(self, vehicle, error);
        if (status != CP_OK || self->is_known[vehicle])
            continue;
        self->is_known[vehicle] = true;
        status = cp_equipment_has(context->equipment, self->traffic, vehicle, &has, error);
        if (status == CP_OK && has)
            status = limit(self, context, vehicle, error);
    }
    return status;
}

static size_t counters(const void *state, const char **names, double *values, size_t room)
{
    const isa *self = state;
    if (room < 1)
        return 0;
    names[0] = "limited_vehicles";
    values[0] = (double)self->limited;
    return 1;
}

const cp_control_type CP_CONTROL_ISA = {
    .name = "isa",
    .kind = CP_CONTROL_FUNCTION,
    .what = "intelligent speed assistance: no faster than the speed limit",
    .acts_long_before = true,
    .parameters = PARAMETERS,
    .parameter_count = sizeof PARAMETERS / sizeof *PARAMETERS,
    .create = create,
    .step = step,
    .counters = counters,
    .destroy = destroy,
};
