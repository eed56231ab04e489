/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef EXCHANGE_SUMO_TYPES_H
#define EXCHANGE_SUMO_TYPES_H

#include "core/error.h"

#include <stddef.h>

/* What the vehicles of a SUMO run were: the vTypes in its route or additional files. SUMO's outputs
 * name types only. */

/* SUMO's own car, where a vType of a car leaves its size open. */
#define CP_SUMO_CAR_LENGTH_M 5.0
#define CP_SUMO_CAR_WIDTH_M 1.8
#define CP_SUMO_CAR_HEIGHT_M 1.5

typedef struct cp_vtype {
    char *id;            /* owned */
    char *vehicle_class; /* owned: vClass, "passenger" where the file gives none */
    char *model;         /* owned: value of its parameter crashpulse.model; NULL without one */
    char *path;          /* owned: the file that model is seen from */
    double length_m;
    double width_m;
    double height_m;
    double mass_kg; /* its parameter vehicleMass; NAN without one */
} cp_vtype;

typedef struct cp_vtypes {
    cp_vtype *type;
    size_t count;
} cp_vtypes;

/* Read the vTypes of one more file into zero-initialised or earlier filled types; the caller
 * destroys. A size that a vType leaves open is that of its class in SUMO 1.15. Errors: CP_BAD_INPUT
 * with file, line, attribute; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_vtypes_read(const char *path, cp_vtypes *types, cp_error *error);
void cp_vtypes_destroy(cp_vtypes *types);

/* By id; NULL when there is none. */
const cp_vtype *cp_vtypes_find(const cp_vtypes *types, const char *id);

#endif
