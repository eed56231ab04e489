/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/args.h"
#include "cli/commands.h"
#include "cli/comparison_table.h"
#include "core/log.h"
#include "report/answer.h"
#include "report/comparison_json.h"

#include <stdlib.h>

typedef struct arguments {
    const char *db_path;
    const char *baseline;
    cp_format format;
} arguments;

static const struct argp_option OPTIONS[] = {
    {"baseline", 'b', "VARIANT", 0, "compare with this variant (default: the study's baseline)", 0},
    {0},
};

static error_t parse(int key, char *argument, struct argp_state *state)
{
    arguments *a = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &a->format;
        return 0;
    case 'b':
        a->baseline = argument;
        return 0;
    case ARGP_KEY_ARG:
        if (a->db_path)
            argp_error(state, "one database at a time, found '%s' too", argument);
        a->db_path = argument;
        return 0;
    case ARGP_KEY_END:
        if (!a->db_path)
            argp_error(state, "which database? DB is missing");
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child CHILDREN[] = {{&CP_ARGS_FORMAT, 0, NULL, 0}, {0}};

static const struct argp ARGP = {
    .options = OPTIONS,
    .parser = parse,
    .args_doc = "DB",
    .doc = "Compare the variants of a study: how often it crashes (rates of frontal crashes per "
           "million vehicle-km) and how severe the crashes are (OLC of the frontally struck "
           "vehicles), each treatment against the baseline."
           "\v"
           "Intervals by bootstrap and p-values by permutation take whole replications, because "
           "crashes of one replication are not independent; under 20 replications there is no "
           "bootstrap interval. Rates are conditional on the study's driver errors. OLC describes "
           "the crash pulse of a car.\n\n"
           "Examples:\n"
           "  crashpulse compare demo.db\n"
           "  crashpulse compare demo.db --baseline aeb --format json\n",
    .children = CHILDREN,
};

static cp_status print_json(const cp_study_data *data, const cp_comparison *comparison,
                            const char *answer, cp_error *error)
{
    json_t *result = cp_comparison_json(data, comparison);
    if (json_object_set_new(result, "study", json_string(data->name)) != 0 ||
        json_object_set_new(result, "answer", json_string(answer)) != 0) {
        json_decref(result);
        result = NULL;
    }
    return cp_json_print(result, stdout, error);
}

static cp_status print(const cp_study_data *data, const cp_comparison *comparison, cp_format format,
                       cp_error *error)
{
    char *answer = NULL;
    cp_status status = cp_comparison_answer(data, comparison, &answer, error);
    if (status != CP_OK)
        return status;
    if (format == CP_FORMAT_JSON)
        status = print_json(data, comparison, answer, error);
    else if (format == CP_FORMAT_CSV)
        status = cp_comparison_print_csv(data, comparison, stdout, error);
    else
        status = cp_comparison_print_table(data, comparison, answer, stdout, error);
    free(answer);
    return status;
}

cp_status cmd_compare(int argc, char **argv, cp_error *error)
{
    arguments a = {0};
    cp_args_parse(&ARGP, argc, argv, &a);

    cp_store *store = NULL;
    cp_study_data data = {0};
    cp_comparison comparison = {0};
    size_t baseline = 0;
    cp_comparison_options options = cp_comparison_options_default();
    cp_status status = cp_store_open(a.db_path, CP_STORE_READ, &store, error);
    if (status == CP_OK)
        status = cp_study_data_read(store, &data, error);
    if (status == CP_OK)
        status = cp_study_data_variant(&data, a.baseline, &baseline, error);
    if (status == CP_OK && data.unfinished > 0)
        cp_log_warning("replications that are not finished and not counted: %zu", data.unfinished);
    if (status == CP_OK)
        status = cp_compare(&data, baseline, (cp_slice){CP_SLICE_ALL, CP_SLICE_ALL}, &options,
                            &comparison, error);
    if (status == CP_OK)
        status = print(&data, &comparison, a.format, error);
    cp_comparison_destroy(&comparison);
    cp_study_data_destroy(&data);
    cp_store_close(store);
    return status;
}
