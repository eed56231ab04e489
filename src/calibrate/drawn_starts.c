/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/drawn_starts.h"

#include "core/rng.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { DRAWS = 8, FIRST_SHARE = 8, LEFT_OF = 4 };

/* A point and its value; values first, to be sorted by. */
typedef struct drawn_start {
    double value;
    double *point;
} drawn_start;

static int by_value(const void *one, const void *other)
{
    double a = ((const drawn_start *)one)->value, b = ((const drawn_start *)other)->value;
    return (a > b) - (a < b);
}

// The best of a few points half of the way from what is known to anywhere; number: of the start.
static void draw(const cp_drawn_starts *starts, cp_rng_key key, size_t number, double *trial,
                 drawn_start *start)
{
    size_t n = starts->dimension;
    start->value = INFINITY;
    for (size_t k = 0; k < DRAWS; k++) {
        for (size_t j = 0; j < n; j++) {
            double anywhere = cp_rng_uniform(key, (number * DRAWS + k) * n + j);
            trial[j] = 0.5 * (starts->known[j] + anywhere);
        }
        double value = starts->value(starts->context, trial, n);
        if (k == 0 || value < start->value) {
            start->value = value;
            memcpy(start->point, trial, n * sizeof *trial);
        }
    }
}

static cp_status descend_all(const cp_drawn_starts *starts, drawn_start *start, size_t count,
                             size_t evaluations)
{
    cp_status status = CP_OK;
    for (size_t s = 0; status == CP_OK && s < count; s++) {
        status = starts->descend(starts->context, evaluations, start[s].point);
        if (status == CP_OK)
            start[s].value = starts->value(starts->context, start[s].point, starts->dimension);
    }
    return status;
}

cp_status cp_drawn_starts_search(const cp_drawn_starts *starts, double *point, cp_error *error)
{
    size_t n = starts->dimension, left = starts->count;
    drawn_start *start = calloc(left, sizeof *start);
    double *points = calloc((left + 1) * n, sizeof *points);
    if (start == NULL || points == NULL) {
        free(start);
        free(points);
        return cp_fail_memory(error, "starts of a search");
    }

    // The known point first, then those drawn; the last row is for trials.
    cp_rng_key key = cp_rng_key_text(cp_rng_key_seed(starts->seed), "starts");
    for (size_t s = 0; s < left; s++)
        start[s].point = points + s * n;
    memcpy(start[0].point, starts->known, n * sizeof *points);
    for (size_t s = 1; s < left; s++)
        draw(starts, key, s, points + starts->count * n, &start[s]);

    // Round by round fewer and further.
    cp_status status = CP_OK;
    size_t share = FIRST_SHARE;
    for (; status == CP_OK && left > 1; share = share > 1 ? share / 2 : 1) {
        status = descend_all(starts, start, left, starts->evaluations / share);
        qsort(start, left, sizeof *start, by_value);
        left = (left + LEFT_OF - 1) / LEFT_OF;
    }
    if (status == CP_OK)
        status = descend_all(starts, start, 1, starts->evaluations);
    memcpy(point, start[0].point, n * sizeof *points);
    free(start);
    free(points);
    return status;
}
