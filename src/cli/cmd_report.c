/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/args.h"
#include "cli/commands.h"
#include "control/control.h"
#include "core/log.h"
#include "core/output_files.h"
#include "report/report.h"

typedef struct arguments {
    cp_args_input input;
    const char *output_path;
    const char *baseline;
} arguments;

static const struct argp_option OPTIONS[] = {
    {"output", 'o', "FILE.html", 0, "file to write", 0},
    {"baseline", 'b', "VARIANT", 0, "compare with this variant (default: the study's baseline)", 0},
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
    case 'b':
        a->baseline = argument;
        return 0;
    case ARGP_KEY_END:
        cp_args_need(state, a->output_path != NULL, "where to? --output FILE.html");
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child CHILDREN[] = {{&CP_ARGS_INPUT, 0, NULL, 0}, {0}};

static const struct argp ARGP = {
    .options = OPTIONS,
    .parser = parse,
    .args_doc = "DB --output FILE.html",
    .doc =
        "Write the comparison of a study as one HTML file: figures with filters, tables, limits, "
        "and what is needed to make it again."
        "\v"
        "The file needs no network and no other file. Every figure can be saved from the page as "
        "SVG and its data as CSV.\n\n"
        "Example:\n"
        "  crashpulse report demo.db --output demo.html\n",
    .children = CHILDREN,
};

// Defaults of every driver error and function, so that the page can show what a study changed.
static json_t *controls_json(void)
{
    json_t *controls = json_object();
    for (size_t k = 0; k < CP_CONTROL_TYPE_COUNT; k++) {
        const cp_control_type *type = CP_CONTROL_TYPE[k];
        json_t *parameters = json_object();
        for (size_t p = 0; p < type->parameter_count; p++)
            json_object_set_new(parameters, type->parameters[p].name,
                                json_real(type->parameters[p].standard));
        json_object_set_new(controls, type->name,
                            json_pack("{s:s, s:o}", "what", type->what, "parameters", parameters));
    }
    return controls;
}

cp_status cmd_report(int argc, char **argv, cp_error *error)
{
    arguments a = {.input = CP_ARGS_DATABASE};
    cp_args_parse(&ARGP, argc, argv, &a);
    cp_store *store = NULL;
    json_t *controls = controls_json();
    cp_status status =
        cp_output_files_check(&a.output_path, 1, (const char *const[]){a.input.path}, 1, error);
    if (status == CP_OK)
        status = cp_store_open(a.input.path, CP_STORE_READ, &store, error);
    if (status == CP_OK)
        status = cp_report_write(store, a.baseline, controls, a.output_path, error);
    if (status == CP_OK)
        cp_log_info("wrote %s", a.output_path);
    json_decref(controls);
    cp_store_close(store);
    return status;
}
