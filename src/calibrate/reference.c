/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/reference.h"

#include "core/csv_row.h"
#include "core/file.h"
#include "core/hash.h"
#include "core/yaml_file.h"

#include <stdlib.h>
#include <string.h>

enum { COLUMN_SPEED, COLUMN_OFFSET, COLUMN_ANGLE, COLUMN_OLC, COLUMN_COUNT };

static const char *const COLUMN_NAME[COLUMN_COUNT] = {"speed_kmh", "offset_mm", "angle_deg",
                                                      "olc_fe_g"};
static const double SMALLEST[COLUMN_COUNT] = {1.0, -3000.0, -90.0, 0.0};
static const double LARGEST[COLUMN_COUNT] = {200.0, 3000.0, 90.0, 200.0};

// The columns of a file: how many, and where those stand that are read.
typedef struct columns {
    char separator;
    size_t count;
    size_t place[COLUMN_COUNT];
} columns;

static cp_status find_columns(const char *path, char *header, columns *found, cp_error *error)
{
    char *fields[CP_CSV_FIELDS_MAX];
    size_t *place = found->place;
    found->separator = cp_csv_separator(header);
    found->count = cp_csv_split(header, found->separator, fields, CP_CSV_FIELDS_MAX);
    cp_status status = cp_csv_check_fields(path, 1, found->count, found->count, error);
    if (status != CP_OK)
        return status;
    for (int c = 0; c < COLUMN_COUNT; c++) {
        place[c] = CP_CSV_FIELDS_MAX;
        for (size_t k = 0; k < found->count; k++) {
            if (strcmp(fields[k], COLUMN_NAME[c]) != 0 &&
                (c != COLUMN_OLC || strcmp(fields[k], "olc_g") != 0))
                continue;
            if (place[c] != CP_CSV_FIELDS_MAX)
                return cp_fail(error, CP_BAD_INPUT, "%s:1: column %s is given twice", path,
                               COLUMN_NAME[c]);
            place[c] = k;
        }
        if (place[c] == CP_CSV_FIELDS_MAX)
            return cp_fail(error, CP_BAD_INPUT, "%s:1: column %s is missing", path, COLUMN_NAME[c]);
    }
    return CP_OK;
}

static cp_status read_case(const char *path, size_t line_number, char *line, const columns *found,
                           cp_reference_case *row, cp_error *error)
{
    char *fields[CP_CSV_FIELDS_MAX];
    size_t count = cp_csv_split(line, found->separator, fields, CP_CSV_FIELDS_MAX);
    double value[COLUMN_COUNT];
    cp_status status = cp_csv_check_fields(path, line_number, count, found->count, error);
    if (status != CP_OK)
        return status;
    for (int c = 0; c < COLUMN_COUNT; c++) {
        const char *text = fields[found->place[c]];
        if (!cp_parse_number(text, &value[c]) || value[c] < SMALLEST[c] || value[c] > LARGEST[c])
            return cp_fail(error, CP_BAD_INPUT,
                           "%s:%zu: %s must be a number between %g and %g, found '%s'", path,
                           line_number, COLUMN_NAME[c], SMALLEST[c], LARGEST[c], text);
    }
    *row = (cp_reference_case){value[COLUMN_SPEED], value[COLUMN_OFFSET], value[COLUMN_ANGLE],
                               value[COLUMN_OLC]};
    return CP_OK;
}

static cp_status read_lines(const char *path, char *content, cp_reference *reference,
                            cp_error *error)
{
    size_t lines = 1;
    for (const char *c = content; *c != '\0'; c++)
        lines += *c == '\n';
    reference->cases = calloc(lines, sizeof *reference->cases);
    if (reference->cases == NULL)
        return cp_fail_memory(error, path);
    columns found = {0};
    size_t number = 0;
    for (char *rest = content; rest != NULL && *rest != '\0';) {
        char *line = cp_csv_next_line(&rest);
        cp_status status = CP_OK;
        if (++number == 1)
            status = find_columns(path, line, &found, error);
        else if (line[strspn(line, " \t\r")] != '\0')
            status =
                read_case(path, number, line, &found, &reference->cases[reference->count++], error);
        if (status != CP_OK)
            return status;
    }
    if (reference->count == 0)
        return cp_fail(error, CP_BAD_INPUT, "%s: no configuration in the file", path);
    return CP_OK;
}

cp_status cp_reference_load(const char *path, cp_reference *reference, cp_error *error)
{
    *reference = (cp_reference){0};
    char *content = NULL;
    size_t size = 0;
    cp_status status = cp_file_read_text(path, &content, &size, error);
    if (status != CP_OK)
        return status;
    cp_hash_bytes(content, size, reference->hash);
    status = read_lines(path, content, reference, error);
    free(content);
    if (status != CP_OK)
        cp_reference_destroy(reference);
    return status;
}

void cp_reference_destroy(cp_reference *reference)
{
    free(reference->cases);
    *reference = (cp_reference){0};
}
