/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/ev5_pulse.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Attachments on the structure, by the first letters of their codes: centre of gravity, floor pan,
// sills, pillars, rear deck, tunnel, frame, firewall, cross-members.
static const char *const STRUCTURE[] = {"VECG", "FLL", "FLR", "FLC", "SLL", "SLR", "SIL",
                                        "APL",  "APR", "BPL", "BPR", "CPL", "CPR", "RDK",
                                        "TUN",  "TNL", "FRM", "FIR", "XMB", "TRN"};
// What moves against it, and what sits on a dummy.
static const char *const MOVING[] = {"ENG", "BRC", "BRK", "WHL", "DOR", "STC", "STW", "IPL",
                                     "IPN", "DPL", "DSH", "SEA", "RAD", "HOD", "BMP"};
static const char *const STRUCTURE_WORD[] = {
    "CG",     "C.G.",   "CENTER OF GRAVITY", "FLOOR", "SILL",  "CROSSMEMBER", "CROSS MEMBER",
    "PILLAR", "TUNNEL", "REAR DECK",         "TRUNK", "FRAME", "ROCKER"};
static const char *const MOVING_WORD[] = {"ENGINE",   "BRAKE",   "CALIPER",    "WHEEL", "STEERING",
                                          "BUMPER",   "HOOD",    "HEAD",       "CHEST", "PELVIS",
                                          "RADIATOR", "BARRIER", "INSTRUMENT", "DASH",  "DOOR"};
#define COUNT(list) (sizeof(list) / sizeof *(list))

static bool begins_with_one(const char *code, const char *const list[], size_t count)
{
    for (size_t k = 0; k < count; k++)
        if (strncmp(code, list[k], strlen(list[k])) == 0)
            return true;
    return false;
}

// Whether a comment holds one of the words, as words of their own.
static bool has_one_word(const char *comment, const char *const list[], size_t count)
{
    char text[128];
    size_t length = strlen(comment) < sizeof text - 1 ? strlen(comment) : sizeof text - 1;
    for (size_t k = 0; k < length; k++)
        text[k] = (char)toupper((unsigned char)comment[k]);
    text[length] = '\0';
    for (size_t k = 0; k < count; k++)
        for (const char *at = strstr(text, list[k]); at != NULL; at = strstr(at + 1, list[k])) {
            bool begins = at == text || !isalpha((unsigned char)at[-1]);
            bool ends = !isalpha((unsigned char)at[strlen(list[k])]);
            if (begins && ends)
                return true;
        }
    return false;
}

static bool is_longitudinal(const cp_ev5_instrument *own)
{
    return strcmp(own->sensor, "AC") == 0 && own->axis[0] == 'X';
}

static bool is_occupants(const cp_ev5_instrument *own)
{
    return own->position[0] != '\0' && strcmp(own->position, "NA") != 0 &&
           strcmp(own->position, "00") != 0;
}

static bool is_on_structure(const cp_ev5_instrument *own)
{
    if (is_occupants(own) || begins_with_one(own->attachment, MOVING, COUNT(MOVING)) ||
        has_one_word(own->comment, MOVING_WORD, COUNT(MOVING_WORD)))
        return false;
    return begins_with_one(own->attachment, STRUCTURE, COUNT(STRUCTURE)) ||
           has_one_word(own->comment, STRUCTURE_WORD, COUNT(STRUCTURE_WORD));
}

static cp_status check_sensor(const cp_ev5_test *test, int curve, cp_error *error)
{
    const cp_ev5_instrument *own = cp_ev5_find(test, curve);
    if (own == NULL)
        return cp_fail(error, CP_BAD_INPUT, "%s: has no curve number %d", test->path, curve);
    if (!is_longitudinal(own))
        return cp_fail(error, CP_BAD_INPUT,
                       "%s:%zu: curve %d is no longitudinal accelerometer (sensor AC, axis X): "
                       "sensor %s, axis %s (%s)",
                       test->path, own->line, curve, own->sensor, own->axis, own->comment);
    if (strcmp(own->status, "AM") != 0)
        return cp_fail(
            error, CP_BAD_INPUT,
            "%s:%zu: the data status of curve %d must be AM (as measured), found %s (%s)",
            test->path, own->line, curve, own->status, own->comment);
    if (!is_on_structure(own))
        return cp_fail(error, CP_BAD_INPUT,
                       "%s:%zu: curve %d must sit on the structure of the car (centre of gravity, "
                       "floor pan, sill, pillar, cross-member), found attachment %s%s%s (%s)",
                       test->path, own->line, curve, own->attachment,
                       is_occupants(own) ? " of the occupant on seat " : "",
                       is_occupants(own) ? own->position : "", own->comment);
    return CP_OK;
}

cp_status cp_ev5_find_structure(const cp_ev5_test *test, int vehicle,
                                int curve[CP_PULSE_CURVES_MAX], size_t *count, cp_error *error)
{
    *count = 0;
    for (size_t k = 0; k < test->instrument_count && *count < CP_PULSE_CURVES_MAX; k++) {
        const cp_ev5_instrument *own = &test->instrument[k];
        bool suits = is_longitudinal(own) && is_on_structure(own) &&
                     strcmp(own->status, "AM") == 0 && strcmp(own->rank, "R") != 0;
        if (!suits || own->vehicle == 0 || (vehicle > 0 && own->vehicle != vehicle))
            continue;
        vehicle = own->vehicle;
        curve[(*count)++] = own->curve;
    }
    if (*count > 0)
        return CP_OK;
    return cp_fail(error, CP_BAD_INPUT,
                   "%s: has no longitudinal accelerometer on the structure of %s that was measured "
                   "well (sensor AC, axis X, status AM)",
                   test->path, vehicle > 0 ? "that vehicle" : "a vehicle");
}

// One more curve into the mean, which takes over the first one's room.
static cp_status add_curve(const cp_ev5_test *test, const int curve[], size_t count, size_t k,
                           cp_ev5_channel *mean, cp_error *error)
{
    double share = 1.0 / (double)count;
    cp_ev5_channel channel = {0};
    cp_status status = check_sensor(test, curve[k], error);
    int first = cp_ev5_find(test, curve[0])->vehicle;
    if (status == CP_OK && cp_ev5_find(test, curve[k])->vehicle != first)
        status =
            cp_fail(error, CP_BAD_INPUT,
                    "%s: curves %d and %d must sit on one vehicle, found vehicles %d and %d",
                    test->path, curve[0], curve[k], first, cp_ev5_find(test, curve[k])->vehicle);
    if (status == CP_OK)
        status = cp_ev5_channel_load(test, curve[k], &channel, error);
    if (status != CP_OK)
        return status;
    if (k == 0) {
        *mean = channel;
        for (size_t i = 0; i < mean->sample_count; i++)
            mean->value[i] *= share;
        return CP_OK;
    }
    bool alike = channel.first_sample == mean->first_sample &&
                 channel.sample_count == mean->sample_count &&
                 fabs(channel.interval_s - mean->interval_s) < 1e-12;
    for (size_t i = 0; alike && i < mean->sample_count; i++)
        mean->value[i] += share * channel.value[i];
    cp_ev5_channel_destroy(&channel);
    return alike ? CP_OK
                 : cp_fail(error, CP_BAD_INPUT, "%s: curves %d and %d are sampled differently",
                           test->path, curve[0], curve[k]);
}

cp_status cp_ev5_mean_of_structure(const cp_ev5_test *test, const int curve[], size_t count,
                                   cp_ev5_channel *mean, cp_error *error)
{
    *mean = (cp_ev5_channel){0};
    cp_status status = check_sensor(test, curve[0], error);
    for (size_t k = 0; status == CP_OK && k < count; k++)
        status = add_curve(test, curve, count, k, mean, error);
    if (status == CP_OK &&
        (mean->first_sample > 0 || mean->first_sample + (long)mean->sample_count < 2))
        status = cp_fail(error, CP_BAD_INPUT, "%s: curve %d does not begin at or before time 0",
                         test->path, curve[0]);
    if (status != CP_OK)
        cp_ev5_channel_destroy(mean);
    return status;
}

double cp_ev5_speed_m_s(const cp_ev5_test *test, int curve)
{
    const cp_ev5_instrument *instrument = cp_ev5_find(test, curve);
    const cp_ev5_vehicle *own = NULL, *other = NULL;
    for (size_t k = 0; instrument != NULL && k < test->vehicle_count; k++)
        if (test->vehicle[k].number == instrument->vehicle)
            own = &test->vehicle[k];
        else
            other = &test->vehicle[k];
    if (own == NULL || (own->speed_m_s == 0.0 && other == NULL))
        return test->closing_speed_m_s > 0.0 ? test->closing_speed_m_s : NAN;
    // A vehicle that stood is struck at the speed of the other.
    bool stood = other != NULL && other->speed_m_s > 0.0 &&
                 fabs(test->closing_speed_m_s - other->speed_m_s) < 0.01 * other->speed_m_s;
    return own->speed_m_s > 0.0 || stood ? own->speed_m_s : NAN;
}

cp_status cp_ev5_velocity(const cp_ev5_test *test, const int curve[], size_t count,
                          const cp_ev5_channel *mean, double speed_m_s, bool may_gain,
                          double *vx_m_s, cp_error *error)
{
    // As a record of that one channel.
    size_t zero = (size_t)-mean->first_sample, samples = mean->sample_count - zero;
    cp_pulse_request request = {.speed_m_s = speed_m_s, .may_gain = may_gain};
    cp_pulse_record record = {.separation_s = NAN, .known = {[CP_CHANNEL_AX] = true}};
    cp_ev5_describe(test, curve, count, record.source, sizeof record.source);
    cp_status status = cp_pulse_create(&record.pulse, samples, mean->interval_s, error);
    if (status == CP_OK) {
        memcpy(record.pulse.channel[CP_CHANNEL_AX], mean->value + zero, samples * sizeof *vx_m_s);
        status = cp_pulse_record_complete(&record, &request, error);
    }
    if (status == CP_OK)
        memcpy(vx_m_s, record.pulse.channel[CP_CHANNEL_VX], samples * sizeof *vx_m_s);
    cp_pulse_record_destroy(&record);
    return status;
}

void cp_ev5_describe(const cp_ev5_test *test, const int curve[], size_t count, char *text,
                     size_t size)
{
    int used = snprintf(text, size, "%s.EV5, channel%s", test->name, count > 1 ? "s" : "");
    for (size_t k = 0; k < count && used > 0 && (size_t)used < size; k++)
        used += snprintf(text + used, size - (size_t)used, "%s%d",
                         k == 0           ? " "
                         : k + 1 == count ? " and "
                                          : ", ",
                         curve[k]);
}

static double mass_kg(const cp_ev5_test *test, int vehicle)
{
    for (size_t k = 0; k < test->vehicle_count; k++)
        if (test->vehicle[k].number == vehicle)
            return test->vehicle[k].mass_kg;
    return NAN;
}

static cp_status read_mean(const cp_pulse_request *request, const cp_ev5_test *test,
                           const int curve[], size_t count, cp_pulse_record *record,
                           cp_error *error)
{
    cp_ev5_channel mean;
    cp_status status = cp_ev5_mean_of_structure(test, curve, count, &mean, error);
    if (status != CP_OK)
        return status;
    size_t zero = (size_t)-mean.first_sample;
    int vehicle = cp_ev5_find(test, curve[0])->vehicle;
    record->mass_kg = mass_kg(test, vehicle);
    record->known[CP_CHANNEL_AX] = true;
    record->against_car = test->vehicle_count > 1;
    snprintf(record->vehicle, sizeof record->vehicle, "%d", vehicle);
    cp_ev5_describe(test, curve, count, record->source, sizeof record->source);
    status = cp_pulse_create(&record->pulse, mean.sample_count - zero, mean.interval_s, error);
    for (size_t k = 0; status == CP_OK && k < record->pulse.sample_count; k++)
        record->pulse.channel[CP_CHANNEL_AX][k] =
            request->is_reversed ? -mean.value[zero + k] : mean.value[zero + k];
    cp_ev5_channel_destroy(&mean);
    cp_pulse_request own = *request;
    if (isnan(own.speed_m_s))
        own.speed_m_s = cp_ev5_speed_m_s(test, curve[0]);
    return status == CP_OK ? cp_pulse_record_complete(record, &own, error) : status;
}

cp_status cp_ev5_pulse_read(const cp_pulse_request *request, cp_pulse_record *record,
                            cp_error *error)
{
    cp_ev5_test test;
    int curve[CP_PULSE_CURVES_MAX];
    size_t count = request->curve_count;
    *record = (cp_pulse_record){.separation_s = NAN, .mass_kg = NAN};
    cp_status status = cp_ev5_load(request->path, &test, error);
    if (status != CP_OK)
        return status;
    memcpy(curve, request->curve, sizeof curve);
    const char *told = request->vehicle;
    bool is_digit = told != NULL && told[0] >= '1' && told[0] <= '9' && told[1] == '\0';
    int vehicle = is_digit ? told[0] - '0' : 0;
    if (told != NULL && !is_digit)
        status = cp_fail(error, CP_BAD_INPUT, "%s: the vehicle must be a number, found '%s'",
                         request->path, request->vehicle);
    else if (count == 0)
        status = cp_ev5_find_structure(&test, vehicle, curve, &count, error);
    if (status == CP_OK)
        status = read_mean(request, &test, curve, count, record, error);
    cp_ev5_destroy(&test);
    if (status != CP_OK)
        cp_pulse_record_destroy(record);
    return status;
}
