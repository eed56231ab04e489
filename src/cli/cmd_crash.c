/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/args.h"
#include "cli/commands.h"
#include "cli/crash_again.h"
#include "cli/crash_output.h"
#include "cli/crash_samples.h"
#include "core/output_files.h"
#include "core/units.h"
#include "crash/named_vehicle.h"
#include "report/animation.h"

#include <limits.h>
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
    const char *animation_path;
    const char *overlay_vehicle_path;  /* NULL: the same vehicle */
    const char *overlay_opponent_path; /* NULL: the same opponent; "barrier" */
    long samples;                      /* 0: none */
    long seed;                         /* -1: not given */
    const char *from_path;             /* database of a study; NULL: none */
    long crash_id;                     /* -1: not given */
    const char *treatment;             /* NULL: the crash as it happened in the baseline */
    bool described;                    /* an option says how the cars meet */
    cp_format format;
} arguments;

enum {
    AGAINST = 256,
    OPPONENT_SPEED,
    OFFSET,
    ANGLE,
    DURATION,
    PULSE,
    RAW,
    ANIMATE,
    OVERLAY_VEHICLE,
    OVERLAY_AGAINST,
    SAMPLES,
    SEED,
    FROM,
    CRASH,
    TREATMENT
};

static const struct argp_option OPTIONS[] = {
    {"against", AGAINST, "OPPONENT", 0,
     "'barrier' (rigid, rounded corners; the default) or a vehicle", 0},
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
    {"animate", ANIMATE, "FILE.html", 0,
     "write a page that shows the crash from above over time beside its pulses", 0},
    {"overlay-against", OVERLAY_AGAINST, "OPPONENT", 0,
     "lay a second run over the animation: the same, but against 'barrier' or a vehicle", 0},
    {"overlay-vehicle", OVERLAY_VEHICLE, "VEHICLE", 0,
     "lay a second run over the animation: the same, but with this vehicle", 0},
    {"samples", SAMPLES, "N", 0,
     "crash N times with parameters drawn from the scatter in the vehicle files; print medians and "
     "5 to 95 % intervals",
     0},
    {"seed", SEED, "S", 0, "seed of the samples (default 1)", 0},
    {"from", FROM, "DB", 0,
     "simulate a crash of this study's database again, from the database alone", 0},
    {"crash", CRASH, "ID", 0, "which one: crash.id", 0},
    {"treatment", TREATMENT, "VARIANT", 0,
     "of a counterfactual study: what this crash became under the variant", 0},
    {0},
};

static void check_raw(const arguments *a, struct argp_state *state)
{
    cp_args_need(state, !a->raw || a->pulse_path != NULL,
                 "--raw is about the pulse file: --pulse FILE.csv");
}

// A stored crash brings all with it.
static void check_stored(const arguments *a, struct argp_state *state)
{
    cp_args_need(state, a->crash_id >= 0, "which crash? --crash ID");
    cp_args_need(state, a->from_path != NULL, "--crash is about a database: --from DB");
    if (a->vehicle_path || a->opponent_path || a->described || a->samples > 0 ||
        a->overlay_vehicle_path || a->overlay_opponent_path)
        argp_error(state, "--from takes vehicles, speeds and all else from the database; only "
                          "--treatment, --pulse, --raw, --animate and --format go with it");
    check_raw(a, state);
}

static void check(const arguments *a, struct argp_state *state)
{
    if (a->from_path || a->crash_id >= 0 || a->treatment) {
        check_stored(a, state);
        return;
    }
    cp_args_need(state, a->vehicle_path != NULL, "which vehicle? VEHICLE");
    cp_args_need(state, !isnan(a->speed_km_h), "how fast? --speed KMH");
    bool overlay = a->overlay_vehicle_path || a->overlay_opponent_path;
    bool overlay_car = a->overlay_opponent_path && strcmp(a->overlay_opponent_path, "barrier") != 0;
    if (!a->opponent_path && !overlay_car && !isnan(a->opponent_speed_km_h))
        argp_error(state, "--opponent-speed needs an opponent: --against VEHICLE");
    cp_args_need(state, !overlay || a->animation_path != NULL,
                 "an overlay is drawn in the animation: --animate FILE.html");
    cp_args_need(state, a->seed < 0 || a->samples > 0, "--seed is about samples: --samples N");
    check_raw(a, state);
}

// Options about what to make of the crash.
static error_t parse_output(int key, char *argument, struct argp_state *state)
{
    arguments *a = state->input;
    switch (key) {
    case PULSE:
        a->pulse_path = argument;
        return 0;
    case RAW:
        a->raw = true;
        return 0;
    case ANIMATE:
        a->animation_path = argument;
        return 0;
    case OVERLAY_VEHICLE:
        a->overlay_vehicle_path = argument;
        return 0;
    case OVERLAY_AGAINST:
        a->overlay_opponent_path = argument;
        return 0;
    case SAMPLES:
        a->samples = cp_args_integer(state, "--samples", argument, 2, 1000000);
        return 0;
    case FROM:
        a->from_path = argument;
        return 0;
    case CRASH:
        a->crash_id = cp_args_integer(state, "--crash", argument, 0, LONG_MAX);
        return 0;
    case TREATMENT:
        a->treatment = argument;
        return 0;
    case SEED:
        a->seed = cp_args_integer(state, "--seed", argument, 0, LONG_MAX);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static error_t parse(int key, char *argument, struct argp_state *state)
{
    arguments *a = state->input;
    a->described |= key == 's' || (key >= OPPONENT_SPEED && key <= DURATION);
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
        return parse_output(key, argument, state);
    }
}

static const struct argp_child CHILDREN[] = {{&CP_ARGS_FORMAT, 0, NULL, 0}, {0}};

static const struct argp ARGP = {
    .options = OPTIONS,
    .parser = parse,
    .args_doc = "VEHICLE --speed KMH\n--from DB --crash ID",
    .doc = "Simulate one crash of the vehicle on the multibody surrogate, against a rigid barrier "
           "or another car, and print OLC, delta-v, peak and crush."
           "\v"
           "A VEHICLE is a name (honda_accord_2014; an unknown one is answered with the list) or, "
           "with a "
           "'/' or a '.' in it, a vehicle file. The cars are moved along their headings until they "
           "touch. Axes of a vehicle: x forward, "
           "y left. Every result says whether it lies in the range the vehicle model was validated "
           "in.\n\n"
           "Examples:\n"
           "  crashpulse crash honda_accord_2014 --speed 56\n"
           "  crashpulse crash car.yaml --speed 40 --offset 400 --angle 15 --format json\n"
           "  crashpulse crash car.yaml --against other.yaml --speed 50 --pulse pulse.csv\n"
           "  crashpulse crash a.yaml --speed 56 --animate a.html --overlay-against b.yaml\n"
           "  crashpulse crash car.yaml --speed 50 --samples 1000 --seed 7\n"
           "  crashpulse crash --from demo.db --crash 2305843009213693952 --animate again.html\n",
    .children = CHILDREN,
};

// A vehicle by name or file, or the barrier.
static cp_status load(const char *path, cp_vehicle_model *model, const cp_vehicle_model **loaded,
                      cp_error *error)
{
    *loaded = NULL;
    if (!path || strcmp(path, "barrier") == 0)
        return CP_OK;
    cp_status status = cp_named_vehicle_load(NULL, path, model, error);
    if (status == CP_OK)
        *loaded = model;
    return status;
}

static cp_crash_request request_of(const arguments *a)
{
    double own_km_h = a->speed_km_h;
    double opponent_km_h = isnan(a->opponent_speed_km_h) ? own_km_h : a->opponent_speed_km_h;
    return (cp_crash_request){.speed_m_s = cp_m_s_from_km_h(own_km_h),
                              .opponent_speed_m_s = cp_m_s_from_km_h(opponent_km_h),
                              .offset_m = a->offset_mm / 1e3,
                              .angle_rad = cp_rad_from_deg(a->angle_deg),
                              .duration_s = a->duration_ms / 1e3};
}

// One run of the animation, filmed.
typedef struct filmed_run {
    cp_vehicle_model model[2];
    cp_crash_run run;
    cp_crash_film film;
} filmed_run;

static cp_status film(const arguments *a, const char *vehicle_path, const char *opponent_path,
                      filmed_run *filmed, cp_error *error)
{
    cp_crash_request request = request_of(a);
    filmed->film = cp_crash_film_default();
    cp_status status = load(vehicle_path, &filmed->model[0], &filmed->run.model[0], error);
    if (status == CP_OK)
        status = load(opponent_path, &filmed->model[1], &filmed->run.model[1], error);
    if (status == CP_OK)
        status = cp_crash_run_simulate(&request, &filmed->run,
                                       a->animation_path ? &filmed->film : NULL, error);
    return status;
}

static cp_status animate(const filmed_run *first, const filmed_run *overlay, const char *path,
                         cp_error *error)
{
    const filmed_run *const filmed[2] = {first, overlay};
    cp_animated_run animated[2];
    for (int k = 0; k < (overlay ? 2 : 1); k++)
        animated[k] = (cp_animated_run){
            .model = {filmed[k]->run.model[0], filmed[k]->run.model[1]},
            .configuration = &filmed[k]->run.configuration,
            .description = &filmed[k]->run.description,
            .result = &filmed[k]->run.result,
            .film = &filmed[k]->film,
        };
    return cp_animation_write(animated, overlay ? 2 : 1, path, error);
}

static cp_status write_animation(const arguments *a, const filmed_run *first, cp_error *error)
{
    if (!a->overlay_vehicle_path && !a->overlay_opponent_path)
        return animate(first, NULL, a->animation_path, error);
    filmed_run overlay = {0};
    cp_status status = film(a, a->overlay_vehicle_path ? a->overlay_vehicle_path : a->vehicle_path,
                            a->overlay_opponent_path ? a->overlay_opponent_path : a->opponent_path,
                            &overlay, error);
    if (status != CP_OK)
        status = cp_error_prefix(error, "overlay: ");
    else
        status = animate(first, &overlay, a->animation_path, error);
    cp_crash_film_destroy(&overlay.film);
    cp_crash_result_destroy(&overlay.run.result);
    return status;
}

static cp_status print_samples(const arguments *a, const cp_crash_run *nominal, cp_error *error)
{
    const char *const paths[2] = {a->vehicle_path, a->opponent_path};
    cp_crash_request request = request_of(a);
    cp_crash_samples samples = {0};
    cp_status status = cp_crash_samples_run(&request, nominal, paths, (size_t)a->samples,
                                            a->seed < 0 ? 1 : (uint64_t)a->seed, &samples, error);
    if (status == CP_OK)
        status = cp_crash_samples_print(&samples, nominal, a->format, stdout, error);
    cp_crash_samples_destroy(&samples);
    return status;
}

static cp_status simulate_again(const arguments *a, cp_error *error)
{
    cp_crash_again again = {0};
    filmed_run filmed = {.film = cp_crash_film_default()};
    cp_status status =
        cp_crash_again_simulate(a->from_path, a->crash_id, a->treatment,
                                a->animation_path ? &filmed.film : NULL, &again, error);
    filmed.run = again.run;
    if (status == CP_OK && a->pulse_path)
        status = cp_crash_write_pulse(&again.run, a->raw, a->pulse_path, error);
    if (status == CP_OK && a->animation_path)
        status = animate(&filmed, NULL, a->animation_path, error);
    if (status == CP_OK)
        status = cp_crash_print(&again.run, a->format, stdout, error);
    if (status == CP_OK)
        status = cp_crash_again_conclude(&again, error);
    cp_crash_film_destroy(&filmed.film);
    cp_crash_result_destroy(&again.run.result);
    return status;
}

static cp_status simulate_described(const arguments *a, cp_error *error)
{
    filmed_run filmed = {0};
    cp_status status = film(a, a->vehicle_path, a->opponent_path, &filmed, error);
    if (status == CP_OK && a->pulse_path)
        status = cp_crash_write_pulse(&filmed.run, a->raw, a->pulse_path, error);
    if (status == CP_OK && a->animation_path)
        status = write_animation(a, &filmed, error);
    if (status == CP_OK && a->samples > 0)
        status = print_samples(a, &filmed.run, error);
    else if (status == CP_OK)
        status = cp_crash_print(&filmed.run, a->format, stdout, error);
    cp_crash_film_destroy(&filmed.film);
    cp_crash_result_destroy(&filmed.run.result);
    return status;
}

cp_status cmd_crash(int argc, char **argv, cp_error *error)
{
    arguments a = {.speed_km_h = NAN,
                   .opponent_speed_km_h = NAN,
                   .duration_ms = 200.0,
                   .seed = -1,
                   .crash_id = -1};
    cp_args_parse(&ARGP, argc, argv, &a);

    const char *const outputs[] = {a.pulse_path, a.animation_path};
    const char *const inputs[] = {a.vehicle_path, a.opponent_path, a.overlay_vehicle_path,
                                  a.overlay_opponent_path, a.from_path};
    cp_status status = cp_output_files_check(outputs, sizeof outputs / sizeof *outputs, inputs,
                                             sizeof inputs / sizeof *inputs, error);
    if (status == CP_OK)
        status = cp_crash_library_begin(error);
    if (status != CP_OK)
        return status;
    status = a.from_path ? simulate_again(&a, error) : simulate_described(&a, error);
    cp_crash_library_end();
    return status;
}
