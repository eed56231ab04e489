/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/study_choice.h"

#include "analysis/study_places.h"
#include "core/memory_stream.h"
#include "core/safe_text.h"
#include "store/query.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Vehicles a query names, by crash and role. */
typedef struct chooser {
    const cp_study_data *data;
    cp_study_choice *choice;
    bool grouped;
} chooser;

// Groups come in order, so a new value is a new group.
static cp_status choose_group(chooser *c, size_t vehicle, const cp_cell *cell, cp_error *error)
{
    cp_study_choice *choice = c->choice;
    char number[64];
    const char *text = cell->text;
    if (cell->type == CP_CELL_INTEGER)
        snprintf(number, sizeof number, "%lld", (long long)cell->integer);
    else
        snprintf(number, sizeof number, "%.9g", cell->real);
    if (cell->type == CP_CELL_INTEGER || cell->type == CP_CELL_REAL)
        text = number;
    else if (cell->type == CP_CELL_NULL)
        text = "NULL";
    if (choice->value_count == 0 || strcmp(choice->value[choice->value_count - 1], text) != 0) {
        if (choice->value_count == CP_CHOICE_VALUES_MAX)
            return cp_fail(error, CP_BAD_INPUT,
                           "the column has more than %d values; choose one of few, or fewer "
                           "vehicles",
                           CP_CHOICE_VALUES_MAX);
        char *name =
            cp_text_copy_plain(text); // of several lines it would break the words around it
        if (!name)
            return cp_fail_memory(error, "a name");
        choice->value[choice->value_count++] = name;
    }
    choice->group[vehicle] = choice->value_count - 1;
    return CP_OK;
}

static cp_status choose_vehicle(void *context, const cp_row *row, cp_error *error)
{
    chooser *c = context;
    size_t vehicle = 2 * (size_t)row->cell[0].integer + (row->cell[1].text[0] == 'b');
    if (vehicle >= c->data->vehicle_count ||
        c->data->vehicle[vehicle].crash != (size_t)row->cell[0].integer)
        return cp_fail(error, CP_STORE_FAILED, "the database changed while it was read");
    c->choice->chosen[vehicle] = 1;
    return c->grouped ? choose_group(c, vehicle, &row->cell[2], error) : CP_OK;
}

static bool is_name(const char *text)
{
    for (const char *c = text; *c; c++)
        if (!(*c == '_' || (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') ||
              (c > text && *c >= '0' && *c <= '9')))
            return false;
    return *text != '\0';
}

cp_status cp_study_choose(cp_store *store, const cp_study_data *data, const char *where,
                          const char *by, cp_study_choice *choice, cp_error *error)
{
    *choice = (cp_study_choice){0};
    if (by && !is_name(by))
        return cp_fail(error, CP_BAD_INPUT,
                       "--by must be one column of the view crash_vehicle_list, found '%s'", by);
    char *sql = NULL;
    size_t size = 0;
    FILE *out = cp_memory_stream(&sql, &size);
    choice->chosen = calloc(data->vehicle_count + 1, sizeof *choice->chosen);
    choice->group = calloc(data->vehicle_count + 1, sizeof *choice->group);
    choice->value = calloc(CP_CHOICE_VALUES_MAX, sizeof *choice->value);
    if (!out || !choice->chosen || !choice->group || !choice->value) {
        if (out)
            fclose(out);
        free(sql);
        cp_study_choice_destroy(choice);
        return cp_fail_memory(error, "a choice of vehicles");
    }
    for (size_t k = 0; k < data->vehicle_count; k++)
        choice->group[k] = SIZE_MAX;

    // The condition stands on a line of its own, so that a comment in it ends there.
    fprintf(out,
            "%sSELECT c.place, x.role, x.by_value FROM (SELECT crash_id, role, %s AS by_value"
            " FROM crash_vehicle_list WHERE (%s\n)) AS x JOIN c ON c.id = x.crash_id"
            " ORDER BY x.by_value, c.place, x.role",
            CP_STUDY_PLACES, by ? by : "NULL", where ? where : "1");
    cp_status status = CP_OK;
    if (fclose(out) != 0)
        status = cp_fail_memory(error, "a choice of vehicles");
    chooser c = {data, choice, by != NULL};
    cp_query_handler handler = {.row = choose_vehicle, .context = &c};
    if (status == CP_OK)
        status = cp_query(store, sql, NULL, 0, &handler, error);
    free(sql);
    if (status != CP_OK)
        cp_study_choice_destroy(choice);
    return status == CP_BAD_INPUT ? cp_error_prefix(error, "--where or --by: ") : status;
}

void cp_study_choice_destroy(cp_study_choice *choice)
{
    for (size_t k = 0; k < choice->value_count; k++)
        free(choice->value[k]);
    free(choice->value);
    free(choice->chosen);
    free(choice->group);
    *choice = (cp_study_choice){0};
}
