/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/args.h"
#include "cli/commands.h"
#include "core/log.h"
#include "run/runner.h"

#include <unistd.h>

static const struct argp_option OPTIONS[] = {
    {"db", 'd', "FILE", 0,
     "database of the study; created, or completed where an earlier run ended", 0},
    {"jobs", 'j', "N", 0, "worker processes at a time (default: one a processor)", 0},
    {0},
};

static error_t parse(int key, char *argument, struct argp_state *state)
{
    cp_runner_options *options = state->input;
    switch (key) {
    case 'd':
        options->db_path = argument;
        return 0;
    case 'j':
        options->jobs = (size_t)cp_args_integer(state, "--jobs", argument, 1, 1024);
        return 0;
    case ARGP_KEY_ARG:
        if (options->study_path)
            argp_error(state, "one study file at a time, found '%s' too", argument);
        options->study_path = argument;
        return 0;
    case ARGP_KEY_END:
        if (!options->study_path)
            argp_error(state, "which study? STUDY.yaml is missing");
        if (!options->db_path)
            argp_error(state, "where to? --db FILE is missing");
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp ARGP = {
    .options = OPTIONS,
    .parser = parse,
    .args_doc = "STUDY.yaml --db FILE",
    .doc = "Simulate a study: every scenario with every variant and seed, each replication in a "
           "process of its own. Every crash, its pulses and the exposure go into the database."
           "\v"
           "A run that was stopped goes on where it ended when it is started again; replications "
           "that are done stay. The result does not depend on --jobs.\n\n"
           "Example:\n"
           "  crashpulse run sumo_scenarios/demo/study.yaml --db demo.db --jobs 2\n",
};

cp_status cmd_run(int argc, char **argv, cp_error *error)
{
    long processors = sysconf(_SC_NPROCESSORS_ONLN);
    cp_runner_options options = {.jobs = processors > 0 ? (size_t)processors : 1, .progress = true};
    cp_args_parse(&ARGP, argc, argv, &options);

    cp_runner_summary summary = {0};
    cp_status status = cp_runner_run(&options, &summary, error);
    if (summary.replications > 0)
        cp_log_info("%zu replications: %zu done before, %zu done now, %zu failed, %zu elsewhere; "
                    "%zu crashes; %.1f s",
                    summary.replications, summary.done_before, summary.done_now, summary.failed,
                    summary.elsewhere, summary.crashes, summary.wall_time_s);
    return status;
}
