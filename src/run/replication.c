/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/replication.h"

#include "core/log.h"
#include "run/crash_record.h"
#include "run/cross_check.h"
#include "traffic/traffic.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char FOUND_CRASH[] = "crash";
static const char VERDICT_AFTER_CRASH[] = "after_crash";
static const char VERDICT_WARMUP[] = "warmup";

// What is happening in a replication; what is known about it is const.
typedef struct replication_run {
    const cp_fleet *fleet;
    const cp_study_scenario *scenario;
    cp_traffic *traffic;
    cp_controls *controls;
    cp_detector *detector;
    cp_cross_check check;
    cp_result_rows *results;
    double counted_from_s; /* SUMO clock: end of the warm-up */
    uint32_t *crashed;     /* vehicles that crashed in this step */
    size_t crashed_count;
    size_t crashed_room;
} replication_run;

// ---- beginning and end ---------------------------------------------------------------------

static cp_status create_controls(const cp_study *study, const cp_study_scenario *scenario,
                                 const cp_study_variant *variant, uint64_t seed,
                                 const cp_traffic *traffic, cp_controls **controls, cp_error *error)
{
    // Driver errors first, then the functions that are to make up for them.
    size_t count = scenario->driver_error_count + variant->function_count;
    cp_control_settings *settings = calloc(count + 1, sizeof *settings);
    if (settings == NULL)
        return cp_fail_memory(error, "controls");
    for (size_t k = 0; k < count; k++)
        settings[k] = k < scenario->driver_error_count
                          ? scenario->driver_errors[k]
                          : variant->functions[k - scenario->driver_error_count];
    cp_status status =
        cp_controls_create(settings, count, study->seed, seed, traffic, controls, error);
    free(settings);
    return status;
}

static cp_status start_traffic(const cp_study *study, const cp_study_scenario *scenario,
                               uint64_t seed, cp_traffic **traffic, cp_error *error)
{
    cp_traffic_options options = {.sumocfg = scenario->sumocfg_path,
                                  .seed = seed,
                                  .step_length_s = study->step_length_s,
                                  .options = (const char *const *)scenario->sumo_options,
                                  .option_count = scenario->sumo_option_count};
    return cp_traffic_create(&options, traffic, error);
}

static void run_destroy(replication_run *run)
{
    cp_cross_check_destroy(&run->check);
    cp_detector_destroy(run->detector);
    cp_controls_destroy(run->controls);
    cp_traffic_destroy(run->traffic);
    free(run->crashed);
}

// ---- contacts of one step ------------------------------------------------------------------

static bool has_crashed(const replication_run *run, uint32_t vehicle)
{
    for (size_t k = 0; k < run->crashed_count; k++)
        if (run->crashed[k] == vehicle)
            return true;
    return false;
}

static cp_status remember_crashed(replication_run *run, uint32_t vehicle, cp_error *error)
{
    if (run->crashed_count == run->crashed_room) {
        size_t room = run->crashed_room == 0 ? 16 : 2 * run->crashed_room;
        uint32_t *larger = realloc(run->crashed, room * sizeof *larger);
        if (larger == NULL)
            return cp_fail_memory(error, "crashed vehicles");
        run->crashed = larger;
        run->crashed_room = room;
    }
    run->crashed[run->crashed_count++] = vehicle;
    return CP_OK;
}

static cp_status record_crash(replication_run *run, const cp_impact *impact, cp_error *error)
{
    cp_impact_names names;
    for (int role = 0; role < 2; role++) {
        names.sumo_id[role] = sumo_bridge_vehicle_id(impact->vehicle[role]);
        names.sumo_type[role] = sumo_bridge_type_id(impact->state[role].type);
        names.at_fault[role] = cp_controls_is_at_fault(run->controls, impact->vehicle[role]);
    }
    cp_crash_row *row = cp_result_rows_add_crash(run->results);
    if (row == NULL)
        return cp_fail_memory(error, "crash");
    return cp_crash_record_fill(impact, &names, run->fleet, row, error);
}

static cp_status record_contact(replication_run *run, const cp_impact *impact, const char *verdict,
                                cp_error *error)
{
    cp_contact_row *row = cp_result_rows_add_contact(run->results);
    if (row == NULL)
        return cp_fail_memory(error, "contact");
    row->time_s = impact->time_s;
    row->contact_m = impact->contact_m;
    row->verdict = verdict;
    for (int role = 0; role < 2; role++) {
        row->vehicle[role] = strdup(sumo_bridge_vehicle_id(impact->vehicle[role]));
        if (row->vehicle[role] == NULL)
            return cp_fail_memory(error, "contact");
    }
    return CP_OK;
}

// A confirmed impact is a crash, unless one of the two had its crash earlier in this step or the
// traffic is still warming up.
static cp_status take_impact(replication_run *run, const cp_impact *impact, cp_error *error)
{
    const char *found_as = FOUND_CRASH;
    if (impact->verdict != CP_CONTACT_CONFIRMED)
        found_as = cp_contact_verdict_text(impact->verdict);
    else if (has_crashed(run, impact->vehicle[0]) || has_crashed(run, impact->vehicle[1]))
        found_as = VERDICT_AFTER_CRASH;
    else if (impact->time_s < run->counted_from_s)
        found_as = VERDICT_WARMUP;

    cp_status status = found_as == FOUND_CRASH ? record_crash(run, impact, error)
                                               : record_contact(run, impact, found_as, error);
    if (status == CP_OK)
        status = cp_cross_check_add_contact(&run->check, impact->vehicle[0], impact->vehicle[1],
                                            found_as, impact->time_s, error);
    for (int role = 0; status == CP_OK && role < 2; role++)
        if (impact->verdict == CP_CONTACT_CONFIRMED && !has_crashed(run, impact->vehicle[role]))
            status = remember_crashed(run, impact->vehicle[role], error);
    return status;
}

static cp_status take_impacts(replication_run *run, cp_error *error)
{
    const cp_impact *impacts = NULL;
    size_t count = 0;
    run->crashed_count = 0;
    cp_status status = cp_detector_step(run->detector, run->traffic, cp_controls_is_at_fault,
                                        run->controls, &impacts, &count, error);
    for (size_t k = 0; status == CP_OK && k < count; k++)
        status = take_impact(run, &impacts[k], error);
    return status;
}

static cp_status take_sumo_collisions(replication_run *run, cp_error *error)
{
    const cp_sumo_collision *collisions = NULL;
    size_t count = 0;
    cp_status status = sumo_bridge_collisions(&collisions, &count, error);
    for (size_t k = 0; status == CP_OK && k < count; k++)
        status =
            cp_cross_check_add_report(&run->check, collisions[k].collider, collisions[k].victim,
                                      collisions[k].type, cp_traffic_time_s(run->traffic), error);
    return status;
}

// ---- the step loop -------------------------------------------------------------------------

static cp_status step(replication_run *run, cp_error *error)
{
    cp_status status = cp_traffic_step(run->traffic, error);
    if (status == CP_OK)
        status = cp_controls_step(run->controls, error);
    if (status == CP_OK)
        status = take_impacts(run, error);
    if (status == CP_OK)
        status = take_sumo_collisions(run, error);

    // Crashed cars leave the road; what happens to it afterwards is another study's question.
    for (size_t k = 0; status == CP_OK && k < run->crashed_count; k++)
        status = cp_traffic_remove(run->traffic, run->crashed[k], error);
    return status;
}

static cp_status run_steps(replication_run *run, const cp_study *study, cp_error *error)
{
    long long steps = llround(study->duration_s / study->step_length_s);
    long long warmup_steps = llround(study->warmup_s / study->step_length_s);
    long long done = 0;
    cp_exposure before = {0};
    cp_status status = CP_OK;
    run->counted_from_s = cp_traffic_time_s(run->traffic) + study->warmup_s;
    while (status == CP_OK && done < steps && (done == 0 || !cp_traffic_finished(run->traffic))) {
        if (done == warmup_steps)
            before = cp_traffic_exposure(run->traffic);
        status = step(run, error);
        done++;
    }
    if (status != CP_OK)
        return status;
    if (done <= warmup_steps) // the traffic ended before it counted
        before = cp_traffic_exposure(run->traffic);
    cp_exposure after = cp_traffic_exposure(run->traffic);
    long long counted = done > warmup_steps ? done - warmup_steps : 0;
    run->results->simulated_s = (double)counted * study->step_length_s;
    run->results->vehicle_km = after.vehicle_km - before.vehicle_km;
    run->results->vehicle_h = after.vehicle_h - before.vehicle_h;
    run->results->departed = after.departed - before.departed;
    return CP_OK;
}

// ---- what is left to say at the end --------------------------------------------------------

static cp_status record_cross_check(replication_run *run, const cp_replication_row *replication,
                                    cp_error *error)
{
    cp_cross_check_match(&run->check);
    for (size_t k = 0; k < run->check.sumo_count; k++) {
        cp_cross_check_pair *pair = &run->check.sumo[k];
        cp_sumo_collision_row *row = cp_result_rows_add_sumo_collision(run->results);
        if (row == NULL)
            return cp_fail_memory(error, "collision of SUMO");
        row->time_s = pair->time_s;
        row->collider = strdup(sumo_bridge_vehicle_id(pair->collider));
        row->victim = strdup(sumo_bridge_vehicle_id(pair->victim));
        row->type = strdup(pair->type);
        row->found_as = pair->found_as;
        if (row->collider == NULL || row->victim == NULL || row->type == NULL)
            return cp_fail_memory(error, "collision of SUMO");
        if (strcmp(pair->found_as, FOUND_CRASH) != 0)
            cp_log_info("scenario %s, seed %llu: SUMO reports a collision (%s) of %s and %s at "
                        "%.2f s, not counted: %s",
                        run->scenario->name, (unsigned long long)replication->seed, row->type,
                        row->collider, row->victim, row->time_s, row->found_as);
    }
    return CP_OK;
}

static cp_status record_versions(replication_run *run, cp_error *error)
{
    run->results->sumo_version = strdup(sumo_bridge_version());
    run->results->sumo_command_line = strdup(sumo_bridge_command_line());
    if (run->results->sumo_version == NULL || run->results->sumo_command_line == NULL)
        return cp_fail_memory(error, "SUMO's command line");
    return cp_controls_counters_json(run->controls, &run->results->counters, error);
}

// ---- public --------------------------------------------------------------------------------

cp_status cp_replication_run(const cp_study *study, const cp_fleet *fleet,
                             const cp_replication_row *replication, cp_result_rows *results,
                             cp_error *error)
{
    const cp_study_scenario *scenario = &study->scenarios[replication->scenario];
    replication_run run = {.fleet = fleet, .scenario = scenario, .results = results};
    cp_status status = start_traffic(study, scenario, replication->seed, &run.traffic, error);
    if (status == CP_OK)
        status = create_controls(study, scenario, &study->variants[replication->variant],
                                 replication->seed, run.traffic, &run.controls, error);
    if (status == CP_OK)
        status = cp_detector_create(&run.detector, error);
    if (status == CP_OK)
        status = run_steps(&run, study, error);
    if (status == CP_OK)
        status = record_cross_check(&run, replication, error);
    if (status == CP_OK)
        status = record_versions(&run, error);
    run_destroy(&run);
    return status;
}

cp_status cp_replication_probe(const cp_study *study, const cp_study_scenario *scenario,
                               cp_error *error)
{
    cp_traffic *traffic = NULL;
    cp_status status = start_traffic(study, scenario, 1, &traffic, error);
    if (status == CP_OK)
        status = cp_traffic_step(traffic, error);

    // Parameters may be good one by one and contradict each other: the controls themselves know.
    for (size_t k = 0; status == CP_OK && k < study->variant_count; k++) {
        cp_controls *controls = NULL;
        status =
            create_controls(study, scenario, &study->variants[k], 1, traffic, &controls, error);
        cp_controls_destroy(controls);
        if (status != CP_OK)
            cp_error_prefix(error, "variant %s: ", study->variants[k].name);
    }
    cp_traffic_destroy(traffic);

    // Whatever keeps a scenario from starting is for its author to mend.
    if (status == CP_TRAFFIC_FAILED) {
        error->status = CP_BAD_INPUT;
        status = CP_BAD_INPUT;
    }
    return status;
}
