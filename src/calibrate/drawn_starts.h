/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_DRAWN_STARTS_H
#define CALIBRATE_DRAWN_STARTS_H

#include "calibrate/optimiser.h"

/* A search for the lowest value from several points of 0..1 coordinates. The first point is what is
 * known; every other lies half of the way from there to a point drawn anywhere, the best of eight
 * draws. All go down with an eighth of the evaluations. Then one of two ways:
 *
 * without offspring most are given up early (successive halving: Karnin, Koren and Somekh 2013,
 * here by quarters): the best quarter goes on with a quarter of the evaluations, and so on until
 * one is left;
 *
 * with offspring the best eight are parents. Two of them, the better the likelier the first, have a
 * child: every coordinate drawn between theirs or a quarter of their distance beyond (blend
 * crossover: Eshelman and Schaffer 1993), the best of eight draws. It goes down with an eighth of
 * the evaluations as well and takes the place of the worst parent it is better than (a memetic
 * search: Moscato 1989), so many children one after the other.
 *
 * What is best in the end goes down with all of the evaluations. */
typedef struct cp_drawn_starts {
    cp_optimiser_function value;
    /* Improve point in place by evaluations calls of value, about. */
    cp_status (*descend)(void *context, size_t evaluations, double *point);
    void *context;
    const double *known; /* dimension coordinates */
    size_t dimension;
    size_t count;     /* of points, >= 1 */
    size_t offspring; /* children, 0: none; needs two points */
    size_t evaluations;
    uint32_t seed; /* of the draws; the same seed, the same result */
} cp_drawn_starts;

/* How often such a search descends. */
size_t cp_drawn_starts_descents(size_t count, size_t offspring);

/* point receives the best that was found. Errors: those of descend; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_drawn_starts_search(const cp_drawn_starts *starts, double *point,
                                               cp_error *error);

#endif
