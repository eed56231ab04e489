/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/history.h"

#include <math.h>
#include <stdlib.h>

// One vehicle in one step.
typedef struct sample {
    uint32_t vehicle;
    cp_vec2 front_m;
    double yaw_rad;
    double speed_m_s;
    double acceleration_m_s2;
} sample;

// All vehicles in one step.
typedef struct frame {
    double time_s;
    sample *samples;
    size_t count;
    size_t room;
} frame;

struct cp_history {
    double length_s;
    frame *frames; /* a ring: step k in frame k modulo their number */
    size_t frame_count;
    size_t steps; /* kept since the beginning */
};

cp_status cp_history_create(double length_s, double step_length_s, cp_history **history,
                            cp_error *error)
{
    cp_history *created = calloc(1, sizeof *created);
    *history = created;
    if (created == NULL)
        return cp_fail_memory(error, "history");
    created->length_s = length_s;
    // One more than fit: the step of the contact itself is in it too.
    created->frame_count = (size_t)ceil(length_s / step_length_s) + 2;
    created->frames = calloc(created->frame_count, sizeof *created->frames);
    if (created->frames != NULL)
        return CP_OK;
    cp_history_destroy(created);
    *history = NULL;
    return cp_fail_memory(error, "history");
}

void cp_history_destroy(cp_history *history)
{
    if (history == NULL)
        return;
    for (size_t k = 0; history->frames != NULL && k < history->frame_count; k++)
        free(history->frames[k].samples);
    free(history->frames);
    free(history);
}

cp_status cp_history_keep(cp_history *history, const cp_traffic *traffic, cp_error *error)
{
    size_t count;
    const cp_vehicle_motion *motions = cp_traffic_motions(traffic, &count);
    frame *now = &history->frames[history->steps % history->frame_count];
    if (count > now->room) {
        sample *larger = realloc(now->samples, 2 * count * sizeof *larger);
        if (larger == NULL)
            return cp_fail_memory(error, "history");
        now->samples = larger;
        now->room = 2 * count;
    }
    now->time_s = cp_traffic_time_s(traffic);
    now->count = count;
    history->steps++;
    for (size_t k = 0; k < count; k++) {
        const cp_vehicle_state *state = &motions[k].after;
        now->samples[k] = (sample){.vehicle = state->vehicle,
                                   .front_m = {state->front_x_m, state->front_y_m},
                                   .yaw_rad = state->yaw_rad,
                                   .speed_m_s = state->speed_m_s,
                                   .acceleration_m_s2 = state->acceleration_m_s2};
    }
    return CP_OK;
}

static const sample *find(const frame *in, uint32_t vehicle)
{
    for (size_t k = 0; k < in->count; k++)
        if (in->samples[k].vehicle == vehicle)
            return &in->samples[k];
    return NULL;
}

cp_status cp_history_of(const cp_history *history, const uint32_t vehicle[2], double time_s,
                        cp_history_row **rows, size_t *count, cp_error *error)
{
    size_t oldest =
        history->steps > history->frame_count ? history->steps - history->frame_count : 0;
    *count = 0;
    *rows = calloc(2 * history->frame_count, sizeof **rows);
    if (*rows == NULL)
        return cp_fail_memory(error, "history of a crash");
    for (int role = 0; role < 2; role++)
        for (size_t step = oldest; step < history->steps; step++) {
            const frame *then = &history->frames[step % history->frame_count];
            const double rounding_s = 1e-9;
            const sample *found = find(then, vehicle[role]);
            if (found == NULL || then->time_s >= time_s ||
                then->time_s < time_s - history->length_s - rounding_s)
                continue;
            (*rows)[(*count)++] = (cp_history_row){.role = role,
                                                   .time_s = then->time_s,
                                                   .front_m = found->front_m,
                                                   .yaw_rad = found->yaw_rad,
                                                   .speed_m_s = found->speed_m_s,
                                                   .acceleration_m_s2 = found->acceleration_m_s2};
        }
    if (*count == 0) {
        free(*rows);
        *rows = NULL;
    }
    return CP_OK;
}
