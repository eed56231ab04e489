/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/nhtsa_ev5.h"

#include "core/file.h"
#include "core/units.h"
#include "core/yaml_file.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

// The zero offset is taken from this long before time 0.
static const double ZERO_WINDOW_S = 0.04;

// ---- records ---------------------------------------------------------------------------------

#define FIELDS_MAX 128

// One line of the EV5 file cut into its fields.
typedef struct record {
    const char *path;
    size_t line;
    size_t count;
    char *field[FIELDS_MAX];
} record;

static void split_record(char *text, record *row)
{
    row->count = 0;
    for (char *field = text; field != NULL && row->count < FIELDS_MAX; row->count++) {
        row->field[row->count] = field;
        char *next = strchr(field, '|');
        if (next != NULL)
            *next++ = '\0';
        for (size_t end = strlen(field); end > 0 && field[end - 1] == ' '; end--)
            field[end - 1] = '\0';
        field = next;
    }
}

// Field number place (from 1, as the format counts them) as a number within bounds. An empty one
// is 0 where that is allowed.
static cp_status number_field(const record *row, size_t place, const char *name, double smallest,
                              double largest, double *value, cp_error *error)
{
    if (place > row->count)
        return cp_fail(error, CP_BAD_INPUT, "%s:%zu: field %zu (%s) is missing: %zu fields",
                       row->path, row->line, place, name, row->count);
    const char *text = row->field[place - 1];
    if (text[0] == '\0' && smallest <= 0.0) {
        *value = 0.0;
        return CP_OK;
    }
    if (!cp_parse_number(text, value) || *value < smallest || *value > largest)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s:%zu: field %zu (%s) must be a number between %g and %g, found '%s'",
                       row->path, row->line, place, name, smallest, largest, text);
    return CP_OK;
}

static cp_status text_field(const record *row, size_t place, const char *name, char *text,
                            size_t room, cp_error *error)
{
    if (place > row->count)
        return cp_fail(error, CP_BAD_INPUT, "%s:%zu: field %zu (%s) is missing: %zu fields",
                       row->path, row->line, place, name, row->count);
    snprintf(text, room, "%s", row->field[place - 1]);
    return CP_OK;
}

static cp_status read_test(const record *row, cp_ev5_test *test, cp_error *error)
{
    double speed_km_h = 0.0;
    cp_status status = text_field(row, 2, "test title", test->title, sizeof test->title, error);
    if (status == CP_OK)
        status = text_field(row, 4, "test date", test->date, sizeof test->date, error);
    if (status == CP_OK)
        status = text_field(row, 7, "test reference", test->laboratory_reference,
                            sizeof test->laboratory_reference, error);
    if (status == CP_OK)
        status = number_field(row, 15, "closing speed, km/h", 0.0, 400.0, &speed_km_h, error);
    test->closing_speed_m_s = cp_m_s_from_km_h(speed_km_h);
    return status;
}

static cp_status read_vehicle(const record *row, cp_ev5_test *test, cp_error *error)
{
    if (test->vehicle_count == CP_EV5_VEHICLES_MAX)
        return cp_fail(error, CP_BAD_INPUT, "%s:%zu: more than %d vehicles in one test", row->path,
                       row->line, CP_EV5_VEHICLES_MAX);
    double number = 0.0, length_mm = 0.0, width_mm = 0.0, cg_mm = 0.0, speed_km_h = 0.0;
    cp_ev5_vehicle *vehicle = &test->vehicle[test->vehicle_count];
    cp_status status = number_field(row, 1, "vehicle number", 1.0, 9.0, &number, error);
    if (status == CP_OK)
        status = number_field(row, 11, "test weight, kg", 1.0, 1e5, &vehicle->mass_kg, error);
    if (status == CP_OK)
        status = number_field(row, 14, "length, mm", 0.0, 3e4, &length_mm, error);
    if (status == CP_OK)
        status = number_field(row, 15, "width, mm", 0.0, 5e3, &width_mm, error);
    if (status == CP_OK)
        status = number_field(row, 16, "centre of gravity behind front axle, mm", 0.0, 2e4, &cg_mm,
                              error);
    if (status == CP_OK)
        status = number_field(row, 42, "vehicle speed, km/h", 0.0, 400.0, &speed_km_h, error);
    if (status != CP_OK)
        return status;
    vehicle->number = (int)number;
    vehicle->length_m = 1e-3 * length_mm;
    vehicle->width_m = 1e-3 * width_mm;
    vehicle->cg_behind_front_axle_m = 1e-3 * cg_mm;
    vehicle->speed_m_s = cp_m_s_from_km_h(speed_km_h);
    test->vehicle_count++;
    return CP_OK;
}

static cp_status read_instrument(const record *row, cp_ev5_test *test, cp_error *error)
{
    double vehicle = 0.0, curve = 0.0, first = 0.0, last = 0.0, interval_us = 0.0;
    cp_ev5_instrument *own = &test->instrument[test->instrument_count];
    const struct {
        size_t place;
        const char *name;
        char *text;
        size_t room;
    } TEXTS[] = {{3, "sensor", own->sensor, sizeof own->sensor},
                 {4, "position", own->position, sizeof own->position},
                 {5, "attachment", own->attachment, sizeof own->attachment},
                 {6, "axis", own->axis, sizeof own->axis},
                 {8, "unit", own->unit, sizeof own->unit},
                 {18, "data status", own->status, sizeof own->status},
                 {19, "channel status", own->rank, sizeof own->rank},
                 {20, "comment", own->comment, sizeof own->comment}};
    cp_status status = number_field(row, 1, "vehicle number", 0.0, 9.0, &vehicle, error);
    if (status == CP_OK)
        status = number_field(row, 2, "curve number", 1.0, 99999.0, &curve, error);
    for (size_t k = 0; status == CP_OK && k < sizeof TEXTS / sizeof *TEXTS; k++)
        status =
            text_field(row, TEXTS[k].place, TEXTS[k].name, TEXTS[k].text, TEXTS[k].room, error);
    if (status == CP_OK)
        status = number_field(row, 15, "first sample", -1e7, 1e7, &first, error);
    if (status == CP_OK)
        status = number_field(row, 16, "last sample", first, 1e7, &last, error);
    if (status == CP_OK)
        status = number_field(row, 17, "interval, microseconds", 0.1, 1e5, &interval_us, error);
    if (status == CP_OK && cp_ev5_find(test, (int)curve) != NULL)
        status = cp_fail(error, CP_BAD_INPUT, "%s:%zu: field 2 (curve number): %g is given twice",
                         row->path, row->line, curve);
    if (status != CP_OK)
        return status;
    own->line = row->line;
    own->vehicle = (int)vehicle;
    own->curve = (int)curve;
    own->first_sample = (long)first;
    own->last_sample = (long)last;
    own->interval_s = 1e-6 * interval_us;
    test->instrument_count++;
    return CP_OK;
}

// ---- the EV5 file ----------------------------------------------------------------------------

typedef cp_status (*record_reader)(const record *, cp_ev5_test *, cp_error *);

// Reader of the section a headline opens; NULL for a section nobody here needs. false: no headline.
static bool open_section(const char *line, record_reader *reader)
{
    char name[32];
    if (sscanf(line, "----- %31[A-Z0-9] -----", name) != 1)
        return false;
    *reader = strcmp(name, "TEST") == 0              ? read_test
              : strcmp(name, "VEHICLE") == 0         ? read_vehicle
              : strcmp(name, "INSTRUMENTATION") == 0 ? read_instrument
                                                     : NULL;
    return true;
}

static cp_status read_lines(char *content, cp_ev5_test *test, cp_error *error)
{
    size_t lines = 1;
    for (const char *c = content; *c != '\0'; c++)
        lines += *c == '\n';
    test->instrument = calloc(lines, sizeof *test->instrument);
    if (test->instrument == NULL)
        return cp_fail_memory(error, test->path);
    record row = {.path = test->path};
    record_reader reader = NULL;
    bool any_test = false;
    for (char *line = content; line != NULL;) {
        char *next = strchr(line, '\n');
        if (next != NULL)
            *next++ = '\0';
        line[strcspn(line, "\r")] = '\0';
        row.line++;
        bool blank = line[0] == '#' || line[strspn(line, " \t")] == '\0';
        if (!blank && !open_section(line, &reader) && reader != NULL) {
            split_record(line, &row);
            any_test |= reader == read_test;
            cp_status status = reader(&row, test, error);
            if (status != CP_OK)
                return status;
        }
        line = next;
    }
    if (!any_test || test->vehicle_count == 0)
        return cp_fail(error, CP_BAD_INPUT, "%s: no record in section %s: not an EV5 file?",
                       test->path, any_test ? "VEHICLE" : "TEST");
    return CP_OK;
}

static bool has_ev5_suffix(const char *name)
{
    size_t length = strlen(name);
    return length > 4 && strcasecmp(name + length - 4, ".ev5") == 0;
}

// The only EV5 file of a folder.
static cp_status find_in_folder(const char *folder, char **path, cp_error *error)
{
    DIR *directory = opendir(folder);
    if (directory == NULL)
        return cp_fail(error, CP_BAD_INPUT, "%s: cannot be read: %s", folder, strerror(errno));
    cp_status status = CP_OK;
    for (struct dirent *entry = readdir(directory); status == CP_OK && entry != NULL;
         entry = readdir(directory)) {
        if (!has_ev5_suffix(entry->d_name))
            continue;
        if (*path != NULL) {
            status = cp_fail(error, CP_BAD_INPUT,
                             "%s: holds more than one EV5 file: name the one meant", folder);
            break;
        }
        size_t room = strlen(folder) + strlen(entry->d_name) + 2;
        *path = malloc(room);
        if (*path == NULL)
            status = cp_fail_memory(error, folder);
        else
            snprintf(*path, room, "%s/%s", folder, entry->d_name);
    }
    closedir(directory);
    if (status == CP_OK && *path == NULL)
        return cp_fail(error, CP_BAD_INPUT, "%s: holds no .EV5 file", folder);
    return status;
}

static cp_status find_file(const char *folder, cp_ev5_test *test, cp_error *error)
{
    struct stat kind;
    if (stat(folder, &kind) != 0)
        return cp_fail(error, CP_BAD_INPUT, "%s: cannot be read: %s", folder, strerror(errno));
    if (S_ISDIR(kind.st_mode)) {
        cp_status status = find_in_folder(folder, &test->path, error);
        if (status != CP_OK)
            return status;
    } else if ((test->path = strdup(folder)) == NULL) {
        return cp_fail_memory(error, folder);
    }
    const char *slash = strrchr(test->path, '/');
    snprintf(test->name, sizeof test->name, "%s", slash != NULL ? slash + 1 : test->path);
    if (has_ev5_suffix(test->name))
        test->name[strlen(test->name) - 4] = '\0';
    return CP_OK;
}

cp_status cp_ev5_load(const char *folder, cp_ev5_test *test, cp_error *error)
{
    *test = (cp_ev5_test){0};
    char *content = NULL;
    size_t size = 0;
    cp_status status = find_file(folder, test, error);
    if (status == CP_OK)
        status = cp_file_read_text(test->path, &content, &size, error);
    if (status == CP_OK)
        status = read_lines(content, test, error);
    free(content);
    if (status != CP_OK)
        cp_ev5_destroy(test);
    return status;
}

void cp_ev5_destroy(cp_ev5_test *test)
{
    free(test->path);
    free(test->instrument);
    *test = (cp_ev5_test){0};
}

const cp_ev5_instrument *cp_ev5_find(const cp_ev5_test *test, int curve)
{
    for (size_t k = 0; k < test->instrument_count; k++)
        if (test->instrument[k].curve == curve)
            return &test->instrument[k];
    return NULL;
}

// ---- curves ----------------------------------------------------------------------------------

// Factor that makes a value of the format's unit one of SI; 0 for a unit not known here.
static double si_of_unit(const char *unit)
{
    static const struct {
        const char *unit;
        double si;
    } UNITS[] = {{"G'S", CP_G0_M_S2}, {"NWT", 1.0},       {"NWM", 1.0},
                 {"MM", 1e-3},        {"KPH", 1.0 / 3.6}, {"DPS", CP_PI / 180.0}};
    for (size_t k = 0; k < sizeof UNITS / sizeof *UNITS; k++)
        if (strcmp(unit, UNITS[k].unit) == 0)
            return UNITS[k].si;
    return 0.0;
}

char *cp_ev5_curve_path(const cp_ev5_test *test, int curve)
{
    size_t stem = strlen(test->path) - (has_ev5_suffix(test->path) ? 4 : 0);
    size_t room = stem + 16;
    char *path = malloc(room);
    if (path != NULL)
        snprintf(path, room, "%.*s.%03d", (int)stem, test->path, curve);
    return path;
}

// One line of a curve file: its time must be that of sample k, to a tenth of an interval.
static cp_status read_sample(const char *path, size_t line, const char *text,
                             const cp_ev5_instrument *record_of, size_t k, double *value,
                             cp_error *error)
{
    char first[64], second[64];
    double time_s = 0.0;
    if (sscanf(text, "%63s %63s", first, second) != 2)
        return cp_fail(error, CP_BAD_INPUT, "%s:%zu: two columns are needed, found '%s'", path,
                       line, text);
    if (!cp_parse_number(first, &time_s))
        return cp_fail(error, CP_BAD_INPUT, "%s:%zu: column 1 (time) is no number: '%s'", path,
                       line, first);
    if (!cp_parse_number(second, value))
        return cp_fail(error, CP_BAD_INPUT, "%s:%zu: column 2 (value) is no number: '%s'", path,
                       line, second);
    double expected_s = (double)(record_of->first_sample + (long)k) * record_of->interval_s;
    if (fabs(time_s - expected_s) > 0.1 * record_of->interval_s)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s:%zu: column 1 (time) must be %.6f s by the record's first sample and "
                       "interval, found '%s'",
                       path, line, expected_s, first);
    return CP_OK;
}

static cp_status read_samples(const char *path, char *content, const cp_ev5_instrument *record_of,
                              cp_ev5_channel *channel, cp_error *error)
{
    size_t number = 0, count = 0;
    for (char *line = content; line != NULL;) {
        char *next = strchr(line, '\n');
        if (next != NULL)
            *next++ = '\0';
        line[strcspn(line, "\r")] = '\0';
        number++;
        if (line[strspn(line, " \t")] != '\0') {
            if (count == channel->sample_count)
                return cp_fail(error, CP_BAD_INPUT,
                               "%s:%zu: more than the %zu samples of its record", path, number,
                               channel->sample_count);
            cp_status status =
                read_sample(path, number, line, record_of, count, &channel->value[count], error);
            if (status != CP_OK)
                return status;
            count++;
        }
        line = next;
    }
    if (count < channel->sample_count)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s:%zu: ends after %zu of the %zu samples of its record", path, number,
                       count, channel->sample_count);
    return CP_OK;
}

// Mean before time 0, taken off every sample.
static void remove_zero_offset(cp_ev5_channel *channel)
{
    double sum = 0.0;
    size_t used = 0;
    for (size_t k = 0; k < channel->sample_count; k++) {
        double time_s = (double)(channel->first_sample + (long)k) * channel->interval_s;
        if (time_s < -ZERO_WINDOW_S - 0.5 * channel->interval_s ||
            channel->first_sample + (long)k >= 0)
            continue;
        sum += channel->value[k];
        used++;
    }
    channel->zero_offset = used > 0 ? sum / (double)used : 0.0;
    for (size_t k = 0; k < channel->sample_count; k++)
        channel->value[k] -= channel->zero_offset;
}

static cp_status check_record(const cp_ev5_test *test, int curve,
                              const cp_ev5_instrument *record_of, cp_error *error)
{
    if (record_of == NULL)
        return cp_fail(error, CP_BAD_INPUT, "%s: has no curve number %d", test->path, curve);
    if (strcmp(record_of->status, "NO") == 0)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s:%zu: field 18 (data status): curve %d holds no data (%s)", test->path,
                       record_of->line, curve, record_of->comment);
    if (si_of_unit(record_of->unit) == 0.0)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s:%zu: field 8 (unit): '%s' is none of G'S, NWT, NWM, MM, KPH, DPS",
                       test->path, record_of->line, record_of->unit);
    return CP_OK;
}

cp_status cp_ev5_channel_load(const cp_ev5_test *test, int curve, cp_ev5_channel *channel,
                              cp_error *error)
{
    *channel = (cp_ev5_channel){0};
    const cp_ev5_instrument *record_of = cp_ev5_find(test, curve);
    cp_status status = check_record(test, curve, record_of, error);
    if (status != CP_OK)
        return status;
    channel->first_sample = record_of->first_sample;
    channel->interval_s = record_of->interval_s;
    channel->sample_count = (size_t)(record_of->last_sample - record_of->first_sample) + 1;

    char *content = NULL, *path = cp_ev5_curve_path(test, curve);
    size_t size = 0;
    channel->value = calloc(channel->sample_count, sizeof *channel->value);
    if (path == NULL || channel->value == NULL)
        status = cp_fail_memory(error, test->path);
    if (status == CP_OK)
        status = cp_file_read_text(path, &content, &size, error);
    if (status == CP_OK)
        status = read_samples(path, content, record_of, channel, error);
    for (size_t k = 0; status == CP_OK && k < channel->sample_count; k++)
        channel->value[k] *= si_of_unit(record_of->unit);
    if (status == CP_OK)
        remove_zero_offset(channel);
    free(content);
    free(path);
    if (status != CP_OK)
        cp_ev5_channel_destroy(channel);
    return status;
}

void cp_ev5_channel_destroy(cp_ev5_channel *channel)
{
    free(channel->value);
    *channel = (cp_ev5_channel){0};
}
