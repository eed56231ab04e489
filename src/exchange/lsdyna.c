/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/lsdyna.h"

#include "core/array.h"
#include "core/csv_row.h"
#include "core/safe_text.h"
#include "core/yaml_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const cp_unit_system SYSTEM[] = {
    {"mm-ms-kg", 1e3, 1e3}, {"m-s-kg", 1.0, 1.0}, {"mm-s-t", 1e3, 1.0}};

// Names of the channels in titles, and their powers of length and time.
static const struct {
    const char *name;
    int length, time;
} MOTION[CP_CHANNEL_COUNT] = {[CP_CHANNEL_AX] = {"a_x", 1, -2},
                              [CP_CHANNEL_AY] = {"a_y", 1, -2},
                              [CP_CHANNEL_VX] = {"v_x", 1, -1},
                              [CP_CHANNEL_VY] = {"v_y", 1, -1},
                              [CP_CHANNEL_X] = {"x", 1, 0},
                              [CP_CHANNEL_Y] = {"y", 1, 0},
                              [CP_CHANNEL_YAW] = {"yaw", 0, 0},
                              [CP_CHANNEL_YAW_RATE] = {"yaw_rate", 0, -1},
                              [CP_CHANNEL_YAW_ACC] = {"yaw_acc", 0, -2}};

static const char TITLE[] = "crashpulse vehicle ";
static const char UNITS_COMMENT[] = "$ units: ";
static const char SIDE_COMMENT[] = "$ struck side of vehicle ";
static const char SEPARATION_COMMENT[] = "$ last contact of vehicle ";

const cp_unit_system *cp_unit_system_find(const char *name)
{
    for (size_t k = 0; k < sizeof SYSTEM / sizeof *SYSTEM; k++)
        if (strcmp(SYSTEM[k].name, name) == 0)
            return &SYSTEM[k];
    return NULL;
}

static double factor_of(int channel, const cp_unit_system *units)
{
    return pow(units->length, MOTION[channel].length) * pow(units->time, MOTION[channel].time);
}

// ---- writing -------------------------------------------------------------------------------

void cp_lsdyna_begin(FILE *file, const char *title, const cp_unit_system *units)
{
    fputs("*KEYWORD\n$ ", file);
    cp_text_print(file, title, "");
    fprintf(file,
            "\n%s%s\n$ axes of the vehicle: x forward, y to the left, yaw counter-clockwise from "
            "above\n",
            UNITS_COMMENT, units->name);
}

void cp_lsdyna_end(FILE *file)
{
    fputs("*END\n", file);
}

void cp_lsdyna_write(FILE *file, const cp_pulse_record *record, const char *role,
                     const cp_unit_system *units, long first_id, long *next_id)
{
    const cp_pulse *pulse = &record->pulse;
    *next_id = first_id;
    if (!isnan(record->separation_s))
        fprintf(file, "%s%s: %.9g s\n", SEPARATION_COMMENT, role, record->separation_s);
    if (record->side[0] != '\0')
        fprintf(file, "%s%s: %s\n", SIDE_COMMENT, role, record->side);
    for (int c = 0; c < CP_CHANNEL_COUNT; c++) {
        if (!record->known[c])
            continue;
        double factor = factor_of(c, units);
        fprintf(file,
                "*DEFINE_CURVE_TITLE\n%s%s %s\n"
                "$     LCID      SIDR       SFA       SFO      OFFA      OFFO\n"
                "%10ld         0       1.0       1.0       0.0       0.0\n"
                "$               time               value\n",
                TITLE, role, MOTION[c].name, (*next_id)++);
        for (size_t k = 0; k < pulse->sample_count; k++) {
            double value = pulse->channel[c][k] * factor;
            fprintf(file, "%20.11E%20.11E\n", (double)k * pulse->sample_interval_s * units->time,
                    value == 0.0 ? 0.0 : value);
        }
    }
}

// ---- reading -------------------------------------------------------------------------------

typedef struct curve {
    size_t line; // of its keyword
    long id;
    int channel;                      // CP_CHANNEL_COUNT: no title of ours
    char role[32];                    // of the title
    double scale_time, scale_value;   // SFA, SFO
    double offset_time, offset_value; // OFFA, OFFO
    double *point;                    // time, value; owned
    size_t count, room;
} curve;

// What comments tell of a vehicle.
typedef struct told {
    char role[32];
    double separation_s; // NAN: not told
    char side[16];       // "": not told
} told;

typedef struct reading {
    const cp_pulse_request *request;
    size_t line;
    int expected; // of the next line: 0 nothing of ours, 1 title, 2 card, 3 points
    curve *list;  // owned
    size_t count;
    const cp_unit_system *units; // of a comment
    told told[2];                // in the order the file tells of them
    size_t told_count;
} reading;

// Field number k of width columns, or the k-th between commas; blanks around it left out.
static bool field_of(const char *line, size_t k, size_t width, char field[64])
{
    const char *begin = line;
    size_t length = 0;
    if (strchr(line, ',') != NULL) {
        for (size_t i = 0; i < k && begin != NULL; i++)
            begin = (begin = strchr(begin, ',')) != NULL ? begin + 1 : NULL;
        if (begin == NULL)
            return false;
        length = strcspn(begin, ",");
    } else {
        if (strlen(line) <= k * width)
            return false;
        begin += k * width;
        length = strlen(begin) < width ? strlen(begin) : width;
    }
    while (length > 0 && strchr(" \t", *begin) != NULL) {
        begin++;
        length--;
    }
    while (length > 0 && strchr(" \t", begin[length - 1]) != NULL)
        length--;
    snprintf(field, 64, "%.*s", (int)(length < 63 ? length : 63), begin);
    return length > 0;
}

// A number of a card; blank or 0 where it is missing: instead.
static cp_status card_number(const reading *self, const char *line, size_t k, const char *name,
                             double instead, double *value, cp_error *error)
{
    char field[64];
    *value = instead;
    if (!field_of(line, k, 10, field))
        return CP_OK;
    if (!cp_parse_number(field, value))
        return cp_fail(error, CP_BAD_INPUT, "%s:%zu: %s must be a number, found '%s'",
                       self->request->path, self->line, name, field);
    if (*value == 0.0)
        *value = instead;
    return CP_OK;
}

static cp_status take_card(reading *self, const char *line, cp_error *error)
{
    curve *own = &self->list[self->count - 1];
    double id = 0.0;
    cp_status status = card_number(self, line, 0, "LCID", 0.0, &id, error);
    if (status == CP_OK && !(id >= 0.0 && id <= 1e9 && id == floor(id)))
        status = cp_fail(error, CP_BAD_INPUT, "%s:%zu: LCID must be a whole number, found %g",
                         self->request->path, self->line, id);
    if (status == CP_OK)
        status = card_number(self, line, 2, "SFA", 1.0, &own->scale_time, error);
    if (status == CP_OK)
        status = card_number(self, line, 3, "SFO", 1.0, &own->scale_value, error);
    if (status == CP_OK)
        status = card_number(self, line, 4, "OFFA", 0.0, &own->offset_time, error);
    if (status == CP_OK)
        status = card_number(self, line, 5, "OFFO", 0.0, &own->offset_value, error);
    own->id = status == CP_OK ? (long)id : 0;
    return status;
}

static cp_status take_point(reading *self, const char *line, cp_error *error)
{
    curve *own = &self->list[self->count - 1];
    char field[2][64];
    double value[2];
    for (size_t k = 0; k < 2; k++)
        if (!field_of(line, k, 20, field[k]) || !cp_parse_number(field[k], &value[k]))
            return cp_fail(error, CP_BAD_INPUT,
                           "%s:%zu: must be two numbers in fields of 20 columns, found '%.50s'",
                           self->request->path, self->line, line);
    cp_status status =
        cp_array_reserve(own->point, own->room, 2 * (own->count + 1), self->request->path, error);
    if (status != CP_OK)
        return status;
    own->point[2 * own->count] = own->scale_time * (value[0] + own->offset_time);
    own->point[2 * own->count++ + 1] = own->scale_value * (value[1] + own->offset_value);
    return CP_OK;
}

// "crashpulse vehicle a v_x"
static void take_title(reading *self, const char *line)
{
    curve *own = &self->list[self->count - 1];
    char role[32], motion[32];
    if (strncmp(line, TITLE, sizeof TITLE - 1) != 0 ||
        sscanf(line + sizeof TITLE - 1, "%31s %31s", role, motion) != 2)
        return;
    for (int c = 0; c < CP_CHANNEL_COUNT; c++)
        if (strcmp(motion, MOTION[c].name) == 0) {
            own->channel = c;
            snprintf(own->role, sizeof own->role, "%s", role);
        }
}

// Where to put what comments tell of a vehicle; NULL for a third one.
static told *told_of(reading *self, const char *role)
{
    size_t k = 0;
    while (k < self->told_count && strcmp(self->told[k].role, role) != 0)
        k++;
    if (k == sizeof self->told / sizeof *self->told)
        return NULL;
    if (k == self->told_count) {
        self->told[self->told_count++].separation_s = NAN;
        snprintf(self->told[k].role, sizeof self->told[k].role, "%s", role);
    }
    return &self->told[k];
}

// The rest of a comment of ours, "a: value", taken apart; false for another comment.
static bool is_told(const char *line, const char *begin, size_t length, char role[32],
                    char value[32])
{
    return strncmp(line, begin, length) == 0 &&
           sscanf(line + length, "%31[^:]: %31s", role, value) == 2;
}

static cp_status take_comment(reading *self, const char *line, cp_error *error)
{
    char text[32], role[32];
    if (strncmp(line, UNITS_COMMENT, sizeof UNITS_COMMENT - 1) == 0 &&
        sscanf(line + sizeof UNITS_COMMENT - 1, "%31s", text) == 1) {
        self->units = cp_unit_system_find(text);
    } else if (is_told(line, SEPARATION_COMMENT, sizeof SEPARATION_COMMENT - 1, role, text)) {
        told *own = told_of(self, role);
        if (own != NULL && !cp_parse_number(text, &own->separation_s))
            return cp_fail(error, CP_BAD_INPUT,
                           "%s:%zu: the time of the last contact must be a number, found '%s'",
                           self->request->path, self->line, text);
    } else if (is_told(line, SIDE_COMMENT, sizeof SIDE_COMMENT - 1, role, text)) {
        told *own = told_of(self, role);
        if (own != NULL)
            snprintf(own->side, sizeof own->side, "%.15s", text);
    }
    return CP_OK;
}

static cp_status take_keyword(reading *self, const char *line, cp_error *error)
{
    bool titled = strncasecmp(line, "*DEFINE_CURVE_TITLE", 19) == 0;
    size_t length = strcspn(line, " \t");
    self->expected = 0;
    if (!titled && !(length == 13 && strncasecmp(line, "*DEFINE_CURVE", 13) == 0))
        return CP_OK;
    curve *added = cp_array_add(self->list, self->count);
    if (added == NULL)
        return cp_fail_memory(error, self->request->path);
    *added = (curve){.line = self->line, .channel = CP_CHANNEL_COUNT};
    self->expected = titled ? 1 : 2;
    return CP_OK;
}

static cp_status take_line(reading *self, const char *line, cp_error *error)
{
    if (line[0] == '$')
        return take_comment(self, line, error);
    if (line[0] == '*')
        return take_keyword(self, line, error);
    if (line[strspn(line, " \t")] == '\0' && self->expected != 1)
        return CP_OK;
    switch (self->expected) {
    case 1:
        take_title(self, line);
        self->expected = 2;
        return CP_OK;
    case 2:
        self->expected = 3;
        return take_card(self, line, error);
    case 3:
        return take_point(self, line, error);
    default:
        return CP_OK;
    }
}

// Times of a curve in s; even steps, one at 0. Gives the step and the place of time 0.
static cp_status check_times(const reading *self, const curve *own, const cp_unit_system *units,
                             double *interval_s, size_t *zero, cp_error *error)
{
    const char *path = self->request->path;
    double step_s = own->count > 1 ? (own->point[2] - own->point[0]) / units->time : 0.0;
    if (!(step_s > 0.0 && step_s <= 0.01))
        return cp_fail(error, CP_BAD_INPUT,
                       "%s:%zu: the times of the curve must rise in even steps of at most 0.01 s, "
                       "found %g s",
                       path, own->line, step_s);
    double first = own->point[0] / units->time / step_s;
    *interval_s = step_s;
    *zero = first < -0.5 ? (size_t)(0.5 - first) : 0;
    for (size_t k = 0; k < own->count; k++) {
        double expected_s = ((double)k - (double)*zero) * step_s;
        double time_s = own->point[2 * k] / units->time;
        if (fabs(time_s - expected_s) > 0.01 * step_s + 1e-9)
            return cp_fail(error, CP_BAD_INPUT,
                           "%s:%zu: point %zu of the curve must be at %g s, in even steps with one "
                           "at 0, found %g s",
                           path, own->line, k + 1, expected_s, time_s);
    }
    return CP_OK;
}

static cp_status take_curve(const reading *self, const curve *own, int channel,
                            const cp_unit_system *units, cp_pulse_record *record, cp_error *error)
{
    double interval_s = 0.0;
    size_t zero = 0;
    cp_pulse *pulse = &record->pulse;
    cp_status status = check_times(self, own, units, &interval_s, &zero, error);
    if (status != CP_OK)
        return status;
    if (zero + 2 > own->count)
        return cp_fail(error, CP_BAD_INPUT, "%s:%zu: fewer than two points from time 0 on",
                       self->request->path, own->line);
    if (pulse->sample_count == 0)
        status = cp_pulse_create(pulse, own->count - zero, interval_s, error);
    if (status == CP_OK && (pulse->sample_count != own->count - zero ||
                            fabs(pulse->sample_interval_s - interval_s) > 1e-9))
        status = cp_fail(error, CP_BAD_INPUT,
                         "%s:%zu: the curve has other times than the vehicle's curves before it",
                         self->request->path, own->line);
    double factor = factor_of(channel, units) * (self->request->is_reversed ? -1.0 : 1.0);
    for (size_t k = 0; status == CP_OK && k < pulse->sample_count; k++)
        pulse->channel[channel][k] = own->point[2 * (zero + k) + 1] / factor;
    record->known[channel] = true;
    return status;
}

// Curves with titles of ours.
static cp_status take_titled(const reading *self, cp_pulse_record *record, cp_error *error)
{
    const char *wanted = self->request->vehicle;
    cp_status status = CP_OK;
    if (self->units == NULL)
        return cp_fail(error, CP_BAD_INPUT, "%s: tells no units ('%s', one of %s)",
                       self->request->path, UNITS_COMMENT, CP_UNIT_SYSTEMS_TEXT);
    for (size_t k = 0; status == CP_OK && k < self->count; k++) {
        const curve *own = &self->list[k];
        if (own->channel == CP_CHANNEL_COUNT)
            continue;
        if (wanted == NULL)
            wanted = own->role;
        if (strcmp(own->role, wanted) != 0) {
            record->against_car = true;
            continue;
        }
        if (record->known[own->channel])
            status = cp_fail(error, CP_BAD_INPUT, "%s:%zu: %s of vehicle %s is given twice",
                             self->request->path, own->line, MOTION[own->channel].name, wanted);
        else
            status = take_curve(self, own, own->channel, self->units, record, error);
    }
    for (size_t k = 0; k < self->told_count; k++)
        if (wanted != NULL && strcmp(self->told[k].role, wanted) == 0) {
            record->separation_s = self->told[k].separation_s;
            cp_pulse_record_take_side(record, self->told[k].side);
        }
    snprintf(record->vehicle, sizeof record->vehicle, "%s", wanted != NULL ? wanted : "");
    if (status == CP_OK && record->pulse.sample_count == 0)
        status = cp_fail(error, CP_BAD_INPUT, "%s: has no curve of vehicle %s", self->request->path,
                         wanted != NULL ? wanted : "");
    return status;
}

// One curve of somebody else.
static cp_status take_untitled(const reading *self, cp_pulse_record *record, cp_error *error)
{
    const cp_pulse_request *request = self->request;
    const curve *own = self->count == 1 ? &self->list[0] : NULL;
    const cp_unit_system *units =
        request->units != NULL ? cp_unit_system_find(request->units) : NULL;
    for (size_t k = 0; request->curve_count > 0 && k < self->count; k++)
        if (self->list[k].id == request->curve[0])
            own = &self->list[k];
    if (own == NULL || (request->curve_count > 0 && own->id != request->curve[0]))
        return cp_fail(error, CP_BAD_INPUT,
                       "%s: holds %zu curves: the id (LCID) of the one meant is needed",
                       request->path, self->count);
    if (units == NULL)
        return cp_fail(error, CP_BAD_INPUT, "%s: its system of units is needed, one of %s",
                       request->path, CP_UNIT_SYSTEMS_TEXT);
    return take_curve(self, own, request->is_acceleration ? CP_CHANNEL_AX : CP_CHANNEL_VX, units,
                      record, error);
}

cp_status cp_lsdyna_parse(const cp_pulse_request *request, char *content, cp_pulse_record *record,
                          cp_error *error)
{
    const char *slash = strrchr(request->path, '/');
    bool titled = false;
    reading self = {.request = request};
    cp_status status = CP_OK;
    *record = (cp_pulse_record){.separation_s = NAN, .mass_kg = NAN};
    snprintf(record->source, sizeof record->source, "%s",
             slash != NULL ? slash + 1 : request->path);
    for (char *rest = content; status == CP_OK && rest != NULL;) {
        const char *line = cp_csv_next_line(&rest);
        self.line++;
        status = take_line(&self, line, error);
    }
    for (size_t k = 0; k < self.count; k++)
        titled |= self.list[k].channel < CP_CHANNEL_COUNT;
    if (status == CP_OK && self.count == 0)
        status = cp_fail(error, CP_BAD_INPUT, "%s: holds no *DEFINE_CURVE", request->path);
    else if (status == CP_OK)
        status = titled && request->curve_count == 0 ? take_titled(&self, record, error)
                                                     : take_untitled(&self, record, error);
    if (status == CP_OK)
        status = cp_pulse_record_complete(record, request, error);
    for (size_t k = 0; k < self.count; k++)
        free(self.list[k].point);
    free(self.list);
    if (status != CP_OK)
        cp_pulse_record_destroy(record);
    return status;
}
