/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/crash_record.h"

#include "core/rng.h"
#include "crash/crash_simulation.h"
#include "impact/confirmation.h"
#include "impact/footprint.h"

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
    *f = (small_fleet){.vehicles = {{.type = NULL}, {.type = "van"}},
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

static cp_impact_names names_of(const char *type_of_b)
{
    return (cp_impact_names){
        .sumocfg_path = "a.sumocfg",
        .sumo_id = {"one", "two"},
        .sumo_type = {"passenger", type_of_b},
        .type = {{"passenger", "", 4.86, 1.85, 1.5, NAN}, {"tram", "", 7.1, 2.4, 2.4, NAN}},
        .at_fault = {true, false}};
}

static void record_as(const cp_impact *impact, const char *type_of_b, cp_result_rows *rows)
{
    small_fleet f;
    cp_error error = {0};
    cp_impact_names names = names_of(type_of_b);
    fill_fleet(&f);
    cp_crash_row *row = cp_result_rows_add_crash(rows);
    assert_non_null(row);
    assert_int_equal(cp_crash_record_fill(impact, &names, &f.fleet, CP_RECORD_ALL, row, &error),
                     CP_OK);
}

static void record(const cp_impact *impact, cp_result_rows *rows)
{
    record_as(impact, "van", rows);
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

// Speed as against a wall: the lighter car's is the higher, whichever role it has.
static void validity_is_each_cars_own(void **state)
{
    (void)state;
    cp_error error = {0};
    for (int role_of_van = 0; role_of_van < 2; role_of_van++) {
        small_fleet f;
        cp_result_rows rows = {0};
        fill_fleet(&f);
        for (int k = 0; k < 2; k++) {
            f.models[k].calibrated_speed_min_m_s = 25.0 / 3.6;
            f.models[k].calibrated_speed_max_m_s = 56.0 / 3.6;
            f.models[k].calibrated_offset_max_m = 1.05;
            f.models[k].calibrated_angle_max_rad = 0.5;
        }
        f.models[0].mass_kg =
            1400.0; // 108 km/h of closing: 68.2 km/h for the car, 39.8 for the van
        cp_impact impact = head_on(0.0);
        cp_impact_names names = names_of("van");
        if (role_of_van == 0) {
            names.sumo_type[0] = "van";
            names.sumo_type[1] = "passenger";
            const cp_sumo_type car = names.type[0];
            names.type[0] = names.type[1];
            names.type[1] = car;
        }
        cp_crash_row *row = cp_result_rows_add_crash(&rows);
        assert_int_equal(
            cp_crash_record_fill(&impact, &names, &f.fleet, CP_RECORD_ALL, row, &error), CP_OK);
        assert_string_equal(row->vehicle[role_of_van].vehicle_model, "van");
        assert_int_equal(row->vehicle[role_of_van].outside, 0);
        assert_int_equal(row->vehicle[1 - role_of_van].outside, CP_OUTSIDE_SPEED);
        cp_result_rows_destroy(&rows);

        // A van that was never calibrated says nothing of the car.
        f.models[1].calibrated_speed_max_m_s = 0.0;
        f.models[1].calibrated_speed_min_m_s = 0.0;
        rows = (cp_result_rows){0};
        row = cp_result_rows_add_crash(&rows);
        assert_int_equal(
            cp_crash_record_fill(&impact, &names, &f.fleet, CP_RECORD_ALL, row, &error), CP_OK);
        assert_true(row->vehicle[role_of_van].outside & CP_OUTSIDE_MODEL);
        assert_int_equal(row->vehicle[1 - role_of_van].outside, CP_OUTSIDE_SPEED);
        cp_result_rows_destroy(&rows);
    }
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
    // What OLC does not say of the struck one is there.
    assert_string_equal(rows.crash->vehicle[0].intrusion_zone, "front");
    assert_string_equal(rows.crash->vehicle[1].intrusion_zone, "rear");
    assert_true(rows.crash->vehicle[1].intrusion_m > 0.05);
    assert_true(rows.crash->vehicle[1].severity.asi_1 > 0.1);
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
        assert_true(isnan(vehicle->crush_m) && isnan(vehicle->intrusion_m));
        assert_null(vehicle->intrusion_zone);
        assert_null(vehicle->pulse);
        assert_true(vehicle->speed_m_s == 15.0);
        assert_true((vehicle->outside & CP_OUTSIDE_NO_CONTACT) != 0);
    }
    cp_result_rows_destroy(&rows);
}

// What is known of the same crash is what simulating it again gives; who errs is the new one's.
static void a_repeated_crash_is_the_known_one(void **state)
{
    (void)state;
    cp_result_rows rows = {0};
    cp_crash_row again = {0};
    cp_error error = {0};
    cp_impact impact = head_on(0.3);
    record(&impact, &rows);
    record(&impact, &rows);
    cp_impact_names names = names_of("van");
    names.at_fault[0] = false;
    names.at_fault[1] = true;
    assert_int_equal(cp_crash_record_repeat(&rows.crash[0], &names, &again, &error), CP_OK);
    assert_true(again.shift_m == rows.crash[1].shift_m && again.follows == CP_FOLLOWS_NONE);
    for (int role = 0; role < 2; role++) {
        const cp_crash_vehicle_row *one = &again.vehicle[role];
        const cp_crash_vehicle_row *other = &rows.crash[1].vehicle[role];
        assert_int_equal(one->at_fault, role == 1);
        assert_string_equal(one->sumo_id, other->sumo_id);
        assert_true(one->pulse != rows.crash[0].vehicle[role].pulse);
        assert_int_equal(one->pulse_size, other->pulse_size);
        assert_memory_equal(one->pulse, other->pulse, one->pulse_size);
        assert_true(one->severity.olc.olc_g == other->severity.olc.olc_g);
        assert_int_equal(one->outside, other->outside);
    }
    cp_crash_row_destroy(&again);
    cp_result_rows_destroy(&rows);
}

// A tram: what happened is kept, no severity of either, and both say why.
static void vehicle_without_model_is_no_car(void **state)
{
    (void)state;
    cp_result_rows rows = {0};
    cp_impact impact = head_on(0.0);
    impact.state[1].length_m = 7.1;
    impact.state[1].width_m = 2.4;
    record_as(&impact, "lorry", &rows);
    const cp_crash_vehicle_row *car = &rows.crash->vehicle[0], *truck = &rows.crash->vehicle[1];
    assert_string_equal(car->vehicle_model, "car");
    assert_string_equal(car->chosen_by, "study_default");
    assert_string_equal(truck->vehicle_model, CP_NO_VEHICLE_MODEL);
    assert_string_equal(truck->no_model_reason, "no shipped model of vClass tram");
    assert_int_equal(truck->outside, CP_OUTSIDE_NO_MODEL);
    assert_true((car->outside & CP_OUTSIDE_OPPONENT_STRUCTURE) != 0);
    assert_true((car->outside & CP_OUTSIDE_NO_MODEL) == 0);
    for (int role = 0; role < 2; role++) {
        assert_int_equal(rows.crash->vehicle[role].severity.olc.status, CP_OLC_SIMULATION_FAILED);
        assert_null(rows.crash->vehicle[role].pulse);
    }
    assert_true(fabs(rows.crash->description.closing_speed_m_s - 30.0) < 1e-9);
    assert_true(fabs(truck->body.cog_m.x - 0.42 * 7.1) < 1e-9);
    cp_result_rows_destroy(&rows);
}

// SUMO's van is longer than its model: what touches it at its end is a crash all the same, and is
// marked when the model was stretched far.
static void what_touches_in_traffic_touches_in_the_crash(void **state)
{
    (void)state;
    double model_m = cp_vehicle_model_default().length_m;
    static const double LONGER_M[] = {0.0, 0.4, 1.5};
    for (int k = 0; k < 3; k++) {
        // a strikes b from the side, with half its front past the end of b's model.
        cp_result_rows rows = {0};
        cp_impact impact = head_on(0.0);
        double length_m = model_m + LONGER_M[k], overlap_m = 0.3;
        impact.side[1] = CP_SIDE_LEFT;
        impact.state[1].length_m = length_m;
        impact.state[1].yaw_rad = 0.5 * 3.14159265358979323846;
        impact.state[1].front_x_m = 0.5 * impact.state[1].width_m;
        impact.state[1].front_y_m = length_m + 0.5 * impact.state[0].width_m - overlap_m;
        impact.front_velocity_m_s[1] = (cp_vec2){0.0, 0.0};
        record(&impact, &rows);
        for (int role = 0; role < 2; role++)
            assert_non_null(rows.crash->vehicle[role].pulse);
        assert_true(rows.crash->vehicle[1].severity.delta_v_m_s > 0.1);
        assert_string_equal(rows.crash->vehicle[1].intrusion_zone, "rear");
        assert_int_equal((rows.crash->vehicle[1].outside & CP_OUTSIDE_SIZE) != 0, k == 2);
        cp_result_rows_destroy(&rows);
    }
}

static const cp_vec2 NOWHERE = {0.0, 0.0};

// Straight on, b's middle at middle_m when both are where a is at the origin: slide b back along
// the relative velocity until the rectangles just touch. False when it never parts.
static bool slide_to_touch(cp_impact *impact, cp_vec2 middle_m, cp_touching_body body[2])
{
    cp_vec2 way = cp_vec2_sub(impact->front_velocity_m_s[1], impact->front_velocity_m_s[0]);
    double near_s = 0.0, far_s = 2.0;
    for (int k = 0; k < 80; k++) {
        double back_s = k == 0 ? far_s : 0.5 * (near_s + far_s);
        cp_vehicle_state *b = &impact->state[1];
        cp_vec2 to_front = cp_vec2_scale(cp_vec2_heading(b->yaw_rad), 0.5 * b->length_m);
        cp_vec2 front_m = cp_vec2_add(cp_vec2_sub(middle_m, cp_vec2_scale(way, back_s)), to_front);
        b->front_x_m = front_m.x;
        b->front_y_m = front_m.y;
        for (int role = 0; role < 2; role++)
            body[role] = (cp_touching_body){.rectangle = cp_vehicle_rectangle(&impact->state[role]),
                                            .front_velocity_m_s = impact->front_velocity_m_s[role]};
        bool apart = cp_rectangle_separation(&body[0].rectangle, &body[1].rectangle) > 0.0;
        if (k == 0 && !apart)
            return false;
        *(apart ? &far_s : &near_s) = back_s;
    }
    return true;
}

// Whatever two vehicles of any size do to each other in traffic that counts as a crash, the
// surrogate simulates.
static void every_crash_of_traffic_is_simulated(void **state)
{
    (void)state;
    cp_rng_key key = cp_rng_key_text(cp_rng_key_seed(3), "crashes of traffic");
    size_t crashes = 0, draw = 0;
    while (crashes < 300) {
        double u[9];
        for (int k = 0; k < 9; k++)
            u[k] = cp_rng_uniform(key, 9 * draw + (uint64_t)k);
        draw++;
        cp_impact impact = head_on(0.0);
        impact.state[1].yaw_rad = 6.2 * u[0];
        for (int role = 0; role < 2; role++) {
            impact.state[role].length_m = 3.2 + 3.3 * u[1 + role];
            impact.state[role].width_m = 1.5 + 0.7 * u[3 + role];
            impact.state[role].speed_m_s = 1.0 + 20.0 * u[5 + role];
            impact.front_velocity_m_s[role] = cp_vec2_scale(
                cp_vec2_heading(impact.state[role].yaw_rad), impact.state[role].speed_m_s);
        }
        cp_touching_body body[2];
        cp_vec2 middle_m = {-7.0 * u[7], 6.0 * (u[8] - 0.5)};
        if (!slide_to_touch(&impact, middle_m, body) || !cp_contact_goes_deep(body))
            continue;
        impact.contact_m = NOWHERE;
        cp_result_rows rows = {0};
        record(&impact, &rows);
        if (rows.crash->vehicle[0].pulse == NULL)
            fail_msg("draw %zu: %g x %g m and %g x %g m never meet", draw, impact.state[0].length_m,
                     impact.state[0].width_m, impact.state[1].length_m, impact.state[1].width_m);
        cp_result_rows_destroy(&rows);
        crashes++;
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(front_to_front),
        cmocka_unit_test(validity_is_each_cars_own),
        cmocka_unit_test(olc_is_for_struck_fronts_only),
        cmocka_unit_test(crash_without_simulation_is_kept),
        cmocka_unit_test(vehicle_without_model_is_no_car),
        cmocka_unit_test(a_repeated_crash_is_the_known_one),
        cmocka_unit_test(what_touches_in_traffic_touches_in_the_crash),
        cmocka_unit_test(every_crash_of_traffic_is_simulated),
    };
    return cmocka_run_group_tests(tests, crash_library_begin, crash_library_end);
}
