/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control.h"

#include "control/scripted_road.h"
#include "core/units.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

/* What a drift came to: the car drives at 25 m/s in a lane 3.2 m wide and drifts from 0.5 s on. */
typedef struct outcome {
    double largest_m;     /* offset to the left */
    double end_m;         /* offset after 10 s */
    double sharpest_m_s2; /* lateral acceleration on the way back */
    bool acted;
} outcome;

static outcome drift(double lateral_m_s, double oncoming_x_m, double penetration_1,
                     double speed_m_s)
{
    const char *const names[] = {"penetration_1", NULL};
    cp_control_settings settings = road_settings(CP_CONTROL_FUNCTION, "elk", names, &penetration_1);
    const double step_s = 0.05;
    cp_traffic *traffic = road_open(step_s);
    cp_controls *controls;
    cp_error error = {0};
    outcome found = {0};
    assert_int_equal(cp_controls_create(&settings, 1, 5, 1, traffic, &controls, &error), CP_OK);
    road_add("own", 0.0, 0.0, 0.0, speed_m_s);
    road_add("oncoming", oncoming_x_m, 3.2, CP_PI, 25.0);
    cp_lateral_overlays *overlays = cp_traffic_overlays(traffic);
    double slope_1 = 0.0;
    while (road.time_s < 10.0) {
        assert_int_equal(cp_traffic_step(traffic, &error), CP_OK);
        cp_lateral_overlay now = cp_lateral_overlay_get(overlays, 0);
        found.acted |= now.slope_1 != slope_1;
        if (found.acted)
            found.sharpest_m_s2 =
                fmax(found.sharpest_m_s2, fabs(now.slope_1 - slope_1) / step_s * speed_m_s);
        // The driver looks away and steers no more once somebody else has.
        slope_1 = found.acted ? now.slope_1 : road.time_s > 0.5 ? lateral_m_s / speed_m_s : 0.0;
        if (!found.acted)
            assert_int_equal(cp_lateral_overlay_steer(overlays, 0, slope_1, slope_1, &error),
                             CP_OK);
        assert_int_equal(cp_controls_step(controls, &error), CP_OK);
        found.largest_m = fmax(found.largest_m, now.offset_m);
        found.end_m = now.offset_m;
    }
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
    return found;
}

static void brings_the_car_back_before_an_oncoming_one(void **unused)
{
    (void)unused;
    outcome found = drift(0.5, 200.0, 1.0, 25.0);
    assert_true(found.acted);
    // The line is 0.7 m away; request 0.3 s before it, 0.2 s of delay.
    assert_true(found.largest_m > 0.6 && found.largest_m < 0.95);
    assert_true(fabs(found.end_m) < 1e-9);
    assert_true(found.sharpest_m_s2 < 3.3);
}

static void leaves_the_driver_alone_otherwise(void **unused)
{
    (void)unused;
    // Nobody oncoming in time; nobody equipped; too slow.
    assert_false(drift(0.5, 5000.0, 1.0, 25.0).acted);
    assert_false(drift(0.5, 300.0, 0.0, 25.0).acted);
    assert_false(drift(0.3, 200.0, 1.0, 10.0).acted);
    // Away from the oncoming side.
    assert_false(drift(-0.5, 300.0, 1.0, 25.0).acted);
    // No drift at all.
    assert_false(drift(0.0, 300.0, 1.0, 25.0).acted);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(brings_the_car_back_before_an_oncoming_one),
        cmocka_unit_test(leaves_the_driver_alone_otherwise),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
