/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/pair_risk.h"

double cp_pair_risk(const cp_study_data *data, const cp_study_pair *pair, const cp_study_risk *risk,
                    size_t role, bool treated, double times, double *gradient)
{
    const cp_study_vehicle *vehicle = &data->vehicle[2 * pair->crash + role];
    const cp_study_crash *crash = &data->crash[pair->crash];
    bool frontal = treated ? pair->treated_frontal[role] : vehicle->frontal;
    if ((treated && pair->outcome == CP_OUTCOME_AVOIDED) || (risk->frontal_only && !frontal))
        return 0.0;
    double predictor =
        treated ? pair->predictor[role][risk->predictor] : vehicle->predictor[risk->predictor];
    const char *type = treated ? pair->treated_type : data->crash_type[crash->crash_type];
    return cp_risk_add(&risk->function, predictor, type, times, gradient);
}
