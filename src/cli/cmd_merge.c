/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/args.h"
#include "cli/commands.h"
#include "core/log.h"
#include "store/merge.h"
#include "store/query.h"

#include <string.h>
#include <unistd.h>

typedef struct arguments {
    const char *out_path;
    char **in_paths; /* the rest of the command line */
    int in_count;
} arguments;

static error_t parse(int key, char *argument, struct argp_state *state)
{
    arguments *a = state->input;
    switch (key) {
    case ARGP_KEY_ARG:
        if (a->out_path) {
            // The rest are all inputs.
            a->in_paths = &state->argv[state->next - 1];
            a->in_count = state->argc - state->next + 1;
            state->next = state->argc;
        } else {
            a->out_path = argument;
        }
        return 0;
    case ARGP_KEY_END:
        if (a->in_count == 0)
            argp_error(state, "merge what into what? OUT.db IN.db ... are missing");
        for (int k = 0; k < a->in_count; k++)
            if (strcmp(a->in_paths[k], a->out_path) == 0)
                argp_error(state, "'%s' cannot be merged into itself", a->out_path);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp ARGP = {
    .parser = parse,
    .args_doc = "OUT.db IN.db...",
    .doc = "Put databases of one study together: what shards or several machines have done. OUT is "
           "created when it is not there, and only if all of them fit."
           "\v"
           "Databases of different studies, or of different states of one, are refused. Merging "
           "the same again changes nothing. Tables attempt and merge_source tell where every "
           "replication was run.\n\n"
           "Example:\n"
           "  crashpulse run study.yaml --db part1.db --shard 1/2\n"
           "  crashpulse run study.yaml --db part2.db --shard 2/2    (elsewhere)\n"
           "  crashpulse merge study.db part1.db part2.db\n",
};

static cp_status report(cp_store *store, const char *path, cp_error *error)
{
    double done = 0, all = 0;
    cp_status status = cp_query_number(
        store, "SELECT count(*) FROM replication WHERE status = 'done'", &done, error);
    if (status == CP_OK)
        status = cp_query_number(store, "SELECT count(*) FROM replication", &all, error);
    if (status == CP_OK)
        cp_log_info("%s: %.0f of %.0f replications done", path, done, all);
    return status;
}

cp_status cmd_merge(int argc, char **argv, cp_error *error)
{
    arguments a = {0};
    cp_args_parse(&ARGP, argc, argv, &a);

    cp_store *store = NULL;
    bool is_new = access(a.out_path, F_OK) != 0;
    cp_status status = cp_store_open(a.out_path, CP_STORE_CREATE, &store, error);
    bool is_open = status == CP_OK;
    for (int k = 0; status == CP_OK && k < a.in_count; k++) {
        cp_merge_count count;
        status = cp_merge(store, a.in_paths[k], &count, error);
        if (status == CP_OK)
            cp_log_info("%s: %zu replications taken, %zu were here", a.in_paths[k], count.taken,
                        count.present);
    }
    if (status == CP_OK)
        status = report(store, a.out_path, error);
    cp_store_finish(store);
    cp_store_close(store);
    // Half a merge is no result: what was created for it goes.
    if (status != CP_OK && is_new && is_open && unlink(a.out_path) == 0)
        cp_error_prefix(error, "%s is not created: ", a.out_path);
    return status;
}
