/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/suite_row.h"

#include "crash/named_vehicle.h"

#include <math.h>
#include <stdlib.h>

cp_status cp_suite_vehicle(const char *base, const char *text, cp_vehicle_model *model,
                           cp_error *error)
{
    return cp_named_vehicle_load(base, text, model, error);
}

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
