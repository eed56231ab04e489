/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/caveats.h"
#include "analysis/network_background.h"
#include "cli/args.h"
#include "cli/commands.h"
#include "core/safe_text.h"
#include "run/owner.h"
#include "store/query.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct arguments {
    cp_args_input input;
    cp_format format;
} arguments;

static error_t parse(int key, char *argument, struct argp_state *state)
{
    arguments *a = state->input;
    (void)argument;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &a->format;
        state->child_inputs[1] = &a->input;
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child CHILDREN[] = {
    {&CP_ARGS_FORMAT, 0, NULL, 0}, {&CP_ARGS_INPUT, 0, NULL, 0}, {0}};

static const struct argp ARGP = {
    .parser = parse,
    .args_doc = "DB",
    .doc = "How far a study has come: replications done, running, failed and to come of every "
           "scenario and variant, crashes so far, time left, and why replications failed. Only "
           "reads; a study may run meanwhile."
           "\v"
           "'lost' are replications whose worker is gone; the next run takes them up. The time "
           "left is that of the replications to come, at the mean time of those done, shared by "
           "the workers running now. Contacts without driver errors are the networks' own doing; a "
           "warning stands where they are more than 5 % of the baseline's crashes.\n\n"
           "Example:\n"
           "  crashpulse status demo.db\n",
    .children = CHILDREN,
};

// ---- what is running -----------------------------------------------------------------------

typedef struct owners {
    size_t alive;
    size_t lost;
} owners;

static cp_status look_at_owner(void *context, const cp_row *row, cp_error *error)
{
    (void)error;
    owners *found = context;
    cp_owner owner = {.pid = row->cell[1].integer, .process_start = row->cell[2].integer};
    snprintf(owner.host, sizeof owner.host, "%s", row->cell[0].text);
    *(cp_owner_is_alive(&owner) ? &found->alive : &found->lost) += 1;
    return CP_OK;
}

static cp_status find_owners(cp_store *store, owners *found, cp_error *error)
{
    cp_query_handler handler = {.row = look_at_owner, .context = found};
    return cp_query(store, "SELECT host, pid, process_start FROM attempt WHERE outcome = 'running'",
                    NULL, 0, &handler, error);
}

// ---- the tables ----------------------------------------------------------------------------

static cp_status add_progress(void *context, const cp_row *row, cp_error *error)
{
    (void)error;
    cp_table *table = context;
    for (size_t k = 0; k < row->column_count; k++) {
        if (k < 2)
            cp_table_text(table, row->cell[k].text);
        else
            cp_table_integer(table, row->cell[k].integer);
    }
    return CP_OK;
}

static cp_status print_progress(cp_store *store, cp_format format, cp_error *error)
{
    static const char *const COLUMN[] = {"scenario", "variant", "replications", "done",
                                         "running",  "failed",  "planned",      "crashes"};
    cp_table table = {0};
    cp_table_begin(&table, COLUMN, 8);
    cp_query_handler handler = {.row = add_progress, .context = &table};
    cp_status status = cp_query(
        store,
        "SELECT p.scenario, p.variant, p.replications, p.done, p.running, p.failed, p.planned, "
        "(SELECT count(*) FROM crash AS c JOIN replication AS r ON r.id = c.replication_id JOIN "
        "scenario AS s ON s.id = r.scenario_id JOIN variant AS v ON v.id = r.variant_id WHERE "
        "s.name = p.scenario AND v.name = p.variant) FROM progress AS p",
        NULL, 0, &handler, error);
    if (status == CP_OK)
        status = cp_table_print(&table, format, stdout, error);
    cp_table_destroy(&table);
    return status;
}

// Long ones by their first line and their last, which says what ended it.
static void print_reason(const char *reason)
{
    enum { LONG = 300 };
    const char *last = strrchr(reason, '\n');
    if (strlen(reason) <= LONG || last == NULL) {
        cp_text_print(stdout, reason, "\n\t");
    } else {
        char first[512];
        snprintf(first, sizeof first, "%.*s", (int)strcspn(reason, "\n"), reason);
        cp_text_print(stdout, first, "\t");
        printf("\n    ...\n    ");
        cp_text_print(stdout, last + 1, "\t");
    }
    printf("\n");
}

static cp_status print_failure(void *context, const cp_row *row, cp_error *error)
{
    (void)error;
    (void)context;
    printf("  ");
    cp_text_print(stdout, row->cell[0].text, "");
    printf(", ");
    cp_text_print(stdout, row->cell[1].text, "");
    printf(", replication %lld: ", (long long)row->cell[2].integer);
    print_reason(row->cell[3].text);
    return CP_OK;
}

// Why replications failed: the last words of the last attempt.
static cp_status print_failures(cp_store *store, cp_error *error)
{
    double failed = 0;
    cp_status status = cp_query_number(
        store, "SELECT count(*) FROM replication WHERE status = 'failed'", &failed, error);
    if (status != CP_OK || failed == 0)
        return status;
    printf("\nfailed%s:\n", failed > 5 ? ", the first five" : "");
    cp_query_handler handler = {.row = print_failure};
    return cp_query(
        store,
        "SELECT s.name, v.name, r.number, coalesce((SELECT message FROM attempt AS a WHERE "
        "a.replication_id = r.id ORDER BY a.number DESC LIMIT 1), 'it left no message') "
        "FROM replication AS r "
        "JOIN scenario AS s ON s.id = r.scenario_id JOIN variant AS v ON v.id = "
        "r.variant_id WHERE r.status = 'failed' ORDER BY s.number, v.number, r.number "
        "LIMIT 5",
        NULL, 0, &handler, error);
}

static cp_status print_summary(cp_store *store, cp_error *error)
{
    owners found = {0};
    double all = 0, done = 0, crashes = 0, mean_s = NAN;
    cp_status status = cp_query_number(store, "SELECT count(*) FROM replication", &all, error);
    if (status == CP_OK)
        status = cp_query_number(store, "SELECT count(*) FROM replication WHERE status = 'done'",
                                 &done, error);
    if (status == CP_OK)
        status = cp_query_number(store, "SELECT count(*) FROM crash", &crashes, error);
    if (status == CP_OK && done > 0)
        status = cp_query_number(
            store, "SELECT coalesce(avg(wall_time_s), -1) FROM attempt WHERE outcome = 'done'",
            &mean_s, error);
    if (status == CP_OK)
        status = find_owners(store, &found, error);
    if (status != CP_OK)
        return status;
    printf("\n%.0f of %.0f replications done, %.0f crashes so far, %zu running", done, all, crashes,
           found.alive);
    if (found.lost > 0)
        printf(", %zu lost", found.lost);
    if (done < all && found.alive == 0)
        printf("; nothing runs");
    else if (done < all && mean_s > 0)
        printf("; about %.0f s left", mean_s * (all - done) / (double)found.alive);
    printf("\n");
    return CP_OK;
}

// What the networks do without driver errors, as far as it has been simulated.
static cp_status print_backgrounds(cp_store *store, cp_error *error)
{
    cp_network_backgrounds backgrounds = {0};
    cp_status status = cp_network_backgrounds_read(store, NULL, &backgrounds, error);
    if (status == CP_OK && backgrounds.known > 0) {
        printf("\nwithout driver errors or functions:\n");
        for (size_t k = 0; k < backgrounds.count; k++) {
            const cp_network_background *row = &backgrounds.row[k];
            printf("  ");
            cp_text_print(stdout, row->scenario, "");
            printf(": ");
            cp_text_print(stdout, row->is_known ? row->text : "not simulated yet", "");
            if (row->warning != NULL) {
                printf("\n    warning: ");
                cp_text_print(stdout, row->warning, "");
            }
            printf("\n");
        }
    }
    cp_network_backgrounds_destroy(&backgrounds);
    return status;
}

static cp_status print_caveats(cp_store *store, cp_error *error)
{
    cp_caveats caveats = {0};
    cp_status status = cp_caveats_read(store, NULL, &caveats, error);
    for (size_t k = 0; status == CP_OK && k < caveats.count; k++) {
        printf(k == 0 ? "\nmind:\n  " : "  ");
        cp_text_print(stdout, caveats.sentence[k], "");
        printf("\n");
    }
    cp_caveats_destroy(&caveats);
    return status;
}

cp_status cmd_status(int argc, char **argv, cp_error *error)
{
    arguments a = {.input = CP_ARGS_DATABASE};
    cp_args_parse(&ARGP, argc, argv, &a);

    cp_store *store = NULL;
    cp_status status = cp_store_open(a.input.path, CP_STORE_READ, &store, error);
    if (status == CP_OK)
        status = print_progress(store, a.format, error);
    if (status == CP_OK && a.format == CP_FORMAT_TABLE)
        status = print_summary(store, error);
    if (status == CP_OK && a.format == CP_FORMAT_TABLE)
        status = print_failures(store, error);
    if (status == CP_OK && a.format == CP_FORMAT_TABLE)
        status = print_backgrounds(store, error);
    if (status == CP_OK && a.format == CP_FORMAT_TABLE)
        status = print_caveats(store, error);
    cp_store_close(store);
    return status;
}
