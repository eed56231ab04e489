/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STATS_RAKING_H
#define STATS_RAKING_H

#include "core/error.h"

#include <stdbool.h>
#include <stddef.h>

/* Weights that give a sample the margins of a population: each unit has a class of every margin, or
 * none known; its weight is a factor of each of its classes, found by adjusting one margin after
 * the other until all hold (raking, iterative proportional fitting: Deming and Stephan 1940). A
 * class that is not known leaves a weight alone. */

enum {
    CP_RAKING_MARGINS_MAX = 4,
    CP_RAKING_CLASSES_MAX = 16,
    CP_RAKING_ROUNDS_MAX = 200,
    CP_RAKING_UNKNOWN = 255 /* as a class */
};

/* A margin of the population. */
typedef struct cp_raking_margin {
    size_t count;                         /* classes, <= CP_RAKING_CLASSES_MAX */
    double target[CP_RAKING_CLASSES_MAX]; /* share of each, >= 0, sum 1 */
    bool ordered;                         /* class k lies between k - 1 and k + 1 */
} cp_raking_margin;

typedef struct cp_raking {
    size_t count; /* margins */
    cp_raking_margin margin[CP_RAKING_MARGINS_MAX];
    double cap; /* no weight is larger than this times the mean; INFINITY: none. > 1 */
} cp_raking;

/* Classes of one unit, one a margin. */
typedef struct cp_raking_classes {
    unsigned char of[CP_RAKING_MARGINS_MAX]; /* < margin count, or CP_RAKING_UNKNOWN */
} cp_raking_classes;

/* The outcome for one sample. Weights have the mean 1 over it. */
typedef struct cp_raking_factors {
    double factor[CP_RAKING_MARGINS_MAX][CP_RAKING_CLASSES_MAX]; /* NAN: no unit of the sample */
    double scale;                                                /* before the cap */
    double cap;                                                  /* of scaled weights */
    size_t rounds;
    double gap_1; /* largest difference of a margin's weighted share from its target (rescaled to
                     the classes the sample has) that is left, by the cap or without convergence */
} cp_raking_factors;

/* Number of combinations of classes, unknown ones included, and the place of one among them. */
size_t cp_raking_cells(const cp_raking *raking);
size_t cp_raking_cell(const cp_raking *raking, const cp_raking_classes *classes);

/* Rake a sample that has units[c] units (>= 0, need not be whole) in combination c. Classes without
 * a unit drop out, the targets of the others are rescaled. room: cp_raking_cells(raking) numbers,
 * overwritten with the weight of each combination (as cp_raking_weight; 1 where nothing is known).
 * Without a unit all weights are 1. */
void cp_raking_rake(const cp_raking *raking, const double *units, double *room,
                    cp_raking_factors *factors);

/* Weight of a unit of these classes, also of one that the sample had not: a class without a factor
 * takes the one of the nearest class that has one where classes are ordered, else 1. */
double cp_raking_weight(const cp_raking *raking, const cp_raking_factors *factors,
                        const cp_raking_classes *classes);

#endif
