/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sqlext/observations.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- collecting ----------------------------------------------------------------------------

static bool make_room(double **array, size_t *room, size_t needed)
{
    if (needed <= *room)
        return true;
    size_t larger = *room < 32 ? 64 : 2 * *room;
    double *moved = realloc(*array, larger * sizeof *moved);
    if (moved == NULL)
        return false;
    *array = moved;
    *room = larger;
    return true;
}

// First place in the sorted values that is not below value.
static size_t place_of(const cp_observations *o, double value)
{
    size_t low = 0, high = o->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (o->sorted[middle] < value)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

bool cp_observations_add(cp_observations *o, double value)
{
    // What a window has dropped makes room again.
    if (o->first > 0 && o->first + o->count == o->room) {
        memmove(o->value, o->value + o->first, o->count * sizeof *o->value);
        o->first = 0;
    }
    if (!make_room(&o->value, &o->room, o->first + o->count + 1))
        return false;
    o->value[o->first + o->count] = value;

    // Somebody asks after every change, as in a window: put it where it belongs.
    if (o->is_sorted) {
        if (!make_room(&o->sorted, &o->sorted_room, o->count + 1))
            return false;
        size_t place = place_of(o, value);
        memmove(o->sorted + place + 1, o->sorted + place, (o->count - place) * sizeof *o->sorted);
        o->sorted[place] = value;
    }
    o->count++;
    return true;
}

void cp_observations_drop_oldest(cp_observations *o)
{
    if (o->count == 0)
        return;
    if (o->is_sorted) {
        size_t place = place_of(o, o->value[o->first]);
        memmove(o->sorted + place, o->sorted + place + 1,
                (o->count - place - 1) * sizeof *o->sorted);
    }
    o->first++;
    o->count--;
}

void cp_observations_destroy(cp_observations *o)
{
    free(o->value);
    free(o->sorted);
    *o = (cp_observations){0};
}

static int ascending(const void *one, const void *other)
{
    double x = *(const double *)one, y = *(const double *)other;
    return (x > y) - (x < y);
}

const double *cp_observations_sorted(cp_observations *o)
{
    if (o->count == 0)
        return NULL;
    if (!o->is_sorted) {
        double *sorted = realloc(o->sorted, o->count * sizeof *sorted);
        if (sorted == NULL)
            return NULL;
        o->sorted = sorted;
        o->sorted_room = o->count;
        memcpy(sorted, o->value + o->first, o->count * sizeof *sorted);
        qsort(sorted, o->count, sizeof *sorted, ascending);
        o->is_sorted = true;
    }
    return o->sorted;
}

// ---- what can be said ----------------------------------------------------------------------

double cp_sorted_quantile(const double *sorted, size_t count, double p)
{
    if (count == 0)
        return NAN;
    double place = p * (double)(count - 1);
    size_t below = (size_t)floor(place);
    if (below >= count - 1)
        return sorted[count - 1];
    double share = place - (double)below;
    if (share == 0.0 || isinf(sorted[below]))
        return sorted[below];
    return sorted[below] + share * (sorted[below + 1] - sorted[below]);
}

double cp_sorted_cliffs_delta(const double *a, size_t a_count, const double *b, size_t b_count)
{
    if (a_count == 0 || b_count == 0)
        return NAN;
    // For every b the number of a below it, and of a not above it.
    size_t below = 0, not_above = 0;
    double sum = 0.0;
    for (size_t k = 0; k < b_count; k++) {
        while (below < a_count && a[below] < b[k])
            below++;
        while (not_above < a_count && a[not_above] <= b[k])
            not_above++;
        sum += (double)below - (double)(a_count - not_above);
    }
    return sum / (double)a_count / (double)b_count;
}

double cp_sorted_ks_distance(const double *a, size_t a_count, const double *b, size_t b_count)
{
    if (a_count == 0 || b_count == 0)
        return NAN;
    size_t i = 0, j = 0;
    double largest = 0.0;
    while (i < a_count && j < b_count) {
        double value = a[i] < b[j] ? a[i] : b[j];
        while (i < a_count && a[i] <= value)
            i++;
        while (j < b_count && b[j] <= value)
            j++;
        double distance = fabs((double)i / (double)a_count - (double)j / (double)b_count);
        if (distance > largest)
            largest = distance;
    }
    return largest;
}
