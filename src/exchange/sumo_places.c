/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/sumo_places.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static cp_fcd_sample sample_of(const cp_collision_places *places, int role)
{
    cp_vec2 along_m = cp_vec2_sub(places->front_m[role], places->back_m[role]);
    return (cp_fcd_sample){.time_s = places->time_s,
                           .front_m = places->front_m[role],
                           .yaw_rad = atan2(along_m.y, along_m.x),
                           .speed_m_s = places->speed_m_s[role],
                           .lane_position_m = NAN,
                           .lane = CP_FCD_NO_LANE};
}

// In order of time, in place of a sample of the same step.
static cp_status put(cp_fcd_track *track, cp_fcd_sample sample, double step_length_s,
                     cp_error *error)
{
    size_t at = track->count;
    while (at > 0 && track->sample[at - 1].time_s > sample.time_s - 0.5 * step_length_s)
        at--;
    if (at < track->count && track->sample[at].time_s < sample.time_s + 0.5 * step_length_s) {
        sample.lane_position_m = track->sample[at].lane_position_m;
        sample.lane = track->sample[at].lane;
        track->sample[at] = sample;
        return CP_OK;
    }
    cp_status status = cp_fcd_track_append(track, sample, error);
    if (status != CP_OK)
        return status;
    memmove(&track->sample[at + 1], &track->sample[at],
            (track->count - 1 - at) * sizeof *track->sample);
    track->sample[at] = sample;
    return CP_OK;
}

cp_status cp_sumo_places_add(const cp_collision_list *list, cp_fcd_record *record, cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t k = 0; k < list->count; k++)
        for (size_t i = 0; i < list->collision[k].places_count; i++)
            for (int role = 0; status == CP_OK && role < 2; role++)
                status =
                    put(&record->track[k][role], sample_of(&list->collision[k].places[i], role),
                        record->step_length_s, error);
    return status;
}

static cp_status check(const char *path, const cp_collision_list *list, cp_error *error)
{
    for (size_t k = 0; k < list->count; k++) {
        const cp_listed_collision *listed = &list->collision[k];
        if (listed->places_count == 0 || list->without_places > 0)
            return cp_fail(error, CP_BAD_INPUT,
                           "%s:%zu: without --fcd every <collision> must have colliderFront, "
                           "colliderBack, victimFront and victimBack (SUMO 1.24 or later)",
                           path, listed->line);
        if (listed->type[0] == NULL || listed->type[1] == NULL)
            return cp_fail(
                error, CP_BAD_INPUT,
                "%s:%zu: without --fcd <collision> must have colliderType and victimType", path,
                listed->line);
    }
    return CP_OK;
}

cp_status cp_sumo_places_record(const char *path, const cp_collision_list *list,
                                cp_fcd_record *record, cp_error *error)
{
    double first_s = INFINITY, last_s = -INFINITY;
    *record = (cp_fcd_record){.step_length_s = INFINITY, .of_places = true};
    cp_status status = check(path, list, error);
    if (status != CP_OK)
        return status;
    record->track = calloc(list->count + 1, sizeof *record->track);
    if (record->track == NULL)
        return cp_fail_memory(error, "ways of vehicles");
    record->collision_count = list->count;
    // SUMO repeats what lasts every step.
    for (size_t k = 0; k < list->count; k++) {
        const cp_listed_collision *listed = &list->collision[k];
        for (size_t i = 1; i < listed->places_count; i++)
            record->step_length_s = fmin(record->step_length_s,
                                         listed->places[i].time_s - listed->places[i - 1].time_s);
        first_s = fmin(first_s, listed->time_s);
        last_s = fmax(last_s, listed->last_s);
    }
    if (!(record->step_length_s > 0.0) || isinf(record->step_length_s))
        record->step_length_s = CP_PLACES_STEP_S;
    record->simulated_s = list->count > 0 ? last_s - first_s : 0.0;
    status = cp_sumo_places_add(list, record, error);
    if (status != CP_OK)
        cp_fcd_record_destroy(record);
    return status;
}
