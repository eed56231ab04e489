/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/fit_targets.h"

#include <stdio.h>
#include <string.h>

#define TEXT(key, type)                                                                            \
    CYAML_FIELD_STRING_PTR(#key, CYAML_FLAG_POINTER, type, key, 0, CYAML_UNLIMITED)
#define OPTIONAL_TEXT(key, type)                                                                   \
    CYAML_FIELD_STRING_PTR(#key, CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, type, key, 0,           \
                           CYAML_UNLIMITED)

static const cyaml_schema_field_t BOUNDS_FIELDS[] = {
    TEXT(quantity, cp_yaml_target_bounds),     OPTIONAL_TEXT(at_ms, cp_yaml_target_bounds),
    TEXT(min, cp_yaml_target_bounds),          TEXT(max, cp_yaml_target_bounds),
    OPTIONAL_TEXT(aim, cp_yaml_target_bounds), CYAML_FIELD_END};
static const cyaml_schema_value_t BOUNDS_VALUE = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, cp_yaml_target_bounds, BOUNDS_FIELDS)};

static const cyaml_schema_field_t BARRIER_FIELDS[] = {
    TEXT(width_m, cp_yaml_target_barrier), TEXT(depth_m, cp_yaml_target_barrier),
    TEXT(corner_radius_m, cp_yaml_target_barrier), CYAML_FIELD_END};

static const cyaml_schema_field_t TARGET_FIELDS[] = {
    TEXT(name, cp_yaml_target),
    TEXT(source, cp_yaml_target),
    OPTIONAL_TEXT(against, cp_yaml_target),
    TEXT(speed_km_h, cp_yaml_target),
    OPTIONAL_TEXT(offset_mm, cp_yaml_target),
    OPTIONAL_TEXT(angle_deg, cp_yaml_target),
    CYAML_FIELD_MAPPING_PTR("barrier", CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, cp_yaml_target,
                            barrier, BARRIER_FIELDS),
    OPTIONAL_TEXT(weight, cp_yaml_target),
    CYAML_FIELD_SEQUENCE("bounds", CYAML_FLAG_POINTER, cp_yaml_target, bounds, &BOUNDS_VALUE, 1,
                         CP_TARGET_BOUNDS_MAX),
    CYAML_FIELD_END};
const cyaml_schema_value_t CP_YAML_TARGET_VALUE = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, cp_yaml_target, TARGET_FIELDS)};

// Where a field of the section stands: "targets[2].bounds[1].min".
static const char *key_of(char key[96], size_t target, size_t bound, const char *field)
{
    if (bound < CP_TARGET_BOUNDS_MAX)
        snprintf(key, 96, "targets[%zu].bounds[%zu].%s", target, bound, field);
    else
        snprintf(key, 96, "targets[%zu].%s", target, field);
    return key;
}

static cp_status read_bounds(const cp_yaml_file *file, const cp_yaml_target_bounds *yaml,
                             size_t row, size_t b, cp_target_bounds *bounds, cp_error *error)
{
    char key[96];
    char keys[CP_TARGET_KEYS_SIZE];
    const cp_target_kind *kind = cp_target_kind_find(yaml->quantity);
    if (kind == NULL)
        return cp_yaml_fail(file, error, key_of(key, row, b, "quantity"), "must be %s, found '%s'",
                            cp_target_keys(keys), yaml->quantity);
    bounds->quantity = kind->quantity;
    bool at_instant = cp_suite_quantity_is_timed(kind->quantity);
    if (at_instant != (yaml->at_ms != NULL))
        return cp_yaml_fail(file, error, key_of(key, row, b, "at_ms"), "%s %s", kind->key,
                            at_instant ? "is taken at an instant: give at_ms"
                                       : "is of the whole crash: it has no at_ms");
    double at_ms = 0.0;
    cp_status status =
        cp_yaml_number(file, key_of(key, row, b, "at_ms"), yaml->at_ms, 1, 200, &at_ms, error);
    if (status == CP_OK)
        status = cp_yaml_number(file, key_of(key, row, b, "min"), yaml->min, -1e4, 1e4,
                                &bounds->min, error);
    if (status == CP_OK)
        status = cp_yaml_number(file, key_of(key, row, b, "max"), yaml->max, -1e4, 1e4,
                                &bounds->max, error);
    if (status == CP_OK && bounds->max <= bounds->min)
        status = cp_yaml_fail(file, error, key, "must be above min = %g, found %s", bounds->min,
                              yaml->max);
    bounds->aim = 0.5 * (bounds->min + bounds->max);
    if (status == CP_OK)
        status = cp_yaml_number(file, key_of(key, row, b, "aim"), yaml->aim, bounds->min,
                                bounds->max, &bounds->aim, error);
    bounds->at_s = 1e-3 * at_ms;
    bounds->min *= kind->si_per_unit;
    bounds->max *= kind->si_per_unit;
    bounds->aim *= kind->si_per_unit;
    return status;
}

static cp_status read_barrier(const cp_yaml_file *file, const cp_yaml_target_barrier *yaml,
                              size_t row, cp_target *target, cp_error *error)
{
    if (yaml == NULL)
        return CP_OK;
    char key[96];
    const size_t none = CP_TARGET_BOUNDS_MAX;
    target->has_barrier = true;
    target->barrier = cp_barrier_default();
    cp_status status = cp_yaml_number(file, key_of(key, row, none, "barrier.width_m"),
                                      yaml->width_m, 0.2, 20, &target->barrier.width_m, error);
    if (status == CP_OK)
        status = cp_yaml_number(file, key_of(key, row, none, "barrier.depth_m"), yaml->depth_m, 0.2,
                                20, &target->barrier.depth_m, error);
    if (status == CP_OK)
        status =
            cp_yaml_number(file, key_of(key, row, none, "barrier.corner_radius_m"),
                           yaml->corner_radius_m, 0, 10, &target->barrier.corner_radius_m, error);
    return status == CP_OK ? cp_barrier_validate(&target->barrier, error) : status;
}

static cp_status read_opponent(const cp_yaml_file *file, const cp_yaml_target *yaml, size_t row,
                               cp_target *target, cp_error *error)
{
    char key[96];
    const char *against = yaml->against != NULL ? yaml->against : "barrier";
    target->against_itself = strcmp(against, "itself") == 0;
    if (!target->against_itself && strcmp(against, "barrier") != 0)
        return cp_yaml_fail(file, error, key_of(key, row, CP_TARGET_BOUNDS_MAX, "against"),
                            "must be barrier or itself, found '%s'", against);
    if (target->against_itself && yaml->barrier != NULL)
        return cp_yaml_fail(file, error, key_of(key, row, CP_TARGET_BOUNDS_MAX, "barrier"),
                            "goes with against: barrier");
    return read_barrier(file, yaml->barrier, row, target, error);
}

static cp_status read_text(const cp_yaml_file *file, const char *key, const char *text, char *into,
                           size_t size, cp_error *error)
{
    if (text[0] == '\0' || strlen(text) >= size)
        return cp_yaml_fail(file, error, key, "must have 1 to %zu characters", size - 1);
    snprintf(into, size, "%s", text);
    return CP_OK;
}

static cp_status read_target(const cp_yaml_file *file, const cp_yaml_target *yaml, size_t row,
                             cp_target *target, cp_error *error)
{
    char key[96];
    const size_t none = CP_TARGET_BOUNDS_MAX;
    target->weight = 1.0;
    cp_status status = read_text(file, key_of(key, row, none, "name"), yaml->name, target->name,
                                 sizeof target->name, error);
    if (status == CP_OK)
        status = read_text(file, key_of(key, row, none, "source"), yaml->source, target->source,
                           sizeof target->source, error);
    if (status == CP_OK)
        status = read_opponent(file, yaml, row, target, error);
    if (status == CP_OK)
        status = cp_yaml_number(file, key_of(key, row, none, "speed_km_h"), yaml->speed_km_h, 0.5,
                                200, &target->speed_km_h, error);
    if (status == CP_OK)
        status = cp_yaml_number(file, key_of(key, row, none, "offset_mm"), yaml->offset_mm, -3000,
                                3000, &target->offset_mm, error);
    if (status == CP_OK)
        status = cp_yaml_number(file, key_of(key, row, none, "angle_deg"), yaml->angle_deg, -90, 90,
                                &target->angle_deg, error);
    if (status == CP_OK)
        status = cp_yaml_number(file, key_of(key, row, none, "weight"), yaml->weight, 0.0, 100,
                                &target->weight, error);
    target->bound_count = yaml->bounds_count;
    for (size_t b = 0; status == CP_OK && b < target->bound_count; b++)
        status = read_bounds(file, &yaml->bounds[b], row, b, &target->bound[b], error);
    return status;
}

cp_status cp_fit_targets_read(const cp_yaml_file *file, const cp_yaml_target *yaml, size_t count,
                              cp_fit *fit, cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t row = 0; status == CP_OK && row < count; row++)
        status = read_target(file, &yaml[row], row, &fit->target[row], error);
    fit->target_count = count;
    return status;
}
