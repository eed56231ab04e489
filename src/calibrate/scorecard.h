/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_SCORECARD_H
#define CALIBRATE_SCORECARD_H

#include "calibrate/suite.h"
#include "crash/vehicle_model.h"

/* How far vehicle models lie from a suite of crash tests: one row a class, vehicle and quantity. */

/* X(name, text) */
#define CP_SCORECARD_VERDICTS(X)                                                                   \
    X(CP_SCORECARD_KEPT, "kept")                                                                   \
    X(CP_SCORECARD_MISSED, "missed")                                                               \
    X(CP_SCORECARD_NO_BAR, "no bar")                                                               \
    X(CP_SCORECARD_SKIPPED, "skipped")
typedef enum cp_scorecard_verdict {
#define CP_SCORECARD_VERDICT_NAME(name, text) name,
    CP_SCORECARD_VERDICTS(CP_SCORECARD_VERDICT_NAME)
#undef CP_SCORECARD_VERDICT_NAME
} cp_scorecard_verdict;
/* "kept", "missed", "no bar", "skipped". */
const char *cp_scorecard_verdict_text(cp_scorecard_verdict verdict);

/* One case of a row. What there is not is NAN. */
typedef struct cp_scorecard_case {
    char label[112];
    double time_ms;   /* of a timed quantity */
    double reference; /* in the quantity's unit, as low, high and model */
    double low;       /* corridor: NAN is open */
    double high;
    double model;  /* NAN: could not be simulated */
    double error;  /* model - reference, or that in per cent of the reference */
    bool is_range; /* low and high are the model's own, over the offsets a test may have had */
    bool has_corridor;
    bool inside; /* the model is in the test's corridor, or the test in the model's range */
} cp_scorecard_case;

typedef struct cp_scorecard_row {
    const cp_suite_class *class; /* of the suite */
    const cp_suite_comparison *comparison;
    char vehicle[64];
    const char *quantity;     /* static text */
    const char *error_unit;   /* likewise: "%" where errors are relative */
    cp_scorecard_case *cases; /* owned */
    size_t case_count;
    size_t failed_count;
    double reference; /* means over the cases */
    double model;
    double bias;     /* mean error */
    double mean_abs; /* of the errors */
    double median_abs;
    double p90_abs;
    double max_abs;
    double max_step; /* largest change of the model's value from case to case */
    double inside_1; /* NAN: no corridor */
    char bar[128];
    cp_scorecard_verdict verdict;
    char note[320]; /* why skipped, what failed */
} cp_scorecard_row;

typedef struct cp_scorecard {
    cp_scorecard_row *row; /* owned */
    size_t count;
} cp_scorecard;

typedef struct cp_scorecard_request {
    const cp_suite *suite;
    const char *const *vehicles; /* names or paths; none: those of the suite */
    size_t vehicle_count;
    const char *references; /* folder of the reference tables */
    int threads;
} cp_scorecard_request;

/* Simulate and judge everything; cp_crash_library_begin must have been called. The result does not
 * depend on threads. Errors: CP_BAD_INPUT (a vehicle, a table, a number of values that does not fit
 * the cases), CP_NO_MEMORY, CP_RUN_FAILED. The caller destroys, also after an error; the suite must
 * live as long. */
CP_MUST_CHECK cp_status cp_scorecard_make(const cp_scorecard_request *request,
                                          cp_scorecard *scorecard, cp_error *error);
void cp_scorecard_destroy(cp_scorecard *scorecard);

/* Figures, bar in words and verdict of a row whose cases have their model values. */
CP_MUST_CHECK cp_status cp_scorecard_judge(cp_scorecard_row *row, cp_error *error);

#endif
