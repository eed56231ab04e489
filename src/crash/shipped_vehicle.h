/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_SHIPPED_VEHICLE_H
#define CRASH_SHIPPED_VEHICLE_H

#include <stdbool.h>
#include <stddef.h>

/* The vehicle files of db/vehicles that come inside the program, so that a name is enough. */
typedef struct cp_shipped_vehicle {
    const char *name; /* as in the file, and of the file without ".yaml" */
    const char *yaml; /* zero-terminated */
    size_t size;
} cp_shipped_vehicle;

extern const size_t CP_SHIPPED_VEHICLE_COUNT;

/* Number index < CP_SHIPPED_VEHICLE_COUNT, in order of name. */
cp_shipped_vehicle cp_shipped_vehicle_at(size_t index);

/* By name; false when none has it. */
bool cp_shipped_vehicle_find(const char *name, cp_shipped_vehicle *vehicle);

/* What names a vehicle: the name of a shipped one, or, with a '/' or a '.', a path. */
bool cp_shipped_vehicle_is_path(const char *text);

/* "honda_accord_2014, mid_size, ...", static text for messages. */
const char *cp_shipped_vehicle_names(void);

#endif
