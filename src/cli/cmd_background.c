/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/args.h"
#include "cli/commands.h"
#include "run/background_request.h"
#include "study/scenario_outputs.h"
#include "study/study_file.h"
#include "study/sumo_configuration.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct arguments {
    cp_args_input input;
    const char *db_path;
    double duration_s;    /* NAN: the study's, or 900 */
    double step_length_s; /* NAN: 0.1 */
    long seed;            /* < 0: the study's, of a .sumocfg 1 */
    bool free_outputs;
    cp_format format;
} arguments;

enum { DURATION = 't', STEP_LENGTH = 'l', SEED = 'S', DB = 'd', FREE_OUTPUTS = 256 };

static const struct argp_option OPTIONS[] = {
    {"duration", DURATION, "S", 0, "simulated time, s (default: the study's, of a .sumocfg 900)",
     0},
    {"step-length", STEP_LENGTH, "S", 0,
     "step length of a .sumocfg's run, s (default 0.1); a study has its own", 0},
    {"seed", SEED, "N", 0, "SUMO's seed (default: the study's, of a .sumocfg 1)", 0},
    {"db", DB, "FILE", 0, "of a study: store the result in its database too", 0},
    {"allow-sumo-outputs", FREE_OUTPUTS, NULL, 0,
     "let SUMO write and connect wherever the .sumocfg says, not only in its folder", 0},
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
    case DURATION:
        a->duration_s = cp_args_number(state, "--duration", argument, 0.001, 1e6, "s");
        return 0;
    case STEP_LENGTH:
        a->step_length_s = cp_args_number(state, "--step-length", argument, 0.001, 1.0, "s");
        return 0;
    case SEED:
        a->seed = cp_args_integer(state, "--seed", argument, 0, INT32_MAX);
        return 0;
    case DB:
        a->db_path = argument;
        return 0;
    case FREE_OUTPUTS:
        a->free_outputs = true;
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
    .args_doc = "SUMOCFG|STUDY.yaml",
    .doc =
        "Run a network, or every scenario of a study, without any driver error or assistance "
        "function, and tell what contacts remain: the crashes among them are the network's "
        "doing, the others were filtered for the reason given. 'crashpulse run' does the same for "
        "a study and stores it (tables background_run, background_contact)."
        "\v"
        "Reasons: graze, overlap_at_insertion, lane_change_jump, impossible_motion, "
        "clipped_waiting, long_vehicle_turning, no_common_road, other_level. SUMO's own "
        "collision reports stand behind them by what became of them.\n\n"
        "Examples:\n"
        "  crashpulse background town.sumocfg --duration 900\n"
        "  crashpulse background study.yaml --db study.db\n",
    .children = CHILDREN,
};

static bool is_study(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot != NULL && (strcmp(dot, ".yaml") == 0 || strcmp(dot, ".yml") == 0);
}

static const char *text_of(const json_t *object, const char *key)
{
    const char *text = json_string_value(json_object_get(object, key));
    return text != NULL ? text : "";
}

static double number_of(const json_t *object, const char *key)
{
    return json_number_value(json_object_get(object, key));
}

// One row for each reason, and one for each fate of SUMO's reports.
static void add_rows(cp_table *table, const json_t *result)
{
    size_t k;
    json_t *row;
    static const char *const LIST[] = {"contacts", "sumo_collisions"};
    for (int list = 0; list < 2; list++) {
        json_array_foreach(json_object_get(result, LIST[list]), k, row)
        {
            cp_table_text(table, text_of(result, "network"));
            cp_table_real(table, number_of(result, "simulated_s"));
            cp_table_real(table, number_of(result, "vehicle_km"));
            cp_table_text(table, list == 0 ? "ours" : "SUMO");
            cp_table_text(table, text_of(row, list == 0 ? "reason" : "found_as"));
            cp_table_text(table, text_of(row, "crash_type"));
            cp_table_integer(table, (int64_t)number_of(row, list == 0 ? "contacts" : "collisions"));
        }
    }
    if (json_array_size(json_object_get(result, "contacts")) > 0)
        return;
    cp_table_text(table, text_of(result, "network"));
    cp_table_real(table, number_of(result, "simulated_s"));
    cp_table_real(table, number_of(result, "vehicle_km"));
    cp_table_text(table, "ours");
    cp_table_text(table, "none");
    cp_table_text(table, "");
    cp_table_integer(table, 0);
}

static cp_status run_one(const cp_background_request *request, cp_table *table, cp_error *error)
{
    char *text = NULL;
    cp_status status = cp_background_request_run(request, &text, error);
    json_t *result = status == CP_OK ? json_loads(text, 0, NULL) : NULL;
    if (status == CP_OK && result == NULL)
        status =
            cp_fail(error, CP_RUN_FAILED, "%s: the worker's result cannot be read", request->path);
    if (status == CP_OK)
        add_rows(table, result);
    json_decref(result);
    free(text);
    return status;
}

// Options of a .sumocfg: refused or told, and how long at most it runs unless asked otherwise.
static cp_status look_at_options(const arguments *a, cp_background_request *request,
                                 cp_error *error)
{
    cp_sumo_configuration configuration = {0};
    cp_status status = cp_sumo_configuration_read(a->input.path, NULL, 0, &configuration, error);
    if (status == CP_OK) {
        double length_s = cp_sumo_configuration_length_s(&configuration);
        if (isnan(a->duration_s) && length_s > 0.0)
            request->duration_s = fmin(request->duration_s, length_s);
        status = cp_sumo_configuration_check(&configuration, request->duration_s, error);
    }
    const cp_scenario_inputs inputs = {.sumocfg_path = a->input.path};
    if (status == CP_OK && !a->free_outputs)
        status = cp_scenario_outputs_check(&inputs, error);
    if (status == CP_OK)
        cp_sumo_configuration_tell(&configuration);
    cp_sumo_configuration_destroy(&configuration);
    request->time_limit_s = fmax(600.0, 10.0 * request->duration_s);
    return status;
}

static cp_status run_study(const arguments *a, cp_background_request request, cp_table *table,
                           cp_error *error)
{
    cp_study study = {0};
    cp_status status = cp_study_load(a->input.path, &study, error);
    if (status != CP_OK)
        return status;
    status = cp_study_tell_options(&study, error);
    for (size_t k = 0; k < study.scenario_count && status == CP_OK; k++) {
        const cp_scenario_inputs inputs = cp_study_scenario_inputs(&study.scenarios[k]);
        if (!a->free_outputs)
            status = cp_scenario_outputs_check(&inputs, error);
        request.scenario = study.scenarios[k].name;
        if (status == CP_OK)
            status = run_one(&request, table, error);
    }
    cp_study_destroy(&study);
    return status;
}

cp_status cmd_background(int argc, char **argv, cp_error *error)
{
    static const char *const COLUMN[] = {"network", "simulated_s", "vehicle_km", "reported_by",
                                         "reason",  "crash_type",  "contacts"};
    arguments a = {.input = {.one = "network", .missing = "which network? SUMOCFG or STUDY.yaml"},
                   .duration_s = NAN,
                   .step_length_s = NAN,
                   .seed = -1};
    cp_args_parse(&ARGP, argc, argv, &a);
    if (a.db_path != NULL && !is_study(a.input.path))
        return cp_fail(error, CP_BAD_INPUT, "%s: --db is for the scenarios of a study",
                       a.input.path);
    uint64_t seed = a.seed < 0 ? 1 : (uint64_t)a.seed;
    double duration_s = isnan(a.duration_s) && !is_study(a.input.path) ? 900.0 : a.duration_s;
    cp_background_request request = {.path = a.input.path,
                                     .seed = a.seed < 0 && is_study(a.input.path) ? NULL : &seed,
                                     .step_length_s =
                                         isnan(a.step_length_s) ? 0.1 : a.step_length_s,
                                     .duration_s = duration_s,
                                     .free_outputs = a.free_outputs,
                                     .db_path = a.db_path};
    cp_table table = {0};
    cp_table_begin(&table, COLUMN, sizeof COLUMN / sizeof *COLUMN);
    cp_status status = CP_OK;
    if (!is_study(a.input.path))
        status = look_at_options(&a, &request, error);
    if (status == CP_OK)
        status = is_study(a.input.path) ? run_study(&a, request, &table, error)
                                        : run_one(&request, &table, error);
    if (status == CP_OK)
        status = cp_table_print(&table, a.format, stdout, error);
    cp_table_destroy(&table);
    return status;
}
