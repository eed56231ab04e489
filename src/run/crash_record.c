/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/crash_record.h"

#include "core/log.h"
#include "crash/crash_simulation.h"
#include "pulse/pulse_codec.h"
#include "run/fleet_car.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const cp_severity NO_SEVERITY = {
    .olc = {.status = CP_OLC_SIMULATION_FAILED, .olc_g = NAN, .t1_s = NAN, .t2_s = NAN},
    .end_s = NAN,
    .delta_v_m_s = NAN,
    .delta_v_x_m_s = NAN,
    .delta_v_y_m_s = NAN,
    .peak_g = NAN,
    .mean_g = NAN,
    .t_v0_s = NAN,
    .max_50ms_g = NAN,
    .max_50ms_y_g = NAN,
    .asi_1 = NAN,
    .pdof_rad = NAN,
    .yaw_change_rad_s = NAN};

static cp_status choose(const cp_impact *impact, const cp_impact_names *names,
                        const cp_fleet *fleet, int role, cp_stand_in *car, cp_error *error)
{
    const cp_vehicle_state *state = &impact->state[role];
    cp_vehicle_model drawn;
    cp_status status =
        cp_fleet_car(fleet, names->sumocfg_path, names->sumo_type[role], &names->type[role],
                     names->sumo_id[role], &car->choice, &drawn, error);
    if (status != CP_OK)
        return status;
    if (car->choice.model == NULL) {
        car->model = cp_vehicle_model_default();
        car->model.length_m = state->length_m;
        car->model.width_m = state->width_m;
        car->model.cg_to_front_m = 0.42 * state->length_m;
        return CP_OK;
    }
    cp_drawn_car_text(car->choice.model, &drawn, car->drawn);
    car->model = cp_vehicle_model_cover(&drawn, state->length_m, state->width_m);
    return CP_OK;
}

// What is outside of the calibrated range; of a vehicle without a model nothing else is known.
static unsigned outside_of(const cp_stand_in cars[2], const cp_crash_configuration *configuration,
                           const cp_crash_description *description, int role,
                           cp_validity_ground *ground)
{
    unsigned outside =
        cp_validity(&cars[0].model, &cars[1].model, configuration, description, role, ground);
    if (cars[role].choice.model == NULL)
        return (outside & CP_OUTSIDE_CONTACT_SIDE) | CP_OUTSIDE_NO_MODEL;
    if (cars[1 - role].choice.model == NULL)
        outside |= CP_OUTSIDE_OPPONENT_STRUCTURE;
    return outside;
}

// Lane, edge and junction out of SUMO's name of a lane: EDGE_LANE, in a junction
// :JUNCTION_LINK_LANE.
static cp_status fill_place(const char *lane, cp_crash_vehicle_row *vehicle, cp_error *error)
{
    if (lane == NULL || lane[0] == '\0')
        return CP_OK;
    const char *edge_end = strrchr(lane, '_');
    size_t length = edge_end != NULL ? (size_t)(edge_end - lane) : strlen(lane);
    vehicle->lane = strdup(lane);
    vehicle->edge = strndup(lane, length);
    if (vehicle->lane == NULL || vehicle->edge == NULL)
        return cp_fail_memory(error, "crash");
    if (lane[0] != ':')
        return CP_OK;
    const char *junction_end = strrchr(vehicle->edge, '_');
    length = junction_end != NULL ? (size_t)(junction_end - vehicle->edge) : length;
    vehicle->junction = strndup(vehicle->edge + 1, length - 1);
    return vehicle->junction != NULL ? CP_OK : cp_fail_memory(error, "crash");
}

static cp_status fill_vehicle(const cp_crash_facts *facts, const cp_impact_names *names,
                              const cp_stand_in cars[2],
                              const cp_crash_configuration *configuration, int role,
                              cp_crash_row *row, cp_error *error)
{
    cp_crash_vehicle_row *vehicle = &row->vehicle[role];
    const cp_fleet_choice *choice = &cars[role].choice;
    vehicle->sumo_id = strdup(names->sumo_id[role]);
    vehicle->sumo_type = strdup(names->sumo_type[role]);
    vehicle->vehicle_model =
        strdup(choice->model != NULL ? choice->model->name : CP_NO_VEHICLE_MODEL);
    vehicle->drawn = strdup(cars[role].drawn);
    if (vehicle->sumo_id == NULL || vehicle->sumo_type == NULL || vehicle->vehicle_model == NULL ||
        vehicle->drawn == NULL)
        return cp_fail_memory(error, "crash");
    vehicle->chosen_by = choice->chosen_by;
    snprintf(vehicle->no_model_reason, sizeof vehicle->no_model_reason, "%s", choice->reason);
    vehicle->at_fault = names->at_fault[role];
    vehicle->mass_kg = choice->model != NULL ? cars[role].model.mass_kg : NAN;
    vehicle->body = configuration->vehicle[role];
    vehicle->speed_m_s = row->description.speed_m_s[role];
    vehicle->length_m = facts->length_m[role];
    vehicle->width_m = facts->width_m[role];
    vehicle->velocity_angle_rad = row->description.velocity_angle_rad[role];
    vehicle->side = configuration->side[role];
    cp_validity_ground ground;
    vehicle->outside = outside_of(cars, configuration, &row->description, role, &ground);
    vehicle->evidence_class = ground.evidence_class;
    vehicle->class_error_1 = ground.error_1;
    if (names->had_crashed[0] || names->had_crashed[1])
        vehicle->outside |= CP_OUTSIDE_DAMAGED;
    vehicle->severity = NO_SEVERITY;
    vehicle->crush_m = vehicle->absorbed_j = vehicle->ees_m_s = vehicle->olc_sd_g = NAN;
    vehicle->intrusion_m = NAN;
    return fill_place(names->lane[role], vehicle, error);
}

static cp_status keep_pulse(const cp_pulse *raw, cp_crash_vehicle_row *vehicle, cp_error *error)
{
    cp_pulse record = {0};
    cp_status status = cp_pulse_codec_record(raw, &record, error);
    if (status == CP_OK)
        status = cp_pulse_encode(&record, &vehicle->pulse, &vehicle->pulse_size, error);
    vehicle->sample_count = record.sample_count;
    vehicle->sample_interval_s = record.sample_interval_s;
    cp_pulse_destroy(&record);
    return status;
}

// Run the surrogate and take over what it says of both cars.
static cp_status simulate(const cp_stand_in cars[2], const cp_crash_configuration *configuration,
                          cp_crash_row *row, cp_error *error)
{
    cp_crash_options options = cp_crash_options_default();
    cp_crash_result result = {0};
    cp_status status =
        cp_crash_simulate(&cars[0].model, &cars[1].model, configuration, &options, &result, error);
    for (int role = 0; status == CP_OK && role < 2; role++)
        row->vehicle[role].outside |= cp_validity_of_meeting(result.touched, result.shift_m);
    if (status == CP_OK && !result.touched)
        status = cp_fail(error, CP_CRASH_FAILED, CP_NO_CONTACT_TEXT);
    for (int role = 0; status == CP_OK && role < 2; role++)
        status = keep_pulse(&result.pulse[role], &row->vehicle[role], error);
    if (status == CP_OK) {
        for (int role = 0; role < 2; role++) {
            row->vehicle[role].severity = result.severity[role];
            row->vehicle[role].crush_m = result.crush_m[role];
            row->vehicle[role].intrusion_m = result.struck[role].depth_m;
            row->vehicle[role].intrusion_zone = cp_struck_zone_text(result.struck[role].zone);
            row->vehicle[role].absorbed_j = result.whole[role].absorbed_j;
            row->vehicle[role].ees_m_s = result.whole[role].ees_m_s;
        }
        row->separation_s = result.separation_s;
        row->t_common_s = result.t_common_s;
        row->shift_m = result.shift_m;
    }
    cp_crash_result_destroy(&result);
    return status;
}

// OLC by one parameter set of the ensembles, for both cars; a car without an ensemble stays as it
// is.
static cp_status simulate_member(const cp_stand_in cars[2],
                                 const cp_crash_configuration *configuration, size_t number,
                                 cp_crash_row *row, cp_error *error)
{
    cp_vehicle_model model[2];
    for (int role = 0; role < 2; role++) {
        const cp_vehicle_model *own = &cars[role].model;
        model[role] =
            own->member_count > 0 ? cp_vehicle_model_member(own, number % own->member_count) : *own;
    }
    cp_crash_options options = cp_crash_options_default();
    options.until_olc = true;
    cp_crash_result result = {0};
    cp_error failure = {0};
    cp_status status =
        cp_crash_simulate(&model[0], &model[1], configuration, &options, &result, &failure);
    if (status == CP_NO_MEMORY)
        return cp_fail_memory(error, "crash simulation");
    bool failed = status != CP_OK || !result.touched;
    for (int role = 0; role < 2; role++) {
        cp_crash_vehicle_row *vehicle = &row->vehicle[role];
        if (number < vehicle->member_count)
            vehicle->member[number] = failed ? NO_SEVERITY.olc : result.severity[role].olc;
    }
    cp_crash_result_destroy(&result);
    return CP_OK;
}

// What the fits of the two models leave open: OLC of frontally struck cars by every parameter set.
static cp_status simulate_ensemble(const cp_stand_in cars[2],
                                   const cp_crash_configuration *configuration, cp_crash_row *row,
                                   cp_error *error)
{
    size_t count = 0;
    for (int role = 0; role < 2; role++) {
        if (configuration->side[role] == CP_SIDE_FRONT)
            row->vehicle[role].member_count = cars[role].model.member_count;
        if (row->vehicle[role].member_count > count)
            count = row->vehicle[role].member_count;
    }
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < count; k++)
        status = simulate_member(cars, configuration, k, row, error);
    for (int role = 0; status == CP_OK && role < 2; role++)
        row->vehicle[role].olc_sd_g =
            cp_olc_sd(row->vehicle[role].member, row->vehicle[role].member_count);
    return status;
}

// The database keeps no sign of zero; simulated is what it will give back.
static void drop_sign_of_zero(cp_body_state *body)
{
    body->cog_m.x += 0.0;
    body->cog_m.y += 0.0;
    body->yaw_rad += 0.0;
    body->velocity_m_s.x += 0.0;
    body->velocity_m_s.y += 0.0;
    body->yaw_rate_rad_s += 0.0;
}

// A crash that cannot be simulated has happened all the same: it stays, without a severity.
static cp_status simulate_if_possible(const cp_crash_facts *facts, const cp_impact_names *names,
                                      const cp_stand_in cars[2],
                                      const cp_crash_configuration *configuration,
                                      cp_crash_record_extent extent, cp_crash_row *row,
                                      cp_error *error)
{
    cp_error failure = {0};
    if (cars[0].choice.model == NULL || cars[1].choice.model == NULL)
        return CP_OK;
    cp_status status = simulate(cars, configuration, row, &failure);
    if (status == CP_NO_MEMORY)
        return cp_fail_memory(error, "crash simulation");
    if (status == CP_OK && extent == CP_RECORD_PULSE)
        return CP_OK;
    if (status == CP_OK)
        return simulate_ensemble(cars, configuration, row, error);
    cp_log_warning("crash of %s and %s at %.2f s cannot be simulated: %s", names->sumo_id[0],
                   names->sumo_id[1], facts->time_s, failure.text);
    for (int role = 0; role < 2; role++) {
        free(row->vehicle[role].pulse);
        row->vehicle[role].pulse = NULL;
    }
    return CP_OK;
}

cp_status cp_crash_record_facts(const cp_crash_facts *facts, const cp_impact_names *names,
                                const cp_stand_in cars[2], cp_crash_record_extent extent,
                                cp_crash_row *row, cp_error *error)
{
    cp_crash_configuration configuration = facts->configuration;
    cp_status status = CP_OK;
    for (int role = 0; role < 2; role++)
        drop_sign_of_zero(&configuration.vehicle[role]);
    row->time_s = facts->time_s;
    row->is_secondary = names->had_crashed[0] || names->had_crashed[1];
    row->follows = CP_FOLLOWS_NONE;
    row->contact_m = facts->contact_m;
    row->description = facts->description;
    row->t_common_s = row->separation_s = row->shift_m = NAN;
    for (int role = 0; status == CP_OK && role < 2; role++)
        status = fill_vehicle(facts, names, cars, &configuration, role, row, error);
    if (status == CP_OK)
        status = simulate_if_possible(facts, names, cars, &configuration, extent, row, error);
    if (status != CP_OK)
        return status;

    // What lies outside for another reason has no class that speaks for it.
    for (int role = 0; role < 2; role++)
        if (row->vehicle[role].outside != 0)
            row->vehicle[role].evidence_class = NULL;

    // OLC speaks of frontal contact only.
    for (int role = 0; role < 2; role++)
        if (configuration.side[role] != CP_SIDE_FRONT)
            row->vehicle[role].severity.olc = (cp_olc){
                .status = CP_OLC_NOT_FRONT_CONTACT, .olc_g = NAN, .t1_s = NAN, .t2_s = NAN};
    return CP_OK;
}

cp_status cp_crash_record_fill(const cp_impact *impact, const cp_impact_names *names,
                               const cp_fleet *fleet, cp_crash_record_extent extent,
                               cp_crash_row *row, cp_error *error)
{
    cp_stand_in cars[2] = {0};
    cp_status status = CP_OK;
    for (int role = 0; status == CP_OK && role < 2; role++)
        status = choose(impact, names, fleet, role, &cars[role], error);
    if (status != CP_OK)
        return status;
    cp_crash_facts facts = {
        .time_s = impact->time_s,
        .contact_m = impact->contact_m,
        .configuration = cp_impact_configuration(impact, &cars[0].model, &cars[1].model),
        .description = cp_impact_describe(impact, &cars[0].model, &cars[1].model)};
    for (int role = 0; role < 2; role++) {
        facts.length_m[role] = impact->state[role].length_m;
        facts.width_m[role] = impact->state[role].width_m;
    }
    return cp_crash_record_facts(&facts, names, cars, extent, row, error);
}

cp_status cp_crash_record_repeat(const cp_crash_row *known, const cp_impact_names *names,
                                 cp_crash_row *row, cp_error *error)
{
    *row = *known;
    row->follows = CP_FOLLOWS_NONE;
    row->history = NULL;
    row->history_count = 0;
    row->participants = (cp_participant_rows){0};
    // All of the texts and pulses belong to one row only.
    for (int role = 0; role < 2; role++) {
        cp_crash_vehicle_row *vehicle = &row->vehicle[role];
        vehicle->sumo_id = vehicle->sumo_type = vehicle->vehicle_model = vehicle->drawn = NULL;
        vehicle->lane = vehicle->edge = vehicle->junction = NULL;
        vehicle->pulse = NULL;
    }
    for (int role = 0; role < 2; role++) {
        const cp_crash_vehicle_row *from = &known->vehicle[role];
        cp_crash_vehicle_row *vehicle = &row->vehicle[role];
        vehicle->at_fault = names->at_fault[role];
        vehicle->sumo_id = strdup(from->sumo_id);
        vehicle->sumo_type = strdup(from->sumo_type);
        vehicle->vehicle_model = strdup(from->vehicle_model);
        vehicle->drawn = strdup(from->drawn);
        if (from->pulse != NULL) {
            vehicle->pulse = malloc(from->pulse_size);
            if (vehicle->pulse != NULL)
                memcpy(vehicle->pulse, from->pulse, from->pulse_size);
        }
        if (vehicle->sumo_id == NULL || vehicle->sumo_type == NULL ||
            vehicle->vehicle_model == NULL || vehicle->drawn == NULL ||
            (from->pulse != NULL && vehicle->pulse == NULL))
            return cp_fail_memory(error, "crash");
        cp_status status = fill_place(names->lane[role], vehicle, error);
        if (status != CP_OK)
            return status;
    }
    return CP_OK;
}
