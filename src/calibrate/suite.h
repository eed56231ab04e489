/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_SUITE_H
#define CALIBRATE_SUITE_H

#include "calibrate/suite_quantity.h"
#include "crash/barrier.h"

#include <stddef.h>

/* A suite: classes of crash tests, the vehicles judged by them, what is compared and the bar.
 * Format: db/validation/README.md. */

enum { CP_SUITE_LIST_MAX = 256, CP_SUITE_TEXT_SIZE = 160, CP_SUITE_COMPARISONS_MAX = 16 };

typedef struct cp_suite_numbers {
    double *value; /* owned */
    size_t count;
} cp_suite_numbers;

typedef struct cp_suite_texts {
    char **text; /* owned */
    size_t count;
} cp_suite_texts;

/* Everything given must hold; NAN is not given. Errors are model minus reference, in the unit of
 * the quantity, in per cent of the reference where the comparison is relative. */
typedef struct cp_suite_bar {
    double inside_1; /* smallest share of cases within their corridor */
    double mean_abs; /* largest mean of the absolute errors; likewise median, 90 %, maximum */
    double median_abs;
    double p90_abs;
    double max_abs;
    double max_step;      /* largest change of the model's value from one case to the next */
    bool falling;         /* no case above the one before */
    bool last_is_highest; /* no case above the last */
} cp_suite_bar;

typedef struct cp_suite_comparison {
    cp_suite_quantity quantity;
    cp_suite_numbers times_ms;           /* instants of a timed quantity */
    char population[CP_SUITE_TEXT_SIZE]; /* of the quantiles; "": none */
    cp_suite_numbers reference;          /* one for all cases or one a case; empty: none */
    cp_suite_numbers low;                /* corridor, likewise */
    cp_suite_numbers high;
    bool relative;
    int car; /* of struck or a table of pairs: 1 or 2, this one only; 0: every one that has the
                quantity */
    cp_suite_bar bar;
} cp_suite_comparison;

/* Where the cases of a class come from. X(name, text) */
#define CP_SUITE_FORMS(X)                                                                          \
    X(CP_SUITE_LISTS, "lists")                                                                     \
    X(CP_SUITE_OLC, "olc")                                                                         \
    X(CP_SUITE_SEPARATION, "separation")                                                           \
    X(CP_SUITE_OBLIQUE, "oblique")                                                                 \
    X(CP_SUITE_RECONSTRUCTED, "reconstructed")                                                     \
    X(CP_SUITE_STRUCK, "reconstructed_struck")
typedef enum cp_suite_form {
#define CP_SUITE_FORM_NAME(name, text) name,
    CP_SUITE_FORMS(CP_SUITE_FORM_NAME)
#undef CP_SUITE_FORM_NAME
        CP_SUITE_FORM_COUNT
} cp_suite_form;

typedef struct cp_suite_class {
    char name[64];
    char title[CP_SUITE_TEXT_SIZE];
    char note[512];
    cp_suite_texts vehicles; /* empty: those of the suite */
    cp_suite_form form;
    char *table_path;             /* owned; NULL for lists */
    bool is_reference;            /* the table lies in the folder of references */
    cp_suite_texts rows_with;     /* separation: these barriers only; struck: these sides */
    cp_suite_numbers speeds_km_h; /* cases: every speed with every overlap, side and angle */
    cp_suite_numbers opponent_speeds_km_h; /* empty: the same; else one a speed */
    cp_suite_numbers overlaps_1;           /* share of the car's width; empty: middle on middle */
    cp_suite_numbers sides_1;              /* +1 left, -1 right */
    cp_suite_numbers angles_deg;
    bool has_barrier;
    cp_barrier barrier;
    /* The vehicle is struck on a side (sides_1) or its rear by the front of against or the barrier,
     * which drives at speeds_km_h. */
    bool is_struck;
    bool is_struck_on_rear;
    cp_suite_numbers struck_speeds_km_h; /* own, one a speed; empty: it stands */
    cp_suite_numbers at_mm;           /* where the middle of what strikes meets it, x on a side, y
                                       * on the rear, from its centre of gravity; empty: 0 */
    cp_suite_numbers struck_forces_1; /* times the forces of its side and rear; empty: 1 */
    cp_suite_texts against;           /* "same", shipped names or paths; empty: barrier only */
    cp_suite_comparison *comparison;  /* owned */
    size_t comparison_count;
} cp_suite_class;

typedef struct cp_suite {
    char *path;
    char name[64];
    char *quantiles_path; /* NULL: none */
    cp_suite_texts vehicles;
    cp_suite_class *class; /* owned */
    size_t class_count;
} cp_suite;

/* A zero-initialised one is fine too. */
void cp_suite_destroy(cp_suite *suite);

#endif
