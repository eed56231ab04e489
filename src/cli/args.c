/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/args.h"

#include "core/log.h"
#include "core/nearest.h"
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

// ---- words before argp sees them -----------------------------------------------------------

static void no_memory(void)
{
    cp_log_error("command line: %s", strerror(ENOMEM));
    exit(cp_status_exit_code(CP_NO_MEMORY));
}

// A query may begin with a comment ("-- Which crashes ..."), which is no option: argp gets it with
// a blank in front. The copy lives in argv, as long as the program.
static void shield_comments(int argc, char **argv)
{
    for (int k = 1; k < argc; k++) {
        if (strncmp(argv[k], "--", 2) != 0)
            continue;
        char behind = argv[k][2 + strcspn(argv[k] + 2, " \t\n=")];
        if (behind == '\0' || behind == '=')
            continue;
        char *shielded = malloc(strlen(argv[k]) + 2);
        if (shielded == NULL)
            no_memory();
        argv[k] = strcat(strcpy(shielded, " "), argv[k]);
    }
}

enum { NAMES_MAX = 64 };

typedef struct known_options {
    const struct argp_option *option[NAMES_MAX];
    const char *name[NAMES_MAX];
    size_t count;
} known_options;

// The long options of a parser and its children, and those that argp adds.
static void gather(const struct argp *argp, known_options *known)
{
    static const struct argp_option OF_ARGP[] = {{.name = "help"}, {.name = "usage"}, {0}};
    const struct argp_option *lists[] = {argp->options, OF_ARGP};
    for (size_t k = 0; k < 2; k++)
        for (const struct argp_option *o = lists[k]; o != NULL && (o->name || o->key || o->doc);
             o++)
            if (o->name != NULL && known->count < NAMES_MAX) {
                known->option[known->count] = o;
                known->name[known->count++] = o->name;
            }
    for (const struct argp_child *c = argp->children; c != NULL && c->argp != NULL; c++)
        gather(c->argp, known);
}

// The option that a word names, whole or by its beginning; NULL: none.
static const struct argp_option *find_option(const known_options *known, const char *name,
                                             size_t length)
{
    for (size_t k = 0; k < known->count; k++)
        if (strncmp(known->name[k], name, length) == 0)
            return known->option[k];
    return NULL;
}

// An option that there is not is answered with the nearest one; argp says no more than that.
static void check_options(const struct argp *argp, int argc, char **argv)
{
    known_options known = {0};
    gather(argp, &known);
    for (int k = 1; k < argc && strcmp(argv[k], "--") != 0; k++) {
        if (strncmp(argv[k], "--", 2) != 0)
            continue;
        char word[64], meant[CP_NEAREST_TEXT_SIZE];
        size_t length = strcspn(argv[k] + 2, "=");
        const struct argp_option *option = find_option(&known, argv[k] + 2, length);
        // Its argument may look like an option.
        if (option != NULL)
            k += option->arg != NULL && !(option->flags & OPTION_ARG_OPTIONAL) &&
                 argv[k][2 + length] == '\0';
        if (option != NULL)
            continue;
        snprintf(word, sizeof word, "%.*s", (int)length, argv[k] + 2);
        const char *name = cp_nearest(word, known.name, known.count);
        if (name == NULL)
            return; // argp's own words
        snprintf(meant, sizeof meant, "; did you mean '--%s'?", name);
        fprintf(stderr, "%s: unrecognized option '--%s'%s\n", argv[0], word, meant);
        fprintf(stderr, "Try `%s --help' or `%s --usage' for more information.\n", argv[0],
                argv[0]);
        exit(cp_status_exit_code(CP_BAD_INPUT));
    }
}

void cp_args_parse(const struct argp *argp, int argc, char **argv, void *input)
{
    char name[64];
    snprintf(name, sizeof name, "crashpulse %s", argv[0]);
    char *first = argv[0];
    argv[0] = name;
    argp_err_exit_status = cp_status_exit_code(CP_BAD_INPUT);
    shield_comments(argc, argv);
    check_options(argp, argc, argv);
    error_t failure = argp_parse(argp, argc, argv, 0, NULL, input);
    argv[0] = first;
    if (failure != 0) {
        cp_status status = failure == ENOMEM ? CP_NO_MEMORY : CP_BAD_INPUT;
        cp_log_error("command line: %s", strerror(failure));
        exit(cp_status_exit_code(status));
    }
}
