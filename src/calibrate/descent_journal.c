/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/descent_journal.h"

#include "core/file.h"
#include "core/memory_stream.h"

#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// A row: evaluations, value before, point.
enum { EVALUATIONS, BEFORE, POINT };

static double *row_of(const cp_descent_journal *journal, size_t descent)
{
    return journal->row + descent * (POINT + journal->dimension);
}

// Room for one more descent.
static cp_status grow(cp_descent_journal *journal, cp_error *error)
{
    size_t row_size = (POINT + journal->dimension) * sizeof *journal->row;
    double *row = realloc(journal->row, (journal->count + 1) * row_size);
    if (row == NULL)
        return cp_fail_memory(error, journal->path);
    journal->row = row;
    return CP_OK;
}

// One line; false: not what this program writes.
static bool read_line(const cp_descent_journal *journal, const char *line)
{
    double *row = row_of(journal, journal->count);
    for (size_t k = 0; k < POINT + journal->dimension; k++) {
        char *end = NULL;
        row[k] = strtod(line, &end);
        double largest = k < POINT ? DBL_MAX : 1.0;
        if (end == line || !(row[k] >= 0.0 && row[k] <= largest))
            return false;
        line = end;
    }
    return *line == '\0';
}

cp_status cp_descent_journal_open(cp_descent_journal *journal, const char *path, size_t dimension,
                                  cp_error *error)
{
    *journal = (cp_descent_journal){.dimension = dimension};
    snprintf(journal->path, sizeof journal->path, "%s", path);
    if (access(path, F_OK) != 0)
        return CP_OK;
    char *content = NULL, *rest = NULL;
    size_t size = 0;
    cp_status status = cp_file_read_text(path, &content, &size, error);
    if (status != CP_OK)
        return status;
    for (char *line = strtok_r(content, "\n", &rest); status == CP_OK && line != NULL;
         line = strtok_r(NULL, "\n", &rest)) {
        status = grow(journal, error);
        if (status == CP_OK && !read_line(journal, line))
            status = cp_fail(error, CP_BAD_INPUT,
                             "%s:%zu: must have evaluations, a value and %zu coordinates from 0 to "
                             "1; remove the file to start anew",
                             path, journal->count + 1, dimension);
        journal->count += status == CP_OK;
    }
    free(content);
    return status;
}

cp_status cp_descent_journal_recall(cp_descent_journal *journal, size_t evaluations, double before,
                                    double *point, bool *known, cp_error *error)
{
    *known = journal->next < journal->count;
    if (!*known)
        return CP_OK;
    const double *row = row_of(journal, journal->next);
    if (row[EVALUATIONS] != (double)evaluations || row[BEFORE] != before)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s:%zu: is of another fit (descent with %.0f evaluations from a value of "
                       "%.9g, here %zu from %.9g); remove the file to start anew",
                       journal->path, journal->next + 1, row[EVALUATIONS], row[BEFORE], evaluations,
                       before);
    memcpy(point, row + POINT, journal->dimension * sizeof *point);
    journal->next++;
    return CP_OK;
}

static cp_status write_file(const cp_descent_journal *journal, cp_error *error)
{
    char *text = NULL;
    size_t size = 0;
    FILE *file = cp_memory_stream(&text, &size);
    if (file == NULL)
        return cp_fail_memory(error, journal->path);
    for (size_t descent = 0; descent < journal->count; descent++) {
        const double *row = row_of(journal, descent);
        fprintf(file, "%.0f", row[EVALUATIONS]);
        for (size_t k = BEFORE; k < POINT + journal->dimension; k++)
            fprintf(file, " %a", row[k]);
        fputc('\n', file);
    }
    bool lost = ferror(file) != 0;
    lost |= fclose(file) != 0;
    cp_status status = lost ? cp_fail_memory(error, journal->path)
                            : cp_file_write(journal->path, text, size, error);
    free(text);
    return status;
}

cp_status cp_descent_journal_add(cp_descent_journal *journal, size_t evaluations, double before,
                                 const double *point, cp_error *error)
{
    cp_status status = grow(journal, error);
    if (status != CP_OK)
        return status;
    double *row = row_of(journal, journal->count++);
    row[EVALUATIONS] = (double)evaluations;
    row[BEFORE] = before;
    memcpy(row + POINT, point, journal->dimension * sizeof *point);
    journal->next = journal->count;
    return write_file(journal, error);
}

void cp_descent_journal_close(cp_descent_journal *journal)
{
    free(journal->row);
    *journal = (cp_descent_journal){0};
}
