/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/query_json.h"
#include "cli/args.h"
#include "cli/commands.h"
#include "core/installation.h"
#include "core/log.h"
#include "store/query.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct arguments {
    cp_args_input input;
    const char *query;
    cp_format format;
} arguments;

static error_t parse(int key, char *argument, struct argp_state *state)
{
    arguments *a = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &a->format;
        state->child_inputs[1] = &a->input;
        return 0;
    case ARGP_KEY_ARG:
        if (a->input.path == NULL)
            return ARGP_ERR_UNKNOWN;
        if (a->query != NULL)
            argp_error(state, "one query at a time, found '%s' too", argument);
        a->query = argument;
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child CHILDREN[] = {
    {&CP_ARGS_FORMAT, 0, NULL, 0}, {&CP_ARGS_INPUT, 0, NULL, 0}, {0}};

static const struct argp ARGP = {
    .parser = parse,
    .args_doc = "DB [QUERY]",
    .doc = "Ask the database of a study. With QUERY: print the result of one SQL statement that "
           "reads. Without: start the sqlite3 shell on it, which also reads SQL from a pipe."
           "\v"
           "Tables and views are described in db/schema and db/views.sql, questions others asked "
           "are in db/queries. The functions of the SQL extension are loaded: median, quantile, "
           "cliffs_delta, ks_distance, olc, delta_v, peak, cfc, pulse_samples (db/README.md).\n\n"
           "Examples:\n"
           "  crashpulse sql demo.db \"SELECT * FROM olc_by_variant\"\n"
           "  crashpulse sql demo.db -f csv \"SELECT * FROM frontal_vehicle\" > cars.csv\n"
           "  crashpulse sql demo.db \"$(cat db/queries/worst_crashes.sql)\"\n"
           "  crashpulse sql demo.db\n",
    .children = CHILDREN,
};

static cp_status begin_table(void *context, const cp_row *row, cp_error *error)
{
    (void)error;
    cp_table_begin(context, row->column, row->column_count);
    return CP_OK;
}

static cp_status add_row(void *context, const cp_row *row, cp_error *error)
{
    (void)error;
    for (size_t k = 0; k < row->column_count; k++)
        cp_table_json(context, cp_cell_json(&row->cell[k]));
    return CP_OK;
}

// The extension that belongs to the running executable; "" when it is not there.
static void find_extension(char path[PATH_MAX])
{
    static const char NAME[] = "crashpulse_sql.so";
    cp_error error = {0};
    if (cp_installation_find(CP_INSTALLED_LIBRARY, NAME, path, PATH_MAX, &error) != CP_OK ||
        access(path, R_OK) != 0) {
        cp_log_warning("%s is not where crashpulse is: its functions are missing", NAME);
        path[0] = '\0';
    }
}

static cp_status start_shell(const char *db_path, const char *extension, cp_format format,
                             cp_error *error)
{
    static const char *const MODE[] = {
        [CP_FORMAT_TABLE] = "-column", [CP_FORMAT_JSON] = "-json", [CP_FORMAT_CSV] = "-csv"};
    char load[PATH_MAX + 16];
    char *file_name = cp_store_file_name(db_path); // no option and no URI of the shell
    if (file_name == NULL)
        return cp_fail_memory(error, db_path);
    snprintf(load, sizeof load, ".load '%s'", extension);
    if (extension[0] != '\0')
        execlp("sqlite3", "sqlite3", "-header", MODE[format], "-cmd", load, file_name,
               (char *)NULL);
    else
        execlp("sqlite3", "sqlite3", "-header", MODE[format], file_name, (char *)NULL);
    cp_status status = cp_fail(
        error, CP_BAD_INPUT, "cannot start the sqlite3 shell (%s); install sqlite3 or give a QUERY",
        strerror(errno));
    free(file_name);
    return status;
}

static cp_status print_query(cp_store *store, const arguments *a, cp_error *error)
{
    cp_table table = {0};
    cp_query_handler handler = {.columns = begin_table, .row = add_row, .context = &table};
    cp_status status = cp_query(store, a->query, NULL, 0, &handler, error);
    if (status == CP_OK)
        status = cp_table_print(&table, a->format, stdout, error);
    cp_table_destroy(&table);
    return status;
}

cp_status cmd_sql(int argc, char **argv, cp_error *error)
{
    arguments a = {.input = CP_ARGS_DATABASE};
    cp_args_parse(&ARGP, argc, argv, &a);

    // Opened in both cases: a file that is no study's database is refused with one clear message.
    cp_store *store = NULL;
    cp_status status = cp_store_open(a.input.path, CP_STORE_READ, &store, error);
    if (status != CP_OK)
        return status;
    char extension[PATH_MAX];
    find_extension(extension);
    if (a.query && extension[0] != '\0')
        status = cp_store_load_extension(store, extension, error);
    if (a.query && status == CP_OK)
        status = print_query(store, &a, error);
    cp_store_close(store);
    return a.query ? status : start_shell(a.input.path, extension, a.format, error);
}
