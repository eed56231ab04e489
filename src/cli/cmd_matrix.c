/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/args.h"
#include "cli/commands.h"
#include "control/control_types.h"
#include "core/log.h"
#include "core/output_files.h"
#include "matrix/matrix_result.h"
#include "matrix/matrix_study.h"
#include "run/runner.h"
#include "study/library_section.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct arguments {
    cp_args_input input;
    const char *db_path;
    const char *function;
    const char *library;
    const char *plot_path;
    size_t jobs;
    bool allow_plugins;
    cp_format format;
} arguments;

enum { PLOT = 256, FUNCTION, LIBRARY, ALLOW_PLUGINS };

static const struct argp_option OPTIONS[] = {
    {"db", 'd', "FILE", 0,
     "database of the runs; network, demand and study are written into FILE.study", 0},
    {"function", FUNCTION, "NAME", 0,
     "this function with its defaults, in place of those that the file lists", 0},
    {"library", LIBRARY, "FILE", 0, "a function from this shared library in their place", 0},
    {"plot", PLOT, "FILE", 0, "map of impact speeds, into a file ending in .svg or .pdf", 0},
    {"jobs", 'j', "N", 0, "worker processes at a time (default: one a processor)", 0},
    {"allow-plugins", ALLOW_PLUGINS, NULL, 0,
     "load the libraries that the file names: code that may do what you may (--library says so "
     "itself)",
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
    case 'd':
        a->db_path = argument;
        return 0;
    case FUNCTION:
        a->function = argument;
        return 0;
    case LIBRARY:
        a->library = argument;
        return 0;
    case PLOT:
        a->plot_path = argument;
        return 0;
    case 'j':
        a->jobs = (size_t)cp_args_integer(state, "--jobs", argument, 1, 1024);
        return 0;
    case ALLOW_PLUGINS:
        a->allow_plugins = true;
        return 0;
    case ARGP_KEY_END:
        cp_args_need(state, a->db_path != NULL, "where to? --db FILE");
        if (a->function && a->library)
            argp_error(state, "either --function or --library");
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
    .args_doc = "MATRIX.yaml",
    .doc = "Run two cars of SUMO through every cell of a matrix of encounters, without a function "
           "and with it in the own car, and print what became of each: avoided, or the own speed "
           "at impact, delta-v and OLC."
           "\v"
           "The runs are an ordinary study, one simulation in which every cell has a track of its "
           "own: 'crashpulse sql', 'report' and the rest work on its database.\n\n"
           "Example:\n"
           "  crashpulse matrix sumo_scenarios/ncap/ccftap.yaml --function aeb --db ccftap.db "
           "--plot ccftap.svg\n",
    .children = CHILDREN,
};

// ---- the function --------------------------------------------------------------------------

// The one of the command line in place of those of the file.
static cp_status choose_function(const arguments *a, cp_matrix *matrix, cp_error *error)
{
    if (a->function == NULL && a->library == NULL)
        return matrix->function_count > 0
                   ? CP_OK
                   : cp_fail(error, CP_BAD_INPUT,
                             "%s: lists no functions; --function NAME or --library FILE says which",
                             a->input.path);
    const cp_control_type *type = a->function != NULL
                                      ? cp_control_type_find(CP_CONTROL_FUNCTION, a->function)
                                      : &CP_CONTROL_PLUGIN;
    if (type == NULL || (a->function != NULL && type->function == NULL))
        return cp_fail(error, CP_BAD_INPUT, "there is no function '%s'", a->function);
    cp_library *library = NULL;
    cp_control_settings *own = calloc(1, sizeof *own);
    cp_status status = own != NULL ? CP_OK : cp_fail_memory(error, "function");
    if (status == CP_OK && a->library != NULL)
        status = cp_library_from_file(a->library, &library, error);
    if (status != CP_OK) {
        free(own);
        return status;
    }
    *own = cp_control_settings_default(type);
    own->library = library;
    for (size_t k = 0; k < matrix->function_count; k++)
        cp_library_destroy(matrix->functions[k].library);
    free(matrix->functions);
    matrix->functions = own;
    matrix->function_count = 1;
    return CP_OK;
}

// ---- running -------------------------------------------------------------------------------

static cp_status run(const arguments *a, const cp_matrix *matrix, cp_error *error)
{
    char *folder = malloc(strlen(a->db_path) + sizeof ".study"), *study = NULL;
    if (folder == NULL)
        return cp_fail_memory(error, a->db_path);
    strcat(strcpy(folder, a->db_path), ".study");
    cp_runner_summary summary;
    long processors = sysconf(_SC_NPROCESSORS_ONLN);
    cp_status status = cp_matrix_study_write(matrix, folder, &study, error);
    cp_runner_options options = {.study_path = study,
                                 .db_path = a->db_path,
                                 .jobs = a->jobs > 0 ? a->jobs
                                                     : (size_t)(processors > 0 ? processors : 1),
                                 .allow_plugins = a->allow_plugins || a->library != NULL};
    if (status == CP_OK)
        status = cp_runner_run(&options, &summary, error);
    free(study);
    free(folder);
    return status;
}

// ---- table ---------------------------------------------------------------------------------

#define OUTCOME_COLUMNS 9

static void begin_table(const cp_matrix *matrix, cp_table *table)
{
    static const char *const OUTCOME[OUTCOME_COLUMNS] = {
        "outcome",    "impact_km_h", "closing_km_h", "delta_v_km_h",       "olc_g",
        "contact_on", "overlap_1",   "validity",     "without_impact_km_h"};
    const char *column[1 + CP_MATRIX_AXES + OUTCOME_COLUMNS] = {"cell"};
    size_t count = 1;
    for (size_t k = 0; k < matrix->axis_count; k++)
        column[count++] = cp_cell_parameter_name(matrix->axis[k].parameter);
    for (size_t k = 0; k < OUTCOME_COLUMNS; k++)
        column[count++] = OUTCOME[k];
    cp_table_begin(table, column, count);
}

static void add_cell(const cp_matrix *matrix, const cp_matrix_result *result, size_t k,
                     cp_table *table)
{
    double parameter[CP_CELL_PARAMETER_COUNT];
    const cp_cell_outcome *with = &result->with[k], *without = &result->without[k];
    cp_matrix_cell(matrix, k, parameter);
    cp_table_integer(table, (int64_t)k);
    for (size_t axis = 0; axis < matrix->axis_count; axis++)
        cp_table_real(table, parameter[matrix->axis[axis].parameter]);
    cp_table_text(table, with->is_impact          ? "impact"
                         : with->touch[0] != '\0' ? with->touch
                         : without->is_impact     ? "avoided"
                                                  : "no encounter");
    cp_table_real(table, 3.6 * with->impact_m_s);
    cp_table_real(table, 3.6 * with->closing_m_s);
    cp_table_real(table, 3.6 * with->delta_v_m_s);
    cp_table_real(table, with->olc_g);
    cp_table_text(table, with->contact_side);
    cp_table_real(table, with->overlap_1);
    cp_table_text(table, !with->is_impact ? "" : with->is_inside ? "inside" : "outside");
    cp_table_real(table, 3.6 * without->impact_m_s);
}

static cp_status print_result(const arguments *a, const cp_matrix *matrix,
                              const cp_matrix_result *result, cp_error *error)
{
    cp_table table = {0};
    size_t missed = 0;
    begin_table(matrix, &table);
    for (size_t k = 0; k < result->count; k++) {
        missed += !result->without[k].is_impact;
        add_cell(matrix, result, k, &table);
    }
    cp_status status = cp_table_print(&table, a->format, stdout, error);
    cp_table_destroy(&table);
    if (missed > 0)
        cp_log_warning("in %zu of %zu cells the two cars do not meet without the function either",
                       missed, result->count);
    if (a->format == CP_FORMAT_TABLE)
        printf("\n%s: %s\n", matrix->name, matrix->source);
    return status;
}

cp_status cmd_matrix(int argc, char **argv, cp_error *error)
{
    arguments a = {.input = {.one = "matrix file", .missing = "which matrix? MATRIX.yaml"}};
    cp_args_parse(&ARGP, argc, argv, &a);
    const char *const outputs[] = {a.db_path, a.plot_path};
    const char *const inputs[] = {a.input.path, a.library};
    cp_matrix matrix = {0};
    cp_matrix_result result = {0};
    cp_store *store = NULL;
    cp_status status = cp_output_files_check(outputs, 2, inputs, 2, error);
    if (status == CP_OK)
        status = cp_matrix_load(a.input.path, &matrix, error);
    if (status == CP_OK)
        status = choose_function(&a, &matrix, error);
    if (status == CP_OK)
        status = run(&a, &matrix, error);
    if (status == CP_OK)
        status = cp_store_open(a.db_path, CP_STORE_READ, &store, error);
    if (status == CP_OK)
        status = cp_matrix_result_read(store, &matrix, &result, error);
    cp_store_close(store);
    if (status == CP_OK)
        status = print_result(&a, &matrix, &result, error);
    if (status == CP_OK && a.plot_path != NULL)
        status = cp_matrix_plot(&matrix, &result, a.plot_path, error);
    cp_matrix_result_destroy(&result);
    cp_matrix_destroy(&matrix);
    return status;
}
