/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/args.h"
#include "cli/commands.h"
#include "cli/pulse_input.h"
#include "cli/pulse_metrics.h"

typedef struct arguments {
    cp_pulse_input input;
    cp_format format;
} arguments;

static error_t parse(int key, char *argument, struct argp_state *state)
{
    arguments *a = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &a->format;
        state->child_inputs[1] = &a->input;
        return 0;
    case ARGP_KEY_ARG:
        if (a->input.request.path != NULL)
            argp_error(state, "one pulse at a time, found '%s' too", argument);
        a->input.request.path = argument;
        return 0;
    case ARGP_KEY_END:
        cp_args_need(state, a->input.request.path != NULL, "which pulse? PULSE");
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child CHILDREN[] = {
    {&CP_ARGS_FORMAT, 0, NULL, 0}, {&CP_PULSE_INPUT_ARGS, 0, NULL, 2}, {0}};

static const struct argp ARGP = {
    .parser = parse,
    .args_doc = "PULSE\nDB --crash ID",
    .doc =
        "Compute every figure of a crash pulse: OLC, delta-v, peak after CFC60, mean, highest "
        "50 ms mean, ASI, time of v = 0, direction of force."
        "\v"
        "PULSE: the folder or EV5 file of a test from NHTSA, the folder, .mme file or a channel "
        "file of an ISO-MME test, an LS-DYNA file with load curves, a CSV file as 'crashpulse "
        "crash --pulse' and 'crashpulse export' write it. Axes: x forward, y left.\n\n"
        "Delta-v is that of the place that was measured, until the last contact (where the file "
        "tells it) or its largest value; delta_v_m_s of a database is that of the whole car, its "
        "momentum over its mass. The OLC is that of a car struck on its front. A record that ends "
        "before its OLC is "
        "decided has none, and that is said; a velocity and an acceleration that do not go "
        "together are refused.\n\n"
        "Examples:\n"
        "  crashpulse pulse v10146/\n"
        "  crashpulse pulse v10146/ --channels 93,94 --format json\n"
        "  crashpulse pulse test/test.mme --vehicle 2\n"
        "  crashpulse pulse sled.k --channels 7 --units mm-ms-kg\n"
        "  crashpulse pulse demo.db --crash 4711 --vehicle b\n",
    .children = CHILDREN,
};

cp_status cmd_pulse(int argc, char **argv, cp_error *error)
{
    arguments a = {.input = cp_pulse_input_default()};
    cp_pulse_record record = {0};
    cp_args_parse(&ARGP, argc, argv, &a);
    cp_status status = cp_pulse_input_read(&a.input, &record, error);
    if (status == CP_OK)
        status = cp_pulse_metrics_print(&record, a.format, stdout, error);
    cp_pulse_record_destroy(&record);
    return status;
}
