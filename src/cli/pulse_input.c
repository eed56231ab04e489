/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/pulse_input.h"

#include "core/units.h"
#include "exchange/crash_selection.h"
#include "exchange/lsdyna.h"
#include "exchange/pulse_file.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    VEHICLE = 1024,
    CRASH,
    TREATMENT,
    CHANNELS,
    CODE,
    SPEED,
    REVERSED,
    FROM_BEHIND,
    UNITS,
    ACCELERATION
};

static const struct argp_option OPTIONS[] = {
    {"crash", CRASH, "ID", 0, "of a database or an exported table: crash.id", 2},
    {"treatment", TREATMENT, "VARIANT", 0, "what the crash became under this variant", 2},
    {"vehicle", VEHICLE, "WHICH", 0,
     "a or b of a crash, 1 or 2 of a crash test (default: the first)", 2},
    {"channels", CHANNELS, "N,N...", 0,
     "EV5: longitudinal accelerometers whose mean is taken (default: the primary ones on the car's "
     "structure); LS-DYNA: id of the curve",
     2},
    {"code", CODE, "CODE", 0, "ISO-MME: channel code of the longitudinal acceleration", 2},
    {"speed", SPEED, "KMH", 0, "speed at first contact (default: as the file tells)", 2},
    {"reversed", REVERSED, NULL, 0, "the accelerometers sit the other way round", 2},
    {"struck-from-behind", FROM_BEHIND, NULL, 0, "the car may get faster", 2},
    {"units", UNITS, "SYSTEM", 0, "LS-DYNA: system of units, one of " CP_UNIT_SYSTEMS_TEXT, 2},
    {"acceleration", ACCELERATION, NULL, 0,
     "LS-DYNA: the curve of another program is an acceleration, not a velocity", 2},
    {0},
};

// Numbers between commas.
static void read_channels(const char *text, cp_pulse_request *request, struct argp_state *state)
{
    char copy[256];
    if (strlen(text) >= sizeof copy)
        argp_error(state, "--channels is too long");
    snprintf(copy, sizeof copy, "%s", text);
    for (char *rest = copy; rest != NULL;) {
        char *number = rest;
        rest = strchr(rest, ',');
        if (rest != NULL)
            *rest++ = '\0';
        if (request->curve_count == CP_PULSE_CURVES_MAX)
            argp_error(state, "--channels takes at most %d numbers", CP_PULSE_CURVES_MAX);
        request->curve[request->curve_count++] =
            (int)cp_args_integer(state, "--channels", number, 1, 1000000000);
    }
}

static error_t parse(int key, char *argument, struct argp_state *state)
{
    cp_pulse_input *input = state->input;
    cp_pulse_request *request = &input->request;
    switch (key) {
    case VEHICLE:
        request->vehicle = argument;
        return 0;
    case CRASH:
        input->crash_id = cp_args_integer(state, "--crash", argument, 0, LONG_MAX);
        snprintf(input->crash_text, sizeof input->crash_text, "%lld", (long long)input->crash_id);
        return 0;
    case TREATMENT:
        request->treatment = argument;
        return 0;
    case CHANNELS:
        read_channels(argument, request, state);
        return 0;
    case CODE:
        request->code = argument;
        return 0;
    case SPEED:
        request->speed_m_s =
            cp_m_s_from_km_h(cp_args_number(state, "--speed", argument, 0.0, 400.0, "km/h"));
        return 0;
    case REVERSED:
        request->is_reversed = true;
        return 0;
    case FROM_BEHIND:
        request->may_gain = true;
        return 0;
    case UNITS:
        if (cp_unit_system_find(argument) == NULL)
            argp_error(state, "--units must be one of %s, found '%s'", CP_UNIT_SYSTEMS_TEXT,
                       argument);
        request->units = argument;
        return 0;
    case ACCELERATION:
        request->is_acceleration = true;
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

const struct argp CP_PULSE_INPUT_ARGS = {.options = OPTIONS, .parser = parse};

cp_pulse_input cp_pulse_input_default(void)
{
    return (cp_pulse_input){.request = cp_pulse_request_default(NULL), .crash_id = -1};
}

// ---- a stored one --------------------------------------------------------------------------

typedef struct taking {
    int vehicle;
    cp_pulse_record *record;
} taking;

// Take the record over from the selection.
static cp_status take_stored(void *context, const cp_selected_crash *crash, cp_error *error)
{
    taking *self = context;
    const cp_selected_vehicle *vehicle = &crash->vehicle[self->vehicle];
    if (!vehicle->has_pulse)
        return cp_fail(error, CP_BAD_INPUT, "crash %lld: no pulse is stored of it",
                       (long long)crash->id);
    const cp_pulse *stored = &vehicle->record.pulse;
    *self->record = vehicle->record;
    cp_status status = cp_pulse_create(&self->record->pulse, stored->sample_count,
                                       stored->sample_interval_s, error);
    for (int c = 0; status == CP_OK && c < CP_CHANNEL_COUNT; c++)
        memcpy(self->record->pulse.channel[c], stored->channel[c],
               stored->sample_count * sizeof *stored->channel[c]);
    return status;
}

static cp_status read_stored(const cp_pulse_input *input, cp_pulse_record *record, cp_error *error)
{
    const cp_pulse_request *request = &input->request;
    const char *wanted = request->vehicle != NULL ? request->vehicle : "a";
    taking self = {.vehicle = strcmp(wanted, "b") == 0, .record = record};
    cp_crash_selection selection = {
        .crash_id = input->crash_id, .treatment = request->treatment, .with_pulses = true};
    cp_store *store = NULL;
    size_t count = 0;
    if (strcmp(wanted, "a") != 0 && strcmp(wanted, "b") != 0)
        return cp_fail(error, CP_BAD_INPUT,
                       "--vehicle must be a or b of a stored crash, found '%s'", wanted);
    if (input->crash_id < 0)
        return cp_fail(error, CP_BAD_INPUT, "%s: is a database: which crash of it? (--crash ID)",
                       request->path);
    cp_status status = cp_store_open(request->path, CP_STORE_READ, &store, error);
    if (status == CP_OK)
        status = cp_crash_selection_count(store, &selection, &count, error);
    if (status == CP_OK && count == 0)
        status = cp_fail(error, CP_BAD_INPUT, "%s: has no such crash", request->path);
    if (status == CP_OK)
        status = cp_crash_selection_visit(store, &selection, take_stored, &self, error);
    cp_store_close(store);
    return status;
}

cp_status cp_pulse_input_read(const cp_pulse_input *input, cp_pulse_record *record, cp_error *error)
{
    cp_pulse_request request = input->request;
    *record = (cp_pulse_record){0};
    if (cp_pulse_file_is_database(request.path))
        return read_stored(input, record, error);
    request.crash_id = input->crash_id >= 0 ? input->crash_text : NULL;
    return cp_pulse_file_read(&request, record, error);
}
