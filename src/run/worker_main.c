/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/log.h"
#include "run/worker.h"

#include <argp.h>
#include <fcntl.h>
#include <inttypes.h>
#include <signal.h>
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
} worker_arguments;

static const struct argp_option OPTIONS[] = {
    {"study", 's', "FILE", 0, "Study file", 0},
    {"db", 'd', "FILE", 0, "Database of the study", 0},
    {"replication", 'r', "ID", 0, "Row id of the replication to run", 0},
    {"probe", 'p', "SCENARIO", 0, "Only see whether this scenario starts", 0},
    {"parent", 'P', "PID", 0, "Process that must be alive for this one to go on", 0},
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
    case ARGP_KEY_END:
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
    if (argp_parse(&ARGP, argc, argv, 0, NULL, &arguments) != 0)
        return 2;
    if (!follow_parent(arguments.parent))
        return 1;
    cp_status status =
        arguments.probe != NULL
            ? cp_worker_probe(arguments.study, arguments.probe, &error)
            : cp_worker_run(arguments.study, arguments.db, strtoll(arguments.replication, NULL, 10),
                            &elsewhere, &error);
    if (status != CP_OK) {
        tell_error(&error);
        return cp_status_exit_code(status);
    }
    return elsewhere ? CP_WORKER_EXIT_ELSEWHERE : 0;
}
