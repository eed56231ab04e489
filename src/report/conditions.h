/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef REPORT_CONDITIONS_H
#define REPORT_CONDITIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* Conditions of an answer, in the order they come in: what holds for several treatments is said
 * once, with their names, or with what is each one's own. Zero-initialise, add, write, destroy. */
typedef struct cp_condition {
    char *text;        /* a sentence without its full stop, or its beginning */
    char *own;         /* how it ends for the first treatment; NULL: it is whole */
    char *of;          /* "aeb, elk", or "0.1 to 2 (aeb), 3 to 5 (elk)" */
    size_t treatments; /* how many these are */
} cp_condition;

typedef struct cp_conditions {
    size_t count;
    cp_condition *condition;
    bool failed; /* memory was short; what is written would not be all */
} cp_conditions;

/* text, own: as above; copied, NULL text: memory was short. */
void cp_conditions_add(cp_conditions *c, const char *treatment, const char *text, const char *own);

/* A sentence each, a blank behind it; whose it is stands before it unless it is everyone's. */
void cp_conditions_write(FILE *out, const cp_conditions *c, size_t treatments);
void cp_conditions_destroy(cp_conditions *c);

/* A text under way: begin, write to out, end. */
typedef struct cp_condition_draft {
    FILE *out;
    char *text;
    size_t size;
} cp_condition_draft;

/* False when memory is short; then there is nothing to end. */
bool cp_condition_begin(cp_condition_draft *d, cp_conditions *c);

/* Add what was written, an empty text not at all; stem: what it is the end of, NULL: nothing. */
void cp_condition_end(cp_condition_draft *d, cp_conditions *c, const char *treatment,
                      const char *stem);

#endif
