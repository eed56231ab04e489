/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/objective.h"
#include "calibrate/validation.h"
#include "cli/args.h"
#include "cli/commands.h"
#include "cli/pulse_validation.h"
#include "cli/suite_validation.h"
#include "core/output_files.h"
#include "crash/named_vehicle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct arguments {
    cp_args_input input;        /* the vehicle */
    const char *reference_path; /* either this ... */
    cp_pulse_source pulse;      /* ... or its path ... */
    cp_suite_validation suite;  /* ... or its path */
    const char *curves_path;
    long threads;
    cp_format format;
} arguments;

enum { PULSE = 256, CHANNELS, OFFSET, ANGLE, UNTIL, CURVES, SUITE, VEHICLE, REFERENCES, CASES };

static const struct argp_option OPTIONS[] = {
    {"reference", 'r', "FILE.csv", 0,
     "OLC values to hold the model against: columns speed_kmh, offset_mm, angle_deg, olc_fe_g", 0},
    {"pulse", PULSE, "PATH", 0,
     "pulse to hold the model against instead: the folder of a test in NHTSA's EV5 form, or a "
     "file as 'crashpulse crash --pulse' writes it",
     0},
    {"channels", CHANNELS, "N,N...", 0,
     "longitudinal accelerometers of the test; the pulse is their mean", 0},
    {"offset", OFFSET, "MM", 0, "offset of the barrier in the pulse's test (default 0)", 0},
    {"angle", ANGLE, "DEG", 0, "angle of the barrier in the pulse's test (default 0)", 0},
    {"until", UNTIL, "MS", 0, "compare pulses from first contact to here (default 120)", 0},
    {"curves", CURVES, "FILE.csv", 0, "write both pulses side by side", 0},
    {"suite", SUITE, "FILE.yaml", 0,
     "run every crash test of a suite instead and print how far the vehicles lie from them, a row "
     "a "
     "class, vehicle and quantity",
     1},
    {"vehicle", VEHICLE, "NAME|FILE", 0,
     "judge this vehicle instead of the suite's: a shipped name or a file; may be repeated", 1},
    {"references", REFERENCES, "DIR", 0,
     "where the reference tables of a suite lie that do not ship (default: shared/reference beside "
     "the project's folder); classes whose table is absent are skipped",
     1},
    {"cases", CASES, NULL, 0, "list every case of the suite", 1},
    {"threads", 'j', "N", 0, "simulate on N threads (default: as many as cores)", 0},
    {0},
};

// Numbers between commas.
static void read_channels(const char *text, cp_pulse_source *pulse, struct argp_state *state)
{
    char copy[256];
    if (strlen(text) >= sizeof copy)
        argp_error(state, "--channels is too long");
    strcpy(copy, text);
    for (char *rest = copy; rest != NULL;) {
        char *number = rest;
        rest = strchr(rest, ',');
        if (rest != NULL)
            *rest++ = '\0';
        if (pulse->sensor_count == CP_PULSE_SENSORS_MAX)
            argp_error(state, "--channels takes at most %d numbers", CP_PULSE_SENSORS_MAX);
        pulse->sensor[pulse->sensor_count++] =
            (int)cp_args_integer(state, "--channels", number, 1, 99999);
    }
}

static void check(const arguments *a, struct argp_state *state)
{
    if (a->suite.path != NULL && (a->input.path != NULL || a->reference_path != NULL ||
                                  a->pulse.path != NULL || a->curves_path != NULL))
        argp_error(state, "--suite names its vehicles and references itself; choose vehicles with "
                          "--vehicle");
    if (a->suite.path == NULL &&
        (a->suite.vehicle_count > 0 || a->suite.references != NULL || a->suite.list_cases))
        argp_error(state, "--vehicle, --references and --cases go with --suite");
    if (a->suite.path != NULL)
        return;
    cp_args_need(state, a->input.path != NULL, "which vehicle? VEHICLE");
    cp_args_need(state, a->reference_path != NULL || a->pulse.path != NULL,
                 "against what? --reference FILE.csv or --pulse PATH");
    if (a->reference_path != NULL && a->pulse.path != NULL)
        argp_error(state, "either --reference or --pulse, not both");
    if (a->pulse.path == NULL && (a->pulse.sensor_count > 0 || a->curves_path != NULL))
        argp_error(state, "--channels and --curves go with --pulse");
}

static error_t parse(int key, char *argument, struct argp_state *state)
{
    arguments *a = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &a->format;
        state->child_inputs[1] = &a->input;
        return 0;
    case 'r':
        a->reference_path = argument;
        return 0;
    case PULSE:
        a->pulse.path = argument;
        return 0;
    case CHANNELS:
        read_channels(argument, &a->pulse, state);
        return 0;
    case OFFSET:
        a->pulse.offset_mm = cp_args_number(state, "--offset", argument, -3000.0, 3000.0, "mm");
        return 0;
    case ANGLE:
        a->pulse.angle_deg = cp_args_number(state, "--angle", argument, -90.0, 90.0, "degrees");
        return 0;
    case UNTIL:
        a->pulse.until_s = 1e-3 * cp_args_number(state, "--until", argument, 10.0, 1000.0, "ms");
        return 0;
    case CURVES:
        a->curves_path = argument;
        return 0;
    case SUITE:
        a->suite.path = argument;
        return 0;
    case VEHICLE:
        if (a->suite.vehicle_count == CP_SUITE_VEHICLES_MAX)
            argp_error(state, "at most %d times --vehicle", CP_SUITE_VEHICLES_MAX);
        a->suite.vehicles[a->suite.vehicle_count++] = argument;
        return 0;
    case REFERENCES:
        a->suite.references = argument;
        return 0;
    case CASES:
        a->suite.list_cases = true;
        return 0;
    case 'j':
        a->threads = cp_args_integer(state, "--threads", argument, 1, 64);
        return 0;
    case ARGP_KEY_END:
        check(a, state);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child CHILDREN[] = {
    {&CP_ARGS_FORMAT, 0, NULL, 0}, {&CP_ARGS_INPUT, 0, NULL, 0}, {0}};

static const struct argp ARGP = {
    .options = OPTIONS,
    .parser = parse,
    .args_doc = "VEHICLE\n--suite FILE.yaml",
    .doc = "Hold a vehicle model against reference OLC values: every configuration is simulated "
           "against the barrier of the vehicle file; errors are model minus reference, in g. Or "
           "against the pulse of one test at its speed. Or vehicles against all tests of a suite: "
           "bias and mean absolute error, the share inside the tests' 5-95 % corridor, the bar and "
           "whether it is kept."
           "\v"
           "Examples:\n"
           "  crashpulse validate db/vehicles/honda_accord_2014.yaml \\\n"
           "    --reference db/reference/olc_accord_2014.csv --format json\n"
           "  crashpulse validate db/vehicles/toyota_camry_2018.yaml \\\n"
           "    --pulse nhtsa_v10146 --channels 93,94\n"
           "  crashpulse validate --suite db/validation/suite.yaml --vehicle small_car --cases\n",
    .children = CHILDREN,
};

static const char *const VARIABLE[3] = {"speed_km_h", "offset_mm", "angle_deg"};

static json_t *group_json(const cp_validation *validation, int variable)
{
    json_t *groups = json_array();
    for (size_t k = 0; k < validation->group_count[variable]; k++) {
        const cp_validation_group *group = &validation->group[variable][k];
        json_array_append_new(groups, json_pack("{s:f, s:I, s:f}", VARIABLE[variable], group->value,
                                                "count", (json_int_t)group->count,
                                                "mean_abs_error_g", group->mean_abs_error_g));
    }
    return groups;
}

static json_t *result_json(const char *name, const cp_reference *reference, const double *olc_g,
                           const cp_validation *v)
{
    json_t *rows = json_array();
    for (size_t k = 0; k < reference->count; k++) {
        const cp_reference_case *row = &reference->cases[k];
        json_array_append_new(rows,
                              json_pack("{s:f, s:f, s:f, s:f, s:f, s:f}", "speed_km_h",
                                        row->speed_km_h, "offset_mm", row->offset_mm, "angle_deg",
                                        row->angle_deg, "reference_olc_g", row->olc_g, "olc_g",
                                        olc_g[k], "error_g", olc_g[k] - row->olc_g));
    }
    return json_pack("{s:s, s:I, s:f, s:[f,f,f], s:f, s:f, s:f, s:o, s:o, s:o, s:o}", "vehicle",
                     name, "count", (json_int_t)v->count, "mean_abs_error_g", v->mean_abs_error_g,
                     "quartiles_abs_error_g", v->quartile_g[0], v->quartile_g[1], v->quartile_g[2],
                     "max_abs_error_g", v->max_abs_error_g, "lowest_error_g", v->lowest_error_g,
                     "highest_error_g", v->highest_error_g, "by_speed", group_json(v, 0),
                     "by_offset", group_json(v, 1), "by_angle", group_json(v, 2), "configurations",
                     rows);
}

static cp_status print_cases(const cp_reference *reference, const double *olc_g, cp_format format,
                             cp_error *error)
{
    static const char *const COLUMNS[] = {"speed_km_h",      "offset_mm", "angle_deg",
                                          "reference_olc_g", "olc_g",     "error_g"};
    cp_table table = {0};
    cp_table_begin(&table, COLUMNS, sizeof COLUMNS / sizeof *COLUMNS);
    for (size_t k = 0; k < reference->count; k++) {
        const cp_reference_case *row = &reference->cases[k];
        cp_table_real(&table, row->speed_km_h);
        cp_table_real(&table, row->offset_mm);
        cp_table_real(&table, row->angle_deg);
        cp_table_real(&table, row->olc_g);
        cp_table_real(&table, olc_g[k]);
        cp_table_real(&table, olc_g[k] - row->olc_g);
    }
    cp_status status = cp_table_print(&table, format, stdout, error);
    cp_table_destroy(&table);
    return status;
}

static void print_summary(const cp_validation *v)
{
    printf("\nmean absolute error %.3f g; quartiles %.2f / %.2f / %.2f g; largest %.2f g; "
           "signed errors %.2f to %+.2f g; %zu configurations\n",
           v->mean_abs_error_g, v->quartile_g[0], v->quartile_g[1], v->quartile_g[2],
           v->max_abs_error_g, v->lowest_error_g, v->highest_error_g, v->count);
    for (int variable = 0; variable < 3; variable++) {
        printf("by %s:", VARIABLE[variable]);
        for (size_t k = 0; k < v->group_count[variable]; k++)
            printf("  %g: %.3f", v->group[variable][k].value,
                   v->group[variable][k].mean_abs_error_g);
        putchar('\n');
    }
}

static cp_status print(const cp_vehicle_model *model, const cp_reference *reference,
                       const double *olc_g, cp_format format, cp_error *error)
{
    cp_validation validation;
    cp_status status =
        cp_validate_olc(reference->cases, olc_g, reference->count, &validation, error);
    if (status != CP_OK)
        return status;
    if (format == CP_FORMAT_JSON)
        return cp_json_print(result_json(model->name, reference, olc_g, &validation), stdout,
                             error);
    status = print_cases(reference, olc_g, format, error);
    if (status == CP_OK && format == CP_FORMAT_TABLE)
        print_summary(&validation);
    return status;
}

static cp_status validate_olc(const arguments *a, const cp_vehicle_model *model, cp_error *error)
{
    cp_reference reference = {0};
    double *olc_g = NULL;
    cp_status status = cp_reference_load(a->reference_path, &reference, error);
    if (status == CP_OK) {
        olc_g = calloc(reference.count, sizeof *olc_g);
        status =
            olc_g != NULL ? cp_crash_library_begin(error) : cp_fail_memory(error, "validation");
    }
    if (status == CP_OK) {
        status =
            cp_objective_olc(model, reference.cases, reference.count, NULL,
                             cp_crash_options_default().time_step_s, (int)a->threads, olc_g, error);
        cp_crash_library_end();
    }
    if (status == CP_OK)
        status = print(model, &reference, olc_g, a->format, error);
    free(olc_g);
    cp_reference_destroy(&reference);
    return status;
}

cp_status cmd_validate(int argc, char **argv, cp_error *error)
{
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    arguments a = {.input = {.one = "vehicle"},
                   .threads = cores > 0 && cores < 64 ? cores : 1,
                   .pulse = {.speed_km_h = NAN, .until_s = 0.12, .weight_1 = 1.0}};
    cp_args_parse(&ARGP, argc, argv, &a);
    if (a.suite.path != NULL) {
        a.suite.threads = (int)a.threads;
        return cp_suite_validate(&a.suite, a.format, error);
    }

    cp_vehicle_model model;
    const char *const inputs[] = {a.input.path, a.reference_path, a.pulse.path};
    cp_status status = cp_output_files_check(&a.curves_path, 1, inputs, 3, error);
    if (status == CP_OK)
        status = cp_named_vehicle_load(NULL, a.input.path, &model, error);
    if (status != CP_OK)
        return status;
    return a.pulse.path != NULL
               ? cp_pulse_validate(&model, &a.pulse, a.curves_path, a.format, error)
               : validate_olc(&a, &model, error);
}
