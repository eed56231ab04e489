/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/caveats.h"
#include "analysis/comparison.h"
#include "analysis/comparison_store.h"
#include "analysis/field_comparison.h"
#include "analysis/grouping.h"
#include "analysis/network_background.h"
#include "analysis/quantity.h"
#include "cli/args.h"
#include "cli/commands.h"
#include "cli/comparison_table.h"
#include "cli/field_output.h"
#include "core/log.h"
#include "report/answer.h"
#include "report/comparison_json.h"
#include "report/field_words.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct arguments {
    cp_args_input input;
    const char *baseline;
    const char *scenario;
    const char *by;
    const char *where;
    double above[CP_EXCEEDED_COUNT]; /* OLC in g, delta-v in m/s */
    bool no_store;
    bool model_uncertainty;
    const char *field;
    const char *field_margins;
    double field_cap;
    cp_format format;
} arguments;

enum {
    KEY_NO_STORE = 256,
    KEY_ABOVE_OLC,
    KEY_ABOVE_DELTA_V,
    KEY_MODEL_UNCERTAINTY,
    KEY_FIELD,
    KEY_FIELD_MARGINS,
    KEY_FIELD_CAP
};

static const struct argp_option OPTIONS[] = {
    {"baseline", 'b', "VARIANT", 0, "compare with this variant (default: the study's baseline)", 0},
    {"scenario", 's', "NAME", 0, "crashes and exposure of this scenario only", 0},
    {"by", 'y', "COLUMN", 0,
     "one comparison for each value: scenario, crash_type, validity, vehicle_model, … (any column "
     "of the view crash_vehicle_list)",
     0},
    {"where", 'w', "SQL", 0,
     "only vehicles for which this holds, over columns of crash_vehicle_list; exposure stays whole",
     0},
    {"above-olc", KEY_ABOVE_OLC, "G", 0,
     "how often crashes above this OLC happen, g (default 15); the report has the curve", 0},
    {"above-delta-v", KEY_ABOVE_DELTA_V, "KM/H", 0, "the same above this delta-v (default 30)", 0},
    {"model-uncertainty", KEY_MODEL_UNCERTAINTY, NULL, 0,
     "also by every parameter set of the vehicle models' ensembles: what of the uncertainty of OLC "
     "comes from replications and what from the model",
     0},
    {"field", KEY_FIELD, "NAME|FILE", 0,
     "also beside crashes of the field: nass (NASS-CDS, inside the program) or a table of the same "
     "form (db/field/README.md); distances, and all figures with the field's mix",
     0},
    {"field-margins", KEY_FIELD_MARGINS, "LIST", 0,
     "what the mix is of, for treatments too: some of crash_type,delta_v,overlap (default: all, "
     "where treatments are compared without delta_v)",
     0},
    {"field-cap", KEY_FIELD_CAP, "X", 0, "no weight is above X times the mean (default 5)", 0},
    {"no-store", KEY_NO_STORE, NULL, 0, "leave the tables comparison and comparison_figure alone",
     0},
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
    case 'b':
        a->baseline = argument;
        return 0;
    case 's':
        a->scenario = argument;
        return 0;
    case 'y':
        a->by = argument;
        return 0;
    case 'w':
        a->where = argument;
        return 0;
    case KEY_ABOVE_OLC:
        a->above[CP_EXCEEDED_OLC] = cp_args_number(state, "--above-olc", argument, 0.0, 200.0, "g");
        return 0;
    case KEY_ABOVE_DELTA_V:
        a->above[CP_EXCEEDED_DELTA_V] =
            cp_args_number(state, "--above-delta-v", argument, 0.0, 400.0, "km/h") / 3.6;
        return 0;
    case KEY_FIELD:
        a->field = argument;
        return 0;
    case KEY_FIELD_MARGINS:
        a->field_margins = argument;
        return 0;
    case KEY_FIELD_CAP:
        a->field_cap = cp_args_number(state, "--field-cap", argument, 1.1, 1e6, "");
        return 0;
    case KEY_NO_STORE:
        a->no_store = true;
        return 0;
    case KEY_MODEL_UNCERTAINTY:
        a->model_uncertainty = true;
        return 0;
    case ARGP_KEY_END:
        if (!a->field && (a->field_margins || a->field_cap > 0.0))
            argp_error(state, "--field-margins and --field-cap go with --field");
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
    .doc = "Compare the variants of a study: how often it crashes (rates of frontal crashes per "
           "million vehicle-km), how severe the crashes are (OLC, delta-v and closing speed of the "
           "frontally struck vehicles) and what injuries that leads to expect, each treatment "
           "against the baseline; for counterfactual studies what became of each baseline crash."
           "\v"
           "Intervals and tests take whole replications, because crashes of one replication are "
           "not independent. Rates have two intervals: by bootstrap over replications, from 20 of "
           "them on, and of Poisson counts widened by what replications differ. Severities are "
           "compared at the same mix of scenarios, by a test that holds when one variant crashes "
           "more often; where crashes are too few for an interval or a test the reason stands in "
           "its place. What lies outside the surrogate's validated range counts with its "
           "extrapolated severity, and as unknown in the bounds. "
           "With --model-uncertainty all crashes count by one parameter set after the other, as a "
           "set that is wrong is wrong for all of them; the half-width over the sets (Student's t) "
           "and that of the replications are combined as the root of the sum of their squares. "
           "With --field the baseline's frontally struck vehicles are weighted so that crash type, "
           "delta-v without rebound and overlap have the field's margins (raking), found anew in "
           "every resample; what the field has and the study never makes stays missing, and is "
           "said. "
           "Rates are conditional on the "
           "study's driver errors. OLC describes "
           "the crash pulse of a car; injuries come from the table risk_function, which is yours "
           "to edit. The figures are also written to the tables comparison and "
           "comparison_figure.\n\n"
           "Examples:\n"
           "  crashpulse compare demo.db\n"
           "  crashpulse compare demo.db --baseline aeb --format json\n"
           "  crashpulse compare demo.db --field nass\n"
           "  crashpulse compare demo.db --by crash_type --where \"closing_speed_m_s > 10\"\n"
           "  crashpulse sql demo.db \"SELECT * FROM comparison_figure WHERE against <> ''\"\n",
    .children = CHILDREN,
};

/* Everything one call works with. */
typedef struct job {
    arguments a;
    cp_store *store;
    cp_study_data data;
    cp_grouping grouping;
    cp_network_backgrounds backgrounds;
    cp_caveats caveats;
    cp_comparison *comparison; /* one a group */
    char **answer;
    char **field_words; /* one a group; NULL without a field */
    cp_comparison_options options;
    cp_model_ensemble ensemble;
    cp_field_table field_table;
    cp_field_study field_study;
    cp_field_request field;
} job;

static void job_destroy(job *j)
{
    for (size_t k = 0; k < j->grouping.count; k++) {
        if (j->comparison)
            cp_comparison_destroy(&j->comparison[k]);
        if (j->answer)
            free(j->answer[k]);
        if (j->field_words)
            free(j->field_words[k]);
    }
    free(j->field_words);
    free(j->comparison);
    free(j->answer);
    cp_grouping_destroy(&j->grouping);
    cp_network_backgrounds_destroy(&j->backgrounds);
    cp_caveats_destroy(&j->caveats);
    cp_model_ensemble_destroy(&j->ensemble);
    cp_field_table_destroy(&j->field_table);
    cp_field_study_destroy(&j->field_study);
    cp_study_data_destroy(&j->data);
    cp_store_close(j->store);
}

static cp_status read_ensemble(job *j, cp_error *error)
{
    cp_status status = cp_model_ensemble_read(j->store, &j->data, &j->ensemble, error);
    if (status == CP_OK && j->ensemble.count < CP_MODEL_SETS_MIN && j->data.evidence_count == 0)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s: its crashes have %zu parameter sets in common, --model-uncertainty "
                       "needs %d at least; a vehicle file gets an ensemble by 'ensemble:' of its "
                       "fit file (crashpulse calibrate), 'crashpulse run' then simulates by each",
                       j->a.input.path, j->ensemble.count, CP_MODEL_SETS_MIN);
    j->options.ensemble = &j->ensemble;
    return status;
}

// The names of --field-margins.
static cp_status read_margins(const char *list, bool margin[CP_FIELD_MARGIN_COUNT], cp_error *error)
{
    for (int m = 0; m < CP_FIELD_MARGIN_COUNT; m++)
        margin[m] = list == NULL;
    while (list && *list) {
        size_t length = strcspn(list, ",");
        int m = 0;
        while (m < CP_FIELD_MARGIN_COUNT && (strlen(CP_FIELD_MARGIN_TEXT[m]) != length ||
                                             strncmp(list, CP_FIELD_MARGIN_TEXT[m], length) != 0))
            m++;
        if (m == CP_FIELD_MARGIN_COUNT)
            return cp_fail(error, CP_BAD_INPUT,
                           "--field-margins: must be a list of crash_type, delta_v and overlap, "
                           "found '%.*s'",
                           (int)length, list);
        margin[m] = true;
        list += length + (list[length] == ',');
    }
    return CP_OK;
}

static cp_status read_field(job *j, cp_error *error)
{
    cp_status status = read_margins(j->a.field_margins, j->field.margin, error);
    if (status == CP_OK)
        status = cp_field_table_read(j->a.field, &j->field_table, error);
    if (status == CP_OK)
        status = cp_field_study_read(j->store, &j->data, &j->field_study, error);
    j->field.table = &j->field_table;
    j->field.study = &j->field_study;
    j->field.exact = j->a.field_margins != NULL;
    j->field.cap = j->a.field_cap > 0.0 ? j->a.field_cap : CP_FIELD_CAP;
    j->options.field = &j->field;
    return status;
}

static cp_status compare_groups(job *j, size_t baseline, cp_error *error)
{
    j->comparison = calloc(j->grouping.count, sizeof *j->comparison);
    j->answer = calloc(j->grouping.count, sizeof *j->answer);
    j->field_words = calloc(j->grouping.count, sizeof *j->field_words);
    if (!j->comparison || !j->answer || !j->field_words)
        return cp_fail_memory(error, "a comparison");
    cp_status status = CP_OK;
    for (size_t k = 0; k < j->grouping.count && status == CP_OK; k++) {
        status = cp_compare(&j->data, baseline, j->grouping.slice[k], &j->options,
                            &j->comparison[k], error);
        if (status == CP_OK)
            status = cp_comparison_answer(&j->data, &j->comparison[k], &j->answer[k], error);
        if (status == CP_OK && j->options.field)
            status = cp_field_words(&j->comparison[k], &j->field, &j->field_words[k], error);
    }
    return status;
}

static json_t *group_json(const job *j, size_t k)
{
    json_t *result = cp_comparison_json(&j->data, &j->comparison[k]);
    if (j->a.by)
        json_object_set_new(result, "by_value", json_string(j->grouping.name[k]));
    if (j->field_words && j->field_words[k])
        json_object_set_new(result, "field_words", json_string(j->field_words[k]));
    if (json_object_set_new(result, "study", json_string(j->data.name)) != 0 ||
        json_object_set_new(result, "background", cp_network_backgrounds_json(&j->backgrounds)) !=
            0 ||
        json_object_set_new(result, "caveats", cp_caveats_json(&j->caveats)) != 0 ||
        json_object_set_new(result, "answer", json_string(j->answer[k])) != 0) {
        json_decref(result);
        return NULL;
    }
    return result;
}

// One object, or with --by an array of them.
static cp_status print_json(const job *j, cp_error *error)
{
    if (!j->a.by)
        return cp_json_print(group_json(j, 0), stdout, error);
    json_t *groups = json_array();
    for (size_t k = 0; k < j->grouping.count; k++) {
        if (json_array_append_new(groups, group_json(j, k)) != 0) {
            json_decref(groups);
            return cp_fail_memory(error, "a comparison");
        }
    }
    return cp_json_print(groups, stdout, error);
}

static cp_status print_tables(const job *j, cp_error *error)
{
    cp_status status = CP_OK;
    const char *design = j->data.counterfactual ? "counterfactual"
                         : j->data.paired       ? "paired seeds"
                                                : "independent seeds";
    for (size_t k = 0; k < j->grouping.count && status == CP_OK; k++) {
        char heading[512];
        int used = snprintf(heading, sizeof heading, "%sStudy %s, %s", k ? "\n" : "", j->data.name,
                            design);
        if (j->a.scenario && used > 0 && (size_t)used < sizeof heading)
            used += snprintf(heading + used, sizeof heading - (size_t)used, ", scenario %s",
                             j->a.scenario);
        if (j->a.by && used > 0 && (size_t)used < sizeof heading)
            used += snprintf(heading + used, sizeof heading - (size_t)used, ", %s = %s", j->a.by,
                             j->grouping.name[k]);
        if (j->a.where && used > 0 && (size_t)used < sizeof heading)
            snprintf(heading + used, sizeof heading - (size_t)used, ", where %s", j->a.where);
        status = cp_comparison_print_table(&j->data, &j->comparison[k], heading, j->answer[k],
                                           stdout, error);
        if (status == CP_OK && j->options.field) {
            status = cp_field_print_table(&j->comparison[k], stdout, error);
            cp_comparison_print_paragraph(j->field_words[k], stdout);
        }
    }

    // Below, once: what of it all is not the drivers' doing.
    char *paragraph = NULL;
    if (status == CP_OK)
        status = cp_network_backgrounds_paragraph(&j->backgrounds, &paragraph, error);
    if (status == CP_OK && paragraph[0])
        cp_comparison_print_paragraph(paragraph, stdout);
    free(paragraph);
    if (status != CP_OK)
        return status;
    paragraph = cp_caveats_paragraph(&j->caveats);
    if (paragraph == NULL)
        return cp_fail_memory(error, "caveats");
    if (paragraph[0])
        cp_comparison_print_paragraph(paragraph, stdout);
    free(paragraph);
    return status;
}

static cp_status print(const job *j, cp_error *error)
{
    if (j->a.format == CP_FORMAT_JSON)
        return print_json(j, error);
    if (j->a.format == CP_FORMAT_CSV)
        return cp_comparison_print_csv(&j->data, j->comparison, j->a.by ? j->grouping.name : NULL,
                                       j->grouping.count, stdout, error);
    return print_tables(j, error);
}

static cp_status store(job *j, cp_error *error)
{
    return cp_comparison_store(j->store, &j->data, j->comparison, j->grouping.name,
                               j->grouping.count, &j->options, j->a.scenario ? j->a.scenario : "",
                               j->a.by ? j->a.by : "", j->a.where ? j->a.where : "",
                               j->a.by ? "" : j->answer[0], error);
}

cp_status cmd_compare(int argc, char **argv, cp_error *error)
{
    job j = {.a.input = CP_ARGS_DATABASE, .options = cp_comparison_options_default()};
    memcpy(j.a.above, j.options.above, sizeof j.a.above);
    cp_args_parse(&ARGP, argc, argv, &j.a);
    memcpy(j.options.above, j.a.above, sizeof j.a.above);

    // A database that cannot be written can be compared all the same.
    bool stored = !j.a.no_store;
    if (stored && access(j.a.input.path, F_OK) == 0 && access(j.a.input.path, W_OK) != 0) {
        cp_log_warning("%s is read-only: the figures are not stored in it", j.a.input.path);
        stored = false;
    }
    size_t baseline = 0;
    cp_status status =
        cp_store_open(j.a.input.path, stored ? CP_STORE_WRITE : CP_STORE_READ, &j.store, error);
    if (status == CP_OK)
        status = cp_study_data_read(j.store, &j.data, error);
    if (status == CP_OK)
        status = cp_study_data_variant(&j.data, j.a.baseline, &baseline, error);
    if (status == CP_OK && j.a.model_uncertainty)
        status = read_ensemble(&j, error);
    if (status == CP_OK && j.a.field)
        status = read_field(&j, error);
    if (status == CP_OK && j.data.unfinished > 0)
        cp_log_warning("replications that are not finished and not counted: %zu",
                       j.data.unfinished);
    if (status == CP_OK)
        status = cp_grouping_create(j.store, &j.data, j.a.scenario, j.a.by, j.a.where, &j.grouping,
                                    error);
    if (status == CP_OK)
        status = cp_network_backgrounds_read(j.store, j.a.scenario, &j.backgrounds, error);
    if (status == CP_OK)
        status = cp_caveats_read(j.store, j.a.scenario, &j.caveats, error);
    if (status == CP_OK)
        status = compare_groups(&j, baseline, error);
    if (status == CP_OK && stored)
        status = store(&j, error);
    if (status == CP_OK)
        status = print(&j, error);
    job_destroy(&j);
    return status;
}
