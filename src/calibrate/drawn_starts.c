/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/drawn_starts.h"

#include "core/rng.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { DRAWS = 8, FIRST_SHARE = 8, LEFT_OF = 4, PARENTS = 8 };
// How far beyond its parents a child may lie, in their distance.
static const double BEYOND_1 = 0.25;

/* A point and its value; values first, to be sorted by. */
typedef struct drawn_start {
    double value;
    double *point;
} drawn_start;

/* One search: its points, the best first when sorted, and room for two more. */
typedef struct drawn_search {
    const cp_drawn_starts *settings;
    drawn_start *start;
    double *trial;
    double *child;
    double *points; /* of all of the above */
} drawn_search;

static int by_value(const void *one, const void *other)
{
    double a = ((const drawn_start *)one)->value, b = ((const drawn_start *)other)->value;
    return (a > b) - (a < b);
}

static void sort(drawn_search *search, size_t count)
{
    qsort(search->start, count, sizeof *search->start, by_value);
}

static double value_of(const drawn_search *search, const double *point)
{
    const cp_drawn_starts *s = search->settings;
    return s->value(s->context, point, s->dimension);
}

/* Coordinate j of a point somewhere between two, u: 0..1. */
typedef double (*between)(double one, double other, double u);

// Half of the way from what is known to anywhere.
static double around(double known, double unused, double u)
{
    (void)unused;
    return 0.5 * (known + u);
}

static double blend(double one, double other, double u)
{
    double share_1 = (1.0 + 2.0 * BEYOND_1) * u - BEYOND_1;
    return fmin(1.0, fmax(0.0, one + share_1 * (other - one)));
}

// The best of a few points drawn between two; number: how many of this key came before.
static void draw(drawn_search *search, cp_rng_key key, size_t number, between where,
                 const double *one, const double *other, drawn_start *drawn)
{
    size_t n = search->settings->dimension;
    drawn->value = INFINITY;
    for (size_t k = 0; k < DRAWS; k++) {
        for (size_t j = 0; j < n; j++)
            search->trial[j] =
                where(one[j], other[j], cp_rng_uniform(key, (number * DRAWS + k) * n + j));
        double value = value_of(search, search->trial);
        if (k == 0 || value < drawn->value) {
            drawn->value = value;
            memcpy(drawn->point, search->trial, n * sizeof *search->trial);
        }
    }
}

static cp_status descend(const drawn_search *search, size_t evaluations, drawn_start *start)
{
    const cp_drawn_starts *s = search->settings;
    cp_status status = s->descend(s->context, evaluations, start->point);
    if (status == CP_OK)
        start->value = value_of(search, start->point);
    return status;
}

static cp_status descend_all(drawn_search *search, size_t count, size_t evaluations)
{
    cp_status status = CP_OK;
    for (size_t s = 0; status == CP_OK && s < count; s++)
        status = descend(search, evaluations, &search->start[s]);
    sort(search, count);
    return status;
}

// The known point first, then those drawn around it.
static void draw_starts(drawn_search *search)
{
    const cp_drawn_starts *s = search->settings;
    cp_rng_key key = cp_rng_key_text(cp_rng_key_seed(s->seed), "starts");
    memcpy(search->start[0].point, s->known, s->dimension * sizeof *s->known);
    for (size_t k = 1; k < s->count; k++)
        draw(search, key, k, around, s->known, s->known, &search->start[k]);
}

static size_t left_of(size_t count)
{
    return (count + LEFT_OF - 1) / LEFT_OF;
}

size_t cp_drawn_starts_descents(size_t count, size_t offspring)
{
    size_t descents = 1;
    if (offspring > 0 && count > 1)
        return count + offspring + descents;
    for (size_t left = count; left > 1; left = left_of(left))
        descents += left;
    return descents;
}

// Round by round fewer and further.
static cp_status narrow_down(drawn_search *search)
{
    cp_status status = CP_OK;
    size_t left = search->settings->count, share = FIRST_SHARE;
    for (; status == CP_OK && left > 1; share = share > 1 ? share / 2 : 1) {
        status = descend_all(search, left, search->settings->evaluations / share);
        left = left_of(left);
    }
    return status;
}

// A child of two of the parents, at the bottom of its slope.
static cp_status bear(drawn_search *search, cp_rng_key key, size_t parents, drawn_start *child)
{
    // The first the likelier the better it is, the other any other.
    double luck_1 = cp_rng_uniform(key, 0);
    size_t one = (size_t)(luck_1 * luck_1 * (double)parents);
    size_t other = (size_t)(cp_rng_uniform(key, 1) * (double)(parents - 1));
    other += other >= one;
    draw(search, cp_rng_key_text(key, "draws"), 0, blend, search->start[one].point,
         search->start[other].point, child);
    return descend(search, search->settings->evaluations / FIRST_SHARE, child);
}

// Child after child; each takes the place of the worst parent if it is better.
static cp_status breed(drawn_search *search)
{
    const cp_drawn_starts *s = search->settings;
    size_t parents = s->count < PARENTS ? s->count : PARENTS;
    cp_rng_key key = cp_rng_key_text(cp_rng_key_seed(s->seed), "offspring");
    cp_status status = descend_all(search, s->count, s->evaluations / FIRST_SHARE);
    for (size_t k = 0; status == CP_OK && k < s->offspring; k++) {
        drawn_start child = {.point = search->child};
        status = bear(search, cp_rng_key_number(key, k), parents, &child);
        drawn_start *worst = &search->start[parents - 1];
        if (status == CP_OK && child.value < worst->value) {
            memcpy(worst->point, child.point, s->dimension * sizeof *child.point);
            worst->value = child.value;
            sort(search, parents);
        }
    }
    return status;
}

cp_status cp_drawn_starts_search(const cp_drawn_starts *starts, double *point, cp_error *error)
{
    size_t n = starts->dimension, count = starts->count;
    drawn_search search = {.settings = starts,
                           .start = calloc(count, sizeof *search.start),
                           .points = calloc((count + 2) * n, sizeof *search.points)};
    cp_status status = CP_OK;
    if (search.start == NULL || search.points == NULL)
        status = cp_fail_memory(error, "starts of a search");
    if (status == CP_OK) {
        for (size_t s = 0; s < count; s++)
            search.start[s].point = search.points + s * n;
        search.trial = search.points + count * n;
        search.child = search.trial + n;
        draw_starts(&search);
        status = starts->offspring > 0 && count > 1 ? breed(&search) : narrow_down(&search);
        if (status == CP_OK)
            status = descend(&search, starts->evaluations, &search.start[0]);
        memcpy(point, search.start[0].point, n * sizeof *point);
    }
    free(search.start);
    free(search.points);
    return status;
}
