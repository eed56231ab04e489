/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/drawn_car.h"

#include "crash/parameter_scatter.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static double square(double value)
{
    return value * value;
}

// mass (length^2 + width^2), to which yaw inertia is proportional.
static double inertia_measure(const cp_vehicle_model *model)
{
    return model->mass_kg * (square(model->length_m) + square(model->width_m));
}

// Length and mass of the vehicle in question, where the class allows them; then its inertia.
static void take_size(const cp_vehicle_model *class_model, const cp_vehicle_size *size,
                      cp_vehicle_model *drawn)
{
    size_t mass = cp_vehicle_parameter_index("mass_kg");
    cp_error misfit;
    cp_vehicle_model sized = *drawn;
    if (fabs(size->length_m - class_model->length_m) <= CP_VEHICLE_STRETCHED_LENGTH_M + 1e-9 ||
        class_model->calibrated_speed_max_m_s <= 0.0)
        sized.length_m = size->length_m;
    if (size->mass_kg >= class_model->smallest[mass] && size->mass_kg <= class_model->largest[mass])
        sized.mass_kg = size->mass_kg;
    if (cp_vehicle_model_validate(&sized, &misfit) != CP_OK)
        sized = *drawn;
    sized.yaw_inertia_kg_m2 =
        class_model->yaw_inertia_kg_m2 * inertia_measure(&sized) / inertia_measure(class_model);
    if (cp_vehicle_model_validate(&sized, &misfit) == CP_OK)
        *drawn = sized;

    // The ensemble differs from the car in its front only.
    size_t length = cp_vehicle_parameter_index("length_m");
    size_t inertia = cp_vehicle_parameter_index("yaw_inertia_kg_m2");
    for (size_t m = 0; m < drawn->member_count; m++) {
        drawn->member[m][mass] = drawn->mass_kg;
        drawn->member[m][length] = drawn->length_m;
        drawn->member[m][inertia] = drawn->yaw_inertia_kg_m2;
    }
}

cp_status cp_drawn_car(const cp_vehicle_model *class_model, bool scatters,
                       const cp_vehicle_size *size, cp_rng_key key, cp_vehicle_model *drawn,
                       cp_error *error)
{
    *drawn = *class_model;
    cp_status status = CP_OK;
    if (scatters && cp_parameter_scatter_count(class_model) > 0)
        status = cp_parameter_scatter_draw(class_model, key, 0, drawn, NULL, error);
    if (status == CP_OK)
        take_size(class_model, size, drawn);
    return status;
}

// ---- as text -------------------------------------------------------------------------------

const char *cp_drawn_car_text(const cp_vehicle_model *class_model, const cp_vehicle_model *drawn,
                              char text[CP_DRAWN_CAR_TEXT_SIZE])
{
    size_t used = 0;
    text[0] = '\0';
    for (size_t k = 0; k < CP_VEHICLE_PARAMETER_COUNT; k++) {
        double value = cp_vehicle_model_get(drawn, k);
        if (value != cp_vehicle_model_get(class_model, k))
            used += (size_t)snprintf(text + used, CP_DRAWN_CAR_TEXT_SIZE - used, "%s\"%s\":%.17g",
                                     used > 0 ? "," : "{", CP_VEHICLE_PARAMETER[k].name, value);
    }
    if (used > 0)
        snprintf(text + used, CP_DRAWN_CAR_TEXT_SIZE - used, "}");
    return text;
}

// One "name":value; at moves behind it. False when it is none.
static bool read_one(const char **at, cp_vehicle_model *drawn)
{
    const char *begin = *at;
    const char *end = begin[0] == '"' ? strchr(begin + 1, '"') : NULL;
    char name[64];
    if (end == NULL || end[1] != ':' || (size_t)(end - begin - 1) >= sizeof name)
        return false;
    snprintf(name, sizeof name, "%.*s", (int)(end - begin - 1), begin + 1);
    size_t index = cp_vehicle_parameter_index(name);
    char *rest = NULL;
    double value = strtod(end + 2, &rest);
    if (index == CP_VEHICLE_PARAMETER_COUNT || rest == end + 2 || !isfinite(value))
        return false;
    cp_vehicle_model_set(drawn, index, value);
    *at = rest;
    return true;
}

cp_status cp_drawn_car_read(const cp_vehicle_model *class_model, const char *text,
                            cp_vehicle_model *drawn, cp_error *error)
{
    *drawn = *class_model;
    const char *at = text;
    if (text[0] == '\0')
        return CP_OK;
    do {
        at++; // '{' or ','
        if ((at == text + 1 && text[0] != '{') || !read_one(&at, drawn))
            return cp_fail(error, CP_BAD_INPUT,
                           "what was drawn of a %s must be {\"parameter\":value,...}, found "
                           "'%.60s' at character %zu",
                           class_model->name, text, (size_t)(at - text));
    } while (*at == ',');
    if (strcmp(at, "}") != 0)
        return cp_fail(error, CP_BAD_INPUT, "what was drawn of a %s must end in '}', found '%.40s'",
                       class_model->name, at);
    cp_status status = cp_vehicle_model_validate(drawn, error);
    return status == CP_OK ? CP_OK
                           : cp_error_prefix(error, "what was drawn of a %s: ", class_model->name);
}
