/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/configurations_csv.h"

#include "core/array.h"
#include "core/csv_row.h"
#include "core/file.h"
#include "core/units.h"

#include <search.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Columns. X(name, kind, smallest, largest): kind 't' text, 'r' of relative configurations, 'p' of
 * poses, 'o' optional with poses, 'b' of both kinds. */
#define COLUMNS(X)                                                                                 \
    X(id, 't', 0, 0)                                                                               \
    X(vehicle_a, 't', 0, 0)                                                                        \
    X(vehicle_b, 't', 0, 0)                                                                        \
    X(speed_a_km_h, 'b', 0, 400)                                                                   \
    X(speed_b_km_h, 'b', 0, 400)                                                                   \
    X(offset_mm, 'r', -5000, 5000)                                                                 \
    X(angle_deg, 'r', -180, 180)                                                                   \
    X(x_a_m, 'p', -1e7, 1e7)                                                                       \
    X(y_a_m, 'p', -1e7, 1e7)                                                                       \
    X(heading_a_deg, 'p', -360, 360)                                                               \
    X(x_b_m, 'p', -1e7, 1e7)                                                                       \
    X(y_b_m, 'p', -1e7, 1e7)                                                                       \
    X(heading_b_deg, 'p', -360, 360)                                                               \
    X(yaw_rate_a_deg_s, 'o', -360, 360)                                                            \
    X(yaw_rate_b_deg_s, 'o', -360, 360)

enum {
#define NUMBER(name, kind, smallest, largest) COLUMN_##name,
    COLUMNS(NUMBER)
#undef NUMBER
        COLUMN_COUNT
};

static const struct {
    const char *name;
    char kind;
    double smallest, largest;
} COLUMN[] = {
#define ROW(name, kind, smallest, largest) {#name, kind, smallest, largest},
    COLUMNS(ROW)
#undef ROW
};

#define ABSENT SIZE_MAX

typedef struct reading {
    const char *path;
    size_t line;
    cp_configuration_list *list;
    size_t place[COLUMN_COUNT]; /* of a column in the file; ABSENT */
    char separator;
    size_t field_count;
    char *field[COLUMN_COUNT];
    void *ids; /* of the rows, a binary tree */
} reading;

static int compare_texts(const void *one, const void *other)
{
    return strcmp(one, other);
}

// ---- the first line ------------------------------------------------------------------------

static cp_status need(const reading *self, char kind, cp_error *error)
{
    for (size_t k = 0; k < COLUMN_COUNT; k++)
        if (COLUMN[k].kind == kind && self->place[k] == ABSENT)
            return cp_fail(error, CP_BAD_INPUT, "%s:%zu: the column %s is missing", self->path,
                           self->line, COLUMN[k].name);
    return CP_OK;
}

static bool has_any(const reading *self, char kind)
{
    for (size_t k = 0; k < COLUMN_COUNT; k++)
        if (COLUMN[k].kind == kind && self->place[k] != ABSENT)
            return true;
    return false;
}

static cp_status fail_unknown(const reading *self, const char *name, cp_error *error)
{
    char known[512] = "";
    for (size_t k = 0; k < COLUMN_COUNT; k++)
        snprintf(known + strlen(known), sizeof known - strlen(known), "%s%s", k > 0 ? ", " : "",
                 COLUMN[k].name);
    return cp_fail(error, CP_BAD_INPUT, "%s:%zu: unknown column '%s'; there are %s", self->path,
                   self->line, name, known);
}

static cp_status take_header(reading *self, char *line, cp_error *error)
{
    for (size_t k = 0; k < COLUMN_COUNT; k++)
        self->place[k] = ABSENT;
    self->separator = cp_csv_separator(line);
    self->field_count = cp_csv_split(line, self->separator, self->field, COLUMN_COUNT);
    for (size_t f = 0; f < self->field_count && f < COLUMN_COUNT; f++) {
        size_t k = 0;
        while (k < COLUMN_COUNT && strcmp(COLUMN[k].name, self->field[f]) != 0)
            k++;
        if (k == COLUMN_COUNT)
            return fail_unknown(self, self->field[f], error);
        if (self->place[k] != ABSENT)
            return cp_fail(error, CP_BAD_INPUT, "%s:%zu: the column %s is given twice", self->path,
                           self->line, COLUMN[k].name);
        self->place[k] = f;
    }
    if (self->field_count > COLUMN_COUNT)
        return cp_fail(error, CP_BAD_INPUT, "%s:%zu: must have at most %d columns, found %zu",
                       self->path, self->line, COLUMN_COUNT, self->field_count);
    bool is_relative = has_any(self, 'r');
    self->list->has_poses = has_any(self, 'p') || has_any(self, 'o');
    if (is_relative && self->list->has_poses)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s:%zu: must give either offset_mm and angle_deg or positions and "
                       "headings, found both",
                       self->path, self->line);
    cp_status status = need(self, 'b', error);
    return status == CP_OK ? need(self, self->list->has_poses ? 'p' : 'r', error) : status;
}

// ---- rows ----------------------------------------------------------------------------------

static cp_status number_in(const reading *self, int column, double *value, cp_error *error)
{
    char *end = NULL;
    *value = 0.0;
    if (self->place[column] == ABSENT)
        return CP_OK;
    const char *text = self->field[self->place[column]];
    *value = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(*value) || strpbrk(text, "xX") != NULL)
        return cp_fail(error, CP_BAD_INPUT, "%s:%zu: %s must be a number, found '%s'", self->path,
                       self->line, COLUMN[column].name, text);
    if (*value < COLUMN[column].smallest || *value > COLUMN[column].largest)
        return cp_fail(error, CP_BAD_INPUT, "%s:%zu: %s must be between %g and %g, found %s",
                       self->path, self->line, COLUMN[column].name, COLUMN[column].smallest,
                       COLUMN[column].largest, text);
    return CP_OK;
}

static cp_status text_in(const reading *self, int column, char **text, cp_error *error)
{
    *text = NULL;
    if (self->place[column] == ABSENT || self->field[self->place[column]][0] == '\0')
        return CP_OK;
    *text = strdup(self->field[self->place[column]]);
    return *text != NULL ? CP_OK : cp_fail_memory(error, "configurations");
}

static void destroy_row(cp_listed_configuration *row)
{
    free(row->id);
    free(row->vehicle[0]);
    free(row->vehicle[1]);
}

static cp_status fill_texts(const reading *self, cp_listed_configuration *row, cp_error *error)
{
    char number[32];
    cp_status status = text_in(self, COLUMN_id, &row->id, error);
    if (status == CP_OK)
        status = text_in(self, COLUMN_vehicle_a, &row->vehicle[0], error);
    if (status == CP_OK)
        status = text_in(self, COLUMN_vehicle_b, &row->vehicle[1], error);
    if (status == CP_OK && row->id == NULL) {
        snprintf(number, sizeof number, "%zu", self->list->count + 1);
        row->id = strdup(number);
        if (row->id == NULL)
            status = cp_fail_memory(error, "configurations");
    }
    if (status != CP_OK)
        return status;
    if (tfind(row->id, &self->ids, compare_texts) != NULL)
        return cp_fail(error, CP_BAD_INPUT, "%s:%zu: id '%s' is given twice", self->path,
                       self->line, row->id);
    return CP_OK;
}

static cp_status fill_numbers(const reading *self, cp_listed_configuration *row, cp_error *error)
{
    double value[COLUMN_COUNT] = {0};
    cp_status status = CP_OK;
    for (int k = 0; status == CP_OK && k < COLUMN_COUNT; k++)
        if (COLUMN[k].kind != 't')
            status = number_in(self, k, &value[k], error);
    if (status != CP_OK)
        return status;
    row->speed_m_s[0] = cp_m_s_from_km_h(value[COLUMN_speed_a_km_h]);
    row->speed_m_s[1] = cp_m_s_from_km_h(value[COLUMN_speed_b_km_h]);
    row->offset_m = value[COLUMN_offset_mm] / 1000.0;
    row->angle_rad = cp_rad_from_deg(value[COLUMN_angle_deg]);
    row->pose[0] = (cp_pose){{value[COLUMN_x_a_m], value[COLUMN_y_a_m]},
                             cp_rad_from_deg(value[COLUMN_heading_a_deg])};
    row->pose[1] = (cp_pose){{value[COLUMN_x_b_m], value[COLUMN_y_b_m]},
                             cp_rad_from_deg(value[COLUMN_heading_b_deg])};
    row->yaw_rate_rad_s[0] = cp_rad_from_deg(value[COLUMN_yaw_rate_a_deg_s]);
    row->yaw_rate_rad_s[1] = cp_rad_from_deg(value[COLUMN_yaw_rate_b_deg_s]);
    if (row->speed_m_s[0] == 0.0 && row->speed_m_s[1] == 0.0)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s:%zu: speed_a_km_h or speed_b_km_h must be > 0, found 0 for both",
                       self->path, self->line);
    return CP_OK;
}

static cp_status take_row(reading *self, char *line, cp_error *error)
{
    cp_configuration_list *list = self->list;
    cp_listed_configuration row = {.line = self->line};
    size_t found = cp_csv_split(line, self->separator, self->field, COLUMN_COUNT);
    if (found != self->field_count)
        return cp_fail(error, CP_BAD_INPUT, "%s:%zu: must have %zu fields, found %zu", self->path,
                       self->line, self->field_count, found);
    cp_status status = fill_texts(self, &row, error);
    if (status == CP_OK)
        status = fill_numbers(self, &row, error);
    cp_listed_configuration *added = status == CP_OK ? cp_array_add(list->row, list->count) : NULL;
    if (status == CP_OK && (added == NULL || tsearch(row.id, &self->ids, compare_texts) == NULL))
        status = cp_fail_memory(error, "configurations");
    if (status == CP_OK)
        *added = row;
    else
        destroy_row(&row);
    return status;
}

// Why a row is not in the list.
static cp_status add_bad(cp_configuration_list *list, const char *why, cp_error *error)
{
    char **added = cp_array_add(list->bad, list->bad_count);
    if (added == NULL)
        return cp_fail_memory(error, "configurations");
    *added = strdup(why);
    if (*added == NULL)
        return cp_fail_memory(error, "configurations");
    return CP_OK;
}

cp_status cp_configuration_list_leave_out(cp_configuration_list *list, size_t row, const char *why,
                                          cp_error *error)
{
    cp_status status = add_bad(list, why, error);
    if (status != CP_OK)
        return status;
    destroy_row(&list->row[row]);
    list->row[row] = (cp_listed_configuration){0};
    return CP_OK;
}

void cp_configuration_list_close_up(cp_configuration_list *list)
{
    size_t kept = 0;
    for (size_t k = 0; k < list->count; k++)
        if (list->row[k].id != NULL)
            list->row[kept++] = list->row[k];
    list->count = kept;
}

static cp_status take_lines(reading *self, char *content, bool strict, cp_error *error)
{
    bool has_header = false;
    cp_status status = CP_OK;
    for (char *rest = content; status == CP_OK && rest != NULL;) {
        char *line = cp_csv_next_line(&rest);
        self->line++;
        if (line[strspn(line, " \t\r")] == '\0' || line[0] == '#')
            continue;
        cp_error why = {0};
        status = has_header ? take_row(self, line, &why) : take_header(self, line, &why);
        if (status == CP_BAD_INPUT && has_header && !strict)
            status = add_bad(self->list, why.text, error);
        else if (status != CP_OK)
            *error = why;
        has_header = true;
    }
    return status;
}

cp_status cp_configurations_csv_read(const char *path, bool strict, cp_configuration_list *list,
                                     cp_error *error)
{
    char *content = NULL;
    size_t size = 0;
    cp_error own = {0};
    *list = (cp_configuration_list){0};
    reading self = {.path = path, .list = list};
    cp_status status = cp_file_read_text(path, &content, &size, &own);
    if (status == CP_OK)
        status = take_lines(&self, content, strict, &own);
    while (self.ids != NULL)
        tdelete(*(char **)self.ids, &self.ids, compare_texts);
    free(content);
    if (status == CP_OK && list->count == 0 && list->bad_count > 0)
        status = cp_fail(&own, CP_BAD_INPUT, "%s", list->bad[0]);
    else if (status == CP_OK && list->count == 0)
        status = cp_fail(&own, CP_BAD_INPUT,
                         "%s: must hold a line of column names and at least "
                         "one configuration, found none",
                         path);
    if (status == CP_OK)
        return CP_OK;
    cp_configuration_list_destroy(list);
    return cp_fail(error, status, "%s", own.text);
}

void cp_configuration_list_destroy(cp_configuration_list *list)
{
    for (size_t k = 0; k < list->count; k++)
        destroy_row(&list->row[k]);
    for (size_t k = 0; k < list->bad_count; k++)
        free(list->bad[k]);
    free(list->row);
    free(list->bad);
    *list = (cp_configuration_list){0};
}
