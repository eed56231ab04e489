/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/suite_case.h"

#include "core/units.h"
#include "crash/named_vehicle.h"

#include <math.h>
#include <stdlib.h>

int cp_suite_case_cars(const cp_suite_class *class, const cp_suite_comparison *comparison)
{
    cp_suite_quantity quantity = comparison->quantity;
    bool both = class->form == CP_SUITE_OBLIQUE || class->form == CP_SUITE_RECONSTRUCTED ||
                class->form == CP_SUITE_STRUCK;
    bool of_each = quantity == CP_SUITE_delta_v_m_s || quantity == CP_SUITE_yaw_rate_deg_s;
    return both && of_each && comparison->car == 0 ? 2 : 1;
}

cp_status cp_suite_vehicle(const char *base, const char *text, cp_vehicle_model *model,
                           cp_error *error)
{
    return cp_named_vehicle_load(base, text, model, error);
}

// ---- making cases ------------------------------------------------------------------------------

cp_suite_case cp_suite_plain_case(const cp_suite_class *class, const cp_vehicle_model *vehicle)
{
    cp_suite_case row = {.model = {*vehicle, *vehicle},
                         .has_barrier = class->has_barrier,
                         .barrier = class->barrier,
                         .side_1 = 1.0,
                         .offset_count = 1};
    for (int c = 0; c < 2; c++)
        for (int q = 0; q < CP_SUITE_QUANTITY_COUNT; q++)
            row.reference[c][q] = NAN;
    return row;
}

cp_status cp_suite_cases_make(cp_suite_cases *cases, size_t count, cp_error *error)
{
    cases->row = calloc(count, sizeof *cases->row);
    return cases->row != NULL ? CP_OK : cp_fail_memory(error, "cases of a suite");
}

void cp_suite_set_mass(cp_vehicle_model *model, double mass_kg)
{
    model->yaw_inertia_kg_m2 *= mass_kg / model->mass_kg;
    model->mass_kg = mass_kg;
}

cp_status cp_suite_read_columns(const cp_csv_table *table, size_t k, const cp_suite_column *columns,
                                size_t count, cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t c = 0; status == CP_OK && c < count; c++)
        status = cp_csv_table_number(table, k, columns[c].column, columns[c].smallest,
                                     columns[c].largest, false, columns[c].value, error);
    return status;
}

void cp_suite_cases_destroy(cp_suite_cases *cases)
{
    free(cases->row);
    *cases = (cp_suite_cases){0};
}

// ---- simulating one ----------------------------------------------------------------------------

static cp_status simulate(const cp_suite_case *row, bool pair, double offset_m,
                          cp_crash_result *result, cp_error *error)
{
    const cp_vehicle_model *other = pair ? &row->model[1] : NULL;
    cp_crash_configuration configuration = row->configuration;
    cp_status status = CP_OK;
    if (row->struck != CP_SIDE_FRONT)
        status = cp_crash_configuration_struck(&row->model[0], other, row->struck, offset_m,
                                               row->angle_rad, row->speed_m_s[0], row->speed_m_s[1],
                                               &configuration, error);
    else if (!row->is_placed)
        status = cp_crash_configuration_from_description(
            &row->model[0], other, pair ? NULL : &row->barrier, row->speed_m_s[0],
            pair ? row->speed_m_s[1] : 0.0, offset_m, row->angle_rad, &configuration, error);
    if (status != CP_OK)
        return status;
    cp_crash_options options = cp_crash_options_default();
    options.duration_s = 0.31; // what is compared ends at 300 ms
    return cp_crash_simulate(&row->model[0], other, &configuration, &options, result, error);
}

cp_status cp_suite_case_simulate(const cp_suite_case *row, size_t index, cp_crash_result *result,
                                 cp_crash_result *wall, cp_error *error)
{
    *result = (cp_crash_result){0};
    *wall = (cp_crash_result){0};
    for (int c = 0; c < 1 + row->is_pair; c++) {
        cp_status status = cp_vehicle_model_validate(&row->model[c], error);
        if (status != CP_OK)
            return status;
    }
    cp_status status = simulate(row, row->is_pair, row->offset_m[index], result, error);
    if (status == CP_OK && row->is_pair && row->has_barrier)
        status = simulate(row, false, 0.0, wall, error);
    return status;
}
