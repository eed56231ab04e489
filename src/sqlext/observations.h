/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef SQLEXT_OBSERVATIONS_H
#define SQLEXT_OBSERVATIONS_H

#include <stdbool.h>
#include <stddef.h>

/* The numbers an aggregate has seen, and what can be said of them. No SQLite in here. A left-
 * censored observation is -INFINITY. Zero-initialise, add, destroy. */
typedef struct cp_observations {
    double *value; /* in order of arrival, from first on; the oldest may be taken away again */
    size_t first;
    size_t count; /* of values from first on */
    size_t room;
    double *sorted;     /* the same in order; valid while is_sorted */
    size_t sorted_room; /* kept up to date one by one once somebody asked between two changes */
    bool is_sorted;
} cp_observations;

/* Add one; false when memory is gone. */
bool cp_observations_add(cp_observations *observations, double value);
/* Take the oldest away; nothing happens when there is none. */
void cp_observations_drop_oldest(cp_observations *observations);
void cp_observations_destroy(cp_observations *observations);

/* The values in ascending order, until the next change; NULL when memory is gone or there is none.
 */
const double *cp_observations_sorted(cp_observations *observations);

/* Quantile p (0 ... 1) of count ascending values by linear interpolation between order statistics
 * (Hyndman and Fan's type 7); -INFINITY when a censored one takes part, NAN of nothing. */
double cp_sorted_quantile(const double *sorted, size_t count, double p);

/* Cliff's delta P(b > a) - P(b < a) of two ascending samples, censored ones tied with each other;
 * NAN when either is empty. */
double cp_sorted_cliffs_delta(const double *a, size_t a_count, const double *b, size_t b_count);

/* Largest distance of the two empirical distribution functions; NAN when either is empty. */
double cp_sorted_ks_distance(const double *a, size_t a_count, const double *b, size_t b_count);

#endif
