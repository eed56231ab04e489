/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/any_vehicle.h"

size_t cp_any_vehicle_count(const cp_study_data *data)
{
    return data->vehicle_count + data->treated_count;
}

cp_any_vehicle cp_any_vehicle_at(const cp_study_data *data, size_t k)
{
    bool treated = k >= data->vehicle_count;
    const cp_study_treated *t = treated ? &data->treated[k - data->vehicle_count] : NULL;
    const cp_study_vehicle *v = treated ? &t->vehicle : &data->vehicle[k];
    const cp_study_crash *crash = &data->crash[v->crash];
    const cp_study_replication *replication = &data->replication[crash->replication];
    return (cp_any_vehicle){.vehicle = v,
                            .crash = crash,
                            .replication = replication,
                            .variant = treated ? t->variant : replication->variant,
                            .treated = treated,
                            .x_m = treated ? t->x_m : crash->x_m,
                            .y_m = treated ? t->y_m : crash->y_m};
}
