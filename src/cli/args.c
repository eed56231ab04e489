/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/args.h"

#include "core/log.h"
#include "core/status.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

double cp_args_number(struct argp_state *state, const char *name, const char *text, double smallest,
                      double largest, const char *unit)
{
    char *end = NULL;
    double value = strtod(text, &end);
    // strtod takes "nan", "inf" and "0x1p3" too; none of them is meant.
    bool number = end != text && *end == '\0' && isfinite(value) && !strpbrk(text, "xX");
    if (!number || value < smallest || value > largest)
        argp_error(state, "%s must be a number from %g to %g %s, found '%s'", name, smallest,
                   largest, unit, text);
    return value;
}

long cp_args_integer(struct argp_state *state, const char *name, const char *text, long smallest,
                     long largest)
{
    char *end = NULL;
    errno = 0;
    long value = strtol(text, &end, 10);
    if (end == text || *end != '\0' || errno != 0 || value < smallest || value > largest)
        argp_error(state, "%s must be a whole number from %ld to %ld, found '%s'", name, smallest,
                   largest, text);
    return value;
}

static error_t parse_format(int key, char *argument, struct argp_state *state)
{
    if (key != 'f')
        return ARGP_ERR_UNKNOWN;
    if (!cp_format_from_text(argument, state->input))
        argp_error(state, "--format must be table, json or csv, found '%s'", argument);
    return 0;
}

static const struct argp_option FORMAT_OPTIONS[] = {
    {"format", 'f', "FORMAT", 0, "table (rounded, for reading), json or csv (all digits)", 0},
    {0},
};

const struct argp CP_ARGS_FORMAT = {.options = FORMAT_OPTIONS, .parser = parse_format};

void cp_args_need(struct argp_state *state, bool is_there, const char *missing)
{
    if (!is_there)
        argp_error(state, "%s is missing", missing);
}

static error_t parse_input(int key, char *argument, struct argp_state *state)
{
    cp_args_input *input = state->input;
    switch (key) {
    case ARGP_KEY_ARG:
        if (input->path != NULL)
            argp_error(state, "one %s at a time, found '%s' too", input->one, argument);
        input->path = argument;
        return 0;
    case ARGP_KEY_END:
        cp_args_need(state, input->path != NULL || input->missing == NULL, input->missing);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

const struct argp CP_ARGS_INPUT = {.parser = parse_input};

void cp_args_parse(const struct argp *argp, int argc, char **argv, void *input)
{
    char name[64];
    snprintf(name, sizeof name, "crashpulse %s", argv[0]);
    char *first = argv[0];
    argv[0] = name;
    argp_err_exit_status = cp_status_exit_code(CP_BAD_INPUT);
    error_t failure = argp_parse(argp, argc, argv, 0, NULL, input);
    argv[0] = first;
    if (failure != 0) {
        cp_status status = failure == ENOMEM ? CP_NO_MEMORY : CP_BAD_INPUT;
        cp_log_error("command line: %s", strerror(failure));
        exit(cp_status_exit_code(status));
    }
}
