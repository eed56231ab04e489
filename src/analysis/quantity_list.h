/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_QUANTITY_LIST_H
#define ANALYSIS_QUANTITY_LIST_H

#include "analysis/figures.h"

/* A comparison as a flat list of named figures: what tables print, CSV holds, and the database
 * stores. */

#define CP_QUANTITY_TEXT_SIZE 96

typedef struct cp_quantity {
    char name[CP_QUANTITY_TEXT_SIZE];  /* with its unit, of CSV and database: "olc_median_g" */
    char label[CP_QUANTITY_TEXT_SIZE]; /* of the table; empty: not there */
    bool second;                       /* another interval of the row above: no line of its own */
    const char *section;               /* heading of the table it belongs under; NULL: none */
    int scope;                         /* CP_SCOPE_..., -1: does not matter */
    int digits;                        /* of the table, after the point */
    double factor;                     /* table's unit over the value's: 3.6 for km/h */
    const char *kind;    /* of the interval: "bootstrap", "poisson widened", …; NULL: none */
    const char *missing; /* why there is no value, of a test; NULL: nothing to say */
    cp_interval interval;
    cp_estimate estimate;
} cp_quantity;

/* Zero-initialise; after a failed addition go on, failed tells. */
typedef struct cp_quantities {
    cp_quantity *row;
    size_t count;
    bool failed;       /* memory is gone */
    cp_quantity spare; /* what is lost then is written here */
} cp_quantities;

void cp_quantities_destroy(cp_quantities *list);

/* Append a row of zeroes for the caller to fill. Valid until the next is appended; of a failed
 * addition it is the spare one, and lost. */
cp_quantity *cp_quantities_append(cp_quantities *list);

/* Append one figure, for files of figures beside this one: without scope and interval, exactly
 * value, factor the table's unit over the value's. label "": not in the table. Valid until the next
 * is appended; what is set in it after a failed addition is lost. */
cp_quantity *cp_quantities_add(cp_quantities *list, const char *section, const char *name,
                               const char *label, int digits, double factor, double value);

/* A name or label of parts, cut at the end; returns text. */
const char *cp_quantity_text(char text[CP_QUANTITY_TEXT_SIZE], const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* A severity in the unit of the table, rid of what converting left behind. */
double cp_quantity_rounded(double x);
/* What the interval of injured drivers by a risk function holds: static text. */
const char *cp_injury_kind(const cp_study_risk *risk);

/* "", "=", "<", ">". */
const char *cp_relation_text(cp_relation relation);

#endif
