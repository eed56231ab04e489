/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/args.h"
#include "cli/commands.h"
#include "store/inspection.h"

#include <stdbool.h>

typedef struct arguments {
    cp_args_input input;
    bool upgrade;
    cp_format format;
} arguments;

static const struct argp_option OPTIONS[] = {
    {"upgrade", 'u', NULL, 0, "first bring an older database to the schema of this program", 0},
    {0},
};

static error_t parse(int key, char *argument, struct argp_state *state)
{
    arguments *a = state->input;
    (void)argument;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &a->format;
        state->child_inputs[1] = &a->input;
        return 0;
    case 'u':
        a->upgrade = true;
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child CHILDREN[] = {
    {&CP_ARGS_FORMAT, 0, NULL, 0}, {&CP_ARGS_INPUT, 0, NULL, 0}, {0}};

static const struct argp ARGP = {
    .options = OPTIONS,
    .parser = parse,
    .args_doc = "DB",
    .doc = "See whether the database of a study is whole: the file itself, references between "
           "tables, what must hold between rows, vehicle files against their hashes, and every "
           "stored pulse unpacked."
           "\v"
           "Exit code 1 when something is wrong. Nothing is changed, but for --upgrade.\n\n"
           "Example:\n"
           "  crashpulse check demo.db\n",
    .children = CHILDREN,
};

static cp_status print(const cp_inspection *inspection, cp_format format, cp_error *error)
{
    static const char *const COLUMN[] = {"what", "looked_at", "wrong", "first"};
    cp_table table = {0};
    cp_table_begin(&table, COLUMN, 4);
    for (int k = 0; k < inspection->count; k++) {
        const cp_inspection_result *result = &inspection->result[k];
        cp_table_text(&table, result->what);
        cp_table_integer(&table, result->looked_at);
        cp_table_integer(&table, result->wrong);
        if (result->first[0] != '\0')
            cp_table_text(&table, result->first);
        else
            cp_table_null(&table);
    }
    cp_status status = cp_table_print(&table, format, stdout, error);
    cp_table_destroy(&table);
    return status;
}

cp_status cmd_check(int argc, char **argv, cp_error *error)
{
    arguments a = {.input = CP_ARGS_DATABASE};
    cp_args_parse(&ARGP, argc, argv, &a);

    cp_store *store = NULL;
    cp_inspection inspection;
    cp_status status = CP_OK;
    if (a.upgrade) {
        status = cp_store_open(a.input.path, CP_STORE_WRITE, &store, error);
        cp_store_finish(store);
        cp_store_close(store);
    }
    if (status == CP_OK)
        status = cp_store_open(a.input.path, CP_STORE_READ, &store, error);
    if (status != CP_OK)
        return status;
    status = cp_inspection_run(store, &inspection, error);
    cp_store_close(store);
    if (status == CP_OK)
        status = print(&inspection, a.format, error);
    if (status == CP_OK && inspection.wrong > 0)
        status = cp_fail(error, CP_STORE_FAILED, "%s: %lld things are wrong in it", a.input.path,
                         (long long)inspection.wrong);
    return status;
}
