/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/replication.h"

#include "core/log.h"
#include "run/contact_rows.h"
#include "run/counterfactual.h"
#include "run/crash_record.h"
#include "run/probe_outputs.h"
#include "run/simulation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A counted crash with all that the surrogate needs to know of it. */
typedef struct named_crash {
    const cp_found_contact *found; /* of the simulation, which finds no more */
    cp_impact_names names;         /* its texts are the following */
    char *id[2];                   /* owned */
    char *type[2];                 /* owned */
    char *lane[2];                 /* owned */
} named_crash;

// What is happening in a replication; what is known about it is const.
typedef struct replication_run {
    const cp_study *study;
    const cp_fleet *fleet;
    const cp_study_scenario *scenario;
    cp_simulation simulation;
    cp_treatment *treatment; /* of the counterfactual design; owned */
    cp_treatments treatments;
    cp_counterfactual *counterfactual; /* NULL in other designs */
    named_crash *named;                /* in the order they were found */
    size_t named_count;
    cp_result_rows *results;
} replication_run;

// ---- the step loop -------------------------------------------------------------------------

static cp_status step(replication_run *run, cp_error *error)
{
    cp_status status = cp_simulation_step(&run->simulation, error);
    if (status == CP_OK && run->counterfactual != NULL)
        status = cp_counterfactual_step(run->counterfactual, error);
    return status;
}

static cp_status run_steps(replication_run *run, cp_error *error)
{
    const cp_study *study = run->study;
    const cp_traffic *traffic = run->simulation.traffic;
    long long steps = llround(study->duration_s / study->step_length_s), done = 0;
    cp_status status = CP_OK;
    while (status == CP_OK && done < steps && (done == 0 || !cp_traffic_finished(traffic))) {
        status = step(run, error);
        done++;
    }
    if (status != CP_OK)
        return status;
    cp_exposure counted = cp_simulation_counted(&run->simulation, &run->results->simulated_s);
    run->results->vehicle_km = counted.vehicle_km;
    run->results->vehicle_h = counted.vehicle_h;
    run->results->departed = counted.departed;
    return CP_OK;
}

// ---- what was found ------------------------------------------------------------------------

static bool is_counted(const cp_found_contact *found)
{
    return found->found_as == CP_FOUND_CRASH;
}

// Number of a found crash among those that count.
static size_t number_of(const cp_simulation *simulation, size_t index)
{
    size_t number = 0;
    if (index == CP_FOLLOWS_NONE || !is_counted(&simulation->found[index]))
        return CP_FOLLOWS_NONE;
    for (size_t k = 0; k < index; k++)
        number += is_counted(&simulation->found[k]);
    return number;
}

// All that SUMO knows of the two cars of a crash, copied: it ends before the crash is simulated.
static cp_status name_crash(const replication_run *run, const cp_found_contact *found,
                            named_crash *named, cp_error *error)
{
    const cp_impact *impact = &found->impact;
    *named = (named_crash){.found = found, .names.sumocfg_path = run->simulation.sumocfg_path};
    for (int role = 0; role < 2; role++) {
        named->names.at_fault[role] = found->car[role].at_fault;
        named->names.had_crashed[role] = found->car[role].had_crashed;
        named->id[role] =
            strdup(cp_traffic_vehicle_id(run->simulation.traffic, impact->vehicle[role]));
        named->type[role] =
            strdup(cp_traffic_type_id(run->simulation.traffic, impact->state[role].type));
        named->lane[role] =
            strdup(cp_traffic_lane_id(run->simulation.traffic, impact->state[role].lane));
        if (named->id[role] == NULL || named->type[role] == NULL || named->lane[role] == NULL)
            return cp_fail_memory(error, "crash");
        named->names.lane[role] = named->lane[role];
        named->names.sumo_id[role] = named->id[role];
        named->names.sumo_type[role] = named->type[role];
        cp_status status = cp_traffic_type(run->simulation.traffic, named->type[role],
                                           &named->names.type[role], error);
        if (status != CP_OK)
            return status;
    }
    return CP_OK;
}

static cp_status name_crashes(replication_run *run, cp_error *error)
{
    const cp_simulation *simulation = &run->simulation;
    run->named = calloc(simulation->found_count + 1, sizeof *run->named);
    if (run->named == NULL)
        return cp_fail_memory(error, "crashes");
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < simulation->found_count; k++)
        if (is_counted(&simulation->found[k]))
            status = name_crash(run, &simulation->found[k], &run->named[run->named_count++], error);
    return status;
}

static void forget_names(replication_run *run)
{
    for (size_t k = 0; k < run->named_count; k++)
        for (int role = 0; role < 2; role++) {
            free(run->named[k].id[role]);
            free(run->named[k].type[role]);
            free(run->named[k].lane[role]);
        }
    free(run->named);
}

static cp_status record_crash(replication_run *run, const named_crash *named, cp_error *error)
{
    cp_simulation *simulation = &run->simulation;
    cp_crash_row *row = cp_result_rows_add_crash(run->results);
    if (row == NULL)
        return cp_fail_memory(error, "crash");
    cp_status status = cp_crash_record_fill(&named->found->impact, &named->names, run->fleet,
                                            CP_RECORD_ALL, row, error);
    row->follows = number_of(simulation, named->found->follows);
    if (status == CP_OK)
        status =
            cp_participant_rows_copy(&named->found->participants, false, &row->participants, error);
    if (simulation->history == NULL)
        return status;

    // The row takes the history over.
    cp_found_history *before = &simulation->before[run->results->crash_count - 1];
    row->history = before->rows;
    row->history_count = before->count;
    *before = (cp_found_history){.found = before->found};
    return status;
}

static cp_status record_crashes(replication_run *run, cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < run->named_count; k++)
        status = record_crash(run, &run->named[k], error);
    return status;
}

static cp_status record_contact(replication_run *run, const cp_found_contact *found,
                                cp_error *error)
{
    const cp_traffic *traffic = run->simulation.traffic;
    const char *const ids[2] = {cp_traffic_vehicle_id(traffic, found->impact.vehicle[0]),
                                cp_traffic_vehicle_id(traffic, found->impact.vehicle[1])};
    return cp_contact_rows_add(run->results, &found->impact, cp_found_as_text(found->found_as), ids,
                               error);
}

static cp_status record_contacts(replication_run *run, cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < run->simulation.found_count; k++)
        if (!is_counted(&run->simulation.found[k]))
            status = record_contact(run, &run->simulation.found[k], error);
    return status;
}

static cp_status record_counterfactual(replication_run *run, cp_error *error)
{
    cp_result_rows *results = run->results;
    if (run->counterfactual == NULL)
        return CP_OK;
    results->counterfactual = calloc(1, sizeof *results->counterfactual);
    if (results->counterfactual == NULL)
        return cp_fail_memory(error, "counterfactual pairs");
    return cp_counterfactual_conclude(run->counterfactual, run->fleet, results->crash,
                                      results->crash_count, results->counterfactual, error);
}

// ---- what is left to say at the end --------------------------------------------------------

static cp_status record_cross_check(replication_run *run, const cp_replication_row *replication,
                                    cp_error *error)
{
    cp_cross_check *check = &run->simulation.check;
    const cp_traffic *traffic = run->simulation.traffic;
    size_t unexplained = 0, first = 0;
    cp_status status = CP_OK;
    cp_cross_check_match(check);
    for (size_t k = 0; status == CP_OK && k < check->sumo_count; k++) {
        const cp_cross_check_pair *pair = &check->sumo[k];
        const cp_reported_collision report = {
            .time_s = pair->time_s,
            .collider = cp_traffic_vehicle_id(traffic, pair->collider),
            .victim = cp_traffic_vehicle_id(traffic, pair->victim),
            .type = pair->type,
            .found_as = cp_found_as_text(pair->found_as),
            .gap_m = pair->gap_m};
        status = cp_contact_rows_add_report(run->results, &report, error);
        bool is_apart = isfinite(pair->gap_m) && pair->gap_m > 0.0;
        if (pair->found_as == CP_FOUND_NO_CONTACT && !is_apart && unexplained++ == 0)
            first = run->results->sumo_collision_count - 1;
    }
    if (status != CP_OK)
        return status;
    // All are stored with what they were found as; what nothing explains is said.
    if (unexplained > 0) {
        const cp_sumo_collision_row *row = &run->results->sumo_collision[first];
        cp_log_warning(
            "scenario %s, seed %llu: %zu of SUMO's collisions are in no contact of ours, "
            "first (%s) of %s and %s at %.2f s",
            run->scenario->name, (unsigned long long)replication->seed, unexplained, row->type,
            row->collider, row->victim, row->time_s);
    }
    return CP_OK;
}

static cp_status record_versions(replication_run *run, cp_error *error)
{
    run->results->sumo_version = strdup(cp_traffic_version(run->simulation.traffic));
    run->results->sumo_command_line = strdup(cp_traffic_command_line(run->simulation.traffic));
    if (run->results->sumo_version == NULL || run->results->sumo_command_line == NULL)
        return cp_fail_memory(error, "SUMO's command line");
    return cp_controls_counters_json(run->simulation.controls, &run->results->counters, error);
}

// ---- what a study asks for -----------------------------------------------------------------

// variant: NULL: a probe's, without functions.
static cp_simulation_settings settings_of(const cp_study *study, const cp_study_scenario *scenario,
                                          const cp_study_variant *variant, uint64_t seed)
{
    return (cp_simulation_settings){.sumo = {.sumocfg_path = scenario->sumocfg_path,
                                             .options = scenario->sumo_options,
                                             .option_count = scenario->sumo_option_count,
                                             .scenario = scenario->name,
                                             .variant = variant != NULL ? variant->name : NULL},
                                    .drivers = scenario->driver_errors,
                                    .driver_count = scenario->driver_error_count,
                                    .functions = variant != NULL ? variant->functions : NULL,
                                    .function_count = variant != NULL ? variant->function_count : 0,
                                    .is_treated = study->design == CP_DESIGN_COUNTERFACTUAL,
                                    .study_seed = study->seed,
                                    .seed = seed,
                                    .step_length_s = study->step_length_s,
                                    .warmup_s = study->warmup_s,
                                    .stay_s = study->stay_s,
                                    .history_s = study->history_s};
}

// Every variant but the baseline is a treatment, in the order of the study.
static cp_status begin_counterfactual(replication_run *run, uint64_t seed, cp_error *error)
{
    const cp_study *study = run->study;
    size_t baseline = cp_study_baseline(study);
    if (study->design != CP_DESIGN_COUNTERFACTUAL)
        return CP_OK;
    run->treatment = calloc(study->variant_count, sizeof *run->treatment);
    if (run->treatment == NULL)
        return cp_fail_memory(error, "treatments");
    run->treatments = (cp_treatments){.baseline = study->variants[baseline].name,
                                      .treatment = run->treatment,
                                      .timing = study->counterfactual,
                                      .study_seed = study->seed,
                                      .seed = seed};
    for (size_t k = 0; k < study->variant_count; k++) {
        const cp_study_variant *variant = &study->variants[k];
        if (k != baseline)
            run->treatment[run->treatments.count++] =
                (cp_treatment){variant->name, variant->functions, variant->function_count};
    }
    return cp_counterfactual_create(&run->treatments, &run->simulation, &run->counterfactual,
                                    error);
}

// ---- public --------------------------------------------------------------------------------

cp_status cp_replication_run(const cp_study *study, const cp_fleet *fleet,
                             const cp_replication_row *replication, cp_result_rows *results,
                             cp_error *error)
{
    const cp_study_scenario *scenario = &study->scenarios[replication->scenario];
    replication_run run = {
        .study = study, .fleet = fleet, .scenario = scenario, .results = results};
    cp_simulation_settings settings =
        settings_of(study, scenario, &study->variants[replication->variant], replication->seed);
    cp_status status = cp_simulation_begin(&settings, &run.simulation, error);
    if (status == CP_OK)
        status = begin_counterfactual(&run, replication->seed, error);
    if (status == CP_OK)
        status = run_steps(&run, error);

    // All that SUMO has to say.
    if (status == CP_OK)
        status = name_crashes(&run, error);
    if (status == CP_OK)
        status = record_contacts(&run, error);
    if (status == CP_OK)
        status = record_cross_check(&run, replication, error);
    if (status == CP_OK)
        status = record_versions(&run, error);

    // The surrogate runs when the traffic is over: nothing of it is in the way of a branch, and its
    // pulses take the room that SUMO had.
    if (status == CP_OK && run.counterfactual == NULL)
        cp_simulation_end_traffic(&run.simulation);
    if (status == CP_OK)
        status = record_crashes(&run, error);
    if (status == CP_OK)
        status = record_counterfactual(&run, error);
    forget_names(&run);
    cp_counterfactual_destroy(run.counterfactual);
    free(run.treatment);
    cp_simulation_end(&run.simulation);
    return status;
}

// Parameters may be good one by one and contradict each other: the function itself knows. Libraries
// are not loaded here: what is wrong with them fails their own replications.
static cp_status try_functions(const cp_study *study, const cp_study_variant *variant,
                               const cp_traffic *traffic, cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < variant->function_count; k++) {
        cp_controls *controls = NULL;
        if (variant->functions[k].library != NULL)
            continue;
        status = cp_controls_create(&variant->functions[k], 1, study->seed, 1, traffic, &controls,
                                    error);
        cp_controls_destroy(controls);
    }
    if (status != CP_OK)
        cp_error_prefix(error, "variant %s: ", variant->name);
    return status;
}

cp_status cp_replication_probe(const cp_study *study, const cp_study_scenario *scenario,
                               cp_error *error)
{
    cp_simulation simulation;
    cp_simulation_settings settings = settings_of(study, scenario, NULL, 1);
    cp_status status = cp_simulation_begin(&settings, &simulation, error);
    if (status == CP_OK)
        status = cp_traffic_step(simulation.traffic, error);

    for (size_t k = 0; status == CP_OK && k < study->variant_count; k++)
        status = try_functions(study, &study->variants[k], simulation.traffic, error);
    cp_probe_outputs_delete(scenario->name);
    cp_simulation_end(&simulation);

    // Whatever keeps a scenario from starting is for its author to mend.
    if (status == CP_TRAFFIC_FAILED) {
        error->status = CP_BAD_INPUT;
        status = CP_BAD_INPUT;
    }
    return status;
}
