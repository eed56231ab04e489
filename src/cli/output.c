/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/output.h"

#include "core/safe_text.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CELL_TEXT_SIZE 32

bool cp_format_from_text(const char *text, cp_format *format)
{
    static const char *const NAME[] = {"table", "json", "csv"};
    for (size_t k = 0; k < sizeof NAME / sizeof *NAME; k++) {
        if (strcmp(text, NAME[k]) == 0) {
            *format = (cp_format)k;
            return true;
        }
    }
    return false;
}

void cp_table_begin(cp_table *table, const char *const *column, size_t column_count)
{
    *table =
        (cp_table){.column_count = column_count, .columns = json_array(), .cells = json_array()};
    for (size_t k = 0; k < column_count; k++)
        table->failed |= json_array_append_new(table->columns, json_string(column[k])) != 0;
}

void cp_table_destroy(cp_table *table)
{
    json_decref(table->columns);
    json_decref(table->cells);
    *table = (cp_table){0};
}

void cp_table_json(cp_table *table, json_t *value)
{
    table->failed |= json_array_append_new(table->cells, value) != 0;
    table->row_count = json_array_size(table->cells) / table->column_count;
}

void cp_table_null(cp_table *table)
{
    cp_table_json(table, json_null());
}

void cp_table_integer(cp_table *table, int64_t value)
{
    cp_table_json(table, json_integer(value));
}

void cp_table_real(cp_table *table, double value)
{
    cp_table_json(table, isfinite(value) ? json_real(value) : json_null());
}

void cp_table_text(cp_table *table, const char *text)
{
    json_t *string = json_string(text);
    cp_table_json(table, string ? string : json_string("text that is not UTF-8"));
}

static const json_t *cell_at(const cp_table *table, size_t row, size_t column)
{
    return json_array_get(table->cells, row * table->column_count + column);
}

static const char *column_name(const cp_table *table, size_t column)
{
    return json_string_value(json_array_get(table->columns, column));
}

// A cell as text; digits: significant digits of reals. Returns text or the cell's own string.
static const char *cell_text(const json_t *cell, int digits, char text[CELL_TEXT_SIZE])
{
    if (json_is_string(cell))
        return json_string_value(cell);
    text[0] = '\0';
    if (json_is_integer(cell))
        snprintf(text, CELL_TEXT_SIZE, "%" JSON_INTEGER_FORMAT, json_integer_value(cell));
    else if (json_is_real(cell))
        snprintf(text, CELL_TEXT_SIZE, "%.*g", digits, json_real_value(cell));
    else if (json_is_boolean(cell))
        snprintf(text, CELL_TEXT_SIZE, "%s", json_is_true(cell) ? "true" : "false");
    return text;
}

static void print_padded(FILE *file, const char *text, size_t width, bool right, bool last)
{
    int gap = (int)(width - cp_text_width(text));
    fprintf(file, "%*s", right ? gap : 0, "");
    cp_text_print(file, text, "");
    fprintf(file, "%*s", right || last ? 0 : gap, "");
    fputs(last ? "\n" : "  ", file);
}

static void print_table(const cp_table *table, const size_t *width, const bool *right, FILE *file)
{
    char text[CELL_TEXT_SIZE];
    for (size_t c = 0; c < table->column_count; c++)
        print_padded(file, column_name(table, c), width[c], right[c], c + 1 == table->column_count);
    for (size_t c = 0; c < table->column_count; c++) {
        for (size_t k = 0; k < width[c]; k++)
            fputc('-', file);
        fputs(c + 1 == table->column_count ? "\n" : "  ", file);
    }
    for (size_t r = 0; r < table->row_count; r++)
        for (size_t c = 0; c < table->column_count; c++)
            print_padded(file, cell_text(cell_at(table, r, c), 6, text), width[c], right[c],
                         c + 1 == table->column_count);
}

// Width of every column, and whether it holds numbers only.
static cp_status print_aligned(const cp_table *table, FILE *file, cp_error *error)
{
    size_t *width = calloc(table->column_count + 1, sizeof *width);
    bool *right = calloc(table->column_count + 1, sizeof *right);
    cp_status status = CP_OK;
    if (width && right) {
        char text[CELL_TEXT_SIZE];
        for (size_t c = 0; c < table->column_count; c++) {
            width[c] = cp_text_width(column_name(table, c));
            right[c] = table->row_count > 0;
            bool placed = table->right_from > 0 && c >= table->right_from;
            for (size_t r = 0; r < table->row_count; r++) {
                const json_t *cell = cell_at(table, r, c);
                size_t own = cp_text_width(cell_text(cell, 6, text));
                width[c] = own > width[c] ? own : width[c];
                right[c] &= placed || !json_is_string(cell);
            }
        }
        print_table(table, width, right, file);
    } else {
        status = cp_fail_memory(error, "a table");
    }
    free(width);
    free(right);
    return status;
}

// A spreadsheet takes a text that begins like this for a formula; not a sign alone, nor a number.
static bool is_formula(const char *text)
{
    char *end = NULL;
    if (*text == '\0' || text[1] == '\0' || strchr("=+-@\t\r", *text) == NULL)
        return false;
    strtod(text, &end);
    return *end != '\0';
}

void cp_csv_text(FILE *file, const char *text)
{
    bool formula = is_formula(text);
    if (!formula && !strpbrk(text, ",\"\r\n")) {
        fputs(text, file);
        return;
    }
    fputs(formula ? "\"'" : "\"", file);
    for (; *text; text++) {
        if (*text == '"')
            fputc('"', file);
        fputc(*text, file);
    }
    fputc('"', file);
}

static void print_csv(const cp_table *table, FILE *file)
{
    char text[CELL_TEXT_SIZE];
    for (size_t c = 0; c < table->column_count; c++) {
        cp_csv_text(file, column_name(table, c));
        fputc(c + 1 == table->column_count ? '\n' : ',', file);
    }
    for (size_t r = 0; r < table->row_count; r++) {
        for (size_t c = 0; c < table->column_count; c++) {
            const json_t *cell = cell_at(table, r, c);
            if (json_is_string(cell))
                cp_csv_text(file, cell_text(cell, 17, text));
            else
                fputs(cell_text(cell, 17, text), file);
            fputc(c + 1 == table->column_count ? '\n' : ',', file);
        }
    }
}

static json_t *table_json(const cp_table *table)
{
    json_t *rows = json_array();
    for (size_t r = 0; r < table->row_count; r++) {
        json_t *row = json_object();
        for (size_t c = 0; c < table->column_count; c++)
            json_object_set(row, column_name(table, c), (json_t *)cell_at(table, r, c));
        json_array_append_new(rows, row);
    }
    if (json_array_size(rows) == table->row_count)
        return rows;
    json_decref(rows);
    return NULL;
}

cp_status cp_json_print(json_t *value, FILE *file, cp_error *error)
{
    if (!value)
        return cp_fail_memory(error, "a result");
    int failed = json_dumpf(value, file, JSON_INDENT(2) | JSON_REAL_PRECISION(17));
    json_decref(value);
    if (failed != 0 || fputc('\n', file) == EOF)
        return cp_fail(error, CP_IO_FAILED, "writing the result: %s", strerror(errno));
    return CP_OK;
}

cp_status cp_table_print(const cp_table *table, cp_format format, FILE *file, cp_error *error)
{
    if (table->failed)
        return cp_fail_memory(error, "a result");
    if (format == CP_FORMAT_JSON)
        return cp_json_print(table_json(table), file, error);
    if (format == CP_FORMAT_CSV)
        print_csv(table, file);
    else if (print_aligned(table, file, error) != CP_OK)
        return CP_NO_MEMORY;
    return ferror(file) ? cp_fail(error, CP_IO_FAILED, "writing the result: %s", strerror(errno))
                        : CP_OK;
}
