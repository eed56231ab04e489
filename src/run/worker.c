/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/worker.h"

#include "control/acting.h"
#include "core/file.h"
#include "core/progress.h"
#include "crash/crash_simulation.h"
#include "run/background.h"
#include "run/confinement.h"
#include "run/fleet_car.h"
#include "run/owner.h"
#include "run/replication.h"
#include "run/vehicle_types.h"
#include "store/claim.h"
#include "store/stored_crash.h"
#include "study/plan.h"
#include "study/study_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Before SUMO reads what others wrote. SQLite's own temporary files go where the database is, the
// only other place that is left.
static cp_status confine(const char *sumocfg_path, const char *db_path, const char *result_path,
                         cp_error *error)
{
    char *own = cp_file_beside(sumocfg_path, ".");
    char *of_db = cp_file_beside(db_path != NULL ? db_path : sumocfg_path, ".");
    const char *folders[] = {own, of_db, result_path};
    cp_status status = CP_OK;
    if (own == NULL || of_db == NULL || setenv("SQLITE_TMPDIR", of_db, 1) != 0)
        status = cp_fail_memory(error, sumocfg_path);
    else
        status = cp_confine(folders, result_path != NULL ? 3 : 2, error);
    free(own);
    free(of_db);
    return status;
}

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

// Libraries are loaded when that is allowed, and watched.
static cp_status admit_libraries(const cp_study *study, bool allow_plugins, cp_error *error)
{
    const cp_study_variant *variant = NULL;
    const cp_library *library = cp_study_library(study, 0, &variant);
    if (library == NULL)
        return CP_OK;
    if (!allow_plugins)
        return cp_fail(error, CP_BAD_INPUT, "%s: variant %s loads %s, which is not allowed",
                       study->path, variant->name, library->written);
    return cp_acting_watch(CP_WORKER_REPORT_FD, error);
}

cp_status cp_worker_run(const char *study_path, const char *db_path, int64_t replication_id,
                        bool free_outputs, bool allow_plugins, int *elsewhere, cp_error *error)
{
    cp_study study = {0};
    cp_fleet fleet = {0};
    cp_plan_rows plan = {0};
    int attempt = 0;
    *elsewhere = 0;
    cp_status status = cp_study_load(study_path, &study, error);
    if (status == CP_OK)
        status = admit_libraries(&study, allow_plugins, error);
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
    if (!free_outputs)
        status = confine(study.scenarios[replication->scenario].sumocfg_path, db_path, NULL, error);
    if (status == CP_OK)
        status = claim(db_path, replication, &attempt, error);
    *elsewhere = status == CP_OK && attempt == 0;
    cp_fleet_begin(&fleet, replication->number);
    if (status == CP_OK && attempt > 0)
        status = run_claimed(&study, &fleet, replication, attempt, db_path, error);
done:
    cp_plan_destroy(&plan);
    cp_fleet_destroy(&fleet);
    cp_study_destroy(&study);
    return status;
}

cp_status cp_worker_probe(const char *study_path, const char *scenario, bool free_outputs,
                          cp_error *error)
{
    cp_study study = {0};
    cp_status status = cp_study_load(study_path, &study, error);
    if (status != CP_OK)
        return status;
    const cp_study_scenario *found = cp_study_find_scenario(&study, scenario);
    if (found == NULL)
        status = cp_fail(error, CP_BAD_INPUT, "%s: has no scenario '%s'", study_path, scenario);
    else if (!free_outputs)
        status = confine(found->sumocfg_path, NULL, NULL, error);
    if (status == CP_OK)
        status = cp_replication_probe(&study, found, error);
    cp_study_destroy(&study);
    return status;
}

// ---- backgrounds ---------------------------------------------------------------------------

// In the names of files that SUMO writes; no variant can be called so.
static const char BACKGROUND_NAME[] = "@background";

// Before minutes of simulation: has the database a place for the result?
static cp_status check_place(const cp_background_job *job, cp_error *error)
{
    cp_store *store = NULL;
    if (job->db_path == NULL)
        return CP_OK;
    cp_status status = cp_store_open(job->db_path, CP_STORE_WRITE, &store, error);
    if (status == CP_OK)
        status = cp_background_rows_check(store, job->scenario, error);
    cp_store_close(store);
    return status;
}

static cp_status run_background(const cp_background_job *job, const cp_background_options *options,
                                const char *configuration_hash, cp_error *error)
{
    cp_background_rows rows = {0};
    cp_cross_check check = {0};
    cp_store *store = NULL;
    snprintf(rows.configuration_hash, sizeof rows.configuration_hash, "%s", configuration_hash);
    cp_status status = CP_OK;
    if (!job->free_outputs)
        status = confine(options->sumo.sumocfg_path, job->db_path, job->result_path, error);
    if (status == CP_OK)
        status = check_place(job, error);
    if (status == CP_OK)
        status = cp_background_run(options, &rows, &check, error);
    if (status == CP_OK && job->db_path != NULL) {
        status = cp_store_open(job->db_path, CP_STORE_WRITE, &store, error);
        if (status == CP_OK)
            status = cp_background_rows_write(store, &rows, error);
        cp_store_close(store);
    }
    if (status == CP_OK && job->result_path != NULL)
        status = cp_background_write_json(&rows, &check, job->result_path, error);
    cp_cross_check_destroy(&check);
    cp_background_rows_destroy(&rows);
    return status;
}

static cp_status study_background(const cp_background_job *job, const cp_study *study,
                                  cp_error *error)
{
    cp_background_plan_row own;
    const cp_study_scenario *scenario = cp_study_find_scenario(study, job->scenario);
    if (scenario == NULL)
        return cp_fail(error, CP_BAD_INPUT, "%s: has no scenario '%s'", job->path, job->scenario);
    // The first of the study's own runs, or the one with the seed that is asked for.
    size_t index = (size_t)(scenario - study->scenarios), number = 0;
    for (size_t k = 1; job->seed != NULL && k < study->background_seeds; k++)
        if (cp_plan_seed(study, index, cp_study_baseline(study), k) == *job->seed)
            number = k;
    cp_status status = cp_plan_background(study, index, number, &own, error);
    if (status != CP_OK)
        return status;
    if (job->expected_hash != NULL && strcmp(job->expected_hash, own.configuration_hash) != 0)
        return cp_fail(error, CP_BAD_INPUT, "%s: was changed during the run", job->path);

    // The study's own run, unless seed or length are others.
    cp_background_options options = {.network = scenario->name,
                                     .sumo = {.sumocfg_path = scenario->sumocfg_path,
                                              .options = scenario->sumo_options,
                                              .option_count = scenario->sumo_option_count,
                                              .scenario = scenario->name,
                                              .variant = BACKGROUND_NAME},
                                     .seed = job->seed != NULL ? *job->seed : own.seed,
                                     .step_length_s = study->step_length_s,
                                     .duration_s =
                                         isnan(job->duration_s) ? own.duration_s : job->duration_s,
                                     .warmup_s = study->warmup_s,
                                     .stay_s = study->stay_s};
    bool is_own = options.seed == own.seed && options.duration_s == own.duration_s;
    return run_background(job, &options, is_own ? own.configuration_hash : "", error);
}

cp_status cp_worker_background(const cp_background_job *job, cp_error *error)
{
    if (job->scenario == NULL) {
        cp_background_options options = {
            .network = job->path,
            .sumo = {.sumocfg_path = job->path, .variant = BACKGROUND_NAME},
            .seed = *job->seed,
            .step_length_s = job->step_length_s,
            .duration_s = job->duration_s};
        return run_background(job, &options, "", error);
    }
    cp_study study = {0};
    cp_status status = cp_study_load(job->path, &study, error);
    if (status == CP_OK)
        status = study_background(job, &study, error);
    cp_study_destroy(&study);
    return status;
}
