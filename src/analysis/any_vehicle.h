/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_ANY_VEHICLE_H
#define ANALYSIS_ANY_VEHICLE_H

#include "analysis/study_data.h"

/* The vehicles of a study and, behind them, the treated ones, under one number: vehicle k of
 * crashes as they happened, then those of what treatments made of crashes of the baseline. */
typedef struct cp_any_vehicle {
    const cp_study_vehicle *vehicle;
    const cp_study_crash *crash;             /* its own; of a treated one the baseline's */
    const cp_study_replication *replication; /* of that crash */
    size_t variant;
    bool treated;
    double x_m; /* first contact, world */
    double y_m;
} cp_any_vehicle;

size_t cp_any_vehicle_count(const cp_study_data *data);

/* k < cp_any_vehicle_count(data); borrowed from data. */
cp_any_vehicle cp_any_vehicle_at(const cp_study_data *data, size_t k);

#endif
