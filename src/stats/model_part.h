/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STATS_MODEL_PART_H
#define STATS_MODEL_PART_H

#include "stats/bootstrap.h"
#include "stats/describe.h"

/* What a figure owes to the model behind it. The figure is computed anew by every parameter set of
 * the model's ensemble, each time for all crashes: a set that is wrong is wrong for all of them, so
 * the scatter of the figures over the sets does not shrink with more crashes or replications. */
typedef struct cp_model_part {
    size_t sets;               /* 0: not asked for, nothing else is set */
    cp_estimate estimate;      /* by the model's own parameters */
    cp_interval replications;  /* of the estimate, from replications alone */
    cp_interval_status status; /* whether the model's part is known: CP_INTERVAL_VALUE;
                                  CP_INTERVAL_CENSORED when the estimate, or the figure by a set, is
                                  left-censored; CP_INTERVAL_UNDEFINED when it does not exist */
    double mean;               /* over the sets; NAN without, like the next two */
    double sd;                 /* over the sets, n - 1 */
    double half_width;         /* of 95 %: sd times Student's t of sets - 1 degrees of freedom */
    cp_interval combined; /* either side sqrt(replications^2 + half_width^2) from the estimate; has
                             the status of the part that is missing */
} cp_model_part;

/* The part of a figure whose value by each of sets >= 2 parameter sets is of_set[0 ... sets - 1].
 * The half-width takes the truth for one more draw around the estimate, with the spread the sets
 * show. Coverage: tests/stats/test_model_part.c. */
cp_model_part cp_model_part_of(cp_estimate estimate, cp_interval replications,
                               const cp_estimate *of_set, size_t sets);

#endif
