/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_FIT_H
#define CALIBRATE_FIT_H

#include "calibrate/candidate.h"
#include "calibrate/plausibility.h"
#include "calibrate/reference_pulse.h"
#include "calibrate/target.h"

#include <stdint.h>

enum { CP_UNKNOWNS_MAX = 80, CP_FOLDS_MAX = 50 };

/* What the fit makes small. */
typedef enum cp_fit_objective {
    CP_FIT_OLC,  /* mean absolute OLC error over the rows of a table; the default */
    CP_FIT_PULSE /* weighted mean total error over pulses (pulse_objective.h) */
} cp_fit_objective;

/* Range the fitted model is said to be calibrated in, where it is not simply that of its
 * references. */
typedef struct cp_fit_range {
    bool given;
    double speed_min_km_h;
    double speed_max_km_h;
    double offset_max_mm;
    double angle_max_deg;
    char reason[512]; /* stated in the vehicle file */
} cp_fit_range;

/* What to fit and how, from a YAML file (db/vehicles/README.md describes it). Paths are as seen
 * from the fit file's folder. */
typedef struct cp_fit {
    char name[64]; /* of the fitted vehicle */
    char description[256];
    char hash[65];         /* SHA-256 of the fit file */
    cp_vehicle_model base; /* start values, and all that is not fitted */
    cp_fit_objective objective;
    cp_reference reference; /* owned; by objective pulse: conditions and OLC of the pulses */
    char *reference_path;   /* owned, as written in the file; NULL by objective pulse, and where the
                               targets are all there is to fit */
    size_t pulse_count;
    cp_reference_pulse *pulses; /* owned; none by objective olc */
    cp_fit_range range;
    size_t input_count;
    char **input_path;  /* owned: every file the fit reads, as it is found from here */
    char *output_path;  /* owned: fitted vehicle file; the report stands beside it as .fit.md,
                           the state of an unfinished fit as .fit.state */
    char algorithm[16]; /* "de", "sade" or "cmaes"; default "de" */
    uint32_t seed;
    size_t population;         /* default 40 */
    size_t generations;        /* default 150 */
    double global_time_step_s; /* default 0.0005 */
    double local_time_step_s;  /* default 0.0005 */
    size_t local_evaluations;  /* of Nelder-Mead, default 1000; 0: none */
    size_t starts;             /* global searches from other seeds; the best counts; default 1.
                                  Without generations: drawn around base (drawn_starts.h) */
    size_t offspring;         /* children of starts drawn around base (drawn_starts.h), default 0 */
    size_t slope_evaluations; /* of least squares, default 0: none; of several starts each gets
                                 a quarter, an eighth if drawn, the best in the end all */
    double soft_g;            /* error from which on least squares count the absolute value, not the
                                 square; default 0.3 */
    double prior_g;           /* what an unknown must take off the summed errors to move through the
                                 whole of its bounds from its value in base, so that those the
                                 references say little of stay where they are known to be; default
                                 0: free */
    size_t folds;             /* of the cross-validation, default 0: none */
    size_t neighbour_folds;   /* of one with neighbours apart (cross_validation.h), likewise */
    bool leave_out[4];        /* also leave out one level at a time of: -, speed, offset, angle
                                 (index: cp_cross_kind) */
    cp_plausibility plausible; /* bounds of the pulse's marks */
    size_t target_count;
    cp_target target[CP_TARGETS_MAX]; /* corridors of further crashes */
    size_t ensemble; /* parameter sets kept that fit about as well (ensemble.h), default 0 */
    double ensemble_within_1; /* about as well: the robust cost of the best plus this share of it,
                                 default 0.15 */
    int threads;              /* default 1 */
    size_t unknown_count;
    cp_unknown unknown[CP_UNKNOWNS_MAX];
} cp_fit;

void cp_fit_destroy(cp_fit *fit);

/* Whether its starts are drawn around the base (drawn_starts.h), not found by global searches. */
bool cp_fit_draws_starts(const cp_fit *fit);

#endif
