/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/args.h"
#include "cli/commands.h"
#include "core/log.h"
#include "core/safe_text.h"
#include "run/fleet.h"
#include "study/controls_text.h"
#include "study/occasions.h"
#include "study/plan.h"
#include "study/scenario_outputs.h"
#include "study/study_file.h"
#include "study/type_mapping.h"

#include <stdbool.h>
#include <stdlib.h>

typedef struct arguments {
    cp_args_input input;
    const char *db_path;
    bool each;
    cp_format format;
} arguments;

enum { EACH = 256 };

static const struct argp_option OPTIONS[] = {
    {"db", 'd', "FILE", 0, "what of it this database has done already", 0},
    {"each", EACH, NULL, 0, "one row a replication, with its seed", 0},
    {0},
};

static error_t parse(int key, char *argument, struct argp_state *state)
{
    arguments *a = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &a->format;
        state->child_inputs[1] = &a->input;
        return 0;
    case 'd':
        a->db_path = argument;
        return 0;
    case EACH:
        a->each = true;
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
    .args_doc = "STUDY.yaml",
    .doc = "Show what 'crashpulse run' would do: every scenario with every variant, those of a "
           "sweep included, how many replications of each, and the parameters of every driver "
           "error and function, defaults included, and what files SUMO is asked to write. Runs "
           "nothing, changes nothing."
           "\v"
           "With --db, what of it is done already and what is new. Exit code 2, and the "
           "difference, when the study file contradicts results in the database.\n\n"
           "Example:\n"
           "  crashpulse plan sumo_scenarios/demo/study.yaml --db demo.db\n",
    .children = CHILDREN,
};

// ---- the plan and what is done of it -------------------------------------------------------

typedef struct planned {
    cp_study study;
    cp_fleet fleet;
    cp_plan_rows rows;
    cp_planned_state *state; /* of each replication; NULL without a database */
    size_t dropped;          /* replications in the database that are planned no more */
} planned;

// What a database holds is compared by hashes.
static cp_status make_plan(const char *path, bool hashed, planned *p, cp_error *error)
{
    cp_status status = cp_study_load(path, &p->study, error);
    if (status == CP_OK)
        status = cp_fleet_load(&p->study, &p->fleet, error);
    if (status == CP_OK)
        status = cp_study_check_types(&p->study, error);
    if (status == CP_OK)
        status = (hashed ? cp_plan_create : cp_plan_create_unhashed)(
            &p->study, p->fleet.rows, p->fleet.count, &p->rows, error);
    return status;
}

static cp_status look_into_database(const char *db_path, planned *p, cp_error *error)
{
    cp_store *store = NULL;
    cp_status status = cp_store_open(db_path, CP_STORE_READ, &store, error);
    if (status != CP_OK)
        return status;
    p->state = calloc(p->rows.replication_count + 1, sizeof *p->state);
    status = p->state != NULL ? cp_plan_rows_compare(store, &p->rows, p->state, &p->dropped, error)
                              : cp_fail_memory(error, "plan");
    cp_store_close(store);
    // Of another study's database nothing can be told.
    if (p->state != NULL && p->state[0] == CP_PLANNED_UNKNOWN) {
        free(p->state);
        p->state = NULL;
    }
    return status;
}

static void release(planned *p)
{
    free(p->state);
    cp_plan_destroy(&p->rows);
    cp_fleet_destroy(&p->fleet);
    cp_study_destroy(&p->study);
}

// ---- tables --------------------------------------------------------------------------------

static const char *const STATE_TEXT[] = {
    [CP_PLANNED_UNKNOWN] = "unknown", [CP_PLANNED_NEW] = "new",   [CP_PLANNED_WAITING] = "planned",
    [CP_PLANNED_RUNNING] = "running", [CP_PLANNED_DONE] = "done", [CP_PLANNED_FAILED] = "failed"};
enum { STATES = sizeof STATE_TEXT / sizeof *STATE_TEXT };

static void add_each(const planned *p, cp_table *table)
{
    for (size_t k = 0; k < p->rows.replication_count; k++) {
        const cp_replication_row *row = &p->rows.replication[k];
        cp_table_text(table, p->study.scenarios[row->scenario].name);
        cp_table_text(table, p->study.variants[row->variant].name);
        cp_table_integer(table, (int64_t)row->number);
        cp_table_integer(table, (int64_t)row->seed);
        cp_table_integer(table, row->id);
        if (p->state != NULL)
            cp_table_text(table, STATE_TEXT[p->state[k]]);
    }
}

// {key path: value} of the swept parameters of both.
static json_t *swept_json(const cp_study_scenario *scenario, const cp_study_variant *variant)
{
    json_t *swept = json_object();
    for (size_t k = 0; k < scenario->swept_count; k++)
        json_object_set_new(swept, scenario->swept[k].parameter,
                            json_real(scenario->swept[k].value));
    for (size_t k = 0; k < variant->swept_count; k++)
        json_object_set_new(swept, variant->swept[k].parameter, json_real(variant->swept[k].value));
    return swept;
}

// Replications of each scenario and variant: the total and, behind it, those of each state.
static size_t *count_replications(const planned *p)
{
    size_t variants = p->study.variant_count;
    size_t *count = calloc(p->study.scenario_count * variants * (1 + STATES), sizeof *count);
    for (size_t k = 0; count != NULL && k < p->rows.replication_count; k++) {
        const cp_replication_row *row = &p->rows.replication[k];
        size_t *here = count + (row->scenario * variants + row->variant) * (1 + STATES);
        here[0]++;
        if (p->state != NULL)
            here[1 + p->state[k]]++;
    }
    return count;
}

static cp_status add_groups(const planned *p, cp_format format, cp_table *table, cp_error *error)
{
    size_t *count = count_replications(p);
    if (count == NULL)
        return cp_fail_memory(error, "plan");
    const size_t *here = count;
    for (size_t s = 0; s < p->study.scenario_count; s++) {
        for (size_t v = 0; v < p->study.variant_count; v++, here += 1 + STATES) {
            cp_table_text(table, p->study.scenarios[s].name);
            cp_table_text(table, p->study.variants[v].name);
            cp_table_integer(table, (int64_t)here[0]);
            for (size_t state = CP_PLANNED_NEW; p->state != NULL && state < STATES; state++)
                cp_table_integer(table, (int64_t)here[1 + state]);
            if (format != CP_FORMAT_JSON)
                continue;
            cp_table_json(table, swept_json(&p->study.scenarios[s], &p->study.variants[v]));
            cp_table_json(table, json_loads(p->rows.scenario[s].driver_errors, 0, NULL));
            cp_table_json(table, json_loads(p->rows.variant[v].functions, 0, NULL));
        }
    }
    free(count);
    return CP_OK;
}

static cp_status print_plan(const planned *p, const arguments *a, cp_error *error)
{
    static const char *const EACH_COLUMN[] = {"scenario", "variant", "replication",
                                              "seed",     "id",      "state"};
    static const char *const JSON_COLUMN[] = {"swept", "driver_errors", "functions"};
    const char *group_column[6 + STATES] = {"scenario", "variant", "replications"};
    size_t columns = 3;
    cp_table table = {0};
    cp_status status = CP_OK;
    if (a->each) {
        cp_table_begin(&table, EACH_COLUMN, p->state != NULL ? 6 : 5);
        add_each(p, &table);
    } else {
        for (size_t state = CP_PLANNED_NEW; p->state != NULL && state < STATES; state++)
            group_column[columns++] = STATE_TEXT[state];
        for (size_t k = 0; a->format == CP_FORMAT_JSON && k < 3; k++)
            group_column[columns++] = JSON_COLUMN[k];
        cp_table_begin(&table, group_column, columns);
        status = add_groups(p, a->format, &table, error);
    }
    if (status == CP_OK)
        status = cp_table_print(&table, a->format, stdout, error);
    cp_table_destroy(&table);
    return status;
}

// What of the assessment record only a person can say, and nobody has said.
static void print_missing(const planned *p)
{
    static const char *const KEY[] = {
#define KEY_OF(name, key, title, says) key,
        CP_ASSESSMENT_ITEMS(KEY_OF)
#undef KEY_OF
    };
    const char *separator = "assessment record: missing ";
    for (size_t k = 0; k < CP_ASSESSMENT_ITEM_COUNT; k++) {
        if (p->study.said[k])
            continue;
        printf("%s%s", separator, KEY[k]);
        separator = ", ";
    }
    puts(*separator == ',' ? "" : "assessment record: nothing missing");
}

static void print_summary(const planned *p)
{
    size_t total = p->rows.replication_count, done = 0;
    fputc('\n', stdout);
    cp_controls_text_study(&p->study, "", stdout);
    printf("\n%zu replication%s of %g s, %.3g h of simulated traffic", total, total == 1 ? "" : "s",
           p->study.duration_s, (double)total * p->study.duration_s / 3600.0);
    for (size_t k = 0; p->state != NULL && k < total; k++)
        done += p->state[k] == CP_PLANNED_DONE;
    if (p->state != NULL)
        printf("; %zu done, %zu to run", done, total - done);
    if (p->dropped > 0)
        printf("; %zu in the database are planned no more", p->dropped);
    printf("\n");
    if (p->rows.background_count > 0)
        printf("and %zu of %g s without driver errors or functions, %zu a network\n",
               p->rows.background_count, p->rows.background[0].duration_s,
               p->study.background_seeds);
    if (p->study.design == CP_DESIGN_COUNTERFACTUAL)
        printf("every crash of the baseline is run again with each of %zu treatments\n",
               p->study.variant_count - 1);
    print_missing(p);
}

// ---- what SUMO is asked to write -----------------------------------------------------------

static void print_output(const cp_scenario_output *output)
{
    printf("  ");
    cp_text_print(stdout, output->place, "");
    printf(": ");
    cp_text_print(stdout, output->name, "");
    if (output->why != NULL)
        printf("  REFUSED: %s", output->why);
    fputc('\n', stdout);
}

// As text all of it, in other formats only what 'run' refuses, beside the table.
static size_t tell_outputs(const cp_study_scenario *scenario, const cp_scenario_outputs *outputs,
                           cp_format format)
{
    size_t refused = 0;
    if (format == CP_FORMAT_TABLE && outputs->count > 0)
        printf("\nscenario %s asks SUMO to write\n", scenario->base);
    for (size_t k = 0; k < outputs->count; k++) {
        const cp_scenario_output *output = &outputs->output[k];
        refused += output->why != NULL;
        if (format == CP_FORMAT_TABLE)
            print_output(output);
        else if (output->why != NULL)
            cp_log_warning("%s: '%s' is refused: %s", output->place, output->name, output->why);
    }
    return refused;
}

// What code the study brings along.
static void list_libraries(const cp_study *study, cp_format format)
{
    const cp_study_variant *variant = NULL;
    const cp_library *library;
    size_t count = 0;
    for (; (library = cp_study_library(study, count, &variant)) != NULL; count++) {
        if (format != CP_FORMAT_TABLE)
            continue;
        printf("%svariant %s loads code of its own: ", count == 0 ? "\n" : "", variant->base);
        cp_text_print(stdout, library->written, "");
        printf(", SHA-256 %s\n", library->hash);
    }
    if (count > 0)
        cp_log_warning("the study asks to load code of its own (%zu librar%s): 'crashpulse run' "
                       "refuses that unless it is given --allow-plugins",
                       count, count == 1 ? "y" : "ies");
}

static cp_status list_outputs(const cp_study *study, cp_format format, cp_error *error)
{
    size_t refused = 0;
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < study->scenario_count; k++) {
        const cp_study_scenario *scenario = &study->scenarios[k];
        const cp_scenario_inputs inputs = cp_study_scenario_inputs(scenario);
        cp_scenario_outputs outputs = {0};
        if (k > 0 && cp_study_scenarios_start_alike(scenario - 1, scenario))
            continue;
        status = cp_scenario_outputs_find(&inputs, &outputs, error);
        if (status == CP_OK)
            refused += tell_outputs(scenario, &outputs, format);
        cp_scenario_outputs_destroy(&outputs);
    }
    if (refused > 0)
        cp_log_warning("'crashpulse run' refuses %zu of what SUMO is asked to write or to connect "
                       "to, unless it is given --allow-sumo-outputs",
                       refused);
    return status;
}

cp_status cmd_plan(int argc, char **argv, cp_error *error)
{
    arguments a = {.input = CP_ARGS_STUDY};
    cp_args_parse(&ARGP, argc, argv, &a);

    planned p = {0};
    cp_error contradiction = {0};
    cp_status agrees = CP_OK;
    cp_status status = make_plan(a.input.path, a.db_path != NULL, &p, error);
    // What the database contradicts is said below the plan.
    if (status == CP_OK && a.db_path != NULL)
        agrees = look_into_database(a.db_path, &p, &contradiction);
    if (status == CP_OK)
        status = print_plan(&p, &a, error);
    if (status == CP_OK)
        status = cp_study_tell_occasions(&p.study, error);
    if (status == CP_OK)
        status = cp_study_tell_options(&p.study, error);
    if (status == CP_OK && a.format == CP_FORMAT_TABLE)
        print_summary(&p);
    if (status == CP_OK)
        status = list_outputs(&p.study, a.format, error);
    if (status == CP_OK)
        list_libraries(&p.study, a.format);
    release(&p);
    if (status == CP_OK && agrees != CP_OK) {
        *error = contradiction;
        status = agrees;
    }
    return status;
}
