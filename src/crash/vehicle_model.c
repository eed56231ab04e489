/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/vehicle_model.h"

#include "core/file.h"
#include "core/hash.h"
#include "core/log.h"
#include "core/units.h"
#include "core/yaml_file.h"
#include "crash/crush_law.h"
#include "crash/vehicle_schema.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const cp_vehicle_parameter CP_VEHICLE_PARAMETER[] = {
#define CP_VEHICLE_ROW(field, unit, value, smallest, largest, what)                                \
    {#field, unit, offsetof(cp_vehicle_model, field), value, smallest, largest, what},
    CP_VEHICLE_PARAMETERS(CP_VEHICLE_ROW)
#undef CP_VEHICLE_ROW
};
const size_t CP_VEHICLE_PARAMETER_COUNT =
    sizeof CP_VEHICLE_PARAMETER / sizeof CP_VEHICLE_PARAMETER[0];

cp_vehicle_model cp_vehicle_model_default(void)
{
    cp_vehicle_model model = {.name = "default", .barrier = cp_barrier_default()};
    for (size_t k = 0; k < CP_VEHICLE_PARAMETER_COUNT; k++) {
        cp_vehicle_model_set(&model, k, CP_VEHICLE_PARAMETER[k].standard);
        model.smallest[k] = CP_VEHICLE_PARAMETER[k].smallest;
        model.largest[k] = CP_VEHICLE_PARAMETER[k].largest;
    }
    return model;
}

cp_vehicle_model cp_vehicle_model_of_barrier(const cp_barrier *barrier)
{
    cp_vehicle_model model = cp_vehicle_model_default();
    snprintf(model.name, sizeof model.name, "barrier");
    model.is_barrier = true;
    model.barrier = *barrier;
    model.mass_kg = barrier->mass_kg > 0.0 ? barrier->mass_kg : CP_FIXED_BARRIER_KG;
    model.length_m = barrier->depth_m;
    model.width_m = barrier->width_m;
    model.cg_to_front_m = 0.5 * barrier->depth_m;
    double plate_m2 = barrier->depth_m * barrier->depth_m + barrier->width_m * barrier->width_m;
    model.yaw_inertia_kg_m2 = barrier->yaw_inertia_kg_m2 > 0.0 ? barrier->yaw_inertia_kg_m2
                                                               : model.mass_kg * plate_m2 / 12.0;
    if (barrier->friction_1 >= 0.0)
        model.friction_1 = barrier->friction_1;
    return model;
}

cp_vehicle_model cp_vehicle_model_cover(const cp_vehicle_model *model, double length_m,
                                        double width_m)
{
    cp_vehicle_model covering = *model;
    covering.length_m = fmax(model->length_m, length_m);
    covering.width_m = fmax(model->width_m, width_m);
    // 5.9 m over 5.3 m is not more than 0.6 m, whatever the last bit says.
    double longer_m = covering.length_m - model->length_m - 1e-9;
    double wider_m = covering.width_m - model->width_m - 1e-9;
    covering.is_stretched =
        longer_m > CP_VEHICLE_STRETCHED_LENGTH_M || wider_m > CP_VEHICLE_STRETCHED_WIDTH_M;
    return covering;
}

double cp_vehicle_model_get(const cp_vehicle_model *model, size_t index)
{
    double value = 0.0;
    memcpy(&value, (const char *)model + CP_VEHICLE_PARAMETER[index].offset, sizeof value);
    return value;
}

void cp_vehicle_model_set(cp_vehicle_model *model, size_t index, double value)
{
    memcpy((char *)model + CP_VEHICLE_PARAMETER[index].offset, &value, sizeof value);
}

cp_vehicle_model cp_vehicle_model_member(const cp_vehicle_model *model, size_t index)
{
    cp_vehicle_model member = *model;
    for (size_t k = 0; k < CP_VEHICLE_PARAMETER_COUNT; k++)
        cp_vehicle_model_set(&member, k, model->member[index][k]);

    // An outline stretched over a traffic vehicle stays.
    member.length_m = fmax(member.length_m, model->length_m);
    member.width_m = fmax(member.width_m, model->width_m);
    return member;
}

size_t cp_vehicle_parameter_index(const char *name)
{
    size_t index = 0;
    while (index < CP_VEHICLE_PARAMETER_COUNT &&
           strcmp(CP_VEHICLE_PARAMETER[index].name, name) != 0)
        index++;
    return index;
}

// ---- the file ------------------------------------------------------------------------------

typedef struct yaml_parameter {
    char *name;
    char *value;
    char *unit;
    char *source;
    char *min;
    char *max;
    char *scatter;
} yaml_parameter;

typedef struct yaml_calibrated {
    char *speed_min_km_h;
    char *speed_max_km_h;
    char *offset_max_mm;
    char *angle_max_deg;
} yaml_calibrated;

typedef struct yaml_barrier {
    char *width_m;
    char *depth_m;
    char *corner_radius_m;
    char *pivot_m;
    char *source;
} yaml_barrier;

typedef struct yaml_ensemble {
    char *name;
    char **values;
    unsigned values_count;
} yaml_ensemble;

typedef struct yaml_vehicle {
    char *vehicle;
    char *description;
    yaml_calibrated *calibrated;
    yaml_barrier *barrier;
    yaml_parameter *parameters;
    unsigned parameters_count;
    yaml_ensemble *ensemble;
    unsigned ensemble_count;
} yaml_vehicle;

#define OPTIONAL_TEXT(key, type)                                                                   \
    CYAML_FIELD_STRING_PTR(#key, CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, type, key, 0,           \
                           CYAML_UNLIMITED)
#define REQUIRED_TEXT(key, type)                                                                   \
    CYAML_FIELD_STRING_PTR(#key, CYAML_FLAG_POINTER, type, key, 0, CYAML_UNLIMITED)

static const cyaml_schema_field_t PARAMETER_FIELDS[] = {
    REQUIRED_TEXT(name, yaml_parameter),    REQUIRED_TEXT(value, yaml_parameter),
    OPTIONAL_TEXT(unit, yaml_parameter),    OPTIONAL_TEXT(source, yaml_parameter),
    OPTIONAL_TEXT(min, yaml_parameter),     OPTIONAL_TEXT(max, yaml_parameter),
    OPTIONAL_TEXT(scatter, yaml_parameter), CYAML_FIELD_END};

static const cyaml_schema_value_t PARAMETER_VALUE = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, yaml_parameter, PARAMETER_FIELDS)};

static const cyaml_schema_field_t CALIBRATED_FIELDS[] = {
    REQUIRED_TEXT(speed_min_km_h, yaml_calibrated), REQUIRED_TEXT(speed_max_km_h, yaml_calibrated),
    REQUIRED_TEXT(offset_max_mm, yaml_calibrated), REQUIRED_TEXT(angle_max_deg, yaml_calibrated),
    CYAML_FIELD_END};

static const cyaml_schema_field_t BARRIER_FIELDS[] = {
    REQUIRED_TEXT(width_m, yaml_barrier),         REQUIRED_TEXT(depth_m, yaml_barrier),
    REQUIRED_TEXT(corner_radius_m, yaml_barrier), REQUIRED_TEXT(pivot_m, yaml_barrier),
    OPTIONAL_TEXT(source, yaml_barrier),          CYAML_FIELD_END};

static const cyaml_schema_value_t MEMBER_VALUE = {
    CYAML_VALUE_STRING(CYAML_FLAG_POINTER, char, 0, CYAML_UNLIMITED)};

static const cyaml_schema_field_t ENSEMBLE_FIELDS[] = {
    REQUIRED_TEXT(name, yaml_ensemble),
    CYAML_FIELD_SEQUENCE("values", CYAML_FLAG_POINTER, yaml_ensemble, values, &MEMBER_VALUE, 1,
                         CP_ENSEMBLE_MAX),
    CYAML_FIELD_END};

static const cyaml_schema_value_t ENSEMBLE_VALUE = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, yaml_ensemble, ENSEMBLE_FIELDS)};

static const cyaml_schema_field_t VEHICLE_FIELDS[] = {
    REQUIRED_TEXT(vehicle, yaml_vehicle),
    OPTIONAL_TEXT(description, yaml_vehicle),
    CYAML_FIELD_MAPPING_PTR("calibrated", CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, yaml_vehicle,
                            calibrated, CALIBRATED_FIELDS),
    CYAML_FIELD_MAPPING_PTR("barrier", CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, yaml_vehicle,
                            barrier, BARRIER_FIELDS),
    CYAML_FIELD_SEQUENCE("parameters", CYAML_FLAG_POINTER, yaml_vehicle, parameters,
                         &PARAMETER_VALUE, 0, CYAML_UNLIMITED),
    CYAML_FIELD_SEQUENCE("ensemble", CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, yaml_vehicle,
                         ensemble, &ENSEMBLE_VALUE, 1, CYAML_UNLIMITED),
    CYAML_FIELD_END};

const cyaml_schema_value_t CP_VEHICLE_SCHEMA = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_POINTER, yaml_vehicle, VEHICLE_FIELDS)};

static cp_status read_calibrated(const cp_yaml_file *file, const yaml_calibrated *calibrated,
                                 cp_vehicle_model *model, cp_error *error)
{
    if (calibrated == NULL)
        return CP_OK;
    double speed_min_km_h = 0.0, speed_max_km_h = 0.0, offset_max_mm = 0.0, angle_max_deg = 0.0;
    cp_status status = cp_yaml_number(file, "calibrated.speed_min_km_h", calibrated->speed_min_km_h,
                                      0, 300, &speed_min_km_h, error);
    if (status == CP_OK)
        status = cp_yaml_number(file, "calibrated.speed_max_km_h", calibrated->speed_max_km_h,
                                speed_min_km_h, 300, &speed_max_km_h, error);
    if (status == CP_OK)
        status = cp_yaml_number(file, "calibrated.offset_max_mm", calibrated->offset_max_mm, 0,
                                3000, &offset_max_mm, error);
    if (status == CP_OK)
        status = cp_yaml_number(file, "calibrated.angle_max_deg", calibrated->angle_max_deg, 0, 90,
                                &angle_max_deg, error);
    model->calibrated_speed_min_m_s = cp_m_s_from_km_h(speed_min_km_h);
    model->calibrated_speed_max_m_s = cp_m_s_from_km_h(speed_max_km_h);
    model->calibrated_offset_max_m = 1e-3 * offset_max_mm;
    model->calibrated_angle_max_rad = cp_rad_from_deg(angle_max_deg);
    return status;
}

static cp_status read_barrier(const cp_yaml_file *file, const yaml_barrier *given,
                              cp_barrier *barrier, cp_error *error)
{
    if (given == NULL)
        return CP_OK;
    cp_status status =
        cp_yaml_number(file, "barrier.width_m", given->width_m, 0.3, 20, &barrier->width_m, error);
    if (status == CP_OK)
        status = cp_yaml_number(file, "barrier.depth_m", given->depth_m, 0.3, 20, &barrier->depth_m,
                                error);
    if (status == CP_OK)
        status = cp_yaml_number(file, "barrier.corner_radius_m", given->corner_radius_m, 0, 10,
                                &barrier->corner_radius_m, error);
    if (status == CP_OK)
        status = cp_yaml_number(file, "barrier.pivot_m", given->pivot_m, -3, 3, &barrier->pivot_m,
                                error);
    return status == CP_OK ? cp_barrier_validate(barrier, error) : status;
}

// What takes the place of a parameter of an earlier version of the model, or NULL.
static const char *successor_of(const char *name)
{
#define CP_VEHICLE_SUCCESSOR(former, successor)                                                    \
    if (strcmp(name, former) == 0)                                                                 \
        return successor;
    CP_VEHICLE_FORMER_PARAMETERS(CP_VEHICLE_SUCCESSOR)
#undef CP_VEHICLE_SUCCESSOR
    return NULL;
}

static cp_status read_parameter(const cp_yaml_file *file, const yaml_parameter *entry, size_t row,
                                bool *given, cp_vehicle_model *model, cp_error *error)
{
    char key_path[128];
    snprintf(key_path, sizeof key_path, "parameters[%zu].name", row);
    size_t index = cp_vehicle_parameter_index(entry->name);
    if (successor_of(entry->name) != NULL) {
        cp_log_warning("%s:%zu: %s is no longer part of the vehicle model and is not used: crush "
                       "forces grow with the rate by %s. Fit this vehicle anew (crashpulse "
                       "calibrate) and leave it out",
                       file->path, cp_yaml_line_of(file, key_path), entry->name,
                       successor_of(entry->name));
        return CP_OK;
    }
    if (index == CP_VEHICLE_PARAMETER_COUNT)
        return cp_yaml_fail(file, error, key_path, "'%s' is no parameter of the vehicle model",
                            entry->name);
    if (given[index])
        return cp_yaml_fail(file, error, key_path, "'%s' is given twice", entry->name);
    given[index] = true;
    const cp_vehicle_parameter *parameter = &CP_VEHICLE_PARAMETER[index];
    if (entry->unit != NULL && strcmp(entry->unit, parameter->unit) != 0)
        return cp_yaml_fail(file, error, key_path, "unit must be '%s', found '%s'", parameter->unit,
                            entry->unit);

    // The file's own bounds must lie within the table's, its value within both.
    double smallest = parameter->smallest, largest = parameter->largest;
    double value = parameter->standard;
    snprintf(key_path, sizeof key_path, "parameters[%zu].min", row);
    cp_status status =
        cp_yaml_number(file, key_path, entry->min, smallest, largest, &smallest, error);
    snprintf(key_path, sizeof key_path, "parameters[%zu].max", row);
    if (status == CP_OK)
        status = cp_yaml_number(file, key_path, entry->max, smallest, largest, &largest, error);
    snprintf(key_path, sizeof key_path, "parameters[%zu].scatter", row);
    if (status == CP_OK)
        status = cp_yaml_number(file, key_path, entry->scatter, 0.0, 0.5, &model->scatter_1[index],
                                error);
    snprintf(key_path, sizeof key_path, "parameters[%zu].value", row);
    if (status == CP_OK)
        status = cp_yaml_number(file, key_path, entry->value, smallest, largest, &value, error);
    if (status != CP_OK)
        return cp_error_prefix(error, "parameter '%s': ", entry->name);
    cp_vehicle_model_set(model, index, value);
    model->smallest[index] = smallest;
    model->largest[index] = largest;
    return CP_OK;
}

// One parameter in every set of the ensemble.
static cp_status read_ensemble_row(const cp_yaml_file *file, const yaml_ensemble *entry, size_t row,
                                   cp_vehicle_model *model, cp_error *error)
{
    char key_path[128];
    snprintf(key_path, sizeof key_path, "ensemble[%zu].name", row);
    size_t index = cp_vehicle_parameter_index(entry->name);
    if (index == CP_VEHICLE_PARAMETER_COUNT)
        return cp_yaml_fail(file, error, key_path, "'%s' is no parameter of the vehicle model",
                            entry->name);
    snprintf(key_path, sizeof key_path, "ensemble[%zu].values", row);
    if (entry->values_count != model->member_count)
        return cp_yaml_fail(file, error, key_path,
                            "must have as many values as the first parameter's, %zu, found %u",
                            model->member_count, entry->values_count);
    for (unsigned m = 0; m < entry->values_count; m++) {
        snprintf(key_path, sizeof key_path, "ensemble[%zu].values[%u]", row, m);
        cp_status status = cp_yaml_number(file, key_path, entry->values[m], model->smallest[index],
                                          model->largest[index], &model->member[m][index], error);
        if (status != CP_OK)
            return cp_error_prefix(error, "parameter '%s': ", entry->name);
    }
    return CP_OK;
}

// The ensemble: what it does not name is as in the car itself. Every set must be a car.
static cp_status read_ensemble(const cp_yaml_file *file, const yaml_vehicle *vehicle,
                               cp_vehicle_model *model, cp_error *error)
{
    if (vehicle->ensemble_count == 0)
        return CP_OK;
    model->member_count = vehicle->ensemble[0].values_count;
    for (size_t m = 0; m < model->member_count; m++)
        for (size_t k = 0; k < CP_VEHICLE_PARAMETER_COUNT; k++)
            model->member[m][k] = cp_vehicle_model_get(model, k);
    cp_status status = CP_OK;
    for (size_t row = 0; status == CP_OK && row < vehicle->ensemble_count; row++)
        status = read_ensemble_row(file, &vehicle->ensemble[row], row, model, error);
    for (size_t m = 0; status == CP_OK && m < model->member_count; m++) {
        cp_vehicle_model member = cp_vehicle_model_member(model, m);
        status = cp_vehicle_model_validate(&member, error);
        if (status != CP_OK)
            status = cp_error_prefix(error, "%s: set %zu of the ensemble: ", file->path, m + 1);
    }
    return status;
}

cp_status cp_vehicle_model_parse(const char *name, const char *content, size_t size,
                                 cp_vehicle_model *model, cp_error *error)
{
    cp_yaml_file file = {0};
    cp_status status = cp_yaml_parse(name, content, size, &CP_VEHICLE_SCHEMA, &file, error);
    if (status != CP_OK)
        return status;
    const yaml_vehicle *vehicle = (const yaml_vehicle *)file.data;
    *model = cp_vehicle_model_default();
    if (strlen(vehicle->vehicle) >= sizeof model->name || vehicle->vehicle[0] == '\0')
        status = cp_yaml_fail(&file, error, "vehicle", "must have 1 to %zu characters",
                              sizeof model->name - 1);
    snprintf(model->name, sizeof model->name, "%s", vehicle->vehicle);
    if (vehicle->description != NULL)
        snprintf(model->description, sizeof model->description, "%s", vehicle->description);
    if (status == CP_OK)
        status = read_calibrated(&file, vehicle->calibrated, model, error);
    if (status == CP_OK)
        status = read_barrier(&file, vehicle->barrier, &model->barrier, error);

    bool given[CP_VEHICLE_PARAMETER_TOTAL] = {false};
    for (size_t row = 0; status == CP_OK && row < vehicle->parameters_count; row++)
        status = read_parameter(&file, &vehicle->parameters[row], row, given, model, error);
    if (!given[cp_vehicle_parameter_index("longitudinal_collapse_middle_kn")])
        model->longitudinal_collapse_middle_kn =
            0.5 * (model->longitudinal_collapse_begin_kn + model->longitudinal_collapse_end_kn);
    if (status == CP_OK)
        status = read_ensemble(&file, vehicle, model, error);
    cp_yaml_close(&file);
    if (status != CP_OK)
        return status;
    cp_hash_bytes(content, size, model->hash);
    status = cp_vehicle_model_validate(model, error);
    return status == CP_OK ? CP_OK : cp_error_prefix(error, "%s: ", name);
}

cp_status cp_vehicle_model_load(const char *path, cp_vehicle_model *model, cp_error *error)
{
    char *content = NULL;
    size_t size = 0;
    cp_status status = cp_file_read(path, &content, &size, error);
    if (status == CP_OK)
        status = cp_vehicle_model_parse(path, content, size, model, error);
    free(content);
    return status;
}

// ---- validation ----------------------------------------------------------------------------

static cp_status check_ranges(const cp_vehicle_model *model, cp_error *error)
{
    for (size_t k = 0; k < CP_VEHICLE_PARAMETER_COUNT; k++) {
        const cp_vehicle_parameter *parameter = &CP_VEHICLE_PARAMETER[k];
        double value = cp_vehicle_model_get(model, k);
        if (!(value >= parameter->smallest && value <= parameter->largest))
            return cp_fail(error, CP_BAD_INPUT, "%s must be between %g and %g %s, found %g",
                           parameter->name, parameter->smallest, parameter->largest,
                           parameter->unit, value);
    }
    return CP_OK;
}

static cp_status check_collapse(cp_error *error, const char *element, double begin_m, double end_m,
                                double length_m)
{
    if (end_m <= begin_m)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s_collapse_end_m must be above %s_collapse_begin_m = %g, found %g",
                       element, element, begin_m, end_m);
    const double rounding_m = 1e-6; // of numbers in a file
    if (end_m > length_m + rounding_m)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s_collapse_end_m must not exceed the %g m the element is long, found %g",
                       element, length_m, end_m);
    return CP_OK;
}

// Steepest slope of a crush law: unloading where nothing is left, or the stop.
static double steepest_n_m(const cp_crush_law *law)
{
    return fmax(law->unload_end_n_m, law->stop_n_m);
}

static double in_parallel(double one, double other)
{
    return one * other / (one + other);
}

double cp_vehicle_model_cell_mass(const cp_vehicle_model *model)
{
    double side_kg =
        model->longitudinal_mass_kg + model->crash_box_mass_kg + model->cross_member_mass_kg;
    return model->mass_kg - model->engine_mass_kg - 2.0 * side_kg;
}

double cp_vehicle_model_largest_step(const cp_vehicle_model *m, const char **element)
{
    // Square of the fastest oscillation of every element between the masses it couples. A cross
    // member half on its two contact points rocks at 6 k / m.
    double front_kg = m->crash_box_mass_kg + m->cross_member_mass_kg;
    double root_kg = 0.4 * m->mass_kg;
    cp_crush_law box = cp_crash_box_law(m), rail = cp_longitudinal_law(m),
                 bay = cp_engine_bay_law(m);
    const struct {
        const char *name;
        double omega_square;
    } ELEMENTS[] = {
        {"crash box (unload_end_factor_1 times the steepest of bumper and crash box)",
         steepest_n_m(&box) / in_parallel(front_kg, m->longitudinal_mass_kg)},
        {"longitudinal (unload_end_factor_1 * longitudinal_collapse_begin_kn / "
         "longitudinal_collapse_begin_m)",
         steepest_n_m(&rail) / in_parallel(front_kg + m->longitudinal_mass_kg, root_kg)},
        {"firewall (unload_end_factor_1 * firewall_stiffness_kn_m)",
         2.0 * steepest_n_m(&bay) / in_parallel(m->engine_mass_kg, root_kg)},
        {"contact (contact_stiffness_kn_m)",
         6e3 * m->contact_stiffness_kn_m / m->cross_member_mass_kg},
    };
    double fastest = 0.0;
    for (size_t k = 0; k < sizeof ELEMENTS / sizeof *ELEMENTS; k++) {
        if (ELEMENTS[k].omega_square <= fastest)
            continue;
        fastest = ELEMENTS[k].omega_square;
        if (element != NULL)
            *element = ELEMENTS[k].name;
    }
    return 1.2 / sqrt(fastest);
}

// Side and rear: depths rise, and something is left of the car between front and rear structure.
static cp_status check_struck(const cp_vehicle_model *m, double front_length_m, cp_error *error)
{
    if (m->side_collapse_end_m <= m->side_collapse_begin_m)
        return cp_fail(error, CP_BAD_INPUT,
                       "side_collapse_end_m must be above side_collapse_begin_m = %g, found %g",
                       m->side_collapse_begin_m, m->side_collapse_end_m);
    const double least_m = m->rear_bumper_m + 0.05; // rise and collapse of the rails
    if (m->rear_collapse_end_m < least_m)
        return cp_fail(error, CP_BAD_INPUT,
                       "rear_collapse_end_m must be at least rear_bumper_m + 0.05 = %g, found %g",
                       least_m, m->rear_collapse_end_m);
    double between_m = m->length_m - front_length_m;
    if (m->rear_collapse_end_m > 0.8 * between_m)
        return cp_fail(error, CP_BAD_INPUT,
                       "rear_collapse_end_m must not exceed 80 %% of the %g m behind the firewall, "
                       "found %g",
                       between_m, m->rear_collapse_end_m);
    return CP_OK;
}

cp_status cp_vehicle_model_validate(const cp_vehicle_model *m, cp_error *error)
{
    if (m->is_barrier)
        return cp_barrier_validate(&m->barrier, error);
    cp_status status = check_ranges(m, error);
    if (status != CP_OK)
        return status;

    if (m->corner_strips_1 != floor(m->corner_strips_1))
        return cp_fail(error, CP_BAD_INPUT, "corner_strips_1 must be a whole number, found %g",
                       m->corner_strips_1);
    if (m->upper_strips_1 != floor(m->upper_strips_1))
        return cp_fail(error, CP_BAD_INPUT, "upper_strips_1 must be a whole number, found %g",
                       m->upper_strips_1);

    // Lengths: what collapses fits its member, the engine bay holds an engine.
    double front_length_m =
        m->cross_member_depth_m + m->crash_box_length_m + m->longitudinal_length_m;
    double corner_length_m = front_length_m - m->corner_gap_m;
    double engine_length_m = m->crash_box_length_m + m->longitudinal_length_m -
                             m->engine_gap_front_m - m->engine_gap_firewall_m;
    if (engine_length_m < 0.1)
        return cp_fail(error, CP_BAD_INPUT,
                       "engine_gap_front_m + engine_gap_firewall_m leave %g m for the engine "
                       "between cross member and firewall, at least 0.1 are needed",
                       engine_length_m);
    if (front_length_m >= m->cg_to_front_m)
        return cp_fail(error, CP_BAD_INPUT,
                       "cg_to_front_m must exceed the front structure's length %g, found %g",
                       front_length_m, m->cg_to_front_m);
    if (m->cg_to_front_m >= m->length_m)
        return cp_fail(error, CP_BAD_INPUT, "cg_to_front_m must be below length_m = %g, found %g",
                       m->length_m, m->cg_to_front_m);
    if (m->cross_member_half_width_m > 0.5 * m->width_m)
        return cp_fail(error, CP_BAD_INPUT,
                       "cross_member_half_width_m must not exceed half the width %g, found %g",
                       0.5 * m->width_m, m->cross_member_half_width_m);
    if (m->longitudinal_y_m >= m->cross_member_half_width_m)
        return cp_fail(error, CP_BAD_INPUT,
                       "longitudinal_y_m must be below cross_member_half_width_m = %g, found %g",
                       m->cross_member_half_width_m, m->longitudinal_y_m);
    if (m->bumper_stroke_m > 0.75 * m->cross_member_depth_m)
        return cp_fail(error, CP_BAD_INPUT,
                       "bumper_stroke_m must not exceed three quarters of cross_member_depth_m = "
                       "%g, found %g",
                       m->cross_member_depth_m, m->bumper_stroke_m);
    if (2.0 * m->corner_radius_m > m->cross_member_depth_m)
        return cp_fail(
            error, CP_BAD_INPUT,
            "corner_radius_m must not exceed half of cross_member_depth_m = %g, found %g",
            m->cross_member_depth_m, m->corner_radius_m);
    status = check_collapse(error, "longitudinal", m->longitudinal_collapse_begin_m,
                            m->longitudinal_collapse_end_m, m->longitudinal_length_m);
    if (status == CP_OK)
        status = check_collapse(error, "crash_box", m->crash_box_collapse_begin_m,
                                m->crash_box_collapse_end_m, m->crash_box_length_m);
    if (status == CP_OK)
        status = check_collapse(error, "corner", m->corner_collapse_begin_m,
                                m->corner_collapse_end_m, corner_length_m);
    if (status == CP_OK)
        status = check_collapse(error, "upper", m->upper_collapse_begin_m, m->upper_collapse_end_m,
                                front_length_m - m->upper_gap_m);
    if (status != CP_OK)
        return status;

    status = check_struck(m, front_length_m, error);
    if (status != CP_OK)
        return status;

    // Masses: most of the car lies behind the firewall.
    double front_mass_kg =
        m->engine_mass_kg +
        2.0 * (m->longitudinal_mass_kg + m->crash_box_mass_kg + m->cross_member_mass_kg);
    if (front_mass_kg > 0.6 * m->mass_kg)
        return cp_fail(error, CP_BAD_INPUT,
                       "mass_kg must leave at least 40 %% behind the firewall; the front parts "
                       "weigh %g of %g kg",
                       front_mass_kg, m->mass_kg);

    // Stiffness: the standard time step must do.
    const char *element = NULL;
    double largest_s = cp_vehicle_model_largest_step(m, &element);
    if (largest_s < 0.0005)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s is so stiff that the time step would have to be below %.3f ms, 0.5 ms "
                       "must do",
                       element, 1e3 * largest_s);
    return CP_OK;
}
