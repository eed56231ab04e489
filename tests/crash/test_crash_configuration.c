/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"

#include "builders/crash_builder.h"

#include <string.h>

static void description_and_configuration_are_inverse(void **state)
{
    (void)state;
    cp_vehicle_model car = cp_vehicle_model_default(), van = car;
    van.length_m = 5.6;
    van.width_m = 2.0;
    van.cg_to_front_m = 2.4;
    int met = 0;
    for (uint64_t k = 0; k < 500; k++) {
        double offset_m = crash_builder_draw("offset", k, -1.6, 1.6);
        double angle_rad = crash_builder_draw("angle", k, -1.5, 1.5);
        double speed_a = crash_builder_draw("a", k, 1.0, 30.0);
        double speed_b = crash_builder_draw("b", k, 0.0, 30.0);
        bool barrier = k % 3 == 0;
        // Some of the crossing ones pass by.
        cp_crash_configuration configuration;
        cp_error error = {0};
        if (cp_crash_configuration_from_description(&car, barrier ? NULL : &van, NULL, speed_a,
                                                    speed_b, offset_m, angle_rad, &configuration,
                                                    &error) != CP_OK)
            continue;
        met++;

        // Wherever they are put together, the outlines touch.
        const cp_vehicle_model *other = barrier ? NULL : &van;
        assert_true(cp_crash_contact_gap(&car, other, &configuration) < 1e-9);
        assert_true(cp_crash_contact_gap(&car, other, &configuration) > -1e-9);
        cp_vec2 contact_m = cp_crash_contact_point(&car, barrier ? NULL : &van, &configuration);
        cp_crash_description back =
            cp_crash_describe(&car, barrier ? NULL : &van, &configuration, contact_m);
        assert_near(back.speed_m_s[0], speed_a, 1e-12);
        assert_near(back.lateral_offset_m, offset_m, 1e-12);
        assert_near(back.angle_rad, angle_rad, 1e-12);
        if (!barrier)
            assert_near(back.speed_m_s[1], speed_b, 1e-12);
    }
    assert_true(met > 400);
}

static void a_single_step_to_the_barrier_is_enough(void **state)
{
    (void)state;
    // Face to face the first step already arrives: round angles and offsets must not be lost.
    cp_vehicle_model car = cp_vehicle_model_default();
    car.barrier = (cp_barrier){.width_m = 1.85,
                               .depth_m = 1.197,
                               .corner_radius_m = 0.2672,
                               .pivot_m = 0.6,
                               .friction_1 = -1.0};
    for (int angle_deg = -30; angle_deg <= 30; angle_deg += 5) {
        for (int offset_mm = -700; offset_mm <= 700; offset_mm += 50) {
            cp_crash_configuration configuration =
                crash_builder_configuration(&car, NULL, 50.0, 0.0, offset_mm, angle_deg);
            assert_near(cp_crash_contact_gap(&car, NULL, &configuration), 0.0, 1e-9);
        }
    }
}

static void head_on_cars_meet_with_their_fronts(void **state)
{
    (void)state;
    cp_vehicle_model car = cp_vehicle_model_default();
    cp_crash_configuration configuration =
        crash_builder_configuration(&car, &car, 50.0, 30.0, 400.0, 0.0);
    cp_vec2 contact_m = cp_crash_contact_point(&car, &car, &configuration);
    cp_crash_description description = cp_crash_describe(&car, &car, &configuration, contact_m);
    assert_int_equal(configuration.side[0], CP_SIDE_FRONT);
    assert_int_equal(configuration.side[1], CP_SIDE_FRONT);
    assert_near(description.closing_speed_m_s, 80.0 / 3.6, 1e-9);
    assert_near(description.overlap_1, (car.width_m - 0.4) / car.width_m, 1e-9);
    assert_near(contact_m.x, car.cg_to_front_m, 1e-6);
    assert_near(contact_m.y, 0.2, 1e-6);
    assert_near(description.velocity_angle_rad[0], 0.0, 1e-12);
}

static void a_crossing_car_is_struck_on_its_side(void **state)
{
    (void)state;
    // b heads south, a comes from the west: a strikes b's right side.
    cp_vehicle_model car = cp_vehicle_model_default();
    cp_crash_configuration configuration =
        crash_builder_configuration(&car, &car, 40.0, 20.0, -2500.0, 90.0);
    assert_int_equal(configuration.side[0], CP_SIDE_FRONT);
    assert_int_equal(configuration.side[1], CP_SIDE_RIGHT);
    assert_string_equal(cp_crash_type_text(configuration.side[0], configuration.side[1]),
                        "front-side");
}

static void the_barrier_lies_where_the_sign_convention_says(void **state)
{
    (void)state;
    // Positive offset and angle: face centre to the left, its near corner recedes, so the first
    // contact is farther left than the near corner.
    cp_vehicle_model car = cp_vehicle_model_default();
    cp_crash_configuration receding =
        crash_builder_configuration(&car, NULL, 50.0, 0.0, 700.0, 20.0);
    assert_true(receding.barrier_pose.position_m.y > 0.69);
    cp_vec2 depth = cp_vec2_heading(receding.barrier_pose.yaw_rad);
    assert_true(depth.x > 0.9 && depth.y > 0.3);
    assert_near(cp_crash_contact_point(&car, NULL, &receding).y, 0.5 * car.width_m, 1e-6);
    // Negative offset, same angle: the near corner sticks out and is struck inside the width.
    cp_crash_configuration near_corner =
        crash_builder_configuration(&car, NULL, 50.0, 0.0, -700.0, 20.0);
    double y_m = cp_crash_contact_point(&car, NULL, &near_corner).y;
    assert_true(fabs(y_m) < 0.45 * car.width_m);
}

static void what_misses_is_refused(void **state)
{
    (void)state;
    cp_vehicle_model car = cp_vehicle_model_default();
    cp_crash_configuration configuration;
    cp_error error = {0};
    assert_int_equal(cp_crash_configuration_from_description(&car, &car, NULL, 10.0, 10.0, 2.5, 0.0,
                                                             &configuration, &error),
                     CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "miss each other"));
}

// Front on front the overlap is that of the two front edges, whatever the flank of a turned car
// hides.
static void overlap_is_that_of_the_two_fronts(void **state)
{
    (void)state;
    cp_vehicle_model car = cp_vehicle_model_default();
    const double offset_m = 0.9, angle_rad = cp_rad_from_deg(30.0);
    cp_crash_configuration crash;
    cp_error error = {0};
    if (cp_crash_configuration_from_description(&car, &car, NULL, 12.0, 12.0, offset_m, angle_rad,
                                                &crash, &error) != CP_OK)
        fail_msg("%s", error.text);
    assert_int_equal(crash.side[1], CP_SIDE_FRONT);
    cp_vec2 contact_m = cp_crash_contact_point(&car, &car, &crash);
    double low_m = offset_m - 0.5 * car.width_m * cos(angle_rad);
    double expected = (0.5 * car.width_m - low_m) / car.width_m;
    assert_near(cp_crash_describe(&car, &car, &crash, contact_m).overlap_1, expected, 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(description_and_configuration_are_inverse),
        cmocka_unit_test(a_single_step_to_the_barrier_is_enough),
        cmocka_unit_test(head_on_cars_meet_with_their_fronts),
        cmocka_unit_test(a_crossing_car_is_struck_on_its_side),
        cmocka_unit_test(the_barrier_lies_where_the_sign_convention_says),
        cmocka_unit_test(what_misses_is_refused),
        cmocka_unit_test(overlap_is_that_of_the_two_fronts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
