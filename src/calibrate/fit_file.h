/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_FIT_FILE_H
#define CALIBRATE_FIT_FILE_H

#include "calibrate/candidate.h"
#include "calibrate/reference.h"

#include <stdint.h>

enum { CP_UNKNOWNS_MAX = 80 };

/* What to fit and how, from a YAML file (db/vehicles/README.md describes it). Paths are as seen
 * from the fit file's folder. */
typedef struct cp_fit {
    char name[64]; /* of the fitted vehicle */
    char description[256];
    char hash[65];          /* SHA-256 of the fit file */
    cp_vehicle_model base;  /* start values, and all that is not fitted */
    cp_reference reference; /* owned */
    char *reference_path;   /* owned, as written in the file */
    char *output_path;      /* owned: fitted vehicle file; the report stands beside it as .fit.md,
                               the state of an unfinished fit as .fit.state */
    char algorithm[16];     /* "de", "sade" or "cmaes"; default "de" */
    uint32_t seed;
    size_t population;         /* default 40 */
    size_t generations;        /* default 150 */
    double global_time_step_s; /* default 0.0005 */
    double local_time_step_s;  /* default 0.0005 */
    size_t local_evaluations;  /* of Nelder-Mead, default 1000; 0: none */
    size_t folds;              /* of the cross-validation, default 0: none */
    int threads;               /* default 1 */
    size_t unknown_count;
    cp_unknown unknown[CP_UNKNOWNS_MAX];
} cp_fit;

/* Errors: CP_BAD_INPUT with file, line and field. The caller destroys. */
CP_MUST_CHECK cp_status cp_fit_load(const char *path, cp_fit *fit, cp_error *error);
void cp_fit_destroy(cp_fit *fit);

#endif
