/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/crash_record.h"

#include "crash/crash_simulation.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "builders/crash_library.h"

#include <math.h>
#include <string.h>

/* Impacts made by hand on a fleet of two: "car" by default, "van" for the SUMO type van. */

typedef struct small_fleet {
    cp_study_vehicle vehicles[2];
    cp_study study;
    cp_vehicle_model models[2];
    cp_fleet fleet;
} small_fleet;

static void fill_fleet(small_fleet *f)
{
    *f = (small_fleet){.vehicles = {{NULL, NULL}, {"van", NULL}},
                       .models = {cp_vehicle_model_default(), cp_vehicle_model_default()}};
    strcpy(f->models[0].name, "car");
    strcpy(f->models[1].name, "van");
    f->models[1].mass_kg = 2400;
    f->study = (cp_study){.vehicles = f->vehicles, .vehicle_count = 2};
    f->fleet = (cp_fleet){.study = &f->study, .models = f->models, .count = 2};
}

// Head-on at the origin with 15 m/s each, both as long and wide as their models; b stands offset_m
// to the left of a.
static cp_impact head_on(double offset_m)
{
    cp_vehicle_model model = cp_vehicle_model_default();
    cp_impact impact = {.time_s = 12.3,
                        .front_velocity_m_s = {{15, 0}, {-15, 0}},
                        .side = {CP_SIDE_FRONT, CP_SIDE_FRONT},
                        .verdict = CP_CONTACT_CONFIRMED};
    for (int role = 0; role < 2; role++)
        impact.state[role] = (cp_vehicle_state){.front_y_m = role * offset_m,
                                                .yaw_rad = role * 3.14159265358979323846,
                                                .speed_m_s = 15,
                                                .length_m = model.length_m,
                                                .width_m = model.width_m};
    impact.contact_m = (cp_vec2){0.0, 0.5 * offset_m};
    return impact;
}

static const cp_impact_names NAMES = {
    .sumo_id = {"one", "two"}, .sumo_type = {"passenger", "van"}, .at_fault = {true, false}};

static void record(const cp_impact *impact, cp_result_rows *rows)
{
    small_fleet f;
    cp_error error = {0};
    fill_fleet(&f);
    cp_crash_row *row = cp_result_rows_add_crash(rows);
    assert_non_null(row);
    assert_int_equal(cp_crash_record_fill(impact, &NAMES, &f.fleet, row, &error), CP_OK);
}

static void front_to_front(void **state)
{
    (void)state;
    cp_result_rows rows = {0};
    cp_impact impact = head_on(0.0);
    record(&impact, &rows);
    const cp_crash_row *crash = rows.crash;
    assert_true(fabs(crash->description.closing_speed_m_s - 30.0) < 1e-9);
    assert_true(fabs(crash->description.overlap_1 - 1.0) < 1e-9);
    assert_string_equal(crash->vehicle[0].vehicle_model, "car");
    assert_string_equal(crash->vehicle[1].vehicle_model, "van");
    assert_true(crash->vehicle[0].at_fault && !crash->vehicle[1].at_fault);
    for (int role = 0; role < 2; role++) {
        const cp_crash_vehicle_row *vehicle = &crash->vehicle[role];
        assert_int_equal(vehicle->severity.olc.status, CP_OLC_VALUE);
        assert_non_null(vehicle->pulse);
        assert_true(vehicle->crush_m > 0.1);
        assert_true(isnan(vehicle->severity.t_v0_s));
    }
    // Momentum: velocity changes are in the inverse ratio of the masses.
    double car = crash->vehicle[0].severity.delta_v_m_s * cp_vehicle_model_default().mass_kg;
    double van = crash->vehicle[1].severity.delta_v_m_s * 2400;
    assert_true(fabs(car / van - 1.0) < 0.05);
    cp_result_rows_destroy(&rows);
}

static void olc_is_for_struck_fronts_only(void **state)
{
    (void)state;
    cp_result_rows rows = {0};
    cp_impact impact = head_on(0.0);
    impact.side[1] = CP_SIDE_REAR;
    impact.state[1].yaw_rad = 0.0;
    impact.state[1].front_x_m = impact.state[1].length_m;
    impact.front_velocity_m_s[1] = (cp_vec2){0.0, 0.0};
    record(&impact, &rows);
    assert_int_equal(rows.crash->vehicle[0].severity.olc.status, CP_OLC_VALUE);
    assert_int_equal(rows.crash->vehicle[1].severity.olc.status, CP_OLC_NOT_FRONT_CONTACT);
    assert_true(isnan(rows.crash->vehicle[1].severity.olc.olc_g));
    assert_true(rows.crash->vehicle[1].severity.delta_v_m_s > 1.0);
    assert_true((rows.crash->vehicle[1].outside & CP_OUTSIDE_CONTACT_SIDE) != 0);
    cp_result_rows_destroy(&rows);
}

// SUMO's rectangles touched, the models' outlines do not: the crash stays, without a severity.
static void crash_without_simulation_is_kept(void **state)
{
    (void)state;
    cp_result_rows rows = {0};
    cp_impact impact = head_on(4.0);
    record(&impact, &rows);
    for (int role = 0; role < 2; role++) {
        const cp_crash_vehicle_row *vehicle = &rows.crash->vehicle[role];
        assert_int_equal(vehicle->severity.olc.status, CP_OLC_SIMULATION_FAILED);
        assert_true(isnan(vehicle->severity.delta_v_m_s));
        assert_true(isnan(vehicle->crush_m));
        assert_null(vehicle->pulse);
        assert_true(vehicle->speed_m_s == 15.0);
    }
    cp_result_rows_destroy(&rows);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(front_to_front),
        cmocka_unit_test(olc_is_for_struck_fronts_only),
        cmocka_unit_test(crash_without_simulation_is_kept),
    };
    return cmocka_run_group_tests(tests, crash_library_begin, crash_library_end);
}
