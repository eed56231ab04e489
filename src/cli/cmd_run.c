/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/caveats.h"
#include "analysis/network_background.h"
#include "cli/args.h"
#include "cli/commands.h"
#include "core/log.h"
#include "run/runner.h"

#include <stdlib.h>
#include <unistd.h>

enum { TIME_LIMIT = 256, SHARD, NO_CHECK, FREE_OUTPUTS, ALLOW_PLUGINS };

static const struct argp_option OPTIONS[] = {
    {"db", 'd', "FILE", 0,
     "database of the study; created, or completed where an earlier run ended", 0},
    {"jobs", 'j', "N", 0, "worker processes at a time (default: one a processor)", 0},
    {"time-limit", TIME_LIMIT, "SECONDS", 0,
     "a replication that takes longer has failed (default: ten times the simulated duration, at "
     "least 600)",
     0},
    {"shard", SHARD, "I/N", 0,
     "run only share I of N, into a database of its own; 'crashpulse merge' puts them together", 0},
    {"no-check", NO_CHECK, NULL, 0,
     "do not read the whole database for damage before going on with it (seconds a gigabyte)", 0},
    {"allow-sumo-outputs", FREE_OUTPUTS, NULL, 0,
     "let SUMO write and connect wherever the scenarios say, not only in the folders of their "
     ".sumocfg ('crashpulse plan' lists what they ask for)",
     0},
    {"allow-plugins", ALLOW_PLUGINS, NULL, 0,
     "load the libraries that the study names: code that may do what you may ('crashpulse plan' "
     "lists them)",
     0},
    {0},
};

static void parse_shard(const char *text, cp_runner_options *options, struct argp_state *state)
{
    char *rest = NULL;
    options->shard = strtoul(text, &rest, 10);
    if (*rest == '/' && rest[1] >= '0' && rest[1] <= '9')
        options->shards = strtoul(rest + 1, &rest, 10);
    if (text[0] < '0' || text[0] > '9' || *rest != '\0' || options->shard < 1 ||
        options->shard > options->shards)
        argp_error(state, "--shard must be I/N with I from 1 to N, found '%s'", text);
}

typedef struct arguments {
    cp_args_input input;
    cp_runner_options options;
} arguments;

static error_t parse(int key, char *argument, struct argp_state *state)
{
    arguments *a = state->input;
    cp_runner_options *options = &a->options;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &a->input;
        return 0;
    case 'd':
        options->db_path = argument;
        return 0;
    case 'j':
        options->jobs = (size_t)cp_args_integer(state, "--jobs", argument, 1, 1024);
        return 0;
    case TIME_LIMIT:
        options->time_limit_s = cp_args_number(state, "--time-limit", argument, 1, 1e7, "s");
        return 0;
    case NO_CHECK:
        options->unchecked = true;
        return 0;
    case FREE_OUTPUTS:
        options->free_outputs = true;
        return 0;
    case ALLOW_PLUGINS:
        options->allow_plugins = true;
        return 0;
    case SHARD:
        parse_shard(argument, options, state);
        return 0;
    case ARGP_KEY_END:
        cp_args_need(state, options->db_path != NULL, "where to? --db FILE");
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child CHILDREN[] = {{&CP_ARGS_INPUT, 0, NULL, 0}, {0}};

static const struct argp ARGP = {
    .options = OPTIONS,
    .parser = parse,
    .args_doc = "STUDY.yaml --db FILE",
    .doc = "Simulate a study: every scenario with every variant and seed, each replication in a "
           "process of its own, and each network once without driver errors or functions, which "
           "tells what crashes are its own doing. Every crash, its pulses and the exposure go into "
           "the database."
           "\v"
           "A run that was stopped goes on where it ended when it is started again; replications "
           "that are done stay. The result does not depend on --jobs.\n\n"
           "Example:\n"
           "  crashpulse run sumo_scenarios/demo/study.yaml --db demo.db --jobs 2\n",
    .children = CHILDREN,
};

// What of the crashes is not the drivers' doing, when that is not little, and what is not as
// planned.
static cp_status warn_of_backgrounds(const char *db_path, cp_error *error)
{
    cp_store *store = NULL;
    cp_network_backgrounds backgrounds = {0};
    cp_status status = cp_store_open(db_path, CP_STORE_READ, &store, error);
    if (status == CP_OK)
        status = cp_network_backgrounds_read(store, NULL, &backgrounds, error);
    for (size_t k = 0; status == CP_OK && k < backgrounds.count; k++)
        if (backgrounds.row[k].warning != NULL)
            cp_log_warning("%s (without driver errors: %s)", backgrounds.row[k].warning,
                           backgrounds.row[k].text);
    cp_network_backgrounds_destroy(&backgrounds);
    cp_caveats caveats = {0};
    if (status == CP_OK)
        status = cp_caveats_read(store, NULL, &caveats, error);
    for (size_t k = 0; status == CP_OK && k < caveats.count; k++)
        cp_log_warning("%s", caveats.sentence[k]);
    cp_caveats_destroy(&caveats);
    cp_store_close(store);
    return status;
}

cp_status cmd_run(int argc, char **argv, cp_error *error)
{
    long processors = sysconf(_SC_NPROCESSORS_ONLN);
    arguments a = {.input = CP_ARGS_STUDY,
                   .options = {.jobs = processors > 0 ? (size_t)processors : 1, .progress = true}};
    cp_args_parse(&ARGP, argc, argv, &a);
    a.options.study_path = a.input.path;

    cp_runner_summary summary = {0};
    cp_status status = cp_runner_run(&a.options, &summary, error);
    if (summary.replications > 0)
        cp_log_info("%zu replications: %zu done before, %zu done now, %zu failed, %zu elsewhere; "
                    "%zu crash%s; %.1f s",
                    summary.replications, summary.done_before, summary.done_now, summary.failed,
                    summary.elsewhere, summary.crashes, summary.crashes == 1 ? "" : "es",
                    summary.wall_time_s);
    if (status == CP_OK)
        status = warn_of_backgrounds(a.options.db_path, error);
    return status;
}
