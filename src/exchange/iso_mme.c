/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/iso_mme.h"

#include "core/file_stream.h"
#include "core/safe_text.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <string.h>
#include <sys/stat.h>

const cp_iso_mme_code CP_ISO_MME_CODE[CP_CHANNEL_COUNT] = {
    [CP_CHANNEL_AX] = {"AC", 'X', "m/s2", 1.0},
    [CP_CHANNEL_AY] = {"AC", 'Y', "m/s2", -1.0},
    [CP_CHANNEL_VX] = {"VE", 'X', "m/s", 1.0},
    [CP_CHANNEL_VY] = {"VE", 'Y', "m/s", -1.0},
    [CP_CHANNEL_X] = {"DS", 'X', "m", 1.0},
    [CP_CHANNEL_Y] = {"DS", 'Y', "m", -1.0},
    [CP_CHANNEL_YAW] = {"AN", 'Z', "rad", -1.0},
    [CP_CHANNEL_YAW_RATE] = {"AV", 'Z', "rad/s", -1.0},
    [CP_CHANNEL_YAW_ACC] = {"AA", 'Z', "rad/s2", -1.0}};

const char *const CP_ISO_MME_SIDE[4][2] = {
    {"front", "FR"}, {"left", "LE"}, {"right", "RI"}, {"rear", "RE"}};

static const char *const WORD[CP_CHANNEL_COUNT] = {
    "acceleration x", "acceleration y", "velocity x", "velocity y",      "displacement x",
    "displacement y", "yaw angle",      "yaw rate",   "yaw acceleration"};

enum { FILTER_60_CHANNELS = 3, CHANNELS_MAX = 2 * (CP_CHANNEL_COUNT + FILTER_60_CHANNELS) };

// One channel file to be.
typedef struct channel {
    size_t object; // from 0
    cp_pulse_channel channel;
    char filter;
    const double *value;
} channel;

static void line(FILE *file, const char *name, const char *value)
{
    fprintf(file, "%-28s:", name);
    cp_text_print(file, value, "");
    fputc('\n', file);
}

static void number_line(FILE *file, const char *name, double value)
{
    char text[32];
    snprintf(text, sizeof text, "%.9g", value);
    line(file, name, isfinite(value) ? text : "NOVALUE");
}

// A name with the number of a test object in it.
static const char *of_object(const char *format, size_t object, char name[64])
{
    snprintf(name, 64, "%s %zu", format, object + 1);
    return name;
}

static const char *frequency_class(char filter)
{
    return filter == 'A'   ? "1000"
           : filter == 'B' ? "600"
           : filter == 'C' ? "180"
           : filter == 'D' ? "60"
                           : "NOVALUE";
}

// ISO's letters for a side.
static const char *impact_side(const char *side)
{
    for (size_t k = 0; k < sizeof CP_ISO_MME_SIDE / sizeof *CP_ISO_MME_SIDE; k++)
        if (strcmp(side, CP_ISO_MME_SIDE[k][0]) == 0)
            return CP_ISO_MME_SIDE[k][1];
    return "NOVALUE";
}

static void code_of(const channel *own, char code[17])
{
    const cp_iso_mme_code *letters = &CP_ISO_MME_CODE[own->channel];
    snprintf(code, 17, "%zu0VEHCCG0000%s%c%c", own->object + 1, letters->dimension,
             letters->direction, own->filter);
}

static void write_test(FILE *file, const cp_iso_mme_test *test)
{
    char name[64], count[8];
    snprintf(count, sizeof count, "%zu", test->object_count);
    line(file, "Data format edition number", "1.6");
    line(file, "Laboratory name", test->laboratory);
    line(file, "Customer name", "NOVALUE");
    line(file, "Customer test ref. number", test->name);
    line(file, "Title", test->title);
    line(file, "Timestamp", "NOVALUE");
    line(file, "Type of the test", test->object_count > 1 ? "Car to car" : "NOVALUE");
    line(file, "Date of the test", "NOVALUE");
    line(file, "Number of test objects", count);
    for (size_t k = 0; k < test->object_count; k++) {
        const cp_iso_mme_object *own = &test->object[k];
        line(file, of_object("Name of test object", k, name), own->name);
        number_line(file, of_object("Velocity test object", k, name),
                    own->record->pulse.channel[CP_CHANNEL_VX][0]);
        number_line(file, of_object("Mass test object", k, name), own->record->mass_kg);
        line(file, of_object("Driver position object", k, name), "NOVALUE");
        line(file, of_object("Impact side test object", k, name), impact_side(own->record->side));
        // Names with a point in front are a laboratory's own.
        number_line(file, of_object(".Separation test object", k, name), own->record->separation_s);
    }
}

static void write_list(FILE *file, const channel *list, size_t count)
{
    char text[128], name[64], code[17];
    line(file, "Instrumentation standard", "SAE J211");
    snprintf(text, sizeof text, "%zu", count);
    line(file, "Number of channels", text);
    for (size_t k = 0; k < count; k++) {
        code_of(&list[k], code);
        snprintf(name, sizeof name, "Name of channel %03zu", k + 1);
        snprintf(text, sizeof text, "%s / %s, vehicle %zu", code, WORD[list[k].channel],
                 list[k].object + 1);
        line(file, name, text);
    }
}

static void write_channel(FILE *file, const channel *own, const cp_pulse *pulse)
{
    const cp_iso_mme_code *letters = &CP_ISO_MME_CODE[own->channel];
    char code[17], text[64];
    code_of(own, code);
    line(file, "Test object number", (char[2]){(char)('1' + own->object), '\0'});
    line(file, "Name of the channel", WORD[own->channel]);
    line(file, "Laboratory channel code", "NOVALUE");
    line(file, "Customer channel code", "NOVALUE");
    line(file, "Channel code", code);
    line(file, "Location", "centre of gravity");
    line(file, "Dimension", letters->dimension);
    line(file, "Direction", (char[2]){letters->direction, '\0'});
    line(file, "Channel frequency class", frequency_class(own->filter));
    line(file, "Unit", letters->unit);
    line(file, "Reference system", "SAE J211");
    line(file, "Data source", "calculation");
    line(file, "Data status", "ok");
    line(file, "Reference channel", "implicit");
    line(file, "Reference channel name", "NOVALUE");
    number_line(file, "Sampling interval", pulse->sample_interval_s);
    number_line(file, "Time of first sample", 0.0);
    snprintf(text, sizeof text, "%zu", pulse->sample_count);
    line(file, "Number of samples", text);
    // -0 is 0 to every reader.
    for (size_t k = 0; k < pulse->sample_count; k++)
        fprintf(file, "%.9E\n", own->value[k] == 0.0 ? 0.0 : letters->sign * own->value[k]);
}

// What is written to one of the files.
typedef struct part {
    const cp_iso_mme_test *test;
    const channel *list;
    size_t count;
    size_t number; // of a channel file, from 1
} part;

static cp_status write_file(const char *path, const part *own, char kind, cp_error *error)
{
    cp_file_stream stream;
    cp_status status = cp_file_stream_begin(path, &stream, error);
    if (status != CP_OK)
        return status;
    if (kind == 't')
        write_test(stream.file, own->test);
    else if (kind == 'l')
        write_list(stream.file, own->list, own->count);
    else
        write_channel(stream.file, &own->list[own->number - 1],
                      &own->test->object[own->list[own->number - 1].object].record->pulse);
    return cp_file_stream_commit(&stream, error);
}

static cp_status make_folder(const char *path, cp_error *error)
{
    if (mkdir(path, 0777) == 0)
        return CP_OK;
    return cp_fail(error, CP_IO_FAILED, "%s: cannot be created: %s", path, strerror(errno));
}

static cp_status write_all(const char *folder, const part *all, cp_error *error)
{
    char path[PATH_MAX + 64];
    const char *name = all->test->name;
    if (strlen(folder) + 3 * strlen(name) + 32 > PATH_MAX)
        return cp_fail(error, CP_BAD_INPUT, "%.200s...: the path is too long", folder);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    cp_status status = make_folder(path, error);
    snprintf(path, sizeof path, "%s/%s/%s.mme", folder, name, name);
    if (status == CP_OK)
        status = write_file(path, all, 't', error);
    snprintf(path, sizeof path, "%s/%s/Channel", folder, name);
    if (status == CP_OK)
        status = make_folder(path, error);
    snprintf(path, sizeof path, "%s/%s/Channel/%s.chn", folder, name, name);
    if (status == CP_OK)
        status = write_file(path, all, 'l', error);
    for (size_t k = 0; status == CP_OK && k < all->count; k++) {
        part one = *all;
        one.number = k + 1;
        snprintf(path, sizeof path, "%s/%s/Channel/%s.%03zu", folder, name, name, k + 1);
        status = write_file(path, &one, 'c', error);
    }
    return status;
}

// The known channels of an object as they are, then the accelerations through CFC60.
static void list_channels(const cp_iso_mme_test *test, size_t object, const cp_pulse *filtered,
                          channel *list, size_t *count)
{
    static const cp_pulse_channel FILTERED[FILTER_60_CHANNELS] = {CP_CHANNEL_AX, CP_CHANNEL_AY,
                                                                  CP_CHANNEL_YAW_ACC};
    const cp_iso_mme_object *own = &test->object[object];
    for (int c = 0; c < CP_CHANNEL_COUNT; c++) {
        bool is_acceleration = c == CP_CHANNEL_AX || c == CP_CHANNEL_AY || c == CP_CHANNEL_YAW_ACC;
        char filter = '0';
        if (is_acceleration)
            filter = own->filter;
        if (own->record->known[c])
            list[(*count)++] =
                (channel){object, (cp_pulse_channel)c, filter, own->record->pulse.channel[c]};
    }
    for (int k = 0; filtered->sample_count > 0 && k < FILTER_60_CHANNELS; k++)
        if (own->record->known[FILTERED[k]])
            list[(*count)++] = (channel){object, FILTERED[k], 'D', filtered->channel[FILTERED[k]]};
}

static bool is_plain_name(const char *name)
{
    for (const char *c = name; *c != '\0'; c++)
        if (!isalnum((unsigned char)*c) && *c != '_' && *c != '-')
            return false;
    return *name != '\0' && strlen(name) <= 64;
}

cp_status cp_iso_mme_write(const char *folder, const cp_iso_mme_test *test, cp_error *error)
{
    // Corner of the filter below a quarter of the sampling rate, and not filtered twice by it.
    static const double CFC60_INTERVAL_MAX_S = 0.25 / (60.0 * 2.0775);
    cp_pulse filtered[2] = {0};
    channel list[CHANNELS_MAX];
    part all = {.test = test, .list = list};
    cp_status status = CP_OK;
    if (!is_plain_name(test->name))
        return cp_fail(error, CP_BAD_INPUT,
                       "the name of a test must be letters, digits, _ and -, found '%s'",
                       test->name);
    for (size_t k = 0; status == CP_OK && k < test->object_count; k++) {
        const cp_pulse *pulse = &test->object[k].record->pulse;
        if (pulse->sample_interval_s < CFC60_INTERVAL_MAX_S && test->object[k].filter != 'D')
            status = cp_pulse_filtered(pulse, 60.0, &filtered[k], error);
        if (status == CP_OK)
            list_channels(test, k, &filtered[k], list, &all.count);
    }
    if (status == CP_OK)
        status = write_all(folder, &all, error);
    cp_pulse_destroy(&filtered[0]);
    cp_pulse_destroy(&filtered[1]);
    return status;
}
