/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_NEIGHBOURHOOD_H
#define CONTROL_NEIGHBOURHOOD_H

#include "traffic/traffic.h"

/* Where a vehicle's front is. */
typedef struct cp_neighbour {
    double x_m, y_m;
    uint32_t next; /* row of the next vehicle of the bucket */
} cp_neighbour;

/* Who is near whom: vehicles sorted into square cells by front position, so that a look round costs
 * what stands there and not what drives in the whole network. */
typedef struct cp_neighbourhood {
    double cell_m;
    const cp_vehicle_motion *motions; /* borrowed until the next fill */
    uint32_t *first;                  /* by bucket: row of the first vehicle, or CP_NO_NUMBER */
    cp_neighbour *neighbour;          /* by row */
    size_t buckets;                   /* power of two */
    size_t capacity;                  /* of neighbour */
} cp_neighbourhood;

/* Zero-initialise, fill in every step, clear at the end. cell_m > 0 is the largest distance looked
 * for. */
CP_MUST_CHECK cp_status cp_neighbourhood_fill(cp_neighbourhood *neighbourhood, double cell_m,
                                              const cp_vehicle_motion *motions, size_t count,
                                              cp_error *error);
void cp_neighbourhood_clear(cp_neighbourhood *neighbourhood);

/* Call visit for every vehicle whose front is within cell_m of (x, y), in no particular order. */
void cp_neighbourhood_visit(const cp_neighbourhood *neighbourhood, double x_m, double y_m,
                            void (*visit)(void *context, const cp_vehicle_motion *motion),
                            void *context);

/* Square of the distance of two fronts: who looks at all others every step compares squares. */
static inline double cp_front_distance_m2(const cp_vehicle_motion *one,
                                          const cp_vehicle_motion *other)
{
    double x_m = other->after.front_x_m - one->after.front_x_m;
    double y_m = other->after.front_y_m - one->after.front_y_m;
    return x_m * x_m + y_m * y_m;
}

#endif
