/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "traffic/lateral_overlay.h"

#include "core/units.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "builders/assert_near.h"

static cp_lateral_overlays *create(void)
{
    cp_lateral_overlays *overlays;
    assert_int_equal(cp_lateral_overlays_create(&overlays, NULL), CP_OK);
    return overlays;
}

static void steer(cp_lateral_overlays *overlays, uint32_t vehicle, double mean, double end)
{
    assert_int_equal(cp_lateral_overlay_steer(overlays, vehicle, mean, end, NULL), CP_OK);
}

/* A step: one vehicle northbound at (3, 4), as SUMO has it, and what becomes of it. */
static cp_vehicle_state step(cp_lateral_overlays *overlays, uint32_t vehicle, double way_m)
{
    cp_vehicle_state state = {
        .vehicle = vehicle, .front_x_m = 3.0, .front_y_m = 4.0, .yaw_rad = CP_PI / 2};
    cp_lateral_overlay_apply(overlays, &state, way_m);
    cp_lateral_overlays_prune(overlays);
    return state;
}

static void a_car_lies_left_of_where_sumo_has_it(void **unused)
{
    (void)unused;
    cp_lateral_overlays *overlays = create();
    steer(overlays, 7, 0.05, 0.1);
    cp_vehicle_state state = step(overlays, 7, 2.0);
    assert_near(state.front_x_m, 2.9, 1e-12);
    assert_near(state.front_y_m, 4.0, 1e-12);
    assert_near(state.yaw_rad, CP_PI / 2 + atan(0.1), 1e-12);
    assert_near(step(overlays, 8, 2.0).front_x_m, 3.0, 0.0);
    cp_lateral_overlays_destroy(overlays);
}

static void nobody_steering_it_drifts_on_as_far_as_it_drives(void **unused)
{
    (void)unused;
    cp_lateral_overlays *overlays = create();
    steer(overlays, 7, 0.1, 0.1);
    step(overlays, 7, 1.0);
    step(overlays, 7, 0.5);
    assert_near(cp_lateral_overlay_get(overlays, 7).offset_m, 0.15, 1e-12);
    step(overlays, 7, 0.0);
    assert_near(cp_lateral_overlay_get(overlays, 7).offset_m, 0.15, 1e-12);
    assert_near(step(overlays, 7, 0.0).yaw_rad, CP_PI / 2 + atan(0.1), 1e-12);
    cp_lateral_overlays_destroy(overlays);
}

static void the_last_word_of_a_step_holds(void **unused)
{
    (void)unused;
    cp_lateral_overlays *overlays = create();
    for (uint32_t vehicle = 0; vehicle < 40; vehicle++)
        steer(overlays, vehicle, 0.1, 0.1);
    steer(overlays, 7, 0.05, -0.02);
    assert_near(step(overlays, 7, 10.0).front_x_m, 2.5, 1e-12);
    // The others were not on the road: forgotten.
    assert_near(cp_lateral_overlay_get(overlays, 8).slope_1, 0.0, 0.0);
    cp_lateral_overlay_end(overlays, 7);
    step(overlays, 7, 10.0);
    assert_near(step(overlays, 7, 10.0).front_x_m, 3.0, 0.0);
    cp_lateral_overlays_destroy(overlays);
}

static void a_car_returns_along_one_cubic_whatever_the_step(void **unused)
{
    (void)unused;
    static const double WAY_M[] = {2.5, 1.25, 0.25};
    double middle_m[3];
    for (int k = 0; k < 3; k++) {
        cp_lateral_overlays *overlays = create();
        steer(overlays, 7, 0.2, 0.02);
        step(overlays, 7, 10.0);
        double left_m = 50.0, mean, end;
        for (; left_m > 1e-9; left_m -= WAY_M[k]) {
            cp_lateral_overlay now = cp_lateral_overlay_get(overlays, 7);
            if (fabs(left_m - 25.0) < 1e-9)
                middle_m[k] = now.offset_m;
            cp_lateral_overlay_return(now, left_m, WAY_M[k], &mean, &end);
            steer(overlays, 7, mean, end);
            step(overlays, 7, WAY_M[k]);
        }
        assert_near(cp_lateral_overlay_get(overlays, 7).offset_m, 0.0, 1e-9);
        assert_near(cp_lateral_overlay_get(overlays, 7).slope_1, 0.0, 1e-9);
        cp_lateral_overlays_destroy(overlays);
    }
    // Half-way: 1/2 of 2 m and 1/8 of 0.02 times 50 m.
    for (int k = 0; k < 3; k++)
        assert_near(middle_m[k], 1.125, 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_car_lies_left_of_where_sumo_has_it),
        cmocka_unit_test(nobody_steering_it_drifts_on_as_far_as_it_drives),
        cmocka_unit_test(the_last_word_of_a_step_holds),
        cmocka_unit_test(a_car_returns_along_one_cubic_whatever_the_step),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
