/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/vehicle_choice.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LENGTH, WIDTH, HEIGHT, MASS, SIZE_COUNT };

typedef struct choice {
    const char *vehicle;
    bool takes_cars;
    bool takes_vans;
    double from[SIZE_COUNT];
    double to[SIZE_COUNT];
} choice;

static const choice CHOICE[] = {
#define ROW(vehicle, car, van, l0, l1, w0, w1, h0, h1, m0, m1)                                     \
    {#vehicle, car, van, {l0, w0, h0, m0}, {l1, w1, h1, m1}},
    CP_VEHICLE_CHOICES(ROW)
#undef ROW
};
#define CHOICE_COUNT (sizeof CHOICE / sizeof CHOICE[0])

static bool is_one_of(const char *word, const char *const *list, size_t count)
{
    for (size_t k = 0; k < count; k++)
        if (strcmp(word, list[k]) == 0)
            return true;
    return false;
}

static bool is_car_class(const char *vehicle_class)
{
    static const char *const CARS[] = {"passenger", "private", "taxi",     "evehicle",
                                       "hov",       "vip",     "authority"};
    return is_one_of(vehicle_class, CARS, sizeof CARS / sizeof CARS[0]);
}

static bool is_van(const char *vehicle_class)
{
    static const char *const VANS[] = {"delivery", "emergency"};
    return is_one_of(vehicle_class, VANS, sizeof VANS / sizeof VANS[0]);
}

static bool holds(const choice *row, const double size[SIZE_COUNT])
{
    for (int k = 0; k < SIZE_COUNT; k++)
        if (!isnan(size[k]) && !(size[k] >= row->from[k] && size[k] < row->to[k]))
            return false;
    return true;
}

const char *cp_vehicle_choose(const cp_vehicle_size *size, bool *is_car,
                              char reason[CP_CHOICE_REASON_SIZE])
{
    const double sizes[SIZE_COUNT] = {size->length_m, size->width_m, size->height_m, size->mass_kg};
    bool car = is_car_class(size->vehicle_class), van = is_van(size->vehicle_class);
    for (size_t k = 0; k < CHOICE_COUNT; k++) {
        *is_car = !CHOICE[k].takes_vans;
        if (((car && CHOICE[k].takes_cars) || (van && CHOICE[k].takes_vans)) &&
            holds(&CHOICE[k], sizes))
            return CHOICE[k].vehicle;
    }

    // In words: the class, or the sizes that are known.
    if (!car && !van) {
        snprintf(reason, CP_CHOICE_REASON_SIZE, "no shipped model of vClass %.40s",
                 size->vehicle_class);
        return NULL;
    }
    int used = snprintf(reason, CP_CHOICE_REASON_SIZE,
                        "no shipped model of vClass %.40s is %.4g m long, %.4g m wide",
                        size->vehicle_class, size->length_m, size->width_m);
    if (!isnan(size->height_m))
        used += snprintf(reason + used, CP_CHOICE_REASON_SIZE - (size_t)used, ", %.4g m high",
                         size->height_m);
    if (!isnan(size->mass_kg))
        snprintf(reason + used, CP_CHOICE_REASON_SIZE - (size_t)used, ", %.5g kg", size->mass_kg);
    return NULL;
}
