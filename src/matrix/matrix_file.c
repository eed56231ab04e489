/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "matrix/matrix_file.h"

#include "core/yaml_file.h"
#include "study/control_section.h"
#include "study/library_section.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define KEY_PATH_SIZE 128
#define NAME_CHARACTERS_MAX 64

static const char *const ENCOUNTER[CP_ENCOUNTER_COUNT] = {
#define ENCOUNTER_TEXT(symbol, text) [symbol] = text,
    CP_ENCOUNTERS(ENCOUNTER_TEXT)
#undef ENCOUNTER_TEXT
};

/* What a parameter of a cell is. */
typedef struct cell_row {
    const char *name;
    double standard, smallest, largest;
} cell_row;

static const cell_row CELL[CP_CELL_PARAMETER_COUNT] = {
#define CELL_ROW(symbol, name, standard, smallest, largest, what)                                  \
    [symbol] = {name, standard, smallest, largest},
    CP_CELL_PARAMETERS(CELL_ROW)
#undef CELL_ROW
};

const char *cp_cell_parameter_name(cp_cell_parameter parameter)
{
    return CELL[parameter].name;
}

// ---- the file as libcyaml reads it ---------------------------------------------------------

typedef struct raw_fixed {
    char *parameter;
    char *value;
} raw_fixed;

typedef struct raw_axis {
    char *parameter;
    char **values;
    unsigned values_count;
} raw_axis;

typedef struct raw_function {
    char *function;
    char *library;
    char *as;
    char *data;
} raw_function;

typedef struct raw_matrix {
    char *matrix;
    char *source;
    char *encounter;
    char *step_length_s;
    char *lead_s;
    char *length_m;
    char *width_m;
    char *model;
    raw_fixed *fixed;
    unsigned fixed_count;
    raw_axis *axes;
    unsigned axes_count;
    raw_function *functions;
    unsigned functions_count;
} raw_matrix;

#define TEXT(key, structure, member)                                                               \
    CYAML_FIELD_STRING_PTR(key, CYAML_FLAG_POINTER, structure, member, 1, CYAML_UNLIMITED)
#define TEXT_OPTIONAL(key, structure, member)                                                      \
    CYAML_FIELD_STRING_PTR(key, CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, structure, member, 1,    \
                           CYAML_UNLIMITED)
#define LIST_OPTIONAL(key, structure, member, entry)                                               \
    CYAML_FIELD_SEQUENCE(key, CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, structure, member, &entry, \
                         0, CYAML_UNLIMITED)

static const cyaml_schema_value_t WORD = {
    CYAML_VALUE_STRING(CYAML_FLAG_POINTER, char *, 0, CYAML_UNLIMITED)};

static const cyaml_schema_field_t FIXED_FIELDS[] = {
    TEXT("parameter", raw_fixed, parameter), TEXT("value", raw_fixed, value), CYAML_FIELD_END};
static const cyaml_schema_value_t FIXED = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, raw_fixed, FIXED_FIELDS)};

static const cyaml_schema_field_t AXIS_FIELDS[] = {
    TEXT("parameter", raw_axis, parameter),
    CYAML_FIELD_SEQUENCE("values", CYAML_FLAG_POINTER, raw_axis, values, &WORD, 1, CYAML_UNLIMITED),
    CYAML_FIELD_END};
static const cyaml_schema_value_t AXIS = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, raw_axis, AXIS_FIELDS)};

static const cyaml_schema_field_t FUNCTION_FIELDS[] = {
    TEXT("function", raw_function, function),
    TEXT_OPTIONAL("library", raw_function, library),
    TEXT_OPTIONAL("as", raw_function, as),
    TEXT_OPTIONAL("data", raw_function, data),
    CYAML_FIELD_IGNORE("parameters", CYAML_FLAG_OPTIONAL),
    CYAML_FIELD_END};
static const cyaml_schema_value_t FUNCTION = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, raw_function, FUNCTION_FIELDS)};

static const cyaml_schema_field_t MATRIX_FIELDS[] = {
    TEXT("matrix", raw_matrix, matrix),
    TEXT("source", raw_matrix, source),
    TEXT("encounter", raw_matrix, encounter),
    TEXT_OPTIONAL("step_length_s", raw_matrix, step_length_s),
    TEXT_OPTIONAL("lead_s", raw_matrix, lead_s),
    TEXT_OPTIONAL("length_m", raw_matrix, length_m),
    TEXT_OPTIONAL("width_m", raw_matrix, width_m),
    TEXT_OPTIONAL("model", raw_matrix, model),
    LIST_OPTIONAL("fixed", raw_matrix, fixed, FIXED),
    CYAML_FIELD_SEQUENCE("axes", CYAML_FLAG_POINTER, raw_matrix, axes, &AXIS, 1, CP_MATRIX_AXES),
    LIST_OPTIONAL("functions", raw_matrix, functions, FUNCTION),
    CYAML_FIELD_END};
static const cyaml_schema_value_t MATRIX = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_POINTER, raw_matrix, MATRIX_FIELDS)};

// ---- checks --------------------------------------------------------------------------------

static cp_status take_name(const cp_yaml_file *file, const char *text, cp_matrix *matrix,
                           cp_error *error)
{
    size_t length = strlen(text);
    bool good = length > 0 && length <= NAME_CHARACTERS_MAX;
    for (const char *c = text; good && *c != '\0'; c++)
        good = isalnum((unsigned char)*c) || strchr("_-.", *c) != NULL;
    if (!good)
        return cp_yaml_fail(file, error, "matrix",
                            "must be 1 to %d letters, digits, '_', '-' or '.', found '%s'",
                            NAME_CHARACTERS_MAX, text);
    matrix->name = strdup(text);
    return matrix->name != NULL ? CP_OK : cp_fail_memory(error, "matrix");
}

static cp_status take_encounter(const cp_yaml_file *file, const char *text, cp_matrix *matrix,
                                cp_error *error)
{
    for (int k = 0; k < CP_ENCOUNTER_COUNT; k++) {
        matrix->encounter = (cp_encounter)k;
        if (strcmp(text, ENCOUNTER[k]) == 0)
            return CP_OK;
    }
    return cp_yaml_fail(file, error, "encounter",
                        "must be rear_end, braking, head_on, crossing or turning, found '%s'",
                        text);
}

static cp_status find_parameter(const cp_yaml_file *file, const char *path, const char *text,
                                cp_cell_parameter *parameter, cp_error *error)
{
    char names[256] = "";
    for (int k = 0; k < CP_CELL_PARAMETER_COUNT; k++) {
        *parameter = (cp_cell_parameter)k;
        if (strcmp(text, CELL[k].name) == 0)
            return CP_OK;
        size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", k > 0 ? ", " : "", CELL[k].name);
    }
    return cp_yaml_fail(file, error, path, "must be one of %s; found '%s'", names, text);
}

static cp_status take_fixed(const cp_yaml_file *file, const raw_matrix *raw, cp_matrix *matrix,
                            cp_error *error)
{
    cp_status status = CP_OK;
    for (int k = 0; k < CP_CELL_PARAMETER_COUNT; k++)
        matrix->fixed[k] = CELL[k].standard;
    for (unsigned k = 0; status == CP_OK && k < raw->fixed_count; k++) {
        char path[KEY_PATH_SIZE];
        cp_cell_parameter which;
        snprintf(path, sizeof path, "fixed[%u].parameter", k);
        status = find_parameter(file, path, raw->fixed[k].parameter, &which, error);
        snprintf(path, sizeof path, "fixed[%u].value", k);
        if (status == CP_OK)
            status = cp_yaml_number(file, path, raw->fixed[k].value, CELL[which].smallest,
                                    CELL[which].largest, &matrix->fixed[which], error);
    }
    return status;
}

static cp_status take_axis(const cp_yaml_file *file, const raw_axis *raw, size_t k,
                           cp_matrix *matrix, cp_error *error)
{
    char path[KEY_PATH_SIZE];
    cp_matrix_axis *axis = &matrix->axis[k];
    snprintf(path, sizeof path, "axes[%zu].parameter", k);
    cp_status status = find_parameter(file, path, raw->parameter, &axis->parameter, error);
    for (size_t other = 0; status == CP_OK && other < k; other++)
        if (matrix->axis[other].parameter == axis->parameter)
            status = cp_yaml_fail(file, error, path, "repeats '%s'", raw->parameter);
    if (status != CP_OK)
        return status;
    axis->values = calloc(raw->values_count, sizeof *axis->values);
    matrix->axis_count = k + 1;
    if (axis->values == NULL)
        return cp_fail_memory(error, path);
    for (unsigned v = 0; status == CP_OK && v < raw->values_count; v++) {
        const cell_row *row = &CELL[axis->parameter];
        snprintf(path, sizeof path, "axes[%zu].values[%u]", k, v);
        status = cp_yaml_number(file, path, raw->values[v], row->smallest, row->largest,
                                &axis->values[axis->count++], error);
    }
    return status;
}

static cp_status take_functions(const cp_yaml_file *file, const raw_matrix *raw, cp_matrix *matrix,
                                cp_error *error)
{
    if (raw->functions_count == 0)
        return CP_OK;
    matrix->functions = calloc(raw->functions_count, sizeof *matrix->functions);
    if (matrix->functions == NULL)
        return cp_fail_memory(error, "functions");
    cp_status status = CP_OK;
    for (unsigned k = 0; status == CP_OK && k < raw->functions_count; k++) {
        char path[KEY_PATH_SIZE];
        const raw_function *of = &raw->functions[k];
        cp_control_settings *settings = &matrix->functions[matrix->function_count++];
        snprintf(path, sizeof path, "functions[%u]", k);
        status = cp_control_section_read(file, CP_CONTROL_FUNCTION, path, "function", of->function,
                                         settings, error);
        if (status == CP_OK)
            status = cp_library_section_read(file, path, of->function, of->library, of->as,
                                             of->data, settings, error);
    }
    return status;
}

static cp_status take_numbers(const cp_yaml_file *file, const raw_matrix *raw, cp_matrix *matrix,
                              cp_error *error)
{
    const struct {
        const char *key, *text;
        double smallest, largest, *value;
    } rows[] = {{"step_length_s", raw->step_length_s, 0.001, 0.1, &matrix->step_length_s},
                {"lead_s", raw->lead_s, 3.0, 10.0, &matrix->lead_s},
                {"length_m", raw->length_m, 3.0, 6.0, &matrix->length_m},
                {"width_m", raw->width_m, 1.4, 2.2, &matrix->width_m}};
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < sizeof rows / sizeof *rows; k++)
        status = cp_yaml_number(file, rows[k].key, rows[k].text, rows[k].smallest, rows[k].largest,
                                rows[k].value, error);
    return status;
}

static cp_status take_all(const cp_yaml_file *file, const raw_matrix *raw, cp_matrix *matrix,
                          cp_error *error)
{
    cp_status status = take_name(file, raw->matrix, matrix, error);
    if (status == CP_OK)
        status = take_encounter(file, raw->encounter, matrix, error);
    if (status == CP_OK)
        status = take_numbers(file, raw, matrix, error);
    if (status == CP_OK)
        status = take_fixed(file, raw, matrix, error);
    for (unsigned k = 0; status == CP_OK && k < raw->axes_count; k++)
        status = take_axis(file, &raw->axes[k], k, matrix, error);
    if (status == CP_OK && cp_matrix_cells(matrix) > CP_MATRIX_CELLS)
        status = cp_yaml_fail(file, error, "axes", "must make at most %d cells, found %zu",
                              CP_MATRIX_CELLS, cp_matrix_cells(matrix));
    if (status == CP_OK)
        status = take_functions(file, raw, matrix, error);
    matrix->source = strdup(raw->source);
    matrix->model = strdup(raw->model != NULL ? raw->model : "honda_accord_2014");
    if (status == CP_OK && (matrix->source == NULL || matrix->model == NULL))
        status = cp_fail_memory(error, "matrix");
    return status;
}

// ---- public --------------------------------------------------------------------------------

cp_status cp_matrix_load(const char *path, cp_matrix *matrix, cp_error *error)
{
    cp_yaml_file file = {0};
    *matrix = (cp_matrix){.step_length_s = 0.01, .lead_s = 6.0, .length_m = 4.5, .width_m = 1.8};
    cp_status status = cp_yaml_load(path, &MATRIX, &file, error);
    if (status != CP_OK)
        return status;
    status = take_all(&file, (const raw_matrix *)file.data, matrix, error);
    cp_yaml_close(&file);
    if (status != CP_OK)
        cp_matrix_destroy(matrix);
    return status;
}

void cp_matrix_destroy(cp_matrix *matrix)
{
    for (size_t k = 0; k < CP_MATRIX_AXES; k++)
        free(matrix->axis[k].values);
    for (size_t k = 0; k < matrix->function_count; k++)
        cp_library_destroy(matrix->functions[k].library);
    free(matrix->functions);
    free(matrix->name);
    free(matrix->source);
    free(matrix->model);
    *matrix = (cp_matrix){0};
}

size_t cp_matrix_cells(const cp_matrix *matrix)
{
    size_t cells = 1;
    for (size_t k = 0; k < matrix->axis_count; k++)
        cells *= matrix->axis[k].count;
    return cells;
}

void cp_matrix_cell(const cp_matrix *matrix, size_t k, double parameter[CP_CELL_PARAMETER_COUNT])
{
    memcpy(parameter, matrix->fixed, sizeof matrix->fixed);
    for (size_t axis = matrix->axis_count; axis-- > 0;) {
        const cp_matrix_axis *of = &matrix->axis[axis];
        parameter[of->parameter] = of->values[k % of->count];
        k /= of->count;
    }
}
