/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/args.h"
#include "cli/commands.h"
#include "cli/crash_output.h"
#include "core/units.h"

#include <math.h>
#include <string.h>

typedef struct arguments {
    const char *vehicle_path;
    const char *opponent_path; /* NULL: the barrier */
    double speed_km_h;         /* NAN: not given */
    double opponent_speed_km_h;
    double offset_mm;
    double angle_deg;
    double duration_ms;
    const char *pulse_path;
    bool raw;
    cp_format format;
} arguments;

enum { AGAINST = 256, OPPONENT_SPEED, OFFSET, ANGLE, DURATION, PULSE, RAW };

static const struct argp_option OPTIONS[] = {
    {"against", AGAINST, "OPPONENT", 0,
     "'barrier' (rigid, rounded corners; the default) or a vehicle file", 0},
    {"speed", 's', "KMH", 0, "speed of the vehicle, km/h", 0},
    {"opponent-speed", OPPONENT_SPEED, "KMH", 0, "speed of the opponent, km/h (default: the same)",
     0},
    {"offset", OFFSET, "MM", 0,
     "lateral offset of the opponent's (or barrier's) middle to the left, mm (default 0)", 0},
    {"angle", ANGLE, "DEG", 0,
     "heading of the opponent against exactly oncoming, counter-clockwise, degrees (default 0)", 0},
    {"duration", DURATION, "MS", 0,
     "simulate at least this long after first contact, ms (default 200)", 0},
    {"pulse", PULSE, "FILE.csv", 0, "write the pulses: acceleration, velocity, displacement, yaw",
     0},
    {"raw", RAW, NULL, 0, "pulses with accelerations as simulated, without the CFC60 filter", 0},
    {0},
};

static void check(const arguments *a, struct argp_state *state)
{
    if (!a->vehicle_path)
        argp_error(state, "which vehicle? VEHICLE.yaml is missing");
    if (isnan(a->speed_km_h))
        argp_error(state, "how fast? --speed KMH is missing");
    if (!a->opponent_path && !isnan(a->opponent_speed_km_h))
        argp_error(state, "--opponent-speed needs an opponent: --against VEHICLE2.yaml");
    if (a->raw && !a->pulse_path)
        argp_error(state, "--raw is about the pulse file: --pulse FILE.csv is missing");
}

static error_t parse(int key, char *argument, struct argp_state *state)
{
    arguments *a = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &a->format;
        return 0;
    case AGAINST:
        a->opponent_path = strcmp(argument, "barrier") == 0 ? NULL : argument;
        return 0;
    case 's':
        a->speed_km_h = cp_args_number(state, "--speed", argument, 0.0, 400.0, "km/h");
        return 0;
    case OPPONENT_SPEED:
        a->opponent_speed_km_h =
            cp_args_number(state, "--opponent-speed", argument, 0.0, 400.0, "km/h");
        return 0;
    case OFFSET:
        a->offset_mm = cp_args_number(state, "--offset", argument, -10000.0, 10000.0, "mm");
        return 0;
    case ANGLE:
        a->angle_deg = cp_args_number(state, "--angle", argument, -180.0, 180.0, "degrees");
        return 0;
    case DURATION:
        a->duration_ms = cp_args_number(state, "--duration", argument, 10.0, 1000.0, "ms");
        return 0;
    case PULSE:
        a->pulse_path = argument;
        return 0;
    case RAW:
        a->raw = true;
        return 0;
    case ARGP_KEY_ARG:
        if (a->vehicle_path)
            argp_error(state, "one vehicle, and its opponent by --against; found '%s' too",
                       argument);
        a->vehicle_path = argument;
        return 0;
    case ARGP_KEY_END:
        check(a, state);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child CHILDREN[] = {{&CP_ARGS_FORMAT, 0, NULL, 0}, {0}};

static const struct argp ARGP = {
    .options = OPTIONS,
    .parser = parse,
    .args_doc = "VEHICLE.yaml --speed KMH",
    .doc =
        "Simulate one crash of the vehicle on the multibody surrogate, against a rigid barrier "
        "or another car, and print OLC, delta-v, peak and crush."
        "\v"
        "The cars are moved along their headings until they touch. Axes of a vehicle: x forward, "
        "y left. Every result says whether it lies in the range the vehicle model was validated "
        "in.\n\n"
        "Examples:\n"
        "  crashpulse crash car.yaml --speed 56\n"
        "  crashpulse crash car.yaml --speed 40 --offset 400 --angle 15 --format json\n"
        "  crashpulse crash car.yaml --against other.yaml --speed 50 --pulse pulse.csv\n",
    .children = CHILDREN,
};

static cp_status simulate(const arguments *a, cp_crash_run *run, cp_error *error)
{
    double speed = cp_m_s_from_km_h(a->speed_km_h);
    double opponent_speed =
        isnan(a->opponent_speed_km_h) ? speed : cp_m_s_from_km_h(a->opponent_speed_km_h);
    cp_status status = cp_crash_configuration_from_description(
        run->model[0], run->model[1], NULL, speed, run->model[1] ? opponent_speed : 0.0,
        a->offset_mm / 1e3, cp_rad_from_deg(a->angle_deg), &run->configuration, error);
    if (status != CP_OK)
        return status;
    cp_vec2 contact = cp_crash_contact_point(run->model[0], run->model[1], &run->configuration);
    run->description =
        cp_crash_describe(run->model[0], run->model[1], &run->configuration, contact);

    cp_crash_options options = cp_crash_options_default();
    options.duration_s = run->duration_s = a->duration_ms / 1e3;
    options.longest_duration_s = fmax(options.longest_duration_s, options.duration_s);
    status = cp_crash_library_begin(error);
    if (status != CP_OK)
        return status;
    status = cp_crash_simulate(run->model[0], run->model[1], &run->configuration, &options,
                               &run->result, error);
    cp_crash_library_end();
    if (status == CP_OK && !run->result.touched)
        return cp_fail(error, CP_BAD_INPUT, "the outlines of the two never met");
    return status;
}

cp_status cmd_crash(int argc, char **argv, cp_error *error)
{
    arguments a = {.speed_km_h = NAN, .opponent_speed_km_h = NAN, .duration_ms = 200.0};
    cp_args_parse(&ARGP, argc, argv, &a);

    cp_vehicle_model model[2];
    cp_crash_run run = {.model = {&model[0], a.opponent_path ? &model[1] : NULL}};
    cp_status status = cp_vehicle_model_load(a.vehicle_path, &model[0], error);
    if (status == CP_OK && a.opponent_path)
        status = cp_vehicle_model_load(a.opponent_path, &model[1], error);
    if (status == CP_OK)
        status = simulate(&a, &run, error);
    if (status == CP_OK && a.pulse_path)
        status = cp_crash_write_pulse(&run, a.raw, a.pulse_path, error);
    if (status == CP_OK)
        status = cp_crash_print(&run, a.format, stdout, error);
    cp_crash_result_destroy(&run.result);
    return status;
}
