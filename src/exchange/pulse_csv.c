/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/pulse_csv.h"

#include "core/csv_row.h"
#include "core/yaml_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TIME = CP_CHANNEL_COUNT, SEPARATION, VEHICLE, SIDE, CRASH, TREATMENT, COLUMN_COUNT };
enum { NUMBER_COUNT = VEHICLE };
static const char *const EXTRA_NAME[] = {"time_s",       "separation_s", "vehicle",
                                         "contact_side", "crash_id",     "treatment"};
#define ABSENT CP_CSV_FIELDS_MAX

typedef struct reading {
    const cp_pulse_request *request;
    cp_pulse_record *record;
    char separator;
    size_t line;
    size_t column_count;
    size_t place[COLUMN_COUNT];
    double *sample; /* row by row, CP_CHANNEL_COUNT each */
    size_t count;
    double interval_s;
    double first_s;                /* time of the first row */
    double last_before_s;          /* of the last row before time 0; NAN */
    char crash[64], treatment[64]; /* of the rows taken */
} reading;

static const char *column_name(int column)
{
    return column < TIME ? CP_PULSE_COLUMN[column] : EXTRA_NAME[column - TIME];
}

static cp_status take_header(reading *self, char *line, cp_error *error)
{
    const char *path = self->request->path;
    char *field[CP_CSV_FIELDS_MAX];
    self->separator = cp_csv_separator(line);
    self->column_count = cp_csv_split(line, self->separator, field, CP_CSV_FIELDS_MAX);
    cp_status status =
        cp_csv_check_fields(path, self->line, self->column_count, self->column_count, error);
    if (status != CP_OK)
        return status;
    for (int c = 0; c < COLUMN_COUNT; c++)
        self->place[c] = ABSENT;
    for (size_t f = 0; f < self->column_count; f++) {
        for (size_t other = 0; other < f; other++)
            if (strcmp(field[f], field[other]) == 0)
                return cp_fail(error, CP_BAD_INPUT, "%s:%zu: column %s is given twice", path,
                               self->line, field[f]);
        for (int c = 0; c < COLUMN_COUNT; c++)
            if (strcmp(field[f], column_name(c)) == 0)
                self->place[c] = f;
    }
    if (self->place[TIME] == ABSENT)
        return cp_fail(error, CP_BAD_INPUT, "%s:%zu: column time_s is missing", path, self->line);
    static const int BOTH[] = {CP_CHANNEL_AX, CP_CHANNEL_VX};
    for (int k = 0; self->request->needs_both && k < 2; k++)
        if (self->place[BOTH[k]] == ABSENT)
            return cp_fail(error, CP_BAD_INPUT, "%s:%zu: column %s is missing", path, self->line,
                           column_name(BOTH[k]));
    if (self->place[CP_CHANNEL_AX] == ABSENT && self->place[CP_CHANNEL_VX] == ABSENT)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s:%zu: column ax_m_s2 is missing, and so is vx_m_s: one of them is needed",
                       path, self->line);
    for (int c = 0; c < CP_CHANNEL_COUNT; c++)
        self->record->known[c] = self->place[c] != ABSENT;
    return CP_OK;
}

static const char *text_in(const reading *self, char *const field[], int column)
{
    return self->place[column] == ABSENT ? "" : field[self->place[column]];
}

// Whether a row is of the pulse asked for.
static bool is_asked_for(reading *self, char *const field[])
{
    const cp_pulse_request *request = self->request;
    const char *wanted = request->vehicle != NULL ? request->vehicle : "a";
    if (request->crash_id != NULL && strcmp(text_in(self, field, CRASH), request->crash_id) != 0)
        return false;
    if (request->treatment != NULL &&
        strcmp(text_in(self, field, TREATMENT), request->treatment) != 0)
        return false;
    if (self->place[VEHICLE] == ABSENT)
        return true;
    bool is_own = strcmp(field[self->place[VEHICLE]], wanted) == 0;
    self->record->against_car |= !is_own;
    return is_own;
}

// Rows of two crashes are no pulse.
static cp_status check_crash(reading *self, char *const field[], cp_error *error)
{
    const char *crash = text_in(self, field, CRASH), *treatment = text_in(self, field, TREATMENT);
    if (self->count == 0 && isnan(self->last_before_s)) {
        snprintf(self->crash, sizeof self->crash, "%s", crash);
        snprintf(self->treatment, sizeof self->treatment, "%s", treatment);
        return CP_OK;
    }
    if (strncmp(crash, self->crash, sizeof self->crash - 1) == 0 &&
        strncmp(treatment, self->treatment, sizeof self->treatment - 1) == 0)
        return CP_OK;
    return cp_fail(error, CP_BAD_INPUT,
                   "%s:%zu: holds more than one crash (%s %s after %s %s): name the one meant",
                   self->request->path, self->line, crash, treatment, self->crash, self->treatment);
}

static cp_status take_numbers(reading *self, char *const field[], double value[NUMBER_COUNT],
                              cp_error *error)
{
    for (int c = 0; c < NUMBER_COUNT; c++) {
        const char *text = text_in(self, field, c);
        value[c] = c == SEPARATION ? NAN : 0.0;
        if (self->place[c] == ABSENT || (c == SEPARATION && text[0] == '\0'))
            continue;
        if (!cp_parse_number(text, &value[c]))
            return cp_fail(error, CP_BAD_INPUT, "%s:%zu: %s must be a number, found '%s'",
                           self->request->path, self->line, column_name(c), text);
    }
    return CP_OK;
}

// Times go on in even steps; the second row tells the step. Sample 0 is at time 0.
static cp_status take_time(reading *self, double time_s, bool *is_before, cp_error *error)
{
    const char *path = self->request->path;
    bool is_first = self->count == 0 && isnan(self->last_before_s);
    double tolerance_s = 0.01 * self->interval_s + 1e-9;
    if (is_first)
        self->first_s = time_s;
    else if (self->interval_s == 0.0) {
        self->interval_s = time_s - self->first_s;
        if (!(self->interval_s > 0.0 && self->interval_s <= 0.01))
            return cp_fail(error, CP_BAD_INPUT,
                           "%s:%zu: time_s must rise in even steps of at most 0.01 s, found %g",
                           path, self->line, time_s);
        tolerance_s = 0.01 * self->interval_s + 1e-9;
    }
    *is_before = time_s < -tolerance_s;
    if (*is_before) {
        if (!is_first && fabs(time_s - self->last_before_s - self->interval_s) > tolerance_s)
            return cp_fail(error, CP_BAD_INPUT,
                           "%s:%zu: time_s must be %g, in even steps, found %g", path, self->line,
                           self->last_before_s + self->interval_s, time_s);
        self->last_before_s = time_s;
        return CP_OK;
    }
    double expected_s = (double)self->count * self->interval_s;
    if (fabs(time_s - expected_s) > tolerance_s)
        return cp_fail(error, CP_BAD_INPUT, "%s:%zu: time_s must be %g, in even steps, found %g",
                       path, self->line, expected_s, time_s);
    return CP_OK;
}

static cp_status take_row(reading *self, char *line, cp_error *error)
{
    char *field[CP_CSV_FIELDS_MAX];
    double value[NUMBER_COUNT];
    bool is_before = false;
    size_t found = cp_csv_split(line, self->separator, field, CP_CSV_FIELDS_MAX);
    cp_status status =
        cp_csv_check_fields(self->request->path, self->line, found, self->column_count, error);
    if (status != CP_OK || !is_asked_for(self, field))
        return status;
    status = check_crash(self, field, error);
    if (status == CP_OK)
        status = take_numbers(self, field, value, error);
    if (status == CP_OK)
        status = take_time(self, value[TIME], &is_before, error);
    if (status != CP_OK || is_before)
        return status;
    if (!isnan(value[SEPARATION]))
        self->record->separation_s = value[SEPARATION];
    const char *side = text_in(self, field, SIDE);
    if (side[0] != '\0' && !cp_pulse_record_take_side(self->record, side))
        return cp_fail(error, CP_BAD_INPUT,
                       "%s:%zu: contact_side must be front, left, right or rear, found '%s'",
                       self->request->path, self->line, side);
    memcpy(self->sample + self->count++ * CP_CHANNEL_COUNT, value,
           CP_CHANNEL_COUNT * sizeof *value);
    return CP_OK;
}

static cp_status take_lines(reading *self, char *content, cp_error *error)
{
    cp_status status = CP_OK;
    for (char *rest = content; status == CP_OK && rest != NULL;) {
        char *line = cp_csv_next_line(&rest);
        if (++self->line == 1)
            status = take_header(self, line, error);
        else if (line[strspn(line, " \t")] != '\0')
            status = take_row(self, line, error);
    }
    return status;
}

static cp_status fill_pulse(const reading *self, cp_error *error)
{
    cp_pulse *pulse = &self->record->pulse;
    if (self->count < 2)
        return cp_fail(error, CP_BAD_INPUT, "%s: fewer than two samples%s%s from time 0 on",
                       self->request->path, self->request->vehicle != NULL ? " of vehicle " : "",
                       self->request->vehicle != NULL ? self->request->vehicle : "");
    cp_status status = cp_pulse_create(pulse, self->count, self->interval_s, error);
    for (size_t k = 0; status == CP_OK && k < self->count; k++)
        for (int c = 0; c < CP_CHANNEL_COUNT; c++)
            pulse->channel[c][k] = self->sample[k * CP_CHANNEL_COUNT + (size_t)c];
    return status;
}

cp_status cp_pulse_csv_parse(const cp_pulse_request *request, char *content,
                             cp_pulse_record *record, cp_error *error)
{
    size_t lines = 1;
    const char *slash = strrchr(request->path, '/');
    *record = (cp_pulse_record){.separation_s = NAN, .mass_kg = NAN};
    snprintf(record->source, sizeof record->source, "%s",
             slash != NULL ? slash + 1 : request->path);
    for (const char *c = content; *c != '\0'; c++)
        lines += *c == '\n';
    reading self = {.request = request,
                    .record = record,
                    .last_before_s = NAN,
                    .sample = calloc(lines, CP_CHANNEL_COUNT * sizeof(double))};
    cp_status status = self.sample != NULL ? take_lines(&self, content, error)
                                           : cp_fail_memory(error, request->path);
    if (status == CP_OK)
        status = fill_pulse(&self, error);
    if (status == CP_OK && self.place[VEHICLE] != ABSENT)
        snprintf(record->vehicle, sizeof record->vehicle, "%s",
                 request->vehicle != NULL ? request->vehicle : "a");
    if (status == CP_OK)
        status = cp_pulse_record_complete(record, request, error);
    free(self.sample);
    if (status != CP_OK)
        cp_pulse_record_destroy(record);
    return status;
}
