/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/sumo_types.h"

#include "core/array.h"
#include "core/xml_file.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

typedef struct reading {
    cp_vtypes *types;
    bool inside; /* of a vType, as far as its parameters reach */
} reading;

/* What SUMO 1.15 takes for a class whose vType leaves its size open, m
 * (traci.vehicletype.getLength, getWidth, getHeight of a vType with nothing but its class). All
 * others are as large as its car. */
static const struct class_size {
    const char *vehicle_class;
    double length_m, width_m, height_m;
} CLASS_SIZE[] = {
    {"emergency", 6.5, 2.16, 2.86}, {"pedestrian", 0.215, 0.478, 1.719},
    {"bus", 12, 2.5, 3.4},          {"coach", 14, 2.6, 4},
    {"delivery", 6.5, 2.16, 2.86},  {"truck", 7.1, 2.4, 2.4},
    {"trailer", 16.5, 2.55, 4},     {"motorcycle", 2.2, 0.9, 1.5},
    {"moped", 2.1, 0.78, 1.7},      {"bicycle", 1.6, 0.65, 1.7},
    {"tram", 22, 2.4, 3.2},         {"rail_urban", 109.5, 3, 3.6},
    {"rail", 135, 2.84, 3.75},      {"rail_electric", 200, 2.95, 3.89},
    {"rail_fast", 200, 2.95, 3.89}, {"ship", 17, 4, 4},
};

static struct class_size size_of_class(const char *vehicle_class)
{
    for (size_t k = 0; k < sizeof CLASS_SIZE / sizeof *CLASS_SIZE; k++)
        if (strcmp(CLASS_SIZE[k].vehicle_class, vehicle_class) == 0)
            return CLASS_SIZE[k];
    return (struct class_size){vehicle_class, CP_SUMO_CAR_LENGTH_M, CP_SUMO_CAR_WIDTH_M,
                               CP_SUMO_CAR_HEIGHT_M};
}

// A size; left open it is that of the class.
static cp_status take_size(const cp_xml_element *element, const char *name, double of_class_m,
                           double largest, double *value, cp_error *error)
{
    *value = of_class_m;
    return cp_xml_attribute(element, name) != NULL
               ? cp_xml_number(element, name, 0.1, largest, value, error)
               : CP_OK;
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
    *type = (cp_vtype){.mass_kg = NAN};
    struct class_size size = size_of_class(vehicle_class);
    cp_status status = cp_xml_text(element, "id", &id, error);
    if (status == CP_OK)
        status = take_size(element, "length", size.length_m, 500.0, &type->length_m, error);
    if (status == CP_OK)
        status = take_size(element, "width", size.width_m, 10.0, &type->width_m, error);
    if (status == CP_OK)
        status = take_size(element, "height", size.height_m, 10.0, &type->height_m, error);
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
    cp_vtype *added = status == CP_OK ? cp_array_add(types->type, types->count) : NULL;
    if (status == CP_OK && added == NULL)
        status = cp_fail_memory(error, "vehicle types");
    if (status == CP_OK)
        *added = type;
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
