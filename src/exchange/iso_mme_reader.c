/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/csv_row.h"
#include "core/file.h"
#include "core/units.h"
#include "core/yaml_file.h"
#include "exchange/iso_mme.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

enum { CODE_LENGTH = 16, SAMPLES_MAX = 10000000 };

// What one channel file says of itself; values stay where they are until it is chosen.
typedef struct channel_file {
    char path[PATH_MAX];
    char code[CODE_LENGTH + 1];
    char unit[32];
    double interval_s;
    double first_s;
    size_t count;
    double *value; // owned
} channel_file;

// What is read so far.
typedef struct reading {
    const cp_pulse_request *request;
    cp_pulse_record *record;
    char object;                           // '1' ... of the codes
    channel_file chosen[CP_CHANNEL_COUNT]; // value NULL: none
    double velocity_m_s;                   // of the .mme file; NAN
    size_t channel_count;
    char others[256]; // codes that were passed over
} reading;

// ---- lines ---------------------------------------------------------------------------------

// Cut "Name   :value" into its parts, blanks around them left out; false: no such line.
static bool split_line(char *text, char **name, char **value)
{
    char *colon = strchr(text, ':');
    if (colon == NULL)
        return false;
    *colon = '\0';
    *name = text + strspn(text, " \t");
    *value = colon + 1 + strspn(colon + 1, " \t");
    for (char *part = *name;; part = *value) {
        for (char *end = part + strlen(part); end > part && isspace((unsigned char)end[-1]);)
            *--end = '\0';
        if (part == *value)
            return true;
    }
}

static bool is_value(const char *value)
{
    return value[0] != '\0' && strcasecmp(value, "NOVALUE") != 0;
}

// ---- units ---------------------------------------------------------------------------------

// Factor to SI; 0 for a unit not known here. Blanks, '^' and '*' in it do not count.
static double si_of_unit(const char *unit)
{
    static const struct {
        const char *name;
        double si;
    } UNIT[] = {{"m/s2", 1.0},
                {"m/(ss)", 1.0},
                {"m/ss", 1.0},
                {"m/s\xb2", 1.0},
                {"m/s\xc2\xb2", 1.0},
                {"g", CP_G0_M_S2},
                {"m/s", 1.0},
                {"km/h", 1.0 / 3.6},
                {"mm/s", 1e-3},
                {"m", 1.0},
                {"mm", 1e-3},
                {"cm", 1e-2},
                {"rad", 1.0},
                {"rad/s", 1.0},
                {"rad/s2", 1.0},
                {"deg", CP_PI / 180},
                {"deg/s", CP_PI / 180},
                {"deg/s2", CP_PI / 180},
                {"\xb0", CP_PI / 180},
                {"\xb0/s", CP_PI / 180},
                {"\xc2\xb0", CP_PI / 180},
                {"\xc2\xb0/s", CP_PI / 180}};
    char plain[32];
    size_t length = 0;
    for (const char *c = unit; *c != '\0' && length + 1 < sizeof plain; c++)
        if (strchr(" ^*", *c) == NULL)
            plain[length++] = *c;
    plain[length] = '\0';
    for (size_t k = 0; k < sizeof UNIT / sizeof *UNIT; k++)
        if (strcasecmp(plain, UNIT[k].name) == 0)
            return UNIT[k].si;
    return 0.0;
}

// ---- a channel file ------------------------------------------------------------------------

static cp_status take_number(const char *path, size_t line, const char *name, const char *value,
                             double smallest, double largest, double *number, cp_error *error)
{
    if (cp_parse_number(value, number) && *number >= smallest && *number <= largest)
        return CP_OK;
    return cp_fail(error, CP_BAD_INPUT, "%s:%zu: %s must be a number between %g and %g, found '%s'",
                   path, line, name, smallest, largest, value);
}

static cp_status take_header(channel_file *file, size_t line, const char *name, const char *value,
                             cp_error *error)
{
    double count = 0.0;
    if (strcasecmp(name, "Channel code") == 0)
        snprintf(file->code, sizeof file->code, "%s", value);
    else if (strcasecmp(name, "Unit") == 0)
        snprintf(file->unit, sizeof file->unit, "%s", value);
    else if (strcasecmp(name, "Sampling interval") == 0 && is_value(value))
        return take_number(file->path, line, name, value, 1e-7, 0.01, &file->interval_s, error);
    else if (strcasecmp(name, "Time of first sample") == 0 && is_value(value))
        return take_number(file->path, line, name, value, -1000.0, 0.01, &file->first_s, error);
    else if (strcasecmp(name, "Number of samples") == 0 && is_value(value)) {
        cp_status status =
            take_number(file->path, line, name, value, 1.0, SAMPLES_MAX, &count, error);
        file->count = (size_t)count;
        return status;
    } else if (strcasecmp(name, "Reference channel") == 0 && is_value(value) &&
               strcasecmp(value, "implicit") != 0)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s:%zu: Reference channel must be implicit (times by sampling interval), "
                       "found '%s'",
                       file->path, line, value);
    return CP_OK;
}

static cp_status take_values(channel_file *file, char *rest, size_t line, cp_error *error)
{
    size_t lines = 1, told = file->count;
    for (const char *c = rest; c != NULL && *c != '\0'; c++)
        lines += *c == '\n';
    file->count = 0;
    file->value = calloc(lines, sizeof *file->value);
    if (file->value == NULL)
        return cp_fail_memory(error, file->path);
    while (rest != NULL) {
        char *text = cp_csv_next_line(&rest);
        text += strspn(text, " \t");
        for (char *end = text + strlen(text); end > text && isspace((unsigned char)end[-1]);)
            *--end = '\0';
        if (*text != '\0' && !cp_parse_number(text, &file->value[file->count++]))
            return cp_fail(error, CP_BAD_INPUT, "%s:%zu: must be a number, found '%.40s'",
                           file->path, line, text);
        line++;
    }
    if (told > 0 && told != file->count)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s: must hold the %zu values its header tells, found %zu", file->path, told,
                       file->count);
    return CP_OK;
}

static cp_status check_header(const channel_file *file, cp_error *error)
{
    const char *missing = file->interval_s == 0.0 ? "Sampling interval"
                          : isnan(file->first_s)  ? "Time of first sample"
                          : !is_value(file->unit) ? "Unit"
                                                  : NULL;
    if (missing != NULL)
        return cp_fail(error, CP_BAD_INPUT, "%s: tells no %s", file->path, missing);
    if (si_of_unit(file->unit) == 0.0)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s: Unit '%s' is none of m/s2, g, m/s, km/h, mm/s, m, cm, mm, rad, deg, "
                       "rad/s, deg/s, rad/s2, deg/s2",
                       file->path, file->unit);
    return CP_OK;
}

// The header; *rest is what follows it, *line its first line.
static cp_status read_header(channel_file *file, char *content, char **rest, size_t *line,
                             cp_error *error)
{
    cp_status status = CP_OK;
    *line = 1;
    for (*rest = content; status == CP_OK && *rest != NULL; (*line)++) {
        char *begin = *rest, *name, *value, first[512];
        size_t length = strcspn(begin, "\r\n");
        snprintf(first, sizeof first, "%.*s", (int)(length < 511 ? length : 511), begin);
        if (!split_line(first, &name, &value)) {
            if (first[strspn(first, " \t")] != '\0')
                break;
        } else {
            status = take_header(file, *line, name, value, error);
        }
        begin = strchr(begin, '\n');
        *rest = begin != NULL ? begin + 1 : NULL;
    }
    return status;
}

// ---- which channels ------------------------------------------------------------------------

// Place of a filter class in the order from the least filtered on.
static size_t filter_rank(char filter)
{
    static const char ORDER[] = {'0', 'P', 'A', 'B', 'C', 'D'};
    size_t rank = 0;
    while (rank < sizeof ORDER && ORDER[rank] != filter)
        rank++;
    return rank;
}

// Our channel that a code is of; CP_CHANNEL_COUNT: none that is asked for.
static int channel_of(const reading *self, const char *code)
{
    if (strlen(code) != CODE_LENGTH)
        return CP_CHANNEL_COUNT;
    if (self->request->code != NULL && strcmp(code, self->request->code) == 0)
        return CP_CHANNEL_AX;
    if (code[0] != self->object || strncmp(code + 2, "VEHC", 4) != 0)
        return CP_CHANNEL_COUNT;
    for (int c = 0; c < CP_CHANNEL_COUNT; c++)
        if (strncmp(code + 12, CP_ISO_MME_CODE[c].dimension, 2) == 0 &&
            code[14] == CP_ISO_MME_CODE[c].direction)
            return self->request->code != NULL && c == CP_CHANNEL_AX ? CP_CHANNEL_COUNT : c;
    return CP_CHANNEL_COUNT;
}

static void pass_over(reading *self, const char *code)
{
    size_t used = strlen(self->others);
    if (used + CODE_LENGTH + 8 < sizeof self->others)
        snprintf(self->others + used, sizeof self->others - used, "%s%s", used > 0 ? ", " : "",
                 code);
    else if (used + 4 < sizeof self->others && strstr(self->others, "...") == NULL)
        strcat(self->others, "...");
}

static cp_status read_channel(reading *self, const char *path, cp_error *error)
{
    channel_file file = {.first_s = NAN};
    char *content = NULL, *rest = NULL;
    size_t size = 0, line = 0;
    snprintf(file.path, sizeof file.path, "%s", path);
    cp_status status = cp_file_read_text(path, &content, &size, error);
    if (status == CP_OK)
        status = read_header(&file, content, &rest, &line, error);
    if (status == CP_OK && file.code[0] == '\0')
        status = cp_fail(error, CP_BAD_INPUT, "%s: tells no Channel code", path);
    int channel = status == CP_OK ? channel_of(self, file.code) : CP_CHANNEL_COUNT;
    channel_file *known = channel < CP_CHANNEL_COUNT ? &self->chosen[channel] : NULL;
    if (status == CP_OK)
        self->channel_count++;
    if (known != NULL && known->value != NULL &&
        filter_rank(file.code[15]) >= filter_rank(known->code[15]))
        known = NULL;
    if (status == CP_OK && known == NULL)
        pass_over(self, file.code);
    if (status == CP_OK && known != NULL)
        status = check_header(&file, error);
    if (status == CP_OK && known != NULL)
        status = take_values(&file, rest, line, error);
    if (status == CP_OK && known != NULL) {
        free(known->value);
        *known = file;
        file.value = NULL;
    }
    free(file.value);
    free(content);
    return status;
}

// ---- the test ------------------------------------------------------------------------------

// Whether a name in the .mme file is this of the test object, with or without "of".
static bool is_of_object(const char *name, const char *what, char object)
{
    size_t length = strlen(what);
    if (strncasecmp(name, what, length) != 0)
        return false;
    name += length;
    if (strncasecmp(name, " of", 3) == 0)
        name += 3;
    return strncasecmp(name, " test object ", 13) == 0 && name[13] == object && name[14] == '\0';
}

static cp_status take_test_line(reading *self, const char *path, size_t line, const char *name,
                                const char *value, cp_error *error)
{
    cp_pulse_record *record = self->record;
    double count = 0.0;
    if (!is_value(value))
        return CP_OK;
    if (is_of_object(name, "Velocity", self->object))
        return take_number(path, line, name, value, 0.0, 150.0, &self->velocity_m_s, error);
    if (is_of_object(name, "Mass", self->object))
        return take_number(path, line, name, value, 1.0, 1e6, &record->mass_kg, error);
    if (is_of_object(name, ".Separation", self->object))
        return take_number(path, line, name, value, 0.0, 10.0, &record->separation_s, error);
    for (int k = 0; is_of_object(name, "Impact side", self->object) && k < 4; k++)
        if (strcasecmp(value, CP_ISO_MME_SIDE[k][1]) == 0)
            cp_pulse_record_take_side(record, CP_ISO_MME_SIDE[k][0]);
    if (strcasecmp(name, "Number of test objects") == 0) {
        cp_status status = take_number(path, line, name, value, 1.0, 9.0, &count, error);
        record->against_car = count > 1.0;
        return status;
    }
    return CP_OK;
}

static cp_status read_test(reading *self, const char *path, cp_error *error)
{
    char *content = NULL;
    size_t size = 0, line = 0;
    cp_status status = cp_file_read_text(path, &content, &size, error);
    for (char *rest = content; status == CP_OK && rest != NULL;) {
        char *name, *value, *text = cp_csv_next_line(&rest);
        line++;
        if (split_line(text, &name, &value))
            status = take_test_line(self, path, line, name, value, error);
    }
    free(content);
    return status;
}

// Whether a file name is <stem>.<digits>.
static bool is_channel_name(const char *name, const char *stem)
{
    size_t length = strlen(stem);
    if (strncasecmp(name, stem, length) != 0 || name[length] != '.')
        return false;
    const char *digits = name + length + 1;
    size_t count = strspn(digits, "0123456789");
    return count >= 3 && digits[count] == '\0';
}

static int compare_names(const struct dirent **one, const struct dirent **other)
{
    return strcmp((*one)->d_name, (*other)->d_name);
}

// Every channel file of a folder, in the order of their names.
static cp_status read_folder(reading *self, const char *folder, const char *stem, cp_error *error)
{
    struct dirent **list = NULL;
    int count = scandir(folder, &list, NULL, compare_names);
    if (count < 0)
        return cp_fail(error, CP_BAD_INPUT, "%s: cannot be read: %s", folder, strerror(errno));
    cp_status status = CP_OK;
    for (int k = 0; k < count; k++) {
        char path[PATH_MAX];
        if (status == CP_OK && is_channel_name(list[k]->d_name, stem) &&
            snprintf(path, sizeof path, "%s/%s", folder, list[k]->d_name) < (int)sizeof path)
            status = read_channel(self, path, error);
        free(list[k]);
    }
    free(list);
    return status;
}

// The .mme file of a folder, the only one.
static cp_status find_test(const char *folder, char path[PATH_MAX], cp_error *error)
{
    DIR *directory = opendir(folder);
    size_t found = 0;
    if (directory == NULL)
        return cp_fail(error, CP_BAD_INPUT, "%s: cannot be read: %s", folder, strerror(errno));
    for (struct dirent *entry = readdir(directory); entry != NULL; entry = readdir(directory)) {
        size_t length = strlen(entry->d_name);
        if (length < 5 || strcasecmp(entry->d_name + length - 4, ".mme") != 0)
            continue;
        found += snprintf(path, PATH_MAX, "%s/%s", folder, entry->d_name) < PATH_MAX;
    }
    closedir(directory);
    return found == 1 ? CP_OK
                      : cp_fail(error, CP_BAD_INPUT, "%s: holds %zu .mme files, one is needed",
                                folder, found);
}

static cp_status read_all(reading *self, const char *test_path, cp_error *error)
{
    char folder[PATH_MAX], stem[256], channels[PATH_MAX + 16];
    struct stat entry;
    const char *slash = strrchr(test_path, '/'), *name = slash != NULL ? slash + 1 : test_path;
    snprintf(folder, sizeof folder, "%.*s", slash != NULL ? (int)(slash - test_path) : 1,
             slash != NULL ? test_path : ".");
    snprintf(stem, sizeof stem, "%.*s", (int)strcspn(name, "."), name);
    cp_status status = read_test(self, test_path, error);
    for (int k = 0; status == CP_OK && k < 3; k++) {
        static const char *const BELOW[] = {"/Channel", "/CHANNEL", "/channel"};
        snprintf(channels, sizeof channels, "%s%s", folder, BELOW[k]);
        if (stat(channels, &entry) == 0 && S_ISDIR(entry.st_mode))
            return read_folder(self, channels, stem, error);
    }
    return status == CP_OK ? read_folder(self, folder, stem, error) : status;
}

// ---- the pulse -----------------------------------------------------------------------------

static cp_status take_samples(reading *self, const channel_file *leading, cp_error *error)
{
    double before = -leading->first_s / leading->interval_s;
    size_t zero = before > 0.5 ? (size_t)(before + 0.5) : 0;
    if (fabs(before - (double)zero) > 0.01 || zero + 2 > leading->count)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s: must have a sample at time 0 and one behind it, found %zu samples of "
                       "%g s from %g s on",
                       leading->path, leading->count, leading->interval_s, leading->first_s);
    cp_pulse *pulse = &self->record->pulse;
    cp_status status = cp_pulse_create(pulse, leading->count - zero, leading->interval_s, error);
    for (int c = 0; status == CP_OK && c < CP_CHANNEL_COUNT; c++) {
        const channel_file *own = &self->chosen[c];
        if (own->value == NULL)
            continue;
        if (own->count != leading->count || own->interval_s != leading->interval_s ||
            own->first_s != leading->first_s)
            return cp_fail(error, CP_BAD_INPUT, "%s: is sampled otherwise than %s", own->path,
                           leading->path);
        double factor = si_of_unit(own->unit) * CP_ISO_MME_CODE[c].sign;
        if (self->request->is_reversed && c == CP_CHANNEL_AX)
            factor = -factor;
        for (size_t k = 0; k < pulse->sample_count; k++)
            pulse->channel[c][k] = factor * own->value[zero + k];
        self->record->known[c] = true;
    }
    return status;
}

// The velocity channel and the test's own speed are of the same motion, or one of them is changes.
static cp_status check_velocity(const reading *self, cp_error *error)
{
    double first_m_s = self->record->pulse.channel[CP_CHANNEL_VX][0];
    if (!self->record->known[CP_CHANNEL_VX] || isnan(self->velocity_m_s) ||
        fabs(fabs(first_m_s) - self->velocity_m_s) <= fmax(1.0, 0.1 * self->velocity_m_s))
        return CP_OK;
    return cp_fail(error, CP_BAD_INPUT,
                   "%s: the velocity begins with %g m/s, the test tells %g m/s",
                   self->record->source, first_m_s, self->velocity_m_s);
}

static cp_status take_pulse(reading *self, cp_error *error)
{
    const channel_file *leading = NULL;
    for (int c = 0; c < CP_CHANNEL_COUNT && leading == NULL; c++)
        if (self->chosen[c].value != NULL)
            leading = &self->chosen[c];
    if (leading == NULL)
        return cp_fail(error, CP_BAD_INPUT, "%s: none of its %zu channels is %s; found %s",
                       self->request->path, self->channel_count,
                       self->request->code != NULL ? "the one named"
                                                   : "of the car as a whole (?0VEHC......ACX?)",
                       self->others[0] != '\0' ? self->others : "none");
    cp_status status = take_samples(self, leading, error);
    if (status == CP_OK)
        status = check_velocity(self, error);
    cp_pulse_request own = *self->request;
    if (isnan(own.speed_m_s))
        own.speed_m_s = self->velocity_m_s;
    return status == CP_OK ? cp_pulse_record_complete(self->record, &own, error) : status;
}

// '1' for "1", "a" or nothing.
static char object_of(const char *vehicle)
{
    if (vehicle == NULL || strcmp(vehicle, "a") == 0)
        return '1';
    return strcmp(vehicle, "b") == 0 ? '2' : vehicle[0];
}

cp_status cp_iso_mme_read(const cp_pulse_request *request, cp_pulse_record *record, cp_error *error)
{
    char path[PATH_MAX];
    struct stat entry;
    const char *slash = strrchr(request->path, '/');
    *record = (cp_pulse_record){.separation_s = NAN, .mass_kg = NAN};
    reading *self = calloc(1, sizeof *self);
    if (self == NULL)
        return cp_fail_memory(error, request->path);
    *self = (reading){.request = request,
                      .record = record,
                      .object = object_of(request->vehicle),
                      .velocity_m_s = NAN};
    snprintf(record->source, sizeof record->source, "%s",
             slash != NULL ? slash + 1 : request->path);
    snprintf(record->vehicle, sizeof record->vehicle, "%c", self->object);
    snprintf(path, sizeof path, "%s", request->path);
    bool is_folder = stat(path, &entry) == 0 && S_ISDIR(entry.st_mode);
    cp_status status = is_folder ? find_test(request->path, path, error) : CP_OK;
    size_t length = strlen(path);
    if (status == CP_OK && length > 4 && strcasecmp(path + length - 4, ".mme") == 0)
        status = read_all(self, path, error);
    else if (status == CP_OK)
        status = read_channel(self, path, error);
    if (status == CP_OK)
        status = take_pulse(self, error);
    for (int c = 0; c < CP_CHANNEL_COUNT; c++)
        free(self->chosen[c].value);
    free(self);
    if (status != CP_OK)
        cp_pulse_record_destroy(record);
    return status;
}
