/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/suite_struck.h"

#include "core/units.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Places tried where a test's is not known: shares of what strikes a side that lie within the side,
// from its front end, from its rear end, and its middle; shares of the rear's width from either
// side.
static const double UNKNOWN_SHARE_1[] = {0.2, 0.6, 1.0};
static const double UNKNOWN_OVERLAP_1[] = {0.2, 0.4, 0.6, 0.8, 1.0};

#define COUNT(list) (sizeof(list) / sizeof *(list))

// Forces of side and rear, both ends of every collapse.
static void scale_forces(cp_vehicle_model *model, double factor_1)
{
    double *const forces[] = {&model->side_front_wheel_begin_kn_m,
                              &model->side_front_wheel_end_kn_m,
                              &model->side_door_begin_kn_m,
                              &model->side_door_end_kn_m,
                              &model->side_rear_wheel_begin_kn_m,
                              &model->side_rear_wheel_end_kn_m,
                              &model->rear_bumper_kn,
                              &model->rear_collapse_begin_kn,
                              &model->rear_collapse_end_kn,
                              &model->rear_side_kn};
    for (size_t k = 0; k < COUNT(forces); k++)
        *forces[k] *= factor_1;
}

// The number of a list, or what stands for an empty one.
static double listed(const cp_suite_numbers *numbers, size_t k, double otherwise)
{
    return numbers->count > 0 ? numbers->value[k] : otherwise;
}

static size_t at_least_one(size_t count)
{
    return count > 0 ? count : 1;
}

static void name_case(const cp_suite_class *class, cp_suite_case *row, double speed_km_h,
                      double factor_1)
{
    size_t size = sizeof row->label;
    int used = snprintf(row->label, size, "%.4g km/h, %.40s at %.4g mm", speed_km_h,
                        row->model[1].name, 1e3 * row->offset_m[0]);
    if (class->sides_1.count > 1)
        used += snprintf(row->label + used, size - (size_t)used, ", %s",
                         row->side_1 > 0.0 ? "left" : "right");
    if (row->angle_rad != 0.0)
        used += snprintf(row->label + used, size - (size_t)used, ", %+g deg",
                         cp_deg_from_rad(row->angle_rad));
    if (factor_1 != 1.0)
        snprintf(row->label + used, size - (size_t)used, ", forces x %g", factor_1);
}

// Number k of all combinations; the last list goes round fastest.
static cp_status listed_case(const cp_suite *suite, const cp_suite_class *class, size_t k,
                             cp_suite_case *row, cp_error *error)
{
    const size_t counts[] = {
        at_least_one(class->against.count),    class->speeds_km_h.count,
        at_least_one(class->at_mm.count),      class->sides_1.count,
        at_least_one(class->angles_deg.count), at_least_one(class->struck_forces_1.count)};
    size_t index[COUNT(counts)];
    for (size_t list = COUNT(counts); list-- > 0; k /= counts[list])
        index[list] = k % counts[list];

    cp_status status = CP_OK;
    row->is_pair = true;
    if (class->has_barrier)
        row->model[1] = cp_vehicle_model_of_barrier(&class->barrier);
    else if (strcmp(class->against.text[index[0]], "same") != 0)
        status =
            cp_suite_vehicle(suite->path, class->against.text[index[0]], &row->model[1], error);
    row->has_barrier = false;
    double speed_km_h = class->speeds_km_h.value[index[1]];
    row->speed_m_s[0] = cp_m_s_from_km_h(listed(&class->struck_speeds_km_h, index[1], 0.0));
    row->speed_m_s[1] = cp_m_s_from_km_h(speed_km_h);
    row->side_1 = class->sides_1.value[index[3]];
    row->struck = class->is_struck_on_rear ? CP_SIDE_REAR
                  : row->side_1 > 0.0      ? CP_SIDE_LEFT
                                           : CP_SIDE_RIGHT;
    row->offset_m[0] = 1e-3 * listed(&class->at_mm, index[2], 0.0);
    row->angle_rad = row->side_1 * cp_rad_from_deg(listed(&class->angles_deg, index[4], 0.0));
    if (class->is_struck_on_rear)
        row->offset_m[0] *= row->side_1;
    double factor_1 = listed(&class->struck_forces_1, index[5], 1.0);
    scale_forces(&row->model[0], factor_1);
    name_case(class, row, speed_km_h, factor_1);
    return status;
}

cp_status cp_suite_struck_listed(const cp_suite *suite, const cp_suite_class *class,
                                 const cp_vehicle_model *vehicle, cp_suite_cases *cases,
                                 cp_error *error)
{
    size_t total = at_least_one(class->against.count) * class->speeds_km_h.count *
                   at_least_one(class->at_mm.count) * class->sides_1.count *
                   at_least_one(class->angles_deg.count) *
                   at_least_one(class->struck_forces_1.count);
    cp_status status = cp_suite_cases_make(cases, total, error);
    for (size_t k = 0; status == CP_OK && k < total; k++) {
        cases->row[k] = cp_suite_plain_case(class, vehicle);
        status = listed_case(suite, class, k, &cases->row[k], error);
        cases->count++;
    }
    return status;
}

// Places on the struck car where the middle of the striking front may have met it.
static void try_places(cp_suite_case *row)
{
    const cp_vehicle_model *struck = &row->model[0], *striking = &row->model[1];
    if (row->struck != CP_SIDE_REAR) {
        // The middle of the side, then pairs the same distance before and behind it.
        double middle_m = struck->cg_to_front_m - 0.5 * struck->length_m;
        row->offset_m[0] = middle_m;
        row->offset_count = 1 + 2 * COUNT(UNKNOWN_SHARE_1);
        for (size_t k = 0; k + 1 < row->offset_count; k++) {
            double reach_m = 0.5 * (struck->length_m + striking->width_m) -
                             UNKNOWN_SHARE_1[k / 2] * striking->width_m;
            row->offset_m[k + 1] = middle_m + (k % 2 == 0 ? reach_m : -reach_m);
        }
        return;
    }
    row->offset_count = 2 * COUNT(UNKNOWN_OVERLAP_1);
    for (size_t k = 0; k < row->offset_count; k++) {
        double reach_m = 0.5 * (struck->width_m + striking->width_m) -
                         UNKNOWN_OVERLAP_1[k / 2] * struck->width_m;
        row->offset_m[k] = k % 2 == 0 ? reach_m : -reach_m;
    }
}

static cp_status read_side(const cp_csv_table *table, size_t k, const cp_suite_class *class,
                           cp_suite_case *row, bool *use, cp_error *error)
{
    const char *test = NULL, *text = NULL;
    cp_status status = cp_csv_table_text(table, k, "test", &test, error);
    if (status == CP_OK)
        status = cp_csv_table_text(table, k, "struck", &text, error);
    if (status != CP_OK)
        return status;
    row->struck = CP_SIDE_FRONT;
    for (cp_contact_side side = CP_SIDE_LEFT; side <= CP_SIDE_REAR; side++)
        if (strcmp(text, cp_contact_side_text(side)) == 0)
            row->struck = side;
    if (row->struck == CP_SIDE_FRONT)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s: test %s: struck must be left, right or rear, found '%s'", table->path,
                       test, text);
    *use = false;
    for (size_t n = 0; n < class->rows_with.count; n++)
        *use = *use || strcmp(text, class->rows_with.text[n]) == 0;
    row->side_1 = row->struck == CP_SIDE_RIGHT ? -1.0 : 1.0;
    snprintf(row->label, sizeof row->label, "test %.40s, %s", test, text);
    return CP_OK;
}

cp_status cp_suite_struck_case(const cp_csv_table *table, size_t k, const cp_suite_class *class,
                               cp_suite_case *row, bool *use, cp_error *error)
{
    double angle_deg = 0.0, mass_kg[2];
    const cp_suite_column columns[] = {
        {"speed_1_m_s", 0.0, 80.0, &row->speed_m_s[0]},
        {"speed_2_m_s", 0.0, 80.0, &row->speed_m_s[1]},
        {"angle_deg", -75.0, 75.0, &angle_deg},
        {"mass_1_kg", 500.0, 5000.0, &mass_kg[0]},
        {"mass_2_kg", 500.0, 5000.0, &mass_kg[1]},
        {"delta_v_1_m_s", 0.1, 100.0, &row->reference[0][CP_SUITE_delta_v_m_s]},
        {"delta_v_2_m_s", 0.1, 100.0, &row->reference[1][CP_SUITE_delta_v_m_s]},
    };
    cp_status status = cp_suite_read_columns(table, k, columns, COUNT(columns), error);
    if (status != CP_OK)
        return status;
    row->angle_rad = cp_rad_from_deg(angle_deg);
    for (int c = 0; c < 2; c++)
        cp_suite_set_mass(&row->model[c], mass_kg[c]);
    status = read_side(table, k, class, row, use, error);
    if (status == CP_OK)
        try_places(row);
    return status;
}
