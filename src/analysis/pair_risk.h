/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_PAIR_RISK_H
#define ANALYSIS_PAIR_RISK_H

#include "analysis/study_data.h"

/* Risk of a driver of a counterfactual pair by a risk function, of the baseline's crash or of what
 * became of it (treated); 0 where the function is not of this driver or the crash is avoided, NAN
 * where it is not known. role: 0 = a, 1 = b. times its gradient by the function's parameters is
 * added to gradient (CP_RISK_PARAMETERS_MAX; NULL: not wanted). */
double cp_pair_risk(const cp_study_data *data, const cp_study_pair *pair, const cp_study_risk *risk,
                    size_t role, bool treated, double times, double *gradient);

#endif
