/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_REFERENCE_H
#define CALIBRATE_REFERENCE_H

#include "core/error.h"

#include <stddef.h>

/* OLC values a vehicle model is held against: one barrier test (or simulation of one) a row. */
typedef struct cp_reference_case {
    double speed_km_h;
    double offset_mm;
    double angle_deg;
    double olc_g;
} cp_reference_case;

typedef struct cp_reference {
    cp_reference_case *cases; /* owned */
    size_t count;
    char hash[65]; /* SHA-256 of the file */
} cp_reference;

/* Read a CSV file with a header naming speed_kmh, offset_mm, angle_deg and olc_fe_g (or olc_g);
 * other columns are ignored. Errors: CP_BAD_INPUT with file, line and column. The caller
 * destroys. */
CP_MUST_CHECK cp_status cp_reference_load(const char *path, cp_reference *reference,
                                          cp_error *error);
void cp_reference_destroy(cp_reference *reference);

#endif
