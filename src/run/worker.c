/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/worker.h"

#include "core/progress.h"
#include "crash/crash_simulation.h"
#include "run/background.h"
#include "run/fleet.h"
#include "run/owner.h"
#include "run/replication.h"
#include "run/vehicle_types.h"
#include "store/claim.h"
#include "store/stored_crash.h"
#include "study/scenario_files.h"

// Claim with a connection of its own: none stays open while the replication runs.
static cp_status claim(const char *db_path, const cp_replication_row *replication, int *attempt,
                       cp_error *error)
{
    cp_store *store = NULL;
    cp_owner self;
    cp_status status = cp_owner_self(&self, error);
    if (status == CP_OK)
        status = cp_store_open(db_path, CP_STORE_WRITE, &store, error);
    if (status == CP_OK)
        status = cp_claim_take(store, replication->id, replication->configuration_hash, &self,
                               attempt, error);
    cp_store_close(store);
    return status;
}

static cp_status commit(const char *db_path, const cp_result_rows *results, cp_error *error)
{
    cp_store *store = NULL;
    cp_status status = cp_store_open(db_path, CP_STORE_WRITE, &store, error);
    if (status == CP_OK)
        status = cp_result_rows_commit(store, results, error);
    cp_store_close(store);
    return status;
}

static cp_status run_claimed(const cp_study *study, const cp_fleet *fleet,
                             const cp_replication_row *replication, int attempt,
                             const char *db_path, cp_error *error)
{
    cp_result_rows results = {.replication_id = replication->id, .attempt = attempt};
    double started_s = cp_clock_s();
    cp_status status = cp_crash_library_begin(error);
    if (status != CP_OK)
        return status;
    cp_crash_options options = cp_crash_options_default();
    results.crash_options = cp_crash_options_json(&options);
    status = results.crash_options != NULL
                 ? cp_replication_run(study, fleet, replication, &results, error)
                 : cp_fail_memory(error, "crash options");
    if (status == CP_OK)
        status = cp_vehicle_types_add(&results, error);
    cp_crash_library_end();
    results.wall_time_s = cp_clock_s() - started_s;
    if (status == CP_OK)
        status = commit(db_path, &results, error);
    cp_result_rows_destroy(&results);
    return status;
}

cp_status cp_worker_run(const char *study_path, const char *db_path, int64_t replication_id,
                        int *elsewhere, cp_error *error)
{
    cp_study study = {0};
    cp_fleet fleet = {0};
    cp_plan_rows plan = {0};
    int attempt = 0;
    *elsewhere = 0;
    cp_status status = cp_study_load(study_path, &study, error);
    if (status == CP_OK)
        status = cp_fleet_load(&study, &fleet, error);
    if (status == CP_OK)
        status = cp_plan_create_for(&study, fleet.rows, fleet.count, replication_id, &plan, error);
    if (status != CP_OK)
        goto done;

    // The plan is made anew from the files: if they changed since, it does not have this
    // replication or has it with another configuration hash.
    const cp_replication_row *replication = cp_plan_find(&plan, replication_id);
    if (replication == NULL) {
        status = cp_fail(error, CP_BAD_INPUT, "%s: was changed during the run", study_path);
        goto done;
    }
    status = claim(db_path, replication, &attempt, error);
    *elsewhere = status == CP_OK && attempt == 0;
    if (status == CP_OK && attempt > 0)
        status = run_claimed(&study, &fleet, replication, attempt, db_path, error);
done:
    cp_plan_destroy(&plan);
    cp_fleet_destroy(&fleet);
    cp_study_destroy(&study);
    return status;
}

cp_status cp_worker_probe(const char *study_path, const char *scenario, cp_error *error)
{
    cp_study study = {0};
    cp_status status = cp_study_load(study_path, &study, error);
    if (status != CP_OK)
        return status;
    const cp_study_scenario *found = cp_study_find_scenario(&study, scenario);
    status = found != NULL
                 ? cp_replication_probe(&study, found, error)
                 : cp_fail(error, CP_BAD_INPUT, "%s: has no scenario '%s'", study_path, scenario);
    cp_study_destroy(&study);
    return status;
}

cp_status cp_worker_background(const char *path, const char *scenario, uint64_t seed,
                               double step_length_s, double duration_s, const char *result_path,
                               cp_error *error)
{
    cp_study study = {0};
    cp_study_scenario bare = {.sumocfg_path = (char *)path};
    cp_background_options options = {.network = path,
                                     .scenario = &bare,
                                     .seed = seed,
                                     .step_length_s = step_length_s,
                                     .duration_s = duration_s};
    cp_status status = CP_OK;
    if (scenario != NULL) {
        status = cp_study_load(path, &study, error);
        if (status != CP_OK)
            return status;
        options.network = scenario;
        options.scenario = cp_study_find_scenario(&study, scenario);
        options.step_length_s = study.step_length_s;
        if (options.scenario == NULL)
            status = cp_fail(error, CP_BAD_INPUT, "%s: has no scenario '%s'", path, scenario);
    } else {
        status = cp_scenario_loads_no_state(path, error);
    }
    if (status == CP_OK)
        status = cp_background_run(&options, result_path, error);
    cp_study_destroy(&study);
    return status;
}
