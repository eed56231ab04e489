/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/calibration.h"
#include "calibrate/fit_file.h"
#include "cli/args.h"
#include "cli/commands.h"
#include "crash/crash_simulation.h"

#include <stdio.h>

typedef struct arguments {
    cp_args_input input;
    const char *output_path;
} arguments;

static const struct argp_option OPTIONS[] = {
    {"output", 'o', "FILE.yaml", 0,
     "write the fitted vehicle file here, not where the fit file says; its own place must be in "
     "its "
     "folder or below",
     0},
    {0},
};

static error_t parse(int key, char *argument, struct argp_state *state)
{
    arguments *a = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &a->input;
        return 0;
    case 'o':
        a->output_path = argument;
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child CHILDREN[] = {{&CP_ARGS_INPUT, 0, NULL, 0}, {0}};

static const struct argp ARGP = {
    .options = OPTIONS,
    .parser = parse,
    .args_doc = "FIT.yaml",
    .doc =
        "Fit a vehicle model to reference OLC values or pulses: a global search, least squares "
        "and Nelder-Mead, cross-validated where the fit file asks for it. Writes the fitted "
        "vehicle file and a report beside it (.fit.md)."
        "\v"
        "The fit file names base vehicle, references, unknowns with bounds, algorithm, seed and "
        "budget (db/vehicles/README.md). A killed fit goes on where it was when called again.\n\n"
        "Example:\n"
        "  crashpulse calibrate db/vehicles/honda_accord_2014.fit.yaml\n",
    .children = CHILDREN,
};

cp_status cmd_calibrate(int argc, char **argv, cp_error *error)
{
    arguments a = {.input = {.one = "fit", .missing = "which fit? FIT.yaml"}};
    cp_args_parse(&ARGP, argc, argv, &a);

    cp_fit fit;
    cp_calibration calibration = {0};
    cp_status status = cp_fit_load(a.input.path, a.output_path, &fit, error);
    if (status != CP_OK)
        return status;
    status = cp_crash_library_begin(error);
    if (status == CP_OK) {
        status = cp_calibration_run(&fit, &calibration, error);
        cp_crash_library_end();
    }
    if (status == CP_OK)
        status = cp_calibration_write(&fit, &calibration, error);
    if (status == CP_OK) {
        if (fit.objective == CP_FIT_PULSE)
            printf("%s: total error %.3f over %zu pulses\n", fit.output_path, calibration.objective,
                   fit.pulse_count);
        printf("%s: mean absolute OLC error %.3f g, largest %.2f g\n", fit.output_path,
               calibration.validation.mean_abs_error_g, calibration.validation.max_abs_error_g);
        for (size_t c = 0; c < calibration.cross_count; c++) {
            const cp_validation *predicted = &calibration.cross[c].validation;
            char title[80];
            cp_cross_title(&calibration.cross[c], title);
            printf("%s: %.3f g, largest %.2f g\n", title, predicted->mean_abs_error_g,
                   predicted->max_abs_error_g);
        }
    }
    cp_calibration_destroy(&calibration);
    cp_fit_destroy(&fit);
    return status;
}
