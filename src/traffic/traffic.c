/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "traffic/traffic.h"

#include "core/geometry.h"
#include "core/recent_rows.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// A crashed vehicle that stays on the road.
typedef struct held_vehicle {
    uint32_t vehicle;
    double until_s;
    cp_vehicle_state pose; /* in which it stands */
    cp_vehicle_state last; /* as SUMO had it after the last step */
    bool is_away;          /* SUMO had it nowhere */
} held_vehicle;

struct cp_traffic {
    const cp_traffic_source *source;
    double step_length_s;
    double time_s;
    cp_vehicle_motion *motions; /* of the last step */
    size_t count;
    cp_vehicle_motion *previous; /* those of before vehicles last came or went */
    size_t previous_count;
    size_t capacity;       /* of both */
    cp_recent_rows row_of; /* by vehicle number: row in motions */
    const uint32_t *departed;
    size_t departed_count;
    cp_lateral_overlays *overlays;
    held_vehicle *held;
    size_t held_count;
    size_t held_room;
    bool lacks_places; /* of the states */
    cp_exposure exposure;
};

cp_status cp_traffic_create_from(const cp_traffic_source *source, double step_length_s,
                                 cp_traffic **traffic, cp_error *error)
{
    *traffic = NULL;
    if (!(step_length_s > 0.0))
        return cp_fail(error, CP_BAD_INPUT, "step_length_s must be > 0, found %g", step_length_s);
    cp_traffic *created = calloc(1, sizeof *created);
    if (!created)
        return cp_fail_memory(error, "traffic");
    cp_status status = cp_lateral_overlays_create(&created->overlays, error);
    if (status != CP_OK) {
        free(created);
        return status;
    }
    created->source = source;
    created->step_length_s = step_length_s;
    created->time_s = source->time_s();
    *traffic = created;
    return CP_OK;
}

void cp_traffic_destroy(cp_traffic *traffic)
{
    if (!traffic)
        return;
    traffic->source->stop();
    cp_lateral_overlays_destroy(traffic->overlays);
    free(traffic->motions);
    free(traffic->previous);
    cp_recent_rows_destroy(&traffic->row_of);
    free(traffic->held);
    free(traffic);
}

static cp_status reserve_motions(cp_traffic *traffic, size_t count, cp_error *error)
{
    if (count <= traffic->capacity)
        return CP_OK;
    size_t capacity = 2 * count;
    cp_vehicle_motion *motions = realloc(traffic->motions, capacity * sizeof *motions);
    if (motions)
        traffic->motions = motions;
    cp_vehicle_motion *previous = realloc(traffic->previous, capacity * sizeof *previous);
    if (previous)
        traffic->previous = previous;
    if (!motions || !previous)
        return cp_fail_memory(error, "vehicle states");
    traffic->capacity = capacity;
    return CP_OK;
}

static uint32_t row_of(const cp_traffic *traffic, uint32_t vehicle)
{
    return cp_recent_rows_get(&traffic->row_of, vehicle);
}

// Rows of those there are now, and of none who were there before and are gone.
static cp_status number_rows(cp_traffic *traffic, cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t k = 0; k < traffic->count && status == CP_OK; k++)
        status = cp_recent_rows_set(&traffic->row_of, traffic->motions[k].after.vehicle,
                                    (uint32_t)k, error);
    for (size_t k = 0; k < traffic->previous_count && status == CP_OK; k++) {
        uint32_t vehicle = traffic->previous[k].after.vehicle, row = row_of(traffic, vehicle);
        if (row >= traffic->count || traffic->motions[row].after.vehicle != vehicle)
            cp_recent_rows_clear(&traffic->row_of, vehicle);
    }
    return status;
}

// A vehicle that moved much further than its speeds explain was put there (teleport, moveTo).
static bool has_jumped(const cp_vehicle_state *before, const cp_vehicle_state *after,
                       double step_length_s)
{
    double x_m = after->front_x_m - before->front_x_m, y_m = after->front_y_m - before->front_y_m;
    double fastest_m_s =
        before->speed_m_s > after->speed_m_s ? before->speed_m_s : after->speed_m_s;
    // One lane sideways (instant lane change) is no jump.
    double lane_width_m = 5.0;
    double farthest_m = lane_width_m;
    if (fastest_m_s > 0.0)
        farthest_m += 1.5 * fastest_m_s * step_length_s;
    return x_m * x_m + y_m * y_m > farthest_m * farthest_m;
}

// From a state of the last step, NULL without one, to one of this.
static void move_on(const cp_traffic *traffic, const cp_vehicle_state *before,
                    const cp_vehicle_state *after, cp_vehicle_motion *motion)
{
    // Way of the step by the ballistic update.
    cp_vehicle_state now = *after;
    double dt_s = traffic->step_length_s;
    double way_m = before != NULL ? 0.5 * (before->speed_m_s + after->speed_m_s) * dt_s : 0.0;
    cp_lateral_overlay_apply(traffic->overlays, &now, way_m);
    if (before == NULL || has_jumped(before, &now, dt_s)) {
        *motion = (cp_vehicle_motion){.after = now};
        return;
    }
    now.acceleration_m_s2 = (now.speed_m_s - before->speed_m_s) / dt_s;
    motion->yaw_rate_rad_s = cp_wrap_angle(now.yaw_rad - before->yaw_rad) / dt_s;
    motion->was_present = true;
    motion->before = *before;
    motion->after = now;
}

// Whether the same vehicles are there as after the last step, in the same rows.
static bool are_same(const cp_traffic *traffic, const cp_vehicle_state *states, size_t count)
{
    if (count != traffic->count)
        return false;
    for (size_t k = 0; k < count; k++)
        if (states[k].vehicle != traffic->motions[k].after.vehicle)
            return false;
    return true;
}

// Somebody came or went: motions into the other array, by where they were in this one.
static cp_status move_on_anew(cp_traffic *traffic, const cp_vehicle_state *states, size_t count,
                              cp_error *error)
{
    cp_status status = reserve_motions(traffic, count, error);
    if (status != CP_OK)
        return status;
    cp_vehicle_motion *spare = traffic->previous;
    traffic->previous = traffic->motions;
    traffic->previous_count = traffic->count;
    traffic->motions = spare;
    traffic->count = count;
    for (size_t k = 0; k < count; k++) {
        uint32_t row = row_of(traffic, states[k].vehicle);
        move_on(traffic, row != CP_NO_ROW ? &traffic->previous[row].after : NULL, &states[k],
                &traffic->motions[k]);
    }
    return number_rows(traffic, error);
}

// Motions of the step that led to these states.
static cp_status take_states(cp_traffic *traffic, const cp_vehicle_state *states, size_t count,
                             cp_error *error)
{
    if (!are_same(traffic, states, count))
        return move_on_anew(traffic, states, count, error);
    for (size_t k = 0; k < count; k++)
        move_on(traffic, &traffic->motions[k].after, &states[k], &traffic->motions[k]);
    return CP_OK;
}

// ---- crashed vehicles that stay ------------------------------------------------------------

// Whatever drivers and functions ask of a crashed car, it stands: the last command holds.
static cp_status stop_held(cp_traffic *traffic, cp_error *error)
{
    const cp_traffic_source *source = traffic->source;
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < traffic->held_count; k++) {
        uint32_t vehicle = traffic->held[k].vehicle;
        if (row_of(traffic, vehicle) == CP_NO_ROW)
            continue;
        status = source->set_speed_mode(vehicle, 0, error);
        if (status == CP_OK && source->set_lane_change_mode != NULL)
            status = source->set_lane_change_mode(vehicle, 0, error);
        if (status == CP_OK)
            status = source->set_speed(vehicle, 0.0, error);
    }
    return status;
}

// After a step: standing where they crashed, and off the road when it is time or SUMO has put them
// elsewhere.
static cp_status keep_held(cp_traffic *traffic, cp_error *error)
{
    cp_status status = CP_OK;
    size_t kept = 0;
    for (size_t k = 0; k < traffic->held_count; k++) {
        held_vehicle held = traffic->held[k];
        uint32_t row = row_of(traffic, held.vehicle);
        if (row == CP_NO_ROW) {
            held.is_away = true;
            traffic->held[kept++] = held;
            continue;
        }
        cp_vehicle_motion *motion = &traffic->motions[row];
        bool was_put =
            held.is_away || has_jumped(&held.last, &motion->after, traffic->step_length_s);
        held.last = motion->after;
        *motion = (cp_vehicle_motion){.before = held.pose, .after = held.pose, .was_present = true};
        bool is_over = was_put || traffic->time_s > held.until_s - 0.5 * traffic->step_length_s;
        if (is_over && status == CP_OK)
            status = cp_traffic_remove(traffic, held.vehicle, error);
        else
            traffic->held[kept++] = held;
    }
    traffic->held_count = kept;
    return status;
}

static held_vehicle *held_of(const cp_traffic *traffic, uint32_t vehicle)
{
    for (size_t k = 0; k < traffic->held_count; k++)
        if (traffic->held[k].vehicle == vehicle)
            return &traffic->held[k];
    return NULL;
}

bool cp_traffic_is_held(const cp_traffic *traffic, uint32_t vehicle)
{
    return held_of(traffic, vehicle) != NULL;
}

cp_status cp_traffic_hold(cp_traffic *traffic, uint32_t vehicle, double until_s, cp_error *error)
{
    if (cp_traffic_motion_of(traffic, vehicle) == NULL || cp_traffic_is_held(traffic, vehicle))
        return CP_OK;
    if (traffic->held_count == traffic->held_room) {
        size_t room = traffic->held_room == 0 ? 16 : 2 * traffic->held_room;
        held_vehicle *larger = realloc(traffic->held, room * sizeof *larger);
        if (larger == NULL)
            return cp_fail_memory(error, "crashed vehicles");
        traffic->held = larger;
        traffic->held_room = room;
    }
    cp_vehicle_state *state = &traffic->motions[row_of(traffic, vehicle)].after;
    held_vehicle held = {.vehicle = vehicle, .until_s = until_s, .pose = *state, .last = *state};
    held.pose.speed_m_s = 0.0;
    held.pose.acceleration_m_s2 = 0.0;
    *state = held.pose;
    traffic->held[traffic->held_count++] = held;
    return CP_OK;
}

// ---- the step ------------------------------------------------------------------------------

cp_status cp_traffic_step(cp_traffic *traffic, cp_error *error)
{
    const cp_vehicle_state *states;
    size_t count;
    cp_status status = stop_held(traffic, error);
    if (status == CP_OK)
        status = traffic->source->step(&states, &count, error);
    if (status == CP_OK)
        status = take_states(traffic, states, count, error);
    if (status != CP_OK)
        return status;
    cp_lateral_overlays_prune(traffic->overlays);
    traffic->time_s = traffic->source->time_s();
    if ((status = keep_held(traffic, error)) != CP_OK)
        return status;

    // Exposure: the ballistic update drives the mean of both speeds.
    double dt_s = traffic->step_length_s;
    for (size_t k = 0; k < traffic->count; k++) {
        const cp_vehicle_motion *motion = &traffic->motions[k];
        if (!motion->was_present)
            continue;
        double mean_m_s = 0.5 * (motion->before.speed_m_s + motion->after.speed_m_s);
        traffic->exposure.vehicle_km += mean_m_s * dt_s / 1000.0;
        traffic->exposure.vehicle_h += dt_s / 3600.0;
    }
    status = traffic->source->departed(&traffic->departed, &traffic->departed_count, error);
    if (status == CP_OK)
        traffic->exposure.departed += traffic->departed_count;
    return status;
}

double cp_traffic_time_s(const cp_traffic *traffic)
{
    return traffic->time_s;
}

double cp_traffic_step_length_s(const cp_traffic *traffic)
{
    return traffic->step_length_s;
}

bool cp_traffic_finished(const cp_traffic *traffic)
{
    return traffic->source->expected_vehicles() == 0;
}

const cp_vehicle_motion *cp_traffic_motions(const cp_traffic *traffic, size_t *count)
{
    *count = traffic->count;
    return traffic->motions;
}

const cp_vehicle_motion *cp_traffic_motion_of(const cp_traffic *traffic, uint32_t vehicle)
{
    uint32_t row = row_of(traffic, vehicle);
    return row != CP_NO_ROW ? &traffic->motions[row] : NULL;
}

const uint32_t *cp_traffic_departed(const cp_traffic *traffic, size_t *count)
{
    *count = traffic->departed_count;
    return traffic->departed;
}

cp_status cp_traffic_next_light(const cp_traffic *traffic, uint32_t vehicle, cp_next_light *light,
                                cp_error *error)
{
    *light = (cp_next_light){.distance_m = INFINITY, .number = CP_NO_NUMBER};
    if (traffic->source->next_light == NULL)
        return CP_OK;
    return traffic->source->next_light(vehicle, light, error);
}

void cp_traffic_read_places(cp_traffic *traffic, bool wanted)
{
    if (traffic->source->read_places == NULL)
        return;
    traffic->source->read_places(wanted);
    traffic->lacks_places = !wanted;
}

cp_status cp_traffic_place(const cp_traffic *traffic, cp_vehicle_state *state, cp_error *error)
{
    return traffic->lacks_places ? traffic->source->place(state, error) : CP_OK;
}

cp_status cp_traffic_road_relation(const cp_traffic *traffic, const cp_vehicle_state *one,
                                   const cp_vehicle_state *other, cp_road_relation *relation,
                                   cp_error *error)
{
    *relation = CP_ROADS_MEET;
    if (traffic->source->road_relation == NULL)
        return CP_OK;
    return traffic->source->road_relation(one, other, relation, error);
}

const char *cp_traffic_vehicle_id(const cp_traffic *traffic, uint32_t vehicle)
{
    return traffic->source->vehicle_id(vehicle);
}

const char *cp_traffic_vehicle_type(const cp_traffic *traffic, uint32_t vehicle)
{
    const cp_vehicle_motion *motion = cp_traffic_motion_of(traffic, vehicle);
    return motion ? cp_traffic_type_id(traffic, motion->after.type) : "";
}

const char *cp_traffic_type_id(const cp_traffic *traffic, uint32_t type)
{
    return traffic->source->type_id ? traffic->source->type_id(type) : "";
}

const char *cp_traffic_lane_id(const cp_traffic *traffic, uint32_t lane)
{
    return traffic->source->lane_id ? traffic->source->lane_id(lane) : "";
}

cp_status cp_traffic_type(const cp_traffic *traffic, const char *type_id, cp_sumo_type *type,
                          cp_error *error)
{
    *type = (cp_sumo_type){.mass_kg = NAN};
    return traffic->source->type ? traffic->source->type(type_id, type, error) : CP_OK;
}

cp_status cp_traffic_collisions(const cp_traffic *traffic, const cp_sumo_collision **collisions,
                                size_t *count, cp_error *error)
{
    *collisions = NULL;
    *count = 0;
    return traffic->source->collisions ? traffic->source->collisions(collisions, count, error)
                                       : CP_OK;
}

const char *cp_traffic_version(const cp_traffic *traffic)
{
    return traffic->source->version ? traffic->source->version() : "";
}

const char *cp_traffic_command_line(const cp_traffic *traffic)
{
    return traffic->source->command_line ? traffic->source->command_line() : "";
}

cp_status cp_traffic_lane_map(const cp_traffic *traffic, const cp_lane_map **map, cp_error *error)
{
    *map = NULL;
    return traffic->source->lane_map ? traffic->source->lane_map(map, error) : CP_OK;
}

cp_status cp_traffic_next_lanes(const cp_traffic *traffic, uint32_t vehicle, uint32_t *lanes,
                                size_t room, size_t *count, cp_error *error)
{
    *count = 0;
    return traffic->source->next_lanes
               ? traffic->source->next_lanes(vehicle, lanes, room, count, error)
               : CP_OK;
}

cp_status cp_traffic_lane_width(const cp_traffic *traffic, const cp_vehicle_state *state,
                                double *width_m, cp_error *error)
{
    *width_m = 3.2;
    return traffic->source->lane_width ? traffic->source->lane_width(state->lane, width_m, error)
                                       : CP_OK;
}

const cp_traffic_source *cp_traffic_commands(const cp_traffic *traffic)
{
    return traffic->source;
}

cp_lateral_overlays *cp_traffic_overlays(const cp_traffic *traffic)
{
    return traffic->overlays;
}

cp_exposure cp_traffic_exposure(const cp_traffic *traffic)
{
    return traffic->exposure;
}

cp_status cp_traffic_remove(cp_traffic *traffic, uint32_t vehicle, cp_error *error)
{
    const cp_vehicle_motion *motion = cp_traffic_motion_of(traffic, vehicle);
    if (!motion)
        return CP_OK;
    cp_status status = traffic->source->remove(vehicle, error);
    if (status != CP_OK)
        return status;
    // Close the gap, keeping the order of the others.
    size_t row = row_of(traffic, vehicle);
    memmove(&traffic->motions[row], &traffic->motions[row + 1],
            (traffic->count - row - 1) * sizeof *traffic->motions);
    traffic->count--;
    cp_recent_rows_clear(&traffic->row_of, vehicle);
    for (size_t k = row; k < traffic->count && status == CP_OK; k++)
        status = cp_recent_rows_set(&traffic->row_of, traffic->motions[k].after.vehicle,
                                    (uint32_t)k, error);
    return status;
}
