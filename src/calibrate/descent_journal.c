/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/descent_journal.h"

#include "core/file.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// Room for one more descent.
static cp_status grow(cp_descent_journal *journal, cp_error *error)
{
    size_t rows = journal->count + 1, n = journal->dimension;
    size_t *evaluation = realloc(journal->evaluation, rows * sizeof *evaluation);
    if (evaluation != NULL)
        journal->evaluation = evaluation;
    double *before = realloc(journal->before, rows * sizeof *before);
    if (before != NULL)
        journal->before = before;
    double *point = realloc(journal->point, rows * n * sizeof *point);
    if (point != NULL)
        journal->point = point;
    if (evaluation == NULL || before == NULL || point == NULL)
        return cp_fail_memory(error, journal->path);
    return CP_OK;
}

static bool read_number(char **text, double *number)
{
    char *end = *text;
    *number = strtod(*text, &end);
    bool found = end != *text && isfinite(*number);
    *text = end;
    return found;
}

// One line; false: not what this program writes.
static bool read_line(cp_descent_journal *journal, char *line)
{
    size_t row = journal->count;
    char *end = line;
    errno = 0;
    journal->evaluation[row] = strtoul(line, &end, 10);
    bool sound = end != line && errno == 0 && read_number(&end, &journal->before[row]);
    for (size_t k = 0; sound && k < journal->dimension; k++) {
        double *coordinate = &journal->point[row * journal->dimension + k];
        sound = read_number(&end, coordinate) && *coordinate >= 0.0 && *coordinate <= 1.0;
    }
    return sound && *end == '\0';
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
    cp_status status = cp_file_read(path, &content, &size, error);
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
    size_t row = journal->next, n = journal->dimension;
    if (journal->evaluation[row] != evaluations || journal->before[row] != before)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s:%zu: is of another fit (descent with %zu evaluations from a value of "
                       "%.9g, here %zu from %.9g); remove the file to start anew",
                       journal->path, row + 1, journal->evaluation[row], journal->before[row],
                       evaluations, before);
    memcpy(point, &journal->point[row * n], n * sizeof *point);
    journal->next++;
    return CP_OK;
}

static cp_status write_file(const cp_descent_journal *journal, cp_error *error)
{
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    if (file == NULL)
        return cp_fail_memory(error, journal->path);
    for (size_t row = 0; row < journal->count; row++) {
        fprintf(file, "%zu %a", journal->evaluation[row], journal->before[row]);
        for (size_t k = 0; k < journal->dimension; k++)
            fprintf(file, " %a", journal->point[row * journal->dimension + k]);
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
    size_t row = journal->count++, n = journal->dimension;
    journal->evaluation[row] = evaluations;
    journal->before[row] = before;
    memcpy(&journal->point[row * n], point, n * sizeof *point);
    journal->next = journal->count;
    return write_file(journal, error);
}

void cp_descent_journal_close(cp_descent_journal *journal)
{
    free(journal->evaluation);
    free(journal->before);
    free(journal->point);
    *journal = (cp_descent_journal){0};
}
