/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/log.h"
#include "core/memory.h"
#include "run/worker.h"

#include <argp.h>
#include <fcntl.h>
#include <inttypes.h>
#include <jansson.h>
#include <math.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <unistd.h>

typedef struct worker_arguments {
    const char *study;
    const char *db;
    const char *replication;
    const char *probe;
    const char *parent;
    const char *background; /* where its result goes */
    const char *expect;
    const char *sumocfg;
    const char *scenario;
    const char *seed;
    const char *step_length;
    const char *duration;
    bool free_outputs;
    bool allow_plugins;
} worker_arguments;

static const struct argp_option OPTIONS[] = {
    {"study", 's', "FILE", 0, "Study file", 0},
    {"db", 'd', "FILE", 0, "Database of the study", 0},
    {"replication", 'r', "ID", 0, "Row id of the replication to run", 0},
    {"probe", 'p', "SCENARIO", 0, "Only see whether this scenario starts", 0},
    {"parent", 'P', "PID", 0, "Process that must be alive for this one to go on", 0},
    {"background", 'b', "RESULT", OPTION_ARG_OPTIONAL,
     "Run without driver errors, result into this file or the database", 0},
    {"sumocfg", 'c', "FILE", 0, "of this configuration", 0},
    {"scenario", 'n', "NAME", 0, "or of this scenario of the study", 0},
    {"seed", 'S', "N", 0, "with this seed (default: the study's)", 0},
    {"step-length", 'l', "S", 0, "and this step length, of a configuration", 0},
    {"duration", 't', "S", 0, "for this long (default: the study's)", 0},
    {"expect", 'e', "HASH", 0, "if the study's run has this configuration", 0},
    {"allow-sumo-outputs", 'o', NULL, 0, "Let SUMO write and connect where the scenario says", 0},
    {"version", 'V', NULL, 0, "Only print the version, with libsumo loaded", 0},
    {"allow-plugins", 'L', NULL, 0, "Load the libraries that the study names", 0},
    {0}};

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    worker_arguments *arguments = state->input;
    switch (key) {
    case 's':
        arguments->study = argument;
        return 0;
    case 'd':
        arguments->db = argument;
        return 0;
    case 'r':
        arguments->replication = argument;
        return 0;
    case 'p':
        arguments->probe = argument;
        return 0;
    case 'P':
        arguments->parent = argument;
        return 0;
    case 'b':
        arguments->background = argument != NULL ? argument : "";
        return 0;
    case 'c':
        arguments->sumocfg = argument;
        return 0;
    case 'n':
        arguments->scenario = argument;
        return 0;
    case 'S':
        arguments->seed = argument;
        return 0;
    case 'l':
        arguments->step_length = argument;
        return 0;
    case 't':
        arguments->duration = argument;
        return 0;
    case 'e':
        arguments->expect = argument;
        return 0;
    case 'V':
        puts("crashpulse-worker " CRASHPULSE_VERSION);
        exit(CP_WORKER_EXIT_DONE);
    case 'o':
        arguments->free_outputs = true;
        return 0;
    case 'L':
        arguments->allow_plugins = true;
        return 0;
    case ARGP_KEY_END:
        if (arguments->background != NULL) {
            bool is_bare = arguments->sumocfg != NULL && arguments->study == NULL &&
                           arguments->scenario == NULL && arguments->seed != NULL &&
                           arguments->step_length != NULL && arguments->duration != NULL;
            bool is_of_study = arguments->sumocfg == NULL && arguments->study != NULL &&
                               arguments->scenario != NULL;
            if (!is_bare && !is_of_study)
                argp_error(state, "--background needs --study and --scenario; or --sumocfg, "
                                  "--seed, --step-length and --duration");
            return 0;
        }
        if (arguments->study == NULL ||
            (arguments->probe == NULL) == (arguments->replication == NULL || arguments->db == NULL))
            argp_error(state, "needs --study and either --probe or --db and --replication");
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

// The runner listens on a descriptor of its own; by hand the error goes to stderr.
static void tell_error(const cp_error *error)
{
    size_t length = strlen(error->text);
    if (fcntl(CP_WORKER_REPORT_FD, F_GETFD) == -1 ||
        write(CP_WORKER_REPORT_FD, error->text, length) != (ssize_t)length)
        cp_log_error("%s", error->text);
}

// A worker must not outlive the runner: nobody would reap it.
static int follow_parent(const char *parent)
{
    if (parent == NULL)
        return 1;
    return prctl(PR_SET_PDEATHSIG, SIGKILL) == 0 && getppid() == (pid_t)strtol(parent, NULL, 10);
}

static cp_status run_background(const worker_arguments *arguments, cp_error *error)
{
    uint64_t seed = arguments->seed != NULL ? strtoull(arguments->seed, NULL, 10) : 0;
    cp_background_job job = {
        .path = arguments->sumocfg != NULL ? arguments->sumocfg : arguments->study,
        .scenario = arguments->scenario,
        .seed = arguments->seed != NULL ? &seed : NULL,
        .step_length_s =
            arguments->step_length != NULL ? strtod(arguments->step_length, NULL) : NAN,
        .duration_s = arguments->duration != NULL ? strtod(arguments->duration, NULL) : NAN,
        .expected_hash = arguments->expect,
        .db_path = arguments->db,
        .result_path = arguments->background[0] != '\0' ? arguments->background : NULL,
        .free_outputs = arguments->free_outputs};
    return cp_worker_background(&job, error);
}

static int finish(cp_status status, int elsewhere, const cp_error *error)
{
    if (status != CP_OK) {
        tell_error(error);
        return cp_status_exit_code(status);
    }
    return elsewhere ? CP_WORKER_EXIT_ELSEWHERE : CP_WORKER_EXIT_DONE;
}

int main(int argc, char **argv)
{
    static const struct argp ARGP = {
        .options = OPTIONS,
        .parser = parse_option,
        .doc = "Runs one replication of a crashpulse study. Started by 'crashpulse run'; there is "
               "no need to call it by hand."};
    worker_arguments arguments = {0};
    cp_error error = {0};
    int elsewhere = 0;
    json_set_alloc_funcs(cp_memory_for_json, free); // or fields would be missing without a word
    unsetenv(CP_LOG_FORMAT_VARIABLE); // its messages are passed on by whoever started it
    if (argp_parse(&ARGP, argc, argv, 0, NULL, &arguments) != 0)
        return 2;
    if (!follow_parent(arguments.parent))
        return 1;
    if (arguments.background != NULL)
        return finish(run_background(&arguments, &error), 0, &error);
    cp_status status =
        arguments.probe != NULL
            ? cp_worker_probe(arguments.study, arguments.probe, arguments.free_outputs, &error)
            : cp_worker_run(arguments.study, arguments.db, strtoll(arguments.replication, NULL, 10),
                            arguments.free_outputs, arguments.allow_plugins, &elsewhere, &error);
    return finish(status, elsewhere, &error);
}
