/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/comparison.h"
#include "analysis/grouping.h"
#include "cli/args.h"
#include "cli/commands.h"
#include "core/log.h"
#include "core/output_files.h"
#include "report/plot.h"

#include <string.h>

typedef struct arguments {
    cp_args_input input;
    const char *output_path;
    const char *baseline;
    const char *scenario;
    const char *where;
    cp_plot_kind kind;
    bool has_kind;
    int scope;
} arguments;

enum { KEY_INSIDE = 256 };

static const struct argp_option OPTIONS[] = {
    {"output", 'o', "FILE", 0, "file to write, ending in .svg or .pdf", 0},
    {"baseline", 'b', "VARIANT", 0, "compare with this variant (default: the study's baseline)", 0},
    {"scenario", 's', "NAME", 0, "crashes and exposure of this scenario only", 0},
    {"where", 'w', "SQL", 0, "only vehicles for which this holds, as in compare", 0},
    {"inside", KEY_INSIDE, NULL, 0,
     "describe vehicles inside the validated range only (olc, delta-v, severity, map, sites, "
     "corridor; counterfactual: crashes that were inside with the baseline); "
     "differences and benefits are of all",
     0},
    {0},
};

static const char *const KIND[] = {
#define CP_PLOT_TEXT(kind, name, what) name,
    CP_PLOT_KINDS(CP_PLOT_TEXT)
#undef CP_PLOT_TEXT
};

static void read_kind(arguments *a, const char *text, struct argp_state *state)
{
    for (int k = 0; k < CP_PLOT_KIND_COUNT; k++) {
        if (strcmp(text, KIND[k]) == 0) {
            a->kind = (cp_plot_kind)k;
            a->has_kind = true;
            return;
        }
    }
    argp_error(state,
               "KIND must be rates, olc, delta-v, difference, forest, severity, map, sites, "
               "outcomes, benefit, risk, corridor, above-olc, above-delta-v, convergence or dose, "
               "found '%s'",
               text);
}

static error_t parse(int key, char *argument, struct argp_state *state)
{
    arguments *a = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &a->input;
        return 0;
    case 'o':
        a->output_path = argument;
        return 0;
    case 'b':
        a->baseline = argument;
        return 0;
    case 's':
        a->scenario = argument;
        return 0;
    case 'w':
        a->where = argument;
        return 0;
    case KEY_INSIDE:
        a->scope = CP_SCOPE_INSIDE;
        return 0;
    case ARGP_KEY_ARG:
        if (a->input.path == NULL)
            return ARGP_ERR_UNKNOWN;
        if (a->has_kind)
            argp_error(state, "one kind at a time, found '%s' too", argument);
        read_kind(a, argument, state);
        return 0;
    case ARGP_KEY_END:
        cp_args_need(state, a->has_kind, "which figure? KIND");
        cp_args_need(state, a->output_path != NULL, "where to? --output FILE.svg or FILE.pdf");
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child CHILDREN[] = {{&CP_ARGS_INPUT, 0, NULL, 0}, {0}};

static const struct argp ARGP = {
    .options = OPTIONS,
    .parser = parse,
    .args_doc = "DB KIND --output FILE",
    .doc = "Draw one figure of a study for a paper, with gnuplot: as SVG or PDF by the ending of "
           "FILE."
           "\v"
           "KIND is one of\n"
#define CP_PLOT_HELP(kind, name, what) "  " name ": " what "\n"
    CP_PLOT_KINDS(CP_PLOT_HELP)
#undef CP_PLOT_HELP
        "\n"
        "Examples:\n"
        "  crashpulse plot demo.db olc --output olc.pdf\n"
        "  crashpulse plot demo.db map --scenario left_turn --output map.svg\n",
    .children = CHILDREN,
};

cp_status cmd_plot(int argc, char **argv, cp_error *error)
{
    arguments a = {.input = CP_ARGS_DATABASE, .scope = CP_SCOPE_ALL};
    cp_args_parse(&ARGP, argc, argv, &a);
    cp_store *store = NULL;
    cp_study_data data = {0};
    cp_grouping grouping = {0};
    cp_comparison comparison = {0};
    size_t baseline = 0;
    cp_comparison_options options = cp_comparison_options_default();
    options.permutations = 0; // no figure shows a p-value
    cp_status status =
        cp_output_files_check(&a.output_path, 1, (const char *const[]){a.input.path}, 1, error);
    if (status == CP_OK)
        status = cp_store_open(a.input.path, CP_STORE_READ, &store, error);
    if (status == CP_OK)
        status = cp_study_data_read(store, &data, error);
    if (status == CP_OK)
        status = cp_study_data_variant(&data, a.baseline, &baseline, error);
    if (status == CP_OK)
        status = cp_grouping_create(store, &data, a.scenario, NULL, a.where, &grouping, error);
    if (status == CP_OK)
        status = cp_compare(&data, baseline, grouping.slice[0], &options, &comparison, error);
    if (status == CP_OK)
        status = cp_plot_write(store, &data, &comparison, a.scope, a.kind, a.output_path, error);
    if (status == CP_OK)
        cp_log_info("wrote %s", a.output_path);
    cp_comparison_destroy(&comparison);
    cp_grouping_destroy(&grouping);
    cp_study_data_destroy(&data);
    cp_store_close(store);
    return status;
}
