/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/sumo_types.h"

#include "core/xml_file.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

typedef struct reading {
    cp_vtypes *types;
    bool inside; /* of a vType, as far as its parameters reach */
} reading;

static bool is_car(const char *vehicle_class)
{
    static const char *const CARS[] = {"passenger", "private", "taxi",     "evehicle",
                                       "hov",       "vip",     "authority"};
    for (size_t k = 0; k < sizeof CARS / sizeof *CARS; k++)
        if (strcmp(CARS[k], vehicle_class) == 0)
            return true;
    return false;
}

// A size; a car's may be left to SUMO.
static cp_status size_of(const cp_xml_element *element, const char *name, const char *vehicle_class,
                         double of_car_m, double largest, double *value, cp_error *error)
{
    *value = of_car_m;
    if (cp_xml_attribute(element, name) == NULL && is_car(vehicle_class))
        return CP_OK;
    return cp_xml_number(element, name, 0.1, largest, value, error);
}

static void destroy_type(cp_vtype *type)
{
    free(type->id);
    free(type->vehicle_class);
    free(type->model);
    free(type->path);
}

static cp_status fill(const cp_xml_element *element, cp_vtype *type, cp_error *error)
{
    const char *id = NULL, *vehicle_class = cp_xml_attribute(element, "vClass");
    if (vehicle_class == NULL)
        vehicle_class = "passenger";
    *type = (cp_vtype){.height_m = CP_SUMO_CAR_HEIGHT_M, .mass_kg = NAN};
    cp_status status = cp_xml_text(element, "id", &id, error);
    if (status == CP_OK)
        status = size_of(element, "length", vehicle_class, CP_SUMO_CAR_LENGTH_M, 100.0,
                         &type->length_m, error);
    if (status == CP_OK)
        status = size_of(element, "width", vehicle_class, CP_SUMO_CAR_WIDTH_M, 10.0, &type->width_m,
                         error);
    if (!is_car(vehicle_class))
        type->height_m = NAN;
    if (status == CP_OK && cp_xml_attribute(element, "height") != NULL)
        status = cp_xml_number(element, "height", 0.1, 10.0, &type->height_m, error);
    if (status != CP_OK)
        return status;
    type->id = strdup(id);
    type->vehicle_class = strdup(vehicle_class);
    type->path = strdup(element->path);
    return type->id != NULL && type->vehicle_class != NULL && type->path != NULL
               ? CP_OK
               : cp_fail_memory(error, "vehicle types");
}

static cp_status add(cp_vtypes *types, const cp_xml_element *element, cp_error *error)
{
    cp_vtype type;
    cp_status status = fill(element, &type, error);
    cp_vtype *larger = realloc(types->type, (types->count + 1) * sizeof *larger);
    if (larger != NULL)
        types->type = larger;
    else if (status == CP_OK)
        status = cp_fail_memory(error, "vehicle types");
    if (status == CP_OK)
        types->type[types->count++] = type;
    else
        destroy_type(&type);
    return status;
}

static cp_status take_parameter(cp_vtype *type, const cp_xml_element *element, cp_error *error)
{
    const char *key = NULL, *value = NULL;
    cp_status status = cp_xml_text(element, "key", &key, error);
    if (status == CP_OK)
        status = cp_xml_text(element, "value", &value, error);
    if (status != CP_OK)
        return status;
    if (strcmp(key, "vehicleMass") == 0)
        return cp_xml_number(element, "value", 1.0, 1e6, &type->mass_kg, error);
    if (strcmp(key, "crashpulse.model") != 0 || type->model != NULL)
        return CP_OK;
    type->model = strdup(value);
    return type->model != NULL ? CP_OK : cp_fail_memory(error, "vehicle types");
}

static cp_status visit(void *context, const cp_xml_element *element, cp_error *error)
{
    reading *self = context;
    if (strcmp(element->name, "param") == 0)
        return self->inside
                   ? take_parameter(&self->types->type[self->types->count - 1], element, error)
                   : CP_OK;
    self->inside = strcmp(element->name, "vType") == 0;
    return self->inside ? add(self->types, element, error) : CP_OK;
}

cp_status cp_vtypes_read(const char *path, cp_vtypes *types, cp_error *error)
{
    reading self = {.types = types};
    return cp_xml_read(path, NULL, visit, &self, error);
}

void cp_vtypes_destroy(cp_vtypes *types)
{
    for (size_t k = 0; k < types->count; k++)
        destroy_type(&types->type[k]);
    free(types->type);
    *types = (cp_vtypes){0};
}

const cp_vtype *cp_vtypes_find(const cp_vtypes *types, const char *id)
{
    for (size_t k = 0; k < types->count; k++)
        if (strcmp(types->type[k].id, id) == 0)
            return &types->type[k];
    return NULL;
}
