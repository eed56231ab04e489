/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"
#include "builders/crash_library.h"

#include "builders/crash_builder.h"
#include "crash/struck_structure.h"

#include <glob.h>
#include <stdlib.h>
#include <string.h>

static const cp_crash_options STANDARD = {
    .time_step_s = 0.0005, .duration_s = 0.2, .longest_duration_s = 0.4, .coast_after_s = 0.01};

// FMVSS 214's moving barrier as the validation suite has it.
static cp_barrier moving_barrier(void)
{
    cp_barrier barrier = cp_barrier_default();
    barrier.width_m = 1.676;
    barrier.depth_m = 4.115;
    barrier.corner_radius_m = 0.05;
    barrier.mass_kg = 1368.0;
    barrier.face_m = 0.483;
    barrier.face_kn = 290.0;
    barrier.face_bumper_m = 0.102;
    barrier.face_bumper_kn = 130.0;
    return barrier;
}

enum { VEHICLES_MAX = 64 };
static struct {
    cp_vehicle_model model[VEHICLES_MAX];
    uint64_t count;
} fleet;

// Every vehicle file, the first parameter set, and a moving barrier at the end.
static int load_fleet(void **state)
{
    char pattern[4096];
    const char *source = getenv("CRASHPULSE_SOURCE");
    snprintf(pattern, sizeof pattern, "%s/db/vehicles/*.yaml", source ? source : ".");
    glob_t files;
    if (glob(pattern, 0, NULL, &files) != 0)
        return -1;
    fleet.model[fleet.count++] = cp_vehicle_model_default();
    for (size_t k = 0; k < files.gl_pathc && fleet.count + 1 < VEHICLES_MAX; k++) {
        cp_error error = {0};
        if (strstr(files.gl_pathv[k], ".fit.yaml") == NULL &&
            cp_vehicle_model_load(files.gl_pathv[k], &fleet.model[fleet.count++], &error) != CP_OK)
            crash_builder_stop(&error);
    }
    globfree(&files);
    cp_barrier barrier = moving_barrier();
    fleet.model[fleet.count++] = cp_vehicle_model_of_barrier(&barrier);
    return crash_library_begin(state);
}

typedef struct struck_crash {
    const cp_vehicle_model *struck; /* never the barrier */
    const cp_vehicle_model *striking;
    cp_crash_configuration configuration;
} struck_crash;

static cp_crash_configuration configure(const cp_vehicle_model *struck,
                                        const cp_vehicle_model *striking, cp_contact_side side,
                                        double at_m, double angle_rad, double struck_m_s,
                                        double striking_m_s)
{
    cp_error error = {0};
    cp_crash_configuration configuration;
    if (cp_crash_configuration_struck(struck, striking, side, at_m, angle_rad, struck_m_s,
                                      striking_m_s, &configuration, &error) != CP_OK)
        crash_builder_stop(&error);
    return configuration;
}

// Seeded crash number index: any two vehicles, any place of any side but the front.
static struck_crash draw_struck(uint64_t index)
{
    struck_crash crash = {.struck = &fleet.model[(uint64_t)crash_builder_draw(
                              "struck", index, 0.0, (double)(fleet.count - 1))],
                          .striking = &fleet.model[(uint64_t)crash_builder_draw(
                              "striking", index, 0.0, (double)fleet.count)]};
    static const cp_contact_side SIDE[] = {CP_SIDE_LEFT, CP_SIDE_RIGHT, CP_SIDE_REAR};
    cp_contact_side side = SIDE[index % 3];
    const cp_vehicle_model *m = crash.struck;
    double front_m = m->cg_to_front_m - 0.2, rear_m = m->cg_to_front_m - m->length_m + 0.2;
    double at_m = side == CP_SIDE_REAR
                      ? crash_builder_draw("place", index, -0.45 * m->width_m, 0.45 * m->width_m)
                      : crash_builder_draw("place", index, rear_m, front_m);
    crash.configuration =
        configure(m, crash.striking, side, at_m, crash_builder_draw("turn", index, -0.9, 0.9),
                  crash_builder_draw("struck speed", index, 0.0, 12.0),
                  crash_builder_draw("striking speed", index, 1.0, 25.0));
    return crash;
}

static cp_crash_result simulate(const struck_crash *crash)
{
    return crash_builder_simulate(crash->struck, crash->striking, &crash->configuration, &STANDARD);
}

// ---- laws --------------------------------------------------------------------------------------

static void a_side_is_the_sum_of_its_zones_by_width(void **state)
{
    (void)state;
    cp_vehicle_model car = cp_vehicle_model_default();
    cp_crush_law zone[CP_SIDE_ZONES];
    for (int z = 0; z < CP_SIDE_ZONES; z++)
        zone[z] = cp_side_zone_law(&car, z);
    const double width_m[CP_SIDE_ZONES] = {0.2, 1.1, 0.4};
    cp_crush_law side = cp_side_law(zone, width_m);
    for (double s_m = 0.0; s_m < car.side_collapse_end_m; s_m += 0.01) {
        double sum_n = 0.0;
        for (int z = 0; z < CP_SIDE_ZONES; z++)
            sum_n += width_m[z] * cp_crush_loading_force(&zone[z], s_m);
        assert_near(cp_crush_loading_force(&side, s_m), sum_n, 1e-6);
    }
    assert_near(cp_crush_loading_force(&side, car.side_collapse_begin_m),
                1e3 * (0.2 * car.side_front_wheel_begin_kn_m + 1.1 * car.side_door_begin_kn_m +
                       0.4 * car.side_rear_wheel_begin_kn_m),
                1e-6);
}

// ---- against closed forms ----------------------------------------------------------------------

// A car whose side gives way at a constant force, without what strain rate adds.
static cp_vehicle_model constant_side(double door_kn_m)
{
    cp_vehicle_model car = cp_vehicle_model_default();
    car.side_collapse_begin_m = 0.005;
    car.side_door_begin_kn_m = car.side_door_end_kn_m = door_kn_m;
    car.strain_rate_gain_1 = 0.0;
    car.side_front_wheel_1 = car.side_rear_wheel_1 = 0.02;
    car.side_spread_m = 0.4;
    return car;
}

// Two contact springs of the car's own stiffness and the barrier's in series, side by side.
static double spring_n_m(const cp_vehicle_model *car, const cp_vehicle_model *barrier)
{
    double one_n_m = 1e3 * car->contact_stiffness_kn_m,
           other_n_m = 1e3 * barrier->contact_stiffness_kn_m;
    return 2.0 * one_n_m * other_n_m / (one_n_m + other_n_m);
}

// A fixed flat wall 0.8 m wide that moves into the car at its centre of gravity: nothing turns, and
// the car's energy is the force of 0.8 + 0.4 m times the depth, and what the contact springs hold.
static void a_side_stops_its_car_by_energy(void **state)
{
    (void)state;
    cp_vehicle_model car = constant_side(100.0);
    cp_barrier wall = cp_barrier_default();
    wall.width_m = 0.8;
    wall.corner_radius_m = 0.0;
    cp_vehicle_model striking = cp_vehicle_model_of_barrier(&wall);
    for (double v_m_s = 4.0; v_m_s < 9.0; v_m_s += 2.0) {
        struck_crash crash = {&car, &striking,
                              configure(&car, &striking, CP_SIDE_LEFT, 0.0, 0.0, 0.0, v_m_s)};
        cp_crash_result result = simulate(&crash);
        double force_n = 1.2 * 100e3, elastic_m = 0.5 * 0.005;
        elastic_m -= 0.5 * force_n / spring_n_m(&car, &striking);
        double depth_m = 0.5 * car.mass_kg * v_m_s * v_m_s / force_n + elastic_m;
        assert_near(result.struck[0].depth_m, depth_m, 0.02 * depth_m);
        assert_int_equal(result.struck[0].zone, CP_STRUCK_DOOR);
        assert_near(result.severity[0].yaw_change_rad_s, 0.0, 0.1);
        assert_true(result.severity[0].delta_v_y_m_s >= v_m_s);
        assert_near(result.severity[0].pdof_rad, 0.5 * CP_PI, 0.05);
        cp_crash_result_destroy(&result);
    }
}

// The rear in the same way: full width.
static void a_rear_stops_its_car_by_energy(void **state)
{
    (void)state;
    cp_vehicle_model car = cp_vehicle_model_default();
    car.rear_bumper_m = 0.01;
    car.rear_bumper_kn = car.rear_collapse_begin_kn = car.rear_collapse_end_kn = 200.0;
    car.strain_rate_gain_1 = 0.0;
    cp_barrier wall = cp_barrier_default();
    wall.width_m = 3.0;
    cp_vehicle_model striking = cp_vehicle_model_of_barrier(&wall);
    struck_crash crash = {&car, &striking,
                          configure(&car, &striking, CP_SIDE_REAR, 0.0, 0.0, 0.0, 8.0)};
    cp_crash_result result = simulate(&crash);
    double depth_m = 0.5 * car.mass_kg * 64.0 / 200e3 + 0.5 * 0.01 / 3.0 -
                     0.5 * 200e3 / spring_n_m(&car, &striking);
    assert_near(result.struck[0].depth_m, depth_m, 0.02 * depth_m);
    assert_int_equal(result.struck[0].zone, CP_STRUCK_REAR);
    assert_near(fabs(result.severity[0].pdof_rad), CP_PI, 1e-6);
    cp_crash_result_destroy(&result);
}

// A face at a constant force against a rigid car's rear: both masses meet by the reduced mass.
static void a_face_takes_the_energy_of_both(void **state)
{
    (void)state;
    cp_vehicle_model car = cp_vehicle_model_default();
    car.rear_bumper_kn = car.rear_collapse_begin_kn = 800.0;
    car.rear_collapse_end_kn = 4000.0;
    cp_barrier barrier = moving_barrier();
    barrier.face_bumper_m = 0.0;
    barrier.face_kn = 300.0;
    cp_vehicle_model striking = cp_vehicle_model_of_barrier(&barrier);
    struck_crash crash = {&car, &striking,
                          configure(&car, &striking, CP_SIDE_REAR, 0.0, 0.0, 0.0, 8.0)};
    cp_crash_result result = simulate(&crash);
    double reduced_kg = car.mass_kg * 1368.0 / (car.mass_kg + 1368.0);
    double lost_j = 0.5 * reduced_kg * 64.0;
    // All strips press at once: their springs, with the car's, hold the rest.
    double taken_j =
        result.whole[1].part.struck_j + result.whole[0].part.struck_j + result.whole[0].part.rate_j;
    double held_n_m = 2.0 * CP_BARRIER_STRIPS /
                      (1e-3 / car.contact_stiffness_kn_m +
                       1e-3 * CP_BARRIER_STRIPS / (2.0 * striking.contact_stiffness_kn_m));
    assert_near(taken_j, lost_j - 0.5 * 300e3 * 300e3 / held_n_m, 0.02 * lost_j);
    assert_true(result.whole[1].part.struck_j > 0.85 * lost_j);
    cp_crash_result_destroy(&result);
}

// ---- properties --------------------------------------------------------------------------------

static void energy_and_momentum_are_accounted_for(void **state)
{
    (void)state;
    const char *wanted = getenv("CRASHPULSE_STRUCK_CRASHES"); // 10000 for the long version
    uint64_t crashes = wanted != NULL ? strtoull(wanted, NULL, 10) : 240;
    for (uint64_t k = 0; k < crashes; k++) {
        struck_crash crash = draw_struck(k);
        cp_error error = {0};
        cp_crash_result result;
        if (cp_crash_simulate(crash.struck, crash.striking, &crash.configuration, &STANDARD,
                              &result, &error) != CP_OK)
            fail_msg("crash %d: %s", (int)k, error.text);
        const cp_crash_energy *e = &result.energy;
        double sum_j = e->kinetic_j + e->elastic_j + e->plastic_j + e->friction_j +
                       e->contact_damping_j + e->rate_j + e->mount_damping_j;
        // The books of a front that is pushed into its own cell are its own.
        bool cell = result.struck[1].depth_m > 0.05;
        if (!cell && !(fabs(sum_j - e->start_j) <= 0.01 * e->start_j + 10.0))
            fail_msg("crash %d: %g J of %g J", (int)k, sum_j, e->start_j);
        assert_true(e->highest_mechanical_j <= 1.01 * e->start_j + 10.0);
        assert_true(e->plastic_j >= 0.0 && e->friction_j >= -1.0 && e->rate_j >= 0.0);
        double scale = sqrt(2.0 * e->start_j * crash.struck->mass_kg) + 1.0;
        assert_near(result.momentum_end.linear_kg_m_s.x, result.momentum_start.linear_kg_m_s.x,
                    1e-9 * scale);
        assert_near(result.momentum_end.linear_kg_m_s.y, result.momentum_start.linear_kg_m_s.y,
                    1e-9 * scale);
        assert_near(result.momentum_end.angular_kg_m2_s, result.momentum_start.angular_kg_m2_s,
                    1e-8 * scale);
        assert_true(result.struck[0].depth_m >= 0.0 && result.struck[0].depth_m < 2.0);
        assert_true(isfinite(result.severity[0].delta_v_m_s));
        cp_crash_result_destroy(&result);
    }
}

static void a_mirrored_hit_gives_mirrored_pulses(void **state)
{
    (void)state;
    cp_vehicle_model car = cp_vehicle_model_default();
    for (uint64_t k = 0; k < 12; k++) {
        double at_m = crash_builder_draw("mirror place", k, -2.0, 1.5);
        double turn_rad = crash_builder_draw("mirror turn", k, -0.6, 0.6);
        const cp_vehicle_model *striking = k % 3 == 0 ? &fleet.model[fleet.count - 1] : &car;
        struck_crash left = {&car, striking,
                             configure(&car, striking, CP_SIDE_LEFT, at_m, turn_rad, 5.0, 14.0)};
        struck_crash right = {&car, striking,
                              configure(&car, striking, CP_SIDE_RIGHT, at_m, -turn_rad, 5.0, 14.0)};
        cp_crash_result one = simulate(&left), other = simulate(&right);
        assert_near(one.struck[0].depth_m, other.struck[0].depth_m, 1e-5);
        assert_int_equal(one.struck[0].zone, other.struck[0].zone);
        for (int c = 0; c < 2; c++) {
            for (size_t s = 0; s < 401; s++) {
                assert_near(one.pulse[c].channel[CP_CHANNEL_VX][s],
                            other.pulse[c].channel[CP_CHANNEL_VX][s], 1e-5);
                assert_near(one.pulse[c].channel[CP_CHANNEL_VY][s],
                            -other.pulse[c].channel[CP_CHANNEL_VY][s], 1e-5);
                assert_near(one.pulse[c].channel[CP_CHANNEL_YAW][s],
                            -other.pulse[c].channel[CP_CHANNEL_YAW][s], 1e-5);
            }
        }
        cp_crash_result_destroy(&one);
        cp_crash_result_destroy(&other);
    }
}

static void a_common_velocity_changes_nothing_but_positions(void **state)
{
    (void)state;
    for (uint64_t k = 0; k < 9; k++) {
        struck_crash crash = draw_struck(k);
        cp_crash_result still = simulate(&crash);
        for (int c = 0; c < 2; c++)
            crash.configuration.vehicle[c].velocity_m_s =
                cp_vec2_add(crash.configuration.vehicle[c].velocity_m_s, (cp_vec2){7.0, -3.0});
        cp_crash_result moving = simulate(&crash);
        for (int c = 0; c < 2; c++) {
            assert_near(moving.severity[c].delta_v_m_s, still.severity[c].delta_v_m_s, 1e-9);
            assert_near(moving.severity[c].asi_1, still.severity[c].asi_1, 1e-9);
        }
        assert_near(moving.struck[0].depth_m, still.struck[0].depth_m, 1e-9);
        cp_crash_result_destroy(&still);
        cp_crash_result_destroy(&moving);
    }
}

static void half_the_step_changes_little(void **state)
{
    (void)state;
    cp_vehicle_model car = cp_vehicle_model_default();
    for (double at_m = -1.5; at_m <= 1.0; at_m += 0.5) {
        struck_crash crash = {&car, &car,
                              configure(&car, &car, CP_SIDE_LEFT, at_m, 0.0, 0.0, 14.0)};
        cp_crash_options fine = STANDARD;
        fine.time_step_s *= 0.5;
        cp_crash_result one = simulate(&crash);
        cp_crash_result other = crash_builder_simulate(&car, &car, &crash.configuration, &fine);
        assert_near(one.struck[0].depth_m, other.struck[0].depth_m, 0.004);
        assert_near(one.severity[0].delta_v_m_s, other.severity[0].delta_v_m_s,
                    0.01 * other.severity[0].delta_v_m_s);
        cp_crash_result_destroy(&one);
        cp_crash_result_destroy(&other);
    }
}

// Zones of very different strength side by side: a pole meets ever more of the next one.
static void nothing_jumps_at_the_border_of_zones(void **state)
{
    (void)state;
    cp_vehicle_model car = cp_vehicle_model_default();
    car.side_rear_wheel_begin_kn_m = 3.0 * car.side_door_begin_kn_m;
    car.side_rear_wheel_end_kn_m = 3.0 * car.side_door_end_kn_m;
    cp_barrier pole = cp_barrier_default();
    pole.width_m = pole.depth_m = 0.254;
    pole.corner_radius_m = 0.127;
    cp_vehicle_model striking = cp_vehicle_model_of_barrier(&pole);
    double before_m = NAN, deepest_m = 0.0, flattest_m = INFINITY;
    for (double at_m = -1.7; at_m <= 0.6; at_m += 0.02) {
        struck_crash crash = {&car, &striking,
                              configure(&car, &striking, CP_SIDE_LEFT, at_m, 0.0, 0.0, 8.0)};
        cp_crash_result result = simulate(&crash);
        double depth_m = result.struck[0].depth_m;
        if (!isnan(before_m) && !(fabs(depth_m - before_m) <= 0.01))
            fail_msg("%g m deep at %g m, %g m 2 cm before", depth_m, at_m, before_m);
        before_m = depth_m;
        deepest_m = fmax(deepest_m, depth_m);
        flattest_m = fmin(flattest_m, depth_m);
        cp_crash_result_destroy(&result);
    }
    assert_true(deepest_m > 1.3 * flattest_m);
}

static void the_zone_is_where_it_was_struck(void **state)
{
    (void)state;
    cp_vehicle_model car = cp_vehicle_model_default();
    cp_barrier pole = cp_barrier_default();
    pole.width_m = pole.depth_m = 0.254;
    pole.corner_radius_m = 0.127;
    cp_vehicle_model striking = cp_vehicle_model_of_barrier(&pole);
    const struct {
        double at_m;
        cp_struck_zone zone;
    } PLACES[] = {{1.5, CP_STRUCK_FRONT_WHEEL},
                  {1.0, CP_STRUCK_FRONT_WHEEL},
                  {-0.2, CP_STRUCK_DOOR},
                  {-1.5, CP_STRUCK_REAR_WHEEL},
                  {-2.5, CP_STRUCK_REAR}};
    for (size_t k = 0; k < sizeof PLACES / sizeof *PLACES; k++) {
        for (cp_contact_side side = CP_SIDE_LEFT; side <= CP_SIDE_RIGHT; side++) {
            struck_crash crash = {&car, &striking,
                                  configure(&car, &striking, side, PLACES[k].at_m, 0.0, 0.0, 6.0)};
            cp_crash_result result = simulate(&crash);
            if (result.struck[0].zone != PLACES[k].zone || !(result.struck[0].depth_m > 0.02))
                fail_msg("%s at %g m: %s, %g m", cp_contact_side_text(side), PLACES[k].at_m,
                         cp_struck_zone_text(result.struck[0].zone), result.struck[0].depth_m);
            cp_crash_result_destroy(&result);
        }
    }
}

// A stronger side is pushed in less, and what strikes it decelerates more, but not much.
static void a_stronger_side_gives_less(void **state)
{
    (void)state;
    cp_vehicle_model car = cp_vehicle_model_default(), strong = car;
    strong.side_door_begin_kn_m *= 2.0;
    strong.side_door_end_kn_m *= 2.0;
    double depth_m[2];
    for (int k = 0; k < 2; k++) {
        const cp_vehicle_model *struck = k == 0 ? &car : &strong;
        struck_crash crash = {struck, &car,
                              configure(struck, &car, CP_SIDE_RIGHT, 0.0, 0.0, 0.0, 14.0)};
        cp_crash_result result = simulate(&crash);
        depth_m[k] = result.struck[0].depth_m;
        cp_crash_result_destroy(&result);
    }
    assert_true(depth_m[1] < 0.85 * depth_m[0]);
}

// ---- what is refused ---------------------------------------------------------------------------

static void a_front_is_no_struck_side(void **state)
{
    (void)state;
    cp_vehicle_model car = cp_vehicle_model_default();
    cp_crash_configuration configuration;
    cp_error error = {0};
    assert_int_equal(cp_crash_configuration_struck(&car, &car, CP_SIDE_FRONT, 0.0, 0.0, 0.0, 10.0,
                                                   &configuration, &error),
                     CP_BAD_INPUT);
    assert_int_equal(cp_crash_configuration_struck(&car, &car, CP_SIDE_LEFT, 9.0, 0.0, 0.0, 10.0,
                                                   &configuration, &error),
                     CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "miss"));
}

static void barriers_out_of_range_are_refused(void **state)
{
    (void)state;
    cp_barrier good = moving_barrier();
    cp_error error = {0};
    assert_int_equal(cp_barrier_validate(&good, &error), CP_OK);
    assert_true(cp_barrier_is_party(&good));
    const struct {
        size_t field;
        double value;
        const char *name;
    } WRONG[] = {{offsetof(cp_barrier, mass_kg), 20.0, "mass_kg"},
                 {offsetof(cp_barrier, face_m), 4.0, "face_m"},
                 {offsetof(cp_barrier, face_kn), 0.0, "face_kn"},
                 {offsetof(cp_barrier, face_bumper_m), 0.45, "face_bumper_m"},
                 {offsetof(cp_barrier, face_bumper_kn), 1e5, "face_bumper_kn"}};
    for (size_t k = 0; k < sizeof WRONG / sizeof *WRONG; k++) {
        cp_barrier bad = good;
        memcpy((char *)&bad + WRONG[k].field, &WRONG[k].value, sizeof WRONG[k].value);
        assert_int_equal(cp_barrier_validate(&bad, &error), CP_BAD_INPUT);
        assert_non_null(strstr(error.text, WRONG[k].name));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_side_is_the_sum_of_its_zones_by_width),
        cmocka_unit_test(a_side_stops_its_car_by_energy),
        cmocka_unit_test(a_rear_stops_its_car_by_energy),
        cmocka_unit_test(a_face_takes_the_energy_of_both),
        cmocka_unit_test(energy_and_momentum_are_accounted_for),
        cmocka_unit_test(a_mirrored_hit_gives_mirrored_pulses),
        cmocka_unit_test(a_common_velocity_changes_nothing_but_positions),
        cmocka_unit_test(half_the_step_changes_little),
        cmocka_unit_test(nothing_jumps_at_the_border_of_zones),
        cmocka_unit_test(the_zone_is_where_it_was_struck),
        cmocka_unit_test(a_stronger_side_gives_less),
        cmocka_unit_test(a_front_is_no_struck_side),
        cmocka_unit_test(barriers_out_of_range_are_refused),
    };
    return cmocka_run_group_tests(tests, load_fleet, crash_library_end);
}
