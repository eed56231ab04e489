/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/parameter_scatter.h"

#include <math.h>

enum { TRIES_A_PARAMETER = 1000, TRIES_A_CAR = 500 };

size_t cp_parameter_scatter_count(const cp_vehicle_model *model)
{
    size_t count = 0;
    for (size_t k = 0; k < CP_VEHICLE_PARAMETER_COUNT; k++)
        count += model->scatter_1[k] > 0.0;
    return count;
}

// One value inside the bounds: the first of a row of draws that is.
static cp_status draw_parameter(const cp_vehicle_model *model, size_t index, cp_rng_key car,
                                double *value, cp_error *error)
{
    const char *name = CP_VEHICLE_PARAMETER[index].name;
    cp_rng_key key = cp_rng_key_text(car, name);
    double mean = cp_vehicle_model_get(model, index);
    for (uint64_t draw = 0; draw < TRIES_A_PARAMETER; draw++) {
        *value = mean + model->scatter_1[index] * fabs(mean) * cp_rng_normal(key, draw);
        if (*value >= model->smallest[index] && *value <= model->largest[index])
            return CP_OK;
    }
    return cp_fail(
        error, CP_BAD_INPUT,
        "vehicle %s: %s = %g with scatter %g was never within its bounds %g ... %g in %d "
        "draws",
        model->name, name, mean, model->scatter_1[index], model->smallest[index],
        model->largest[index], TRIES_A_PARAMETER);
}

// The ensemble's values keep their ratio to the car's, within the bounds.
static void take_value(cp_vehicle_model *drawn, size_t index, double value)
{
    double mean = cp_vehicle_model_get(drawn, index);
    for (size_t m = 0; mean != 0.0 && m < drawn->member_count; m++)
        drawn->member[m][index] =
            fmin(fmax(drawn->member[m][index] * value / mean, drawn->smallest[index]),
                 drawn->largest[index]);
    cp_vehicle_model_set(drawn, index, value);
}

static cp_status draw_car(const cp_vehicle_model *model, cp_rng_key key, cp_vehicle_model *drawn,
                          cp_error *error)
{
    *drawn = *model;
    for (size_t k = 0; k < CP_VEHICLE_PARAMETER_COUNT; k++) {
        if (model->scatter_1[k] <= 0.0)
            continue;
        double value = 0.0;
        cp_status status = draw_parameter(model, k, key, &value, error);
        if (status != CP_OK)
            return status;
        take_value(drawn, k, value);
    }
    return CP_OK;
}

cp_status cp_parameter_scatter_draw(const cp_vehicle_model *model, cp_rng_key key, uint64_t sample,
                                    cp_vehicle_model *drawn, size_t *redrawn, cp_error *error)
{
    cp_rng_key own = cp_rng_key_number(key, sample);
    cp_error misfit = {0};
    for (uint64_t round = 0; round < TRIES_A_CAR; round++) {
        cp_status status = draw_car(model, cp_rng_key_number(own, round), drawn, error);
        if (status != CP_OK)
            return status;
        if (redrawn != NULL)
            *redrawn = (size_t)round;
        if (cp_vehicle_model_validate(drawn, &misfit) == CP_OK)
            return CP_OK;
    }
    return cp_fail(error, CP_BAD_INPUT,
                   "vehicle %s: sample %llu was drawn %d times and never fitted together: %s",
                   model->name, (unsigned long long)sample, TRIES_A_CAR, misfit.text);
}
