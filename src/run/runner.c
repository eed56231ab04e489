/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/runner.h"

#include "core/log.h"
#include "core/memory_stream.h"
#include "core/progress.h"
#include "run/child.h"
#include "run/confinement.h"
#include "run/fleet.h"
#include "run/owner.h"
#include "run/shard.h"
#include "run/signals.h"
#include "run/worker.h"
#include "store/background_rows.h"
#include "store/claim.h"
#include "store/query.h"
#include "study/controls_text.h"
#include "study/occasions.h"
#include "study/scenario_outputs.h"
#include "study/study_file.h"
#include "study/type_mapping.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define PATH_SIZE 4096
#define SHORTEST_TIME_LIMIT_S 600.0

// A worker and what it works on.
typedef struct runner_job {
    cp_child child;
    const cp_background_plan_row *background; /* NULL: a replication */
    int64_t replication_id;
} runner_job;

typedef struct runner {
    const cp_runner_options *options;
    cp_runner_summary *summary;
    cp_shard shard;
    char worker_path[PATH_SIZE];
    char parent[32]; /* our pid, for the workers to follow */
    cp_owner self;
    cp_study study;
    cp_fleet fleet;
    cp_plan_rows plan;
    cp_store *store;
    int64_t *waiting; /* replications still to start: waiting[next ...] */
    size_t waiting_count;
    size_t next;
    cp_said said;             /* by workers, passed on once */
    bool *background_missing; /* of each of plan.background: to run, by us, and not yet started */
    runner_job *jobs;
    size_t running;
    cp_signals signals;
    bool interrupted;
    double time_limit_s; /* of one replication */
    char first_failure[512];
    cp_progress progress;
} runner;

// ---- preparation ---------------------------------------------------------------------------

static cp_status find_worker(runner *run, cp_error *error)
{
    cp_status status =
        cp_child_find_worker(run->options->worker_path, run->worker_path, PATH_SIZE, error);
    if (status != CP_OK)
        return status;
    snprintf(run->parent, sizeof run->parent, "%ld", (long)getpid());
    return cp_owner_self(&run->self, error);
}

static cp_status load_inputs(runner *run, cp_error *error)
{
    cp_status status = cp_study_load(run->options->study_path, &run->study, error);
    if (status == CP_OK)
        status = cp_fleet_load(&run->study, &run->fleet, error);
    if (status == CP_OK)
        status = cp_plan_create(&run->study, run->fleet.rows, run->fleet.count, &run->plan, error);
    run->time_limit_s = run->options->time_limit_s;
    if (run->time_limit_s <= 0.0)
        run->time_limit_s = fmax(SHORTEST_TIME_LIMIT_S,
                                 10.0 * fmax(run->study.duration_s, run->study.background_s));
    for (size_t k = 0; k < run->plan.replication_count; k++)
        run->summary->replications += cp_shard_has(&run->shard, k);
    return status;
}

// For a worker; NULL, the end of its words: it is confined.
static const char *outputs_word(const runner *run)
{
    return run->options->free_outputs ? "--allow-sumo-outputs" : NULL;
}

// Let a worker start one scenario: only it can load SUMO.
static cp_status probe_scenario(runner *run, const cp_study_scenario *scenario, cp_error *error)
{
    const char *arguments[] = {"crashpulse-worker", "--study",         run->options->study_path,
                               "--probe",           scenario->name,    "--parent",
                               run->parent,         outputs_word(run), NULL};
    cp_child child;
    cp_child_end end;
    cp_status status = cp_child_start(run->worker_path, arguments, &child, error);
    if (status != CP_OK)
        return status;
    child.said = &run->said;
    cp_child_wait(&child, run->time_limit_s, &end);
    if (end.exit_code == 0)
        return CP_OK;
    return cp_fail(error, end.exit_code == 2 ? CP_BAD_INPUT : CP_RUN_FAILED,
                   "%s: scenario %s does not start: %s", run->options->study_path, scenario->name,
                   end.reason);
}

static cp_status check_outputs(const cp_study_scenario *scenario, cp_error *error)
{
    const cp_scenario_inputs inputs = cp_study_scenario_inputs(scenario);
    return cp_scenario_outputs_check(&inputs, error);
}

// Code of somebody else's is loaded only when that is asked for.
static cp_status check_libraries(const runner *run, cp_error *error)
{
    const cp_study_variant *variant = NULL;
    const cp_library *library = cp_study_library(&run->study, 0, &variant);
    if (library == NULL || run->options->allow_plugins)
        return CP_OK;
    return cp_fail(error, CP_BAD_INPUT,
                   "%s: variant %s loads code of its own, %s (%s); give --allow-plugins only to a "
                   "study whose libraries you would run yourself ('crashpulse plan' lists them)",
                   run->options->study_path, variant->name, library->written, library->path);
}

// Of the values of a sweep one is enough, unless SUMO is started otherwise for each.
static cp_status probe_scenarios(runner *run, cp_error *error)
{
    const cp_study_scenario *scenarios = run->study.scenarios;
    bool is_free = run->options->free_outputs;
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < run->study.scenario_count; k++) {
        if (k > 0 && cp_study_scenarios_start_alike(&scenarios[k - 1], &scenarios[k]))
            continue;
        if (!is_free)
            status = check_outputs(&scenarios[k], error);
        if (status == CP_OK)
            status = probe_scenario(run, &scenarios[k], error);
    }
    if (status == CP_OK && !is_free && !cp_confinement_has_folders())
        cp_log_warning("this system cannot keep workers to folders (Landlock): what SUMO writes is "
                       "only looked for in its options and files");
    return status;
}

static cp_status find_backgrounds(runner *run, cp_error *error)
{
    run->background_missing =
        calloc(run->plan.background_count + 1, sizeof *run->background_missing);
    if (run->background_missing == NULL)
        return cp_fail_memory(error, "backgrounds");
    cp_status status = cp_background_rows_drop_stale(run->store, &run->plan, error);
    return status == CP_OK
               ? cp_background_rows_missing(run->store, &run->plan, run->background_missing, error)
               : status;
}

// Database, claims of the dead, plan, queue: in this order, so that what a dead worker held is
// planned again before the plan is compared.
static cp_status prepare_store(runner *run, cp_error *error)
{
    size_t released = 0;
    double done = 0.0;
    cp_status status = cp_store_open(run->options->db_path, CP_STORE_CREATE, &run->store, error);
    if (status == CP_OK && !run->options->unchecked)
        status = cp_store_check_damage(run->store, error);
    if (status == CP_OK)
        status = cp_claim_release_dead(run->store, cp_owner_is_alive, &released, error);
    if (status == CP_OK)
        status = cp_plan_rows_write(run->store, &run->plan, error);
    if (status == CP_OK)
        status = cp_claim_waiting(run->store, &run->waiting, &run->waiting_count, error);
    if (status == CP_OK)
        status = find_backgrounds(run, error);
    // Of what waits, our share; backgrounds are dealt out in turn too.
    for (size_t k = 0; status == CP_OK && k < run->plan.background_count; k++)
        run->background_missing[k] &= cp_shard_has(&run->shard, k);
    if (status == CP_OK && run->options->shards > 0)
        status = cp_shard_keep(&run->shard, &run->plan, run->waiting, &run->waiting_count, error);
    if (status == CP_OK)
        status = cp_query_number(
            run->store, "SELECT count(*) FROM replication WHERE status = 'done'", &done, error);
    run->summary->done_before = (size_t)done;
    if (status == CP_OK && run->options->shards > 0)
        run->summary->done_before = run->summary->replications - run->waiting_count;
    if (released > 0)
        cp_log_info("%zu replications of a run that ended early are run again", released);
    return status;
}

// ---- jobs ----------------------------------------------------------------------------------

// Until the first of the workers has to be done.
static double seconds_left(const runner *run)
{
    double first_s = INFINITY;
    for (size_t k = 0; k < run->options->jobs; k++)
        if (run->jobs[k].child.pid != 0)
            first_s = fmin(first_s, run->jobs[k].child.started_s + run->time_limit_s);
    return fmax(0.0, first_s - cp_clock_s());
}

// The next background to run; NULL when all are done or being run.
static const cp_background_plan_row *next_background(const runner *run)
{
    for (size_t k = 0; k < run->plan.background_count; k++)
        if (run->background_missing[k])
            return &run->plan.background[k];
    return NULL;
}

static cp_status start_background(runner *run, runner_job *job, cp_error *error)
{
    const cp_background_plan_row *row = next_background(run);
    char seed[32];
    snprintf(seed, sizeof seed, "%" PRIu64, row->seed);
    const char *arguments[] = {"crashpulse-worker",
                               "--background",
                               "--study",
                               run->options->study_path,
                               "--scenario",
                               run->plan.scenario[row->scenario].name,
                               "--seed",
                               seed,
                               "--db",
                               run->options->db_path,
                               "--expect",
                               row->configuration_hash,
                               "--parent",
                               run->parent,
                               outputs_word(run),
                               NULL};
    cp_status status = cp_child_start(run->worker_path, arguments, &job->child, error);
    job->child.said = &run->said;
    if (status != CP_OK)
        return status;
    job->background = row;
    run->background_missing[row - run->plan.background] = false;
    run->running++;
    return CP_OK;
}

static cp_status start_job(runner *run, runner_job *job, cp_error *error)
{
    char id[32];
    job->background = NULL;
    job->replication_id = run->waiting[run->next];
    snprintf(id, sizeof id, "%" PRId64, job->replication_id);
    const char *arguments[] = {"crashpulse-worker",
                               "--study",
                               run->options->study_path,
                               "--db",
                               run->options->db_path,
                               "--replication",
                               id,
                               "--parent",
                               run->parent,
                               NULL,
                               NULL,
                               NULL};
    size_t words = sizeof arguments / sizeof *arguments - 3;
    if (run->options->free_outputs)
        arguments[words++] = outputs_word(run);
    if (run->options->allow_plugins)
        arguments[words++] = "--allow-plugins";
    cp_status status = cp_child_start(run->worker_path, arguments, &job->child, error);
    job->child.said = &run->said;
    if (status != CP_OK)
        return status;
    run->next++;
    run->running++;
    return CP_OK;
}

static cp_status start_jobs(runner *run, cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < run->options->jobs; k++) {
        if (run->jobs[k].child.pid != 0)
            continue;
        if (next_background(run) != NULL)
            status = start_background(run, &run->jobs[k], error);
        else if (run->next < run->waiting_count)
            status = start_job(run, &run->jobs[k], error);
    }
    return status;
}

static void remember_failure(runner *run, int64_t replication_id, const char *reason)
{
    const cp_replication_row *row = cp_plan_find(&run->plan, replication_id);
    run->summary->failed++;
    if (run->first_failure[0] != '\0' || row == NULL)
        return;
    snprintf(run->first_failure, sizeof run->first_failure,
             "scenario %s, variant %s, seed %" PRIu64 ": %.300s",
             run->study.scenarios[row->scenario].name, run->study.variants[row->variant].name,
             row->seed, reason);
}

// A worker failed: its claim, or the replication it never came to claim, is marked so.
static cp_status record_failure(runner *run, int64_t replication_id, pid_t pid,
                                const cp_child_end *end, cp_error *error)
{
    bool ended = false;
    cp_status status =
        cp_claim_end_of(run->store, replication_id, run->self.host, pid, CP_CLAIM_FAILED,
                        end->wall_time_s, end->reason, &ended, error);
    if (status == CP_OK && !ended) {
        cp_owner worker = run->self;
        worker.pid = pid;
        status = cp_claim_record_failure(run->store, replication_id, &worker, end->wall_time_s,
                                         end->reason, error);
    }
    remember_failure(run, replication_id, end->reason);
    return status;
}

static void conclude_background(runner *run, const runner_job *job, const cp_child_end *end)
{
    if (end->exit_code == 0) {
        run->summary->backgrounds_done++;
        return;
    }
    run->summary->backgrounds_failed++;
    if (run->first_failure[0] == '\0')
        snprintf(run->first_failure, sizeof run->first_failure, "background of scenario %s: %.300s",
                 run->plan.scenario[job->background->scenario].name, end->reason);
}

static cp_status conclude_job(runner *run, const runner_job *job, pid_t pid,
                              const cp_child_end *end, cp_error *error)
{
    run->running--;
    if (job->background != NULL)
        conclude_background(run, job, end);
    else if (end->exit_code == 0)
        run->summary->done_now++;
    else if (end->exit_code == CP_WORKER_EXIT_ELSEWHERE)
        run->summary->elsewhere++;
    else
        return record_failure(run, job->replication_id, pid, end, error);
    return CP_OK;
}

static cp_status finish_job(runner *run, runner_job *job, int wait_status, cp_error *error)
{
    cp_child_end end;
    pid_t pid = job->child.pid;
    cp_child_collect(&job->child, wait_status, &end);
    return conclude_job(run, job, pid, &end, error);
}

// A worker that hangs is ended; its replication failed, the others go on.
static cp_status end_overdue_jobs(runner *run, cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < run->options->jobs; k++) {
        runner_job *job = &run->jobs[k];
        cp_child_end end;
        char why[64];
        pid_t pid = job->child.pid;
        if (pid == 0 || cp_clock_s() < job->child.started_s + run->time_limit_s)
            continue;
        snprintf(why, sizeof why, "no end after %g s (--time-limit)", run->time_limit_s);
        cp_child_kill(&job->child, why, &end);
        status = conclude_job(run, job, pid, &end, error);
    }
    return status;
}

static cp_status count_crashes(runner *run, cp_error *error)
{
    double crashes = 0.0;
    cp_status status = cp_query_number(run->store, "SELECT count(*) FROM crash", &crashes, error);
    run->summary->crashes = (size_t)crashes;
    return status;
}

static cp_status show_progress(runner *run, cp_error *error)
{
    char detail[64];
    const cp_runner_summary *summary = run->summary;
    if (!run->options->progress)
        return CP_OK;
    cp_status status = count_crashes(run, error);
    snprintf(detail, sizeof detail, "%zu crash%s", summary->crashes,
             summary->crashes == 1 ? "" : "es");
    if (status == CP_OK)
        cp_progress_update(&run->progress, summary->done_now + summary->failed + summary->elsewhere,
                           detail);
    return status;
}

static cp_status finish_ended_jobs(runner *run, cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < run->options->jobs; k++) {
        int wait_status = 0;
        runner_job *job = &run->jobs[k];
        if (job->child.pid == 0 || waitpid(job->child.pid, &wait_status, WNOHANG) <= 0)
            continue;
        status = finish_job(run, job, wait_status, error);
        if (status == CP_OK)
            status = show_progress(run, error);
    }
    return status;
}

// Stop all workers and give their replications back. What one of them committed stays done.
static void stop_jobs(runner *run)
{
    for (size_t k = 0; run->jobs != NULL && k < run->options->jobs; k++) {
        runner_job *job = &run->jobs[k];
        cp_child_end end;
        cp_error ignored = {0};
        bool ended = false;
        pid_t pid = job->child.pid;
        if (pid == 0)
            continue;
        cp_child_kill(&job->child, NULL, &end);
        run->running--;
        if (job->background != NULL)
            continue;
        cp_status status =
            cp_claim_end_of(run->store, job->replication_id, run->self.host, pid,
                            CP_CLAIM_INTERRUPTED, end.wall_time_s, NULL, &ended, &ignored);
        if (status != CP_OK) // the next run finds its owner dead
            cp_log_warning("%s", ignored.text);
        if (end.exit_code == 0)
            run->summary->done_now++;
    }
}

static cp_status run_jobs(runner *run, cp_error *error)
{
    run->jobs = calloc(run->options->jobs, sizeof *run->jobs);
    if (run->jobs == NULL)
        return cp_fail_memory(error, "jobs");
    cp_status status = cp_signals_begin(&run->signals, error);
    if (status != CP_OK)
        return status;
    if (run->options->progress)
        cp_progress_begin(&run->progress, "replications", run->waiting_count);
    while (status == CP_OK && !run->interrupted) {
        status = start_jobs(run, error);
        if (status != CP_OK || run->running == 0)
            break;
        status = cp_signals_wait(&run->signals, seconds_left(run), &run->interrupted, error);
        if (status == CP_OK)
            status = finish_ended_jobs(run, error);
        if (status == CP_OK)
            status = end_overdue_jobs(run, error);
    }
    stop_jobs(run);
    if (run->options->progress)
        cp_progress_end(&run->progress);
    return status;
}

// ---- public --------------------------------------------------------------------------------

// What drivers and functions the study has, a message a line.
static void tell_controls(const cp_study *study)
{
    char *text = NULL, *rest = NULL;
    size_t size = 0;
    FILE *out = cp_memory_stream(&text, &size);
    if (out == NULL)
        return;
    cp_controls_text_study(study, "", out);
    if (fclose(out) == 0)
        for (char *line = strtok_r(text, "\n", &rest); line != NULL;
             line = strtok_r(NULL, "\n", &rest))
            cp_log_info("%s", line);
    free(text);
}

// What is really run, and what is not as the files have it.
static cp_status tell_inputs(const cp_study *study, cp_error *error)
{
    tell_controls(study);
    cp_status status = cp_study_tell_occasions(study, error);
    return status == CP_OK ? cp_study_tell_options(study, error) : status;
}

static cp_status conclude(runner *run, cp_error *error)
{
    const cp_runner_summary *summary = run->summary;
    cp_status status = count_crashes(run, error);
    if (status != CP_OK)
        return status;
    if (run->interrupted)
        return cp_fail(error, CP_INTERRUPTED,
                       "interrupted with %zu of %zu replications done; the same command goes on "
                       "from there",
                       summary->done_before + summary->done_now, summary->replications);
    if (summary->failed == 0 && summary->backgrounds_failed > 0)
        return cp_fail(error, CP_RUN_FAILED,
                       "%zu of the networks' backgrounds failed (the same command tries them "
                       "again); the first: %s",
                       summary->backgrounds_failed, run->first_failure);
    if (summary->failed > 0)
        return cp_fail(error, CP_RUN_FAILED,
                       "%zu of %zu replications failed (why: table attempt, column message; the "
                       "same command tries them again); the first: %s",
                       summary->failed, summary->replications, run->first_failure);
    return CP_OK;
}

cp_status cp_runner_run(const cp_runner_options *options, cp_runner_summary *summary,
                        cp_error *error)
{
    runner run = {.options = options,
                  .summary = summary,
                  .shard = {options->shard, options->shards},
                  .signals = CP_SIGNALS_NONE};
    double started_s = cp_clock_s();
    *summary = (cp_runner_summary){0};
    if (options->jobs < 1)
        return cp_fail(error, CP_BAD_INPUT, "jobs must be at least 1");
    cp_status status = load_inputs(&run, error);
    if (status == CP_OK && options->progress)
        status = tell_inputs(&run.study, error);
    if (status == CP_OK)
        status = check_libraries(&run, error);
    if (status == CP_OK)
        status = find_worker(&run, error);
    if (status == CP_OK)
        status = probe_scenarios(&run, error);
    if (status == CP_OK)
        status = cp_study_check_types(&run.study, error);
    if (status == CP_OK)
        status = prepare_store(&run, error);
    if (status == CP_OK)
        status = run_jobs(&run, error);
    if (status == CP_OK)
        status = conclude(&run, error);
    summary->wall_time_s = cp_clock_s() - started_s;
    cp_signals_end(&run.signals);
    cp_said_destroy(&run.said);
    free(run.jobs);
    free(run.waiting);
    free(run.background_missing);
    cp_store_finish(run.store);
    cp_store_close(run.store);
    cp_plan_destroy(&run.plan);
    cp_fleet_destroy(&run.fleet);
    cp_study_destroy(&run.study);
    return status;
}
