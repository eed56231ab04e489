/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/csv_table.h"

#include "core/csv_row.h"
#include "core/file.h"
#include "core/yaml_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Room for as many rows as there are lines.
static cp_status make_room(cp_csv_table *table, cp_error *error)
{
    size_t lines = 1;
    for (const char *c = table->content; *c != '\0'; c++)
        lines += *c == '\n';
    table->line = calloc(lines, sizeof *table->line);
    table->field = calloc(lines * CP_CSV_FIELDS_MAX, sizeof *table->field);
    table->column = calloc(CP_CSV_FIELDS_MAX, sizeof *table->column);
    return table->line != NULL && table->field != NULL && table->column != NULL
               ? CP_OK
               : cp_fail_memory(error, table->path);
}

static bool is_blank(const char *line)
{
    return line[strspn(line, " \t\r")] == '\0' || line[0] == '#';
}

static cp_status take_line(cp_csv_table *table, char *line, size_t number, cp_error *error)
{
    if (table->column_count == 0) {
        table->separator = cp_csv_separator(line);
        table->column_count =
            cp_csv_split(line, table->separator, table->column, CP_CSV_FIELDS_MAX);
        if (table->column_count > CP_CSV_FIELDS_MAX)
            return cp_fail(error, CP_BAD_INPUT, "%s:%zu: must have at most %d columns, found %zu",
                           table->path, number, CP_CSV_FIELDS_MAX, table->column_count);
        return CP_OK;
    }
    char *fields[CP_CSV_FIELDS_MAX];
    size_t count = cp_csv_split(line, table->separator, fields, CP_CSV_FIELDS_MAX);
    if (count != table->column_count)
        return cp_fail(error, CP_BAD_INPUT, "%s:%zu: %zu fields, but the header has %zu",
                       table->path, number, count, table->column_count);
    memcpy(table->field + table->row_count * count, fields, count * sizeof *fields);
    table->line[table->row_count++] = number;
    return CP_OK;
}

cp_status cp_csv_table_load(const char *path, cp_csv_table *table, cp_error *error)
{
    char *content = NULL;
    size_t size = 0;
    *table = (cp_csv_table){0};
    cp_status status = cp_file_read_text(path, &content, &size, error);
    return status == CP_OK ? cp_csv_table_parse(path, content, table, error) : status;
}

cp_status cp_csv_table_parse(const char *path, char *content, cp_csv_table *table, cp_error *error)
{
    size_t number = 0;
    *table = (cp_csv_table){.content = content, .path = strdup(path)};
    if (table->path == NULL)
        return cp_fail_memory(error, path);
    cp_status status = make_room(table, error);
    bool marked = strncmp(table->content, "\xef\xbb\xbf", 3) == 0; // byte order mark
    for (char *rest = table->content + (marked ? 3 : 0);
         status == CP_OK && rest != NULL && *rest != '\0';) {
        char *line = cp_csv_next_line(&rest);
        number++;
        if (!is_blank(line))
            status = take_line(table, line, number, error);
    }
    if (status == CP_OK && table->row_count == 0)
        status = cp_fail(error, CP_BAD_INPUT, "%s: no row in the file", path);
    return status;
}

void cp_csv_table_destroy(cp_csv_table *table)
{
    free(table->path);
    free(table->content);
    free(table->line);
    free(table->field);
    free(table->column);
    *table = (cp_csv_table){0};
}

cp_status cp_csv_table_text(const cp_csv_table *table, size_t row, const char *column,
                            const char **text, cp_error *error)
{
    for (size_t c = 0; c < table->column_count; c++)
        if (strcmp(table->column[c], column) == 0) {
            *text = table->field[row * table->column_count + c];
            return CP_OK;
        }
    return cp_fail(error, CP_BAD_INPUT, "%s: column %s is missing", table->path, column);
}

cp_status cp_csv_table_number(const cp_csv_table *table, size_t row, const char *column,
                              double smallest, double largest, bool blank_allowed, double *value,
                              cp_error *error)
{
    const char *text = NULL;
    cp_status status = cp_csv_table_text(table, row, column, &text, error);
    if (status != CP_OK)
        return status;
    *value = NAN;
    if (text[0] == '\0' && blank_allowed)
        return CP_OK;
    if (!cp_parse_number(text, value) || *value < smallest || *value > largest)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s:%zu: %s must be a number between %g and %g, found '%s'", table->path,
                       table->line[row], column, smallest, largest, text);
    return CP_OK;
}
