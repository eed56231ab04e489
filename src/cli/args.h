/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CLI_ARGS_H
#define CLI_ARGS_H

#include "cli/output.h"

#include <argp.h>
#include <stdbool.h>

/* What the commands share in reading their arguments. A wrong argument ends the program with one
 * message and exit code 2. */

/* --format table|json|csv as a child parser; its input is a cp_format*. */
extern const struct argp CP_ARGS_FORMAT;

/* The file that a command is about, as a child parser: the first word that is no option, unless the
 * command takes it itself. A second one, and none at the end, are errors. Its input is a
 * cp_args_input*. */
extern const struct argp CP_ARGS_INPUT;

typedef struct cp_args_input {
    const char *path;
    const char *one;     /* "one <database> at a time, found ... too" */
    const char *missing; /* "<which database? DB> is missing"; NULL: it may be */
} cp_args_input;

#define CP_ARGS_DATABASE                                                                           \
    {                                                                                              \
        .one = "database", .missing = "which database? DB"                                         \
    }
#define CP_ARGS_STUDY                                                                              \
    {                                                                                              \
        .one = "study file", .missing = "which study? STUDY.yaml"                                  \
    }

/* The error "<missing> is missing" unless the value is there. */
void cp_args_need(struct argp_state *state, bool is_there, const char *missing);

/* Read argument text of option name as a number in [smallest, largest]: the whole text, finite. */
double cp_args_number(struct argp_state *state, const char *name, const char *text, double smallest,
                      double largest, const char *unit);

/* The same for whole numbers. */
long cp_args_integer(struct argp_state *state, const char *name, const char *text, long smallest,
                     long largest);

/* Parse with argp; the program calls itself "crashpulse <command>" in messages. */
void cp_args_parse(const struct argp *argp, int argc, char **argv, void *input);

#endif
