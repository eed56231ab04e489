/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/raking.h"

#include <math.h>

#define CLOSE_ENOUGH 1e-10

size_t cp_raking_cells(const cp_raking *raking)
{
    size_t cells = 1;
    for (size_t m = 0; m < raking->count; m++)
        cells *= raking->margin[m].count + 1;
    return cells;
}

size_t cp_raking_cell(const cp_raking *raking, const cp_raking_classes *classes)
{
    // The last class of each margin stands for unknown.
    size_t cell = 0;
    for (size_t m = 0; m < raking->count; m++) {
        size_t count = raking->margin[m].count, own = classes->of[m];
        cell = cell * (count + 1) + (own < count ? own : count);
    }
    return cell;
}

static cp_raking_classes classes_of(const cp_raking *raking, size_t cell)
{
    cp_raking_classes classes = {0};
    for (size_t m = raking->count; m-- > 0;) {
        size_t count = raking->margin[m].count, own = cell % (count + 1);
        classes.of[m] = own < count ? (unsigned char)own : CP_RAKING_UNKNOWN;
        cell /= count + 1;
    }
    return classes;
}

// How many combinations lie between one class of a margin and the next.
static size_t stride_of(const cp_raking *raking, size_t margin)
{
    size_t stride = 1;
    for (size_t m = margin + 1; m < raking->count; m++)
        stride *= raking->margin[m].count + 1;
    return stride;
}

/* Weighted units of each class of one margin, and in all. */
typedef struct sums {
    double of[CP_RAKING_CLASSES_MAX];
    double known;
    double target; /* of the classes that are there */
} sums;

static sums sum_margin(const cp_raking *raking, size_t margin, const double *units,
                       const double *weight)
{
    sums s = {{0.0}, 0.0, 0.0};
    const cp_raking_margin *m = &raking->margin[margin];
    bool there[CP_RAKING_CLASSES_MAX] = {false};
    size_t stride = stride_of(raking, margin), cells = cp_raking_cells(raking);
    for (size_t c = 0; c < cells; c++) {
        size_t own = c / stride % (m->count + 1);
        if (own == m->count || !(units[c] > 0.0))
            continue;
        s.of[own] += units[c] * weight[c];
        s.known += units[c] * weight[c];
        there[own] = true;
    }
    for (size_t k = 0; k < m->count; k++)
        s.target += there[k] ? m->target[k] : 0.0;
    return s;
}

// One margin made to hold; returns the largest change of a factor.
static double adjust(const cp_raking *raking, size_t margin, const double *units, double *weight,
                     cp_raking_factors *factors)
{
    const cp_raking_margin *m = &raking->margin[margin];
    sums s = sum_margin(raking, margin, units, weight);
    double change[CP_RAKING_CLASSES_MAX], largest = 0.0;
    if (!(s.known > 0.0) || !(s.target > 0.0))
        return 0.0;
    for (size_t k = 0; k < m->count; k++) {
        change[k] = s.of[k] > 0.0 ? m->target[k] / s.target * s.known / s.of[k] : 1.0;
        factors->factor[margin][k] *= change[k];
        largest = fmax(largest, fabs(change[k] - 1.0));
    }
    size_t stride = stride_of(raking, margin), cells = cp_raking_cells(raking);
    for (size_t c = 0; c < cells; c++) {
        size_t own = c / stride % (m->count + 1);
        weight[c] *= own < m->count ? change[own] : 1.0;
    }
    return largest;
}

static double largest_gap(const cp_raking *raking, const double *units, const double *weight)
{
    double gap = 0.0;
    for (size_t m = 0; m < raking->count; m++) {
        sums s = sum_margin(raking, m, units, weight);
        for (size_t k = 0; k < raking->margin[m].count; k++)
            if (s.known > 0.0 && s.target > 0.0 && s.of[k] > 0.0)
                gap = fmax(gap, fabs(s.of[k] / s.known - raking->margin[m].target[k] / s.target));
    }
    return gap;
}

static double mean_weight(const double *units, const double *weight, size_t cells)
{
    double sum = 0.0, all = 0.0;
    for (size_t c = 0; c < cells; c++) {
        sum += units[c] > 0.0 ? units[c] * weight[c] : 0.0;
        all += units[c];
    }
    return all > 0.0 && sum > 0.0 ? sum / all : 1.0;
}

// The scale at which weights, cut at the cap, have the mean 1: what is cut off goes to the others,
// until nothing is left to give. Where too few have any weight the mean stays below 1.
static void find_scale(const double *units, const double *weight, size_t cells,
                       cp_raking_factors *factors)
{
    factors->scale = 1.0 / mean_weight(units, weight, cells);
    for (int round = 0; isfinite(factors->cap) && round < CP_RAKING_ROUNDS_MAX; round++) {
        double sum = 0.0, all = 0.0;
        for (size_t c = 0; c < cells; c++) {
            sum += units[c] > 0.0 ? units[c] * fmin(factors->cap, factors->scale * weight[c]) : 0.0;
            all += units[c];
        }
        if (!(sum > 0.0) || sum >= all * (1.0 - CLOSE_ENOUGH))
            break;
        factors->scale *= all / sum;
    }
}

// Factors of classes that the sample has not are unknown, those of classes with units stay.
static void forget_empty(const cp_raking *raking, const double *units, cp_raking_factors *factors)
{
    bool there[CP_RAKING_MARGINS_MAX][CP_RAKING_CLASSES_MAX] = {{false}};
    size_t cells = cp_raking_cells(raking);
    for (size_t c = 0; c < cells; c++) {
        cp_raking_classes own = classes_of(raking, c);
        for (size_t m = 0; units[c] > 0.0 && m < raking->count; m++)
            if (own.of[m] != CP_RAKING_UNKNOWN)
                there[m][own.of[m]] = true;
    }
    for (size_t m = 0; m < raking->count; m++)
        for (size_t k = 0; k < raking->margin[m].count; k++)
            if (!there[m][k])
                factors->factor[m][k] = NAN;
}

void cp_raking_rake(const cp_raking *raking, const double *units, double *room,
                    cp_raking_factors *factors)
{
    size_t cells = cp_raking_cells(raking);
    *factors = (cp_raking_factors){.scale = 1.0, .cap = raking->cap};
    for (size_t c = 0; c < cells; c++)
        room[c] = 1.0;
    for (size_t m = 0; m < raking->count; m++)
        for (size_t k = 0; k < raking->margin[m].count; k++)
            factors->factor[m][k] = 1.0;

    // Round by round until no factor moves.
    double moved = INFINITY;
    while (moved > CLOSE_ENOUGH && factors->rounds < CP_RAKING_ROUNDS_MAX) {
        moved = 0.0;
        for (size_t m = 0; m < raking->count; m++)
            moved = fmax(moved, adjust(raking, m, units, room, factors));
        factors->rounds++;
    }
    forget_empty(raking, units, factors);

    find_scale(units, room, cells, factors);
    for (size_t c = 0; c < cells; c++) {
        cp_raking_classes own = classes_of(raking, c);
        room[c] = cp_raking_weight(raking, factors, &own);
    }
    factors->gap_1 = largest_gap(raking, units, room);
}

// Factor of the nearest class that has one; of two equally near the lower one.
static double factor_of(const cp_raking_margin *margin, const double *factor, size_t own)
{
    if (!isnan(factor[own]))
        return factor[own];
    for (size_t away = 1; margin->ordered && away < margin->count; away++) {
        if (own >= away && !isnan(factor[own - away]))
            return factor[own - away];
        if (own + away < margin->count && !isnan(factor[own + away]))
            return factor[own + away];
    }
    return 1.0;
}

double cp_raking_weight(const cp_raking *raking, const cp_raking_factors *factors,
                        const cp_raking_classes *classes)
{
    double weight = factors->scale;
    for (size_t m = 0; m < raking->count; m++)
        if (classes->of[m] < raking->margin[m].count)
            weight *= factor_of(&raking->margin[m], factors->factor[m], classes->of[m]);
    return fmin(factors->cap, weight);
}
