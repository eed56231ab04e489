/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/simulation.h"

#include "impact/footprint.h"
#include "run/participants.h"

#include <math.h>
#include <stdlib.h>

bool cp_found_is_crash(const cp_found_contact *found)
{
    return cp_found_as_is_crash(found->found_as);
}

// ---- beginning and end ---------------------------------------------------------------------

// Driver errors first, then the functions that are to make up for them.
static cp_status create_controls(const cp_simulation_settings *settings, cp_simulation *simulation,
                                 cp_error *error)
{
    size_t count = settings->driver_count + settings->function_count;
    cp_control_settings *all = calloc(count + 1, sizeof *all);
    if (all == NULL)
        return cp_fail_memory(error, "controls");
    for (size_t k = 0; k < count; k++)
        all[k] = k < settings->driver_count ? settings->drivers[k]
                                            : settings->functions[k - settings->driver_count];
    cp_status status = cp_controls_create(all, count, settings->study_seed, settings->seed,
                                          simulation->traffic, &simulation->controls, error);
    free(all);
    return status;
}

cp_status cp_simulation_begin_on(const cp_simulation_settings *settings, cp_traffic *traffic,
                                 cp_simulation *simulation, cp_error *error)
{
    *simulation = (cp_simulation){.sumocfg_path = settings->sumo.sumocfg_path, .traffic = traffic};
    // Drivers and functions ask where on the road cars are; so do the treatments of branches.
    cp_traffic_read_places(traffic, settings->driver_count > 0 || settings->function_count > 0 ||
                                        settings->is_treated);
    cp_status status = create_controls(settings, simulation, error);
    if (status == CP_OK)
        status = cp_detector_create(&simulation->detector, error);
    if (status == CP_OK && settings->history_s > 0.0)
        status = cp_history_create(settings->history_s, settings->step_length_s,
                                   &simulation->history, error);
    if (status != CP_OK)
        return status;
    simulation->counted_from_s = cp_traffic_time_s(traffic) + settings->warmup_s;
    simulation->warmup_steps = llround(settings->warmup_s / settings->step_length_s);
    simulation->stay_s = settings->stay_s;
    return CP_OK;
}

cp_status cp_simulation_begin(const cp_simulation_settings *settings, cp_simulation *simulation,
                              cp_error *error)
{
    cp_sumo_words words;
    cp_traffic *traffic = NULL;
    *simulation = (cp_simulation){0};
    cp_status status =
        cp_sumo_words_create(&settings->sumo, settings->seed, settings->stay_s, &words, error);
    if (status != CP_OK)
        return status;
    cp_traffic_options options = {.sumocfg = settings->sumo.sumocfg_path,
                                  .seed = settings->seed,
                                  .step_length_s = settings->step_length_s,
                                  .options = (const char *const *)words.word,
                                  .option_count = words.count};
    status = cp_traffic_create(&options, &traffic, error);
    cp_sumo_words_destroy(&words);
    return status == CP_OK ? cp_simulation_begin_on(settings, traffic, simulation, error) : status;
}

void cp_simulation_end_traffic(cp_simulation *simulation)
{
    cp_detector_destroy(simulation->detector);
    cp_controls_destroy(simulation->controls);
    cp_traffic_destroy(simulation->traffic);
    simulation->detector = NULL;
    simulation->controls = NULL;
    simulation->traffic = NULL;
}

void cp_simulation_end(cp_simulation *simulation)
{
    cp_history_destroy(simulation->history);
    for (size_t k = 0; k < simulation->before_count; k++)
        free(simulation->before[k].rows);
    free(simulation->before);
    cp_cross_check_destroy(&simulation->check);
    cp_simulation_end_traffic(simulation);
    for (size_t k = 0; k < simulation->found_count; k++)
        cp_participant_rows_destroy(&simulation->found[k].participants);
    free(simulation->found);
    free(simulation->crashed);
    *simulation = (cp_simulation){0};
}

// ---- contacts of one step ------------------------------------------------------------------

static bool has_crashed(const cp_simulation *simulation, uint32_t vehicle)
{
    for (size_t k = 0; k < simulation->crashed_count; k++)
        if (simulation->crashed[k] == vehicle)
            return true;
    return false;
}

static cp_status remember_crashed(cp_simulation *simulation, uint32_t vehicle, cp_error *error)
{
    if (simulation->crashed_count == simulation->crashed_room) {
        size_t room = simulation->crashed_room == 0 ? 16 : 2 * simulation->crashed_room;
        uint32_t *larger = realloc(simulation->crashed, room * sizeof *larger);
        if (larger == NULL)
            return cp_fail_memory(error, "crashed vehicles");
        simulation->crashed = larger;
        simulation->crashed_room = room;
    }
    simulation->crashed[simulation->crashed_count++] = vehicle;
    return CP_OK;
}

// The error of a driver ends with his crash.
static bool is_at_fault(void *context, uint32_t vehicle)
{
    const cp_simulation *simulation = context;
    return cp_controls_is_at_fault(simulation->controls, vehicle) &&
           !cp_traffic_is_held(simulation->traffic, vehicle);
}

// Index of the first crash of a vehicle.
static size_t first_crash_of(const cp_simulation *simulation, uint32_t vehicle)
{
    for (size_t k = 0; k < simulation->found_count; k++) {
        const cp_found_contact *found = &simulation->found[k];
        if (cp_found_is_crash(found) &&
            (found->impact.vehicle[0] == vehicle || found->impact.vehicle[1] == vehicle))
            return k;
    }
    return CP_FOLLOWS_NONE;
}

static cp_status remember_found(cp_simulation *simulation, const cp_impact *impact,
                                cp_found_as found_as, cp_error *error)
{
    if (simulation->found_count == simulation->found_room) {
        size_t room = simulation->found_room == 0 ? 64 : 2 * simulation->found_room;
        cp_found_contact *larger = realloc(simulation->found, room * sizeof *larger);
        if (larger == NULL)
            return cp_fail_memory(error, "contacts");
        simulation->found = larger;
        simulation->found_room = room;
    }
    cp_found_contact *found = &simulation->found[simulation->found_count++];
    *found =
        (cp_found_contact){.impact = *impact, .found_as = found_as, .follows = CP_FOLLOWS_NONE};
    for (int role = 0; role < 2; role++) {
        cp_found_car *car = &found->car[role];
        uint32_t own = impact->vehicle[role], other = impact->vehicle[1 - role];
        car->at_fault = is_at_fault(simulation, own);
        car->errs_alone = car->at_fault && cp_controls_errs_alone(simulation->controls, own);
        car->error_since_s = cp_controls_error_since_s(simulation->controls, own, other);
        car->had_crashed = cp_traffic_is_held(simulation->traffic, own);
        size_t earlier = car->had_crashed ? first_crash_of(simulation, own) : CP_FOLLOWS_NONE;
        if (earlier < found->follows)
            found->follows = earlier;
    }
    return CP_OK;
}

// What came before the crash found last.
static cp_status remember_history(cp_simulation *simulation, cp_error *error)
{
    if (simulation->before_count == simulation->before_room) {
        size_t room = simulation->before_room == 0 ? 64 : 2 * simulation->before_room;
        cp_found_history *larger = realloc(simulation->before, room * sizeof *larger);
        if (larger == NULL)
            return cp_fail_memory(error, "history of crashes");
        simulation->before = larger;
        simulation->before_room = room;
    }
    size_t index = simulation->found_count - 1;
    const cp_impact *impact = &simulation->found[index].impact;
    cp_found_history *before = &simulation->before[simulation->before_count++];
    *before = (cp_found_history){.found = index};
    return cp_history_of(simulation->history, impact->vehicle, impact->time_s, &before->rows,
                         &before->count, error);
}

// A confirmed impact is a crash, unless one of the two had its crash earlier in this step or the
// traffic is still warming up.
static cp_status take_impact(cp_simulation *simulation, const cp_impact *impact, cp_error *error)
{
    cp_found_as found_as = CP_FOUND_CRASH;
    if (impact->verdict != CP_CONTACT_CONFIRMED)
        found_as = cp_found_as_verdict(impact->verdict);
    else if (has_crashed(simulation, impact->vehicle[0]) ||
             has_crashed(simulation, impact->vehicle[1]))
        found_as = CP_FOUND_AFTER_CRASH;
    else if (impact->time_s < simulation->counted_from_s)
        found_as = CP_FOUND_WARMUP;

    cp_status status = remember_found(simulation, impact, found_as, error);
    if (status != CP_OK)
        return status;
    cp_found_contact *found = &simulation->found[simulation->found_count - 1];
    if (cp_found_is_crash(found))
        status = cp_participants_of(
            simulation->controls, impact,
            (const bool[2]){found->car[0].had_crashed, found->car[1].had_crashed},
            &found->participants, error);
    if (status == CP_OK && found_as == CP_FOUND_CRASH && simulation->history != NULL)
        status = remember_history(simulation, error);
    if (status == CP_OK)
        status = cp_cross_check_add_contact(&simulation->check, impact->vehicle[0],
                                            impact->vehicle[1], found_as, impact->time_s, error);
    for (int role = 0; status == CP_OK && role < 2; role++)
        if (impact->verdict == CP_CONTACT_CONFIRMED &&
            !has_crashed(simulation, impact->vehicle[role]))
            status = remember_crashed(simulation, impact->vehicle[role], error);
    return status;
}

static cp_status take_impacts(cp_simulation *simulation, cp_error *error)
{
    const cp_impact *impacts = NULL;
    size_t count = 0;
    simulation->crashed_count = 0;
    cp_status status = cp_detector_step(simulation->detector, simulation->traffic, is_at_fault,
                                        simulation, &impacts, &count, error);
    for (size_t k = 0; status == CP_OK && k < count; k++)
        status = take_impact(simulation, &impacts[k], error);
    return status;
}

// How far apart the rectangles are of two that SUMO reports.
static double gap_of(const cp_traffic *traffic, const cp_sumo_collision *collision)
{
    const cp_vehicle_motion *one = cp_traffic_motion_of(traffic, collision->collider);
    const cp_vehicle_motion *other = cp_traffic_motion_of(traffic, collision->victim);
    if (one == NULL || other == NULL)
        return INFINITY;
    cp_rectangle rectangle[2] = {cp_vehicle_rectangle(&one->after),
                                 cp_vehicle_rectangle(&other->after)};
    return cp_rectangle_separation(&rectangle[0], &rectangle[1]);
}

static cp_status take_sumo_collisions(cp_simulation *simulation, cp_error *error)
{
    const cp_sumo_collision *collisions = NULL;
    size_t count = 0;
    cp_status status = cp_traffic_collisions(simulation->traffic, &collisions, &count, error);
    for (size_t k = 0; status == CP_OK && k < count; k++)
        status = cp_cross_check_add_report(&simulation->check, collisions[k].collider,
                                           collisions[k].victim, collisions[k].type,
                                           cp_traffic_time_s(simulation->traffic),
                                           gap_of(simulation->traffic, &collisions[k]), error);
    return status;
}

cp_status cp_simulation_step(cp_simulation *simulation, cp_error *error)
{
    if (simulation->steps++ == simulation->warmup_steps) {
        simulation->warmup_exposure = cp_traffic_exposure(simulation->traffic);
        cp_controls_count_from_now(simulation->controls);
    }
    cp_status status = cp_traffic_step(simulation->traffic, error);
    if (status == CP_OK)
        status = cp_controls_step(simulation->controls, error);
    if (status == CP_OK)
        status = take_impacts(simulation, error);
    if (status == CP_OK)
        status = take_sumo_collisions(simulation, error);

    if (status == CP_OK && simulation->history != NULL)
        status = cp_history_keep(simulation->history, simulation->traffic, error);

    // Crashed cars leave the road or stand on it for a while.
    double until_s = cp_traffic_time_s(simulation->traffic) + simulation->stay_s;
    for (size_t k = 0; status == CP_OK && k < simulation->crashed_count; k++)
        status = simulation->stay_s > 0.0
                     ? cp_traffic_hold(simulation->traffic, simulation->crashed[k], until_s, error)
                     : cp_traffic_remove(simulation->traffic, simulation->crashed[k], error);
    return status;
}

cp_exposure cp_simulation_counted(const cp_simulation *simulation, double *simulated_s)
{
    // A traffic that ended before it counted.
    *simulated_s = 0.0;
    if (simulation->steps <= simulation->warmup_steps)
        return (cp_exposure){0};
    cp_exposure all = cp_traffic_exposure(simulation->traffic);
    const cp_exposure *before = &simulation->warmup_exposure;
    *simulated_s = (double)(simulation->steps - simulation->warmup_steps) *
                   cp_traffic_step_length_s(simulation->traffic);
    return (cp_exposure){.vehicle_km = all.vehicle_km - before->vehicle_km,
                         .vehicle_h = all.vehicle_h - before->vehicle_h,
                         .departed = all.departed - before->departed};
}
