/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/neighbourhood.h"

#include <math.h>
#include <stdlib.h>

typedef struct cell {
    int64_t x;
    int64_t y;
} cell;

static cell cell_of(const cp_neighbourhood *neighbourhood, double x_m, double y_m)
{
    return (cell){(int64_t)floor(x_m / neighbourhood->cell_m),
                  (int64_t)floor(y_m / neighbourhood->cell_m)};
}

static size_t bucket_of(const cp_neighbourhood *neighbourhood, cell at)
{
    uint64_t mixed = (uint64_t)at.x * UINT64_C(0x9e3779b97f4a7c15) ^
                     (uint64_t)at.y * UINT64_C(0xc2b2ae3d27d4eb4f);
    return (size_t)(mixed ^ mixed >> 32) & (neighbourhood->buckets - 1);
}

static cp_status reserve(cp_neighbourhood *neighbourhood, size_t count, cp_error *error)
{
    if (count <= neighbourhood->capacity)
        return CP_OK;
    // Twice as many buckets as vehicles at the most.
    size_t buckets = 64;
    while (buckets < 2 * count)
        buckets *= 2;
    cp_neighbourhood_clear(neighbourhood);
    neighbourhood->first = malloc(buckets * sizeof *neighbourhood->first);
    neighbourhood->neighbour = malloc(buckets / 2 * sizeof *neighbourhood->neighbour);
    if (!neighbourhood->first || !neighbourhood->neighbour) {
        cp_neighbourhood_clear(neighbourhood);
        return cp_fail_memory(error, "neighbourhood");
    }
    neighbourhood->buckets = buckets;
    neighbourhood->capacity = buckets / 2;
    return CP_OK;
}

cp_status cp_neighbourhood_fill(cp_neighbourhood *neighbourhood, double cell_m,
                                const cp_vehicle_motion *motions, size_t count, cp_error *error)
{
    cp_status status = reserve(neighbourhood, count, error);
    if (status != CP_OK)
        return status;
    neighbourhood->cell_m = cell_m;
    neighbourhood->motions = motions;
    for (size_t k = 0; k < neighbourhood->buckets; k++)
        neighbourhood->first[k] = CP_NO_NUMBER;
    for (size_t k = 0; k < count; k++) {
        const cp_vehicle_state *state = &motions[k].after;
        size_t bucket =
            bucket_of(neighbourhood, cell_of(neighbourhood, state->front_x_m, state->front_y_m));
        neighbourhood->neighbour[k] =
            (cp_neighbour){state->front_x_m, state->front_y_m, neighbourhood->first[bucket]};
        neighbourhood->first[bucket] = (uint32_t)k;
    }
    return CP_OK;
}

void cp_neighbourhood_clear(cp_neighbourhood *neighbourhood)
{
    free(neighbourhood->first);
    free(neighbourhood->neighbour);
    *neighbourhood = (cp_neighbourhood){0};
}

static bool is_in(const cp_neighbourhood *neighbourhood, cell at, const cp_neighbour *neighbour)
{
    cell own = cell_of(neighbourhood, neighbour->x_m, neighbour->y_m);
    return own.x == at.x && own.y == at.y;
}

void cp_neighbourhood_visit(const cp_neighbourhood *neighbourhood, double x_m, double y_m,
                            void (*visit)(void *context, const cp_vehicle_motion *motion),
                            void *context)
{
    if (neighbourhood->buckets == 0)
        return;
    cell centre = cell_of(neighbourhood, x_m, y_m);
    double farthest_m2 = neighbourhood->cell_m * neighbourhood->cell_m;
    for (int64_t dx = -1; dx <= 1; dx++) {
        for (int64_t dy = -1; dy <= 1; dy++) {
            cell at = {centre.x + dx, centre.y + dy};
            uint32_t row = neighbourhood->first[bucket_of(neighbourhood, at)];
            while (row != CP_NO_NUMBER) {
                const cp_neighbour *own = &neighbourhood->neighbour[row];
                double apart_x_m = own->x_m - x_m, apart_y_m = own->y_m - y_m;
                // Two cells can share a bucket: the cell is compared, so that none comes twice.
                if (apart_x_m * apart_x_m + apart_y_m * apart_y_m <= farthest_m2 &&
                    is_in(neighbourhood, at, own))
                    visit(context, &neighbourhood->motions[row]);
                row = own->next;
            }
        }
    }
}
