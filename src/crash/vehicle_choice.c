/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/vehicle_choice.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LENGTH, WIDTH, HEIGHT, MASS, SIZE_COUNT };

typedef struct choice {
    const char *vehicle;
    unsigned takes;
    double from[SIZE_COUNT];
    double to[SIZE_COUNT];
    double share_1;
} choice;

#define ROW(vehicle, takes, l0, l1, w0, w1, h0, h1, m0, m1)                                        \
    {#vehicle, takes, {l0, w0, h0, m0}, {l1, w1, h1, m1}, 1.0},
#define CLASS_ROW(vehicle, takes, l0, l1, w0, w1, h0, h1, m0, m1, share)                           \
    {#vehicle, takes, {l0, w0, h0, m0}, {l1, w1, h1, m1}, share},

static const choice CHOICE[] = {CP_VEHICLE_CHOICES(ROW)};
static const choice FLEET[] = {CP_FLEET_CLASSES(CLASS_ROW) CP_HEAVY_CHOICES(ROW)};
#define CHOICE_COUNT (sizeof CHOICE / sizeof CHOICE[0])
#define FLEET_COUNT (sizeof FLEET / sizeof FLEET[0])
#undef ROW
#undef CLASS_ROW

// What a vClass is; 0: nothing that has a model.
static unsigned takes_of(const char *vehicle_class)
{
    static const struct {
        const char *vehicle_class;
        unsigned takes;
    } OF_SUMO[] = {
        {"passenger", CP_TAKES_CAR}, {"private", CP_TAKES_CAR},   {"taxi", CP_TAKES_CAR},
        {"evehicle", CP_TAKES_CAR},  {"hov", CP_TAKES_CAR},       {"vip", CP_TAKES_CAR},
        {"authority", CP_TAKES_CAR}, {"delivery", CP_TAKES_VAN},  {"emergency", CP_TAKES_VAN},
        {"truck", CP_TAKES_TRUCK},   {"trailer", CP_TAKES_TRUCK}, {"bus", CP_TAKES_BUS},
        {"coach", CP_TAKES_BUS}};
    for (size_t k = 0; k < sizeof OF_SUMO / sizeof OF_SUMO[0]; k++)
        if (strcmp(vehicle_class, OF_SUMO[k].vehicle_class) == 0)
            return OF_SUMO[k].takes;
    return 0;
}

bool cp_vehicle_is_fleet_class(const char *name)
{
    for (size_t k = 0; k < FLEET_COUNT; k++)
        if (strcmp(name, FLEET[k].vehicle) == 0)
            return true;
    return false;
}

const char *cp_vehicle_fleet_classes(void)
{
    // The text begins with the separator of every name.
#define WORD(vehicle, ...) ", " #vehicle
    return &(CP_FLEET_CLASSES(WORD) CP_HEAVY_CHOICES(WORD))[2];
#undef WORD
}

static bool holds(const choice *row, const cp_vehicle_size *of)
{
    const double size[SIZE_COUNT] = {of->length_m, of->width_m, of->height_m, of->mass_kg};
    if ((row->takes & takes_of(of->vehicle_class)) == 0)
        return false;
    for (int k = 0; k < SIZE_COUNT; k++)
        if (!isnan(size[k]) && !(size[k] >= row->from[k] && size[k] < row->to[k]))
            return false;
    return true;
}

// In words: the class, or the sizes that are known.
static void say_none(const cp_vehicle_size *size, char reason[CP_CHOICE_REASON_SIZE])
{
    if (takes_of(size->vehicle_class) == 0) {
        snprintf(reason, CP_CHOICE_REASON_SIZE, "no shipped model of vClass %.40s",
                 size->vehicle_class);
        return;
    }
    int used = snprintf(reason, CP_CHOICE_REASON_SIZE,
                        "no shipped model of vClass %.40s is %.4g m long, %.4g m wide",
                        size->vehicle_class, size->length_m, size->width_m);
    if (!isnan(size->height_m))
        used += snprintf(reason + used, CP_CHOICE_REASON_SIZE - (size_t)used, ", %.4g m high",
                         size->height_m);
    if (!isnan(size->mass_kg))
        snprintf(reason + used, CP_CHOICE_REASON_SIZE - (size_t)used, ", %.5g kg", size->mass_kg);
}

const char *cp_vehicle_choose(const cp_vehicle_size *size, bool *is_car,
                              char reason[CP_CHOICE_REASON_SIZE])
{
    for (size_t k = 0; k < CHOICE_COUNT; k++) {
        *is_car = CHOICE[k].takes == CP_TAKES_CAR;
        if (holds(&CHOICE[k], size))
            return CHOICE[k].vehicle;
    }
    say_none(size, reason);
    return NULL;
}

const char *cp_vehicle_draw_class(const cp_vehicle_size *size, double uniform_1,
                                  char reason[CP_CHOICE_REASON_SIZE])
{
    double total = 0.0;
    for (size_t k = 0; k < FLEET_COUNT; k++)
        total += holds(&FLEET[k], size) ? FLEET[k].share_1 : 0.0;

    // The last row that holds it takes what rounding leaves.
    const char *drawn = NULL;
    double left = uniform_1 * total;
    for (size_t k = 0; k < FLEET_COUNT && left >= 0.0; k++) {
        if (!holds(&FLEET[k], size))
            continue;
        drawn = FLEET[k].vehicle;
        left -= FLEET[k].share_1;
    }
    if (drawn == NULL)
        say_none(size, reason);
    return drawn;
}
