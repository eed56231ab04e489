/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "api/crashpulse.h"

#include "core/error.h"
#include "crash/crash_simulation.h"
#include "crash/named_vehicle.h"
#include "crash/validity.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

struct crashpulse_vehicle {
    cp_vehicle_model model;
};

struct crashpulse_crash {
    cp_crash_result result;
    crashpulse_severity severity[2];
};

_Static_assert((int)CRASHPULSE_AX_M_S2 == (int)CP_CHANNEL_AX &&
                   (int)CRASHPULSE_VX_M_S == (int)CP_CHANNEL_VX &&
                   (int)CRASHPULSE_YAW_ACC_RAD_S2 == (int)CP_CHANNEL_YAW_ACC,
               "the channels of the interface are those of pulses");
_Static_assert(sizeof((crashpulse_severity *)NULL)->validity >= CP_VALIDITY_TEXT_SIZE,
               "every validity has room");

// The status and words of the program, as the interface has them.
static crashpulse_status told(cp_status status, const cp_error *inner, crashpulse_error *error)
{
    if (error != NULL)
        snprintf(error->text, sizeof error->text, "%.*s", (int)sizeof error->text - 1,
                 status == CP_OK ? "" : inner->text);
    return status == CP_OK          ? CRASHPULSE_OK
           : status == CP_BAD_INPUT ? CRASHPULSE_BAD_INPUT
                                    : CRASHPULSE_FAILED;
}

// ---- beginning and end ---------------------------------------------------------------------

crashpulse_status crashpulse_begin(crashpulse_error *error)
{
    cp_error inner = {0};
    return told(cp_crash_library_begin(&inner), &inner, error);
}

void crashpulse_end(void)
{
    cp_crash_library_end();
}

crashpulse_status crashpulse_thread_begin(crashpulse_error *error)
{
    cp_error inner = {0};
    return told(cp_crash_thread_begin(&inner), &inner, error);
}

void crashpulse_thread_end(void)
{
    cp_crash_thread_end();
}

// ---- vehicles ------------------------------------------------------------------------------

crashpulse_status crashpulse_vehicle_load(const char *name_or_file, crashpulse_vehicle **vehicle,
                                          crashpulse_error *error)
{
    cp_error inner = {0};
    *vehicle = calloc(1, sizeof **vehicle);
    cp_status status = *vehicle != NULL
                           ? cp_named_vehicle_load(NULL, name_or_file, &(*vehicle)->model, &inner)
                           : cp_fail_memory(&inner, name_or_file);
    if (status != CP_OK) {
        free(*vehicle);
        *vehicle = NULL;
    }
    return told(status, &inner, error);
}

void crashpulse_vehicle_free(crashpulse_vehicle *vehicle)
{
    free(vehicle);
}

const char *crashpulse_vehicle_name(const crashpulse_vehicle *vehicle)
{
    return vehicle->model.name;
}

double crashpulse_vehicle_mass_kg(const crashpulse_vehicle *vehicle)
{
    return vehicle->model.mass_kg;
}

// ---- a crash -------------------------------------------------------------------------------

crashpulse_meeting crashpulse_meeting_default(void)
{
    return (crashpulse_meeting){.duration_s = cp_crash_options_default().duration_s};
}

static cp_status check(const crashpulse_meeting *m, cp_error *error)
{
    const struct {
        const char *name;
        double value, smallest, largest;
    } field[] = {
        {"speed_m_s", m->speed_m_s, 0.0, 150.0},
        {"opponent_speed_m_s", m->opponent_speed_m_s, 0.0, 150.0},
        {"offset_m", m->offset_m, -10.0, 10.0},
        {"angle_rad", m->angle_rad, -3.1415926535897932, 3.1415926535897932},
        {"duration_s", m->duration_s, 0.01, 0.4},
    };
    for (size_t k = 0; k < sizeof field / sizeof *field; k++)
        if (!(field[k].value >= field[k].smallest && field[k].value <= field[k].largest))
            return cp_fail(error, CP_BAD_INPUT, "%s must be from %g to %g, found %g", field[k].name,
                           field[k].smallest, field[k].largest, field[k].value);
    return CP_OK;
}

static crashpulse_severity severity_of(const cp_crash_result *result, int car,
                                       const cp_crash_configuration *configuration,
                                       unsigned outside)
{
    const cp_severity *s = &result->severity[car];
    bool frontal = configuration->side[car] == CP_SIDE_FRONT;
    crashpulse_severity severity = {
        .olc_status = cp_olc_status_text(frontal ? s->olc.status : CP_OLC_NOT_FRONT_CONTACT),
        .olc_g = frontal ? s->olc.olc_g : NAN,
        .delta_v_m_s = s->delta_v_m_s,
        .delta_v_x_m_s = s->delta_v_x_m_s,
        .delta_v_y_m_s = s->delta_v_y_m_s,
        .peak_g = s->peak_g,
        .max_50ms_g = s->max_50ms_g,
        .asi_1 = s->asi_1,
        .pdof_rad = s->pdof_rad,
        .ees_m_s = result->whole[car].ees_m_s,
        .crush_m = result->crush_m[car],
    };
    cp_validity_text(outside, severity.validity);
    return severity;
}

static cp_status simulate(const cp_vehicle_model *a, const cp_vehicle_model *b,
                          const crashpulse_meeting *meeting, crashpulse_crash *crash,
                          cp_error *error)
{
    cp_crash_configuration configuration;
    cp_status status = check(meeting, error);
    if (status == CP_OK)
        status = cp_crash_configuration_from_description(
            a, b, NULL, meeting->speed_m_s, b != NULL ? meeting->opponent_speed_m_s : 0.0,
            meeting->offset_m, meeting->angle_rad, &configuration, error);
    if (status != CP_OK)
        return status;
    cp_vec2 contact = cp_crash_contact_point(a, b, &configuration);
    cp_crash_description description = cp_crash_describe(a, b, &configuration, contact);
    cp_crash_options options = cp_crash_options_default();
    options.duration_s = meeting->duration_s;
    options.longest_duration_s = fmax(options.longest_duration_s, options.duration_s);
    status = cp_crash_simulate(a, b, &configuration, &options, &crash->result, error);
    if (status == CP_OK && !crash->result.touched)
        return cp_fail(error, CP_BAD_INPUT, CP_NO_CONTACT_TEXT);
    if (status != CP_OK)
        return status;
    unsigned moved = cp_validity_of_meeting(crash->result.touched, crash->result.shift_m);
    for (int car = 0; car < crash->result.vehicle_count; car++)
        crash->severity[car] =
            severity_of(&crash->result, car, &configuration,
                        cp_validity(a, b, &configuration, &description, car, NULL) | moved);
    return CP_OK;
}

crashpulse_status crashpulse_simulate(const crashpulse_vehicle *a, const crashpulse_vehicle *b,
                                      const crashpulse_meeting *meeting, crashpulse_crash **crash,
                                      crashpulse_error *error)
{
    cp_error inner = {0};
    *crash = calloc(1, sizeof **crash);
    cp_status status = *crash != NULL ? CP_OK : cp_fail_memory(&inner, "a crash");
    if (status == CP_OK)
        status = simulate(&a->model, b != NULL ? &b->model : NULL, meeting, *crash, &inner);
    if (status != CP_OK) {
        crashpulse_crash_free(*crash);
        *crash = NULL;
    }
    return told(status, &inner, error);
}

void crashpulse_crash_free(crashpulse_crash *crash)
{
    if (crash != NULL)
        cp_crash_result_destroy(&crash->result);
    free(crash);
}

int crashpulse_crash_cars(const crashpulse_crash *crash)
{
    return crash->result.vehicle_count;
}

crashpulse_severity crashpulse_crash_severity(const crashpulse_crash *crash, int car)
{
    return car >= 0 && car < crash->result.vehicle_count
               ? crash->severity[car]
               : (crashpulse_severity){.olc_status = "no such car",
                                       .olc_g = NAN,
                                       .delta_v_m_s = NAN,
                                       .delta_v_x_m_s = NAN,
                                       .delta_v_y_m_s = NAN,
                                       .peak_g = NAN,
                                       .max_50ms_g = NAN,
                                       .asi_1 = NAN,
                                       .pdof_rad = NAN,
                                       .ees_m_s = NAN,
                                       .crush_m = NAN};
}

const double *crashpulse_crash_pulse(const crashpulse_crash *crash, int car,
                                     crashpulse_channel channel)
{
    bool there = car >= 0 && car < crash->result.vehicle_count && (int)channel >= 0 &&
                 (int)channel < CP_CHANNEL_COUNT;
    return there ? crash->result.pulse[car].channel[channel] : NULL;
}

size_t crashpulse_crash_samples(const crashpulse_crash *crash)
{
    return crash->result.pulse[0].sample_count;
}

double crashpulse_crash_interval_s(const crashpulse_crash *crash)
{
    return crash->result.pulse[0].sample_interval_s;
}

// ---- pulses from elsewhere -----------------------------------------------------------------

double crashpulse_olc_g(const double *vx_m_s, size_t count, double interval_s, const char **status)
{
    cp_olc olc = cp_olc_from_velocity(vx_m_s, count, interval_s);
    if (status != NULL)
        *status = cp_olc_status_text(olc.status);
    return olc.olc_g;
}
