/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/function_host.h"

#include "control/control_types.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

#include "control/bend_road.h"

/* What a function is told and what becomes of its requests, on a scripted road with lanes. */

#define STEP_S 0.1

/* What the function under test does and has seen; one car has it. */
static struct probe {
    bool looks;
    double acceleration_m_s2;
    const char *says;
    size_t known;
    crashpulse_object object;
    crashpulse_road road;
    bool is_road;
    size_t left;
    size_t steps, odd; /* steps of cars whose memory stands where not everything may stand */
} probe;

static const char *probe_step(void *self, void *car, const crashpulse_view *view,
                              crashpulse_request *request)
{
    (void)self;
    const crashpulse_object *objects;
    probe.steps++;
    probe.odd += (uintptr_t)car % _Alignof(max_align_t) != 0;
    probe.known = 0;
    if (probe.looks && (probe.known = view->host->look(view, &objects)) > 0)
        probe.object = objects[0];
    probe.is_road = view->host->road(view, &probe.road);
    request->acceleration_m_s2 = probe.acceleration_m_s2;
    return probe.says;
}

static void probe_leave(void *self, void *car)
{
    (void)self;
    (void)car;
    probe.left++;
}

static const cp_control_parameter PARAMETERS[] = {
    CP_CONTROL_PENETRATION, {"sensor_field_of_view_deg", 360.0, 1.0, 360.0, "all round"}};
static const crashpulse_function PROBE = {.abi = CRASHPULSE_FUNCTION_ABI,
                                          .does = CRASHPULSE_BRAKES | CRASHPULSE_DRIVES,
                                          .what = "looks",
                                          .parameters = PARAMETERS,
                                          .parameter_count = 2,
                                          .car_size = 1,
                                          .step = probe_step,
                                          .leave = probe_leave};
CP_FUNCTION_TYPE(CP_CONTROL_PROBE, "probe", PROBE, PARAMETERS, "looks", false)

static cp_traffic *begin(double radius_m, cp_controls **controls)
{
    const char *const own[2] = {"own", "own"};
    cp_control_settings settings = cp_control_settings_default(&CP_CONTROL_PROBE);
    cp_error error = {0};
    lay_bend(radius_m, 1.0, 100.0);
    cp_traffic *traffic = open_bend_road(STEP_S);
    probe = (struct probe){.looks = true, .acceleration_m_s2 = CRASHPULSE_NONE};
    assert_int_equal(cp_controls_create(NULL, 0, 1, 1, traffic, controls, &error), CP_OK);
    assert_int_equal(cp_controls_add_treatment(*controls, &settings, 1, 1, 1, own, &error), CP_OK);
    return traffic;
}

static void end(cp_traffic *traffic, cp_controls *controls)
{
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
    cp_lane_map_destroy(bend.map);
}

static cp_status step(cp_traffic *traffic, cp_controls *controls, cp_error *error)
{
    assert_int_equal(cp_traffic_step(traffic, error), CP_OK);
    return cp_controls_step(controls, error);
}

static void steps(cp_traffic *traffic, cp_controls *controls, int count)
{
    cp_error error = {0};
    for (int k = 0; k < count; k++)
        if (step(traffic, controls, &error) != CP_OK)
            fail_msg("%s", error.text);
}

static void the_road_is_told_as_it_is(void **unused)
{
    (void)unused;
    for (uint32_t lane = 0; lane < 2; lane++) {
        cp_controls *controls;
        cp_traffic *traffic = begin(80.0, &controls);
        double radius_m = 80.0 + (lane == 0 ? 0.5 : -0.5) * LANE_WIDTH_M;
        add_car("own", lane, 150.0, 1.0, 1.0); // on the arc
        steps(traffic, controls, 2);
        assert_true(probe.is_road);
        assert_true(probe.road.count > 10);
        // To the left on one lane, to the right on the one that comes back.
        double curvature_1_m = (lane == 0 ? 1.0 : -1.0) / radius_m;
        for (size_t k = 1; k < 10; k++)
            assert_true(fabs(probe.road.point[k].curvature_1_m - curvature_1_m) < 0.02 / radius_m);
        // It begins beside the front and goes ahead.
        assert_true(hypot(probe.road.point[0].ahead_m, probe.road.point[0].left_m) < 0.01);
        assert_true(fabs(probe.road.lane_left_m) < 0.01);
        assert_true(probe.road.point[3].ahead_m > 1.0);
        assert_true((probe.road.point[9].left_m > 0.0) == (lane == 0));
        assert_true(probe.road.lane_width_m == LANE_WIDTH_M);
        assert_true(probe.road.speed_limit_m_s == INFINITY); // the scripted road has none
        end(traffic, controls);
    }
}

static void objects_are_told_in_the_cars_frame(void **unused)
{
    (void)unused;
    cp_controls *controls;
    cp_traffic *traffic = begin(80.0, &controls);
    add_car("own", 0, 20.0, 1.0, 10.0);
    add_car("ahead", 0, 50.0, 1.0, 8.0);
    // Confirmed after 0.2 s in view, which begins with the first step.
    steps(traffic, controls, 2);
    assert_int_equal(probe.known, 0);
    steps(traffic, controls, 1);
    assert_int_equal(probe.known, 1);
    assert_true(fabs(probe.object.ahead_m - (30.0 - 2.0 * 2.0 * STEP_S)) < 1e-9);
    assert_true(fabs(probe.object.left_m) < 1e-9 && fabs(probe.object.heading_rad) < 1e-9);
    assert_true(probe.object.speed_m_s == 8.0 && probe.object.length_m == LENGTH_M);
    assert_true(fabs(probe.object.in_view_s - 2.0 * STEP_S) < 1e-9);
    // A step without looking, and it is confirmed anew.
    probe.looks = false;
    steps(traffic, controls, 1);
    probe.looks = true;
    steps(traffic, controls, 2);
    assert_int_equal(probe.known, 0);
    steps(traffic, controls, 1);
    assert_int_equal(probe.known, 1);
    end(traffic, controls);
    assert_int_equal(probe.left, 1);
}

// Of a function that needs one byte a car, too.
static void memory_of_cars_is_aligned(void **unused)
{
    (void)unused;
    cp_controls *controls;
    cp_error error = {0};
    cp_control_settings settings = cp_control_settings_default(&CP_CONTROL_PROBE);
    lay_bend(80.0, 1.0, 100.0);
    cp_traffic *traffic = open_bend_road(STEP_S);
    probe = (struct probe){.acceleration_m_s2 = CRASHPULSE_NONE};
    assert_int_equal(cp_controls_create(&settings, 1, 1, 1, traffic, &controls, &error), CP_OK);
    add_car("one", 0, 20.0, 1.0, 10.0);
    add_car("two", 0, 40.0, 1.0, 10.0);
    add_car("three", 0, 60.0, 1.0, 10.0);
    steps(traffic, controls, 3);
    assert_int_equal(probe.steps, 9);
    assert_int_equal(probe.odd, 0);
    end(traffic, controls);
    assert_int_equal(probe.left, 3);
}

static void it_drives_as_it_asks(void **unused)
{
    (void)unused;
    cp_controls *controls;
    cp_traffic *traffic = begin(80.0, &controls);
    add_car("own", 0, 20.0, 1.0, 10.0);
    probe.acceleration_m_s2 = 1.5;
    steps(traffic, controls, 11); // the first puts it there, the last command is still to come
    assert_true(fabs(road.cars[0].state.speed_m_s - (10.0 + 1.5 * 10 * STEP_S)) < 1e-9);
    probe.acceleration_m_s2 = CRASHPULSE_NONE;
    steps(traffic, controls, 1);
    assert_true(road.cars[0].command_m_s < 0.0); // the driver's again
    end(traffic, controls);
}

static void what_goes_wrong_has_a_name(void **unused)
{
    (void)unused;
    const struct {
        double acceleration_m_s2;
        const char *says, *wanted;
    } faults[] = {{NAN, NULL, "its request has acceleration_m_s2 nan"},
                  {-21.0, NULL, "must be a number in -20..20"},
                  {CRASHPULSE_NONE, "lost its way", "lost its way"}};
    for (size_t k = 0; k < sizeof faults / sizeof *faults; k++) {
        cp_controls *controls;
        cp_error error = {0};
        cp_traffic *traffic = begin(80.0, &controls);
        add_car("own", 0, 20.0, 1.0, 10.0);
        steps(traffic, controls, 1);
        probe.acceleration_m_s2 = faults[k].acceleration_m_s2;
        probe.says = faults[k].says;
        assert_int_equal(step(traffic, controls, &error), CP_RUN_FAILED);
        assert_non_null(strstr(error.text, "probe: built in: vehicle 'own' at 0.200 s: "));
        assert_non_null(strstr(error.text, faults[k].wanted));
        end(traffic, controls);
    }
}

static void a_library_has_to_be_named(void **unused)
{
    (void)unused;
    cp_controls *controls = NULL;
    cp_error error = {0};
    cp_traffic *traffic = road_open(STEP_S);
    cp_control_settings settings = cp_control_settings_default(&CP_CONTROL_PLUGIN);
    assert_int_equal(cp_controls_create(&settings, 1, 1, 1, traffic, &controls, &error),
                     CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "names no library"));
    cp_library nowhere = {
        .name = (char *)"x", .written = (char *)"x.so", .path = (char *)"nowhere/x.so"};
    settings.library = &nowhere;
    assert_int_equal(cp_controls_create(&settings, 1, 1, 1, traffic, &controls, &error),
                     CP_RUN_FAILED);
    assert_non_null(strstr(error.text, "x: x.so: cannot be loaded"));
    cp_traffic_destroy(traffic);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_road_is_told_as_it_is),
                                       cmocka_unit_test(objects_are_told_in_the_cars_frame),
                                       cmocka_unit_test(memory_of_cars_is_aligned),
                                       cmocka_unit_test(it_drives_as_it_asks),
                                       cmocka_unit_test(what_goes_wrong_has_a_name),
                                       cmocka_unit_test(a_library_has_to_be_named)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
