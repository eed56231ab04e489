/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/shipped_vehicle.h"

#include <string.h>

// Embedded by src/crash/CMakeLists.txt, which has the same names. X(name).
#define SHIPPED(X)                                                                                 \
    X(bus)                                                                                         \
    X(compact_car)                                                                                 \
    X(delivery_van)                                                                                \
    X(honda_accord_2014)                                                                           \
    X(large_car)                                                                                   \
    X(mid_size)                                                                                    \
    X(mid_size_car)                                                                                \
    X(pickup)                                                                                      \
    X(rigid_truck)                                                                                 \
    X(small_car)                                                                                   \
    X(suv)                                                                                         \
    X(toyota_camry_2018)                                                                           \
    X(tractor_trailer)                                                                             \
    X(van)

#define DECLARE(name)                                                                              \
    extern const unsigned char cp_vehicle_##name[];                                                \
    extern const size_t cp_vehicle_##name##_size;
SHIPPED(DECLARE)
#undef DECLARE

#define COUNT_ONE(name) +1
const size_t CP_SHIPPED_VEHICLE_COUNT = 0 SHIPPED(COUNT_ONE);
#undef COUNT_ONE

cp_shipped_vehicle cp_shipped_vehicle_at(size_t index)
{
    static const struct {
        const char *name;
        const unsigned char *yaml;
        const size_t *size;
    } VEHICLE[] = {
#define ROW(name) {#name, cp_vehicle_##name, &cp_vehicle_##name##_size},
        SHIPPED(ROW)
#undef ROW
    };
    return (cp_shipped_vehicle){VEHICLE[index].name, (const char *)VEHICLE[index].yaml,
                                *VEHICLE[index].size};
}

bool cp_shipped_vehicle_find(const char *name, cp_shipped_vehicle *vehicle)
{
    for (size_t k = 0; k < CP_SHIPPED_VEHICLE_COUNT; k++) {
        *vehicle = cp_shipped_vehicle_at(k);
        if (strcmp(vehicle->name, name) == 0)
            return true;
    }
    return false;
}

bool cp_shipped_vehicle_is_path(const char *text)
{
    return strpbrk(text, "/.") != NULL;
}

const char *cp_shipped_vehicle_names(void)
{
    // The text begins with the separator of every name.
#define WORD(name) ", " #name
    return &SHIPPED(WORD)[2];
#undef WORD
}
