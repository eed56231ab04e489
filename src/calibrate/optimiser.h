/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_OPTIMISER_H
#define CALIBRATE_OPTIMISER_H

/* C interface over pagmo's global optimisers. Conventions: opaque handle, freed by
 * cp_optimiser_destroy; no C++ exception crosses, every failure is a cp_status with pagmo's words;
 * the unknowns are scaled to 0..1; smaller is better; same seed, same sequence; one thread. The
 * header compiles as C and as C++. */

#include "core/error.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Value of a point of dimension coordinates in 0..1; finite. */
typedef double (*cp_optimiser_function)(void *context, const double *point, size_t dimension);

typedef struct cp_optimiser_settings {
    const char *algorithm; /* "de" (differential evolution), "sade" (self-adaptive), "cmaes" */
    size_t dimension;
    size_t population; /* >= 8 */
    uint32_t seed;
    const double *start; /* a point to begin with beside the random ones, or NULL */
    cp_optimiser_function function;
    void *context;
} cp_optimiser_settings;

typedef struct cp_optimiser cp_optimiser;

/* Draws and evaluates the first population. */
CP_MUST_CHECK cp_status cp_optimiser_create(const cp_optimiser_settings *settings,
                                            cp_optimiser **optimiser, cp_error *error);
/* The same from a file of cp_optimiser_save; settings must be those it was made with. */
CP_MUST_CHECK cp_status cp_optimiser_restore(const cp_optimiser_settings *settings,
                                             const char *path, cp_optimiser **optimiser,
                                             cp_error *error);
void cp_optimiser_destroy(cp_optimiser *optimiser); /* NULL is fine */

/* One generation ("cmaes": ten). */
CP_MUST_CHECK cp_status cp_optimiser_evolve(cp_optimiser *optimiser, cp_error *error);
size_t cp_optimiser_generation(const cp_optimiser *optimiser);
/* Best value so far; point (dimension values, may be NULL) receives where. */
double cp_optimiser_best(const cp_optimiser *optimiser, double *point);

/* Population and algorithm as a text file, so that a killed fit goes on where it was. */
CP_MUST_CHECK cp_status cp_optimiser_save(const cp_optimiser *optimiser, const char *path,
                                          cp_error *error);

#ifdef __cplusplus
}
#endif

#endif
