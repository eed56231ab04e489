/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The files that the program reads. */
#include "fuzz.h"

#include "calibrate/fit_file.h"
#include "calibrate/reference_pulse.h"
#include "calibrate/suite_file.h"
#include "core/csv_table.h"
#include "crash/vehicle_model.h"
#include "exchange/configurations_csv.h"
#include "exchange/nhtsa_ev5.h"
#include "exchange/sumo_fcd.h"
#include "exchange/sumo_types.h"
#include "study/plan.h"
#include "study/study_file.h"
#include "study/sumo_configuration.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void fuzz_vehicle(const uint8_t *data, size_t size)
{
    cp_vehicle_model model;
    cp_error error = {0};
    cp_status status = cp_vehicle_model_parse("car.yaml", (const char *)data, size, &model, &error);
    fuzz_judge(status, &error);
    if (status != CP_OK)
        return;
    fuzz_must(cp_vehicle_model_validate(&model, &error) == CP_OK, "read, and not valid");
    fuzz_must(cp_vehicle_model_largest_step(&model, NULL) >= 0.0005, "unstable at 0.5 ms");
    for (size_t k = 0; k < model.member_count; k++) {
        cp_vehicle_model member = cp_vehicle_model_member(&model, k);
        fuzz_must(cp_vehicle_model_validate(&member, &error) == CP_OK, "a set is not valid");
    }
    for (size_t k = 0; k < CP_VEHICLE_PARAMETER_COUNT; k++)
        fuzz_must(model.scatter_1[k] >= 0.0 && model.scatter_1[k] <= 0.5, "scatter");
}

void fuzz_study(const uint8_t *data, size_t size)
{
    enum { PLANNED_MAX = 200, VEHICLES_MAX = 16 };
    cp_vehicle_model_row models[VEHICLES_MAX];
    for (int k = 0; k < VEHICLES_MAX; k++)
        models[k] = (cp_vehicle_model_row){"car", "0", "vehicle: car\n"};
    cp_study study = {0};
    cp_plan_rows plan = {0};
    cp_error error = {0};
    fuzz_write("study.yaml", data, size);
    cp_status status = cp_study_load("study.yaml", &study, &error);
    fuzz_judge(status, &error);
    if (status != CP_OK)
        return;
    fuzz_must(study.scenario_count > 0 && study.variant_count > 0 && study.replications > 0,
              "a study of nothing");
    fuzz_must(study.duration_s > study.warmup_s && isfinite(study.duration_s), "duration");
    fuzz_must(cp_study_baseline(&study) < study.variant_count, "no baseline");
    if (study.vehicle_count <= VEHICLES_MAX &&
        study.scenario_count * study.variant_count * study.replications <= PLANNED_MAX) {
        status = cp_plan_create(&study, models, study.vehicle_count, &plan, &error);
        fuzz_judge(status, &error);
        if (status == CP_OK)
            fuzz_must(plan.replication_count ==
                          study.scenario_count * study.variant_count * study.replications,
                      "a plan of another size");
        cp_plan_destroy(&plan);
    }
    cp_study_destroy(&study);
}

void fuzz_fit(const uint8_t *data, size_t size)
{
    cp_fit *fit = calloc(1, sizeof *fit);
    cp_error error = {0};
    fuzz_must(fit != NULL, "no memory");
    fuzz_write("fit.yaml", data, size);
    cp_status status = cp_fit_load("fit.yaml", NULL, fit, &error);
    fuzz_judge(status, &error);
    fuzz_must(status != CP_OK || (fit->unknown_count > 0 && fit->threads >= 1), "a fit of nothing");
    cp_fit_destroy(fit);
    free(fit);
}

void fuzz_suite(const uint8_t *data, size_t size)
{
    cp_suite suite = {0};
    cp_error error = {0};
    fuzz_write("suite.yaml", data, size);
    cp_status status = cp_suite_load("suite.yaml", &suite, &error);
    fuzz_judge(status, &error);
    fuzz_must(status != CP_OK || suite.class_count > 0, "a suite of nothing");
    cp_suite_destroy(&suite);
}

void fuzz_reference(const uint8_t *data, size_t size)
{
    cp_reference reference = {0};
    cp_error error = {0};
    fuzz_write("input.csv", data, size);
    cp_status status = cp_reference_load("input.csv", &reference, &error);
    fuzz_judge(status, &error);
    for (size_t k = 0; status == CP_OK && k < reference.count; k++) {
        const cp_reference_case *row = &reference.cases[k];
        fuzz_must(isfinite(row->speed_km_h + row->offset_mm + row->angle_deg + row->olc_g),
                  "a number that is not finite");
    }
    fuzz_must(status != CP_OK || reference.count > 0, "a reference of nothing");
    if (status == CP_OK)
        cp_reference_destroy(&reference);
}

void fuzz_configurations(const uint8_t *data, size_t size)
{
    cp_configuration_list list = {0};
    cp_error error = {0};
    fuzz_write("input.csv", data, size);
    cp_status status = cp_configurations_csv_read("input.csv", size % 2 == 0, &list, &error);
    fuzz_judge(status, &error);
    for (size_t k = 0; status == CP_OK && k < list.count; k++) {
        const cp_listed_configuration *row = &list.row[k];
        fuzz_must(row->id != NULL && row->line > 0, "a row without id or line");
        fuzz_must(row->speed_m_s[0] >= 0.0 && row->speed_m_s[1] >= 0.0 &&
                      row->speed_m_s[0] + row->speed_m_s[1] > 0.0 &&
                      isfinite(row->speed_m_s[0] + row->speed_m_s[1] + row->offset_m +
                               row->angle_rad + row->yaw_rate_rad_s[0] + row->yaw_rate_rad_s[1]),
                  "a number out of range");
    }
    cp_configuration_list_destroy(&list);
}

void fuzz_pulse_csv(const uint8_t *data, size_t size)
{
    cp_pulse_source source = {
        .path = "input.csv", .speed_km_h = NAN, .until_s = NAN, .weight_1 = 1.0};
    cp_reference_pulse pulse = {0};
    cp_error error = {0};
    fuzz_write("input.csv", data, size);
    cp_status status = cp_reference_pulse_load(&source, &pulse, &error);
    fuzz_judge(status, &error);
    fuzz_must(status != CP_OK || (pulse.interval_s > 0.0 && isfinite(pulse.until_s)),
              "an interval or end out of range");
    if (status == CP_OK)
        cp_reference_pulse_destroy(&pulse);
}

void fuzz_table(const uint8_t *data, size_t size)
{
    cp_csv_table table = {0};
    cp_error error = {0};
    fuzz_write("input.csv", data, size);
    cp_status status = cp_csv_table_load("input.csv", &table, &error);
    fuzz_judge(status, &error);
    for (size_t row = 0; status == CP_OK && row < table.row_count; row++)
        for (size_t column = 0; column < table.column_count; column++) {
            double value = 0.0;
            cp_error told = {0};
            cp_status one = cp_csv_table_number(&table, row, table.column[column], -1e9, 1e9, true,
                                                &value, &told);
            fuzz_judge(one, &told);
            fuzz_must(one != CP_OK || isnan(value) || fabs(value) <= 1e9, "a number out of range");
        }
    cp_csv_table_destroy(&table);
}

// First the records, then curve 7.
void fuzz_ev5(const uint8_t *data, size_t size)
{
    enum { CURVES_MAX = 4 };
    cp_ev5_test test = {0};
    cp_error error = {0};
    size_t records_size = 0, curve_size = 0;
    const uint8_t *records = fuzz_part(data, size, 0, &records_size);
    const uint8_t *curve = fuzz_part(data, size, 1, &curve_size);
    fuzz_write("t1.EV5", records, records_size);
    fuzz_write("t1.007", curve, curve_size);
    cp_status status = cp_ev5_load("t1.EV5", &test, &error);
    fuzz_judge(status, &error);
    for (size_t k = 0; status == CP_OK && k < test.instrument_count && k < CURVES_MAX; k++) {
        cp_ev5_channel channel = {0};
        cp_error told = {0};
        cp_status one = cp_ev5_channel_load(&test, test.instrument[k].curve, &channel, &told);
        fuzz_judge(one, &told);
        for (size_t s = 0; one == CP_OK && s < channel.sample_count; s++)
            fuzz_must(isfinite(channel.value[s]), "a sample that is not finite");
        if (one == CP_OK)
            cp_ev5_channel_destroy(&channel);
    }
    if (status == CP_OK)
        cp_ev5_destroy(&test);
}

void fuzz_collisions(const uint8_t *data, size_t size)
{
    cp_collision_list list = {0};
    cp_error error = {0};
    fuzz_write("input.xml", data, size);
    cp_status status = cp_sumo_collisions_read("input.xml", &list, &error);
    fuzz_judge(status, &error);
    for (size_t k = 0; status == CP_OK && k < list.count; k++)
        fuzz_must(isfinite(list.collision[k].time_s) &&
                      list.collision[k].last_s >= list.collision[k].time_s &&
                      strcmp(list.collision[k].id[0], list.collision[k].id[1]) != 0,
                  "a collision that cannot be");
    cp_collision_list_destroy(&list);
}

void fuzz_fcd(const uint8_t *data, size_t size)
{
    cp_collision_list list = {0};
    cp_fcd_record record = {0};
    cp_error error = {0};
    fuzz_write("input.xml", data, size);
    cp_status status = cp_sumo_collisions_read("collisions.xml", &list, &error);
    fuzz_must(status == CP_OK, error.text);
    status = cp_sumo_fcd_read("input.xml", &list, 3.0, 3.0, &record, &error);
    fuzz_judge(status, &error);
    for (int v = 0; status == CP_OK && v < 2; v++) {
        const cp_fcd_track *track = &record.track[0][v];
        for (size_t k = 0; k < track->count; k++) {
            const cp_fcd_sample *sample = &track->sample[k];
            fuzz_must(isfinite(sample->time_s + sample->front_m.x + sample->front_m.y +
                               sample->yaw_rad + sample->speed_m_s),
                      "a sample that is not finite");
            fuzz_must(k == 0 || sample->time_s > track->sample[k - 1].time_s, "time goes back");
        }
    }
    fuzz_must(status != CP_OK || (record.step_length_s > 0.0 && record.vehicle_km >= 0.0 &&
                                  isfinite(record.vehicle_km + record.vehicle_h)),
              "an exposure that cannot be");
    if (status == CP_OK)
        cp_fcd_record_destroy(&record);
    cp_collision_list_destroy(&list);
}

void fuzz_types(const uint8_t *data, size_t size)
{
    cp_vtypes types = {0};
    cp_error error = {0};
    fuzz_write("input.xml", data, size);
    cp_status status = cp_vtypes_read("input.xml", &types, &error);
    fuzz_judge(status, &error);
    for (size_t k = 0; status == CP_OK && k < types.count; k++)
        fuzz_must(types.type[k].length_m > 0.0 && types.type[k].width_m > 0.0 &&
                      isfinite(types.type[k].length_m + types.type[k].width_m) &&
                      cp_vtypes_find(&types, types.type[k].id) != NULL,
                  "a type that cannot be");
    cp_vtypes_destroy(&types);
}

void fuzz_sumocfg(const uint8_t *data, size_t size)
{
    cp_sumo_configuration configuration = {0};
    cp_error error = {0};
    fuzz_write("input.sumocfg", data, size);
    cp_status status = cp_sumo_configuration_read("input.sumocfg", NULL, 0, &configuration, &error);
    fuzz_judge(status, &error);
    if (status == CP_OK) {
        fuzz_must(!isnan(cp_sumo_configuration_length_s(&configuration)), "no length");
        fuzz_judge(cp_sumo_configuration_check(&configuration, 100.0, &error), &error);
    }
    cp_sumo_configuration_destroy(&configuration);
}
