/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control.h"

#include "control/scripted_road.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

static cp_controls *create(const cp_traffic *traffic, double probability_1, uint64_t seed)
{
    const char *const names[] = {"probability_1", NULL};
    cp_control_settings settings =
        road_settings(CP_CONTROL_DRIVER_ERROR, "failed_to_see", names, &probability_1);
    cp_controls *controls;
    cp_error error = {0};
    assert_int_equal(cp_controls_create(&settings, 1, 5, seed, traffic, &controls, &error), CP_OK);
    return controls;
}

static void step(cp_traffic *traffic, cp_controls *controls)
{
    cp_error error = {0};
    assert_int_equal(cp_traffic_step(traffic, &error), CP_OK);
    assert_int_equal(cp_controls_step(controls, &error), CP_OK);
}

// Whether a word is in a text of words separated by blanks.
static bool has_word(const char *text, const char *word)
{
    char padded[300], wanted[32];
    snprintf(padded, sizeof padded, " %s ", text);
    snprintf(wanted, sizeof wanted, " %s ", word);
    return strstr(padded, wanted) != NULL;
}

static void certain_drivers_overlook_everybody_both_ways(void **unused)
{
    (void)unused;
    cp_traffic *traffic = road_open(0.1);
    cp_controls *controls = create(traffic, 1.0, 1);
    road_add("one", 0.0, 0.0, 0.0, 10.0);
    road_add("two", 100.0, 0.0, 0.0, 10.0);
    step(traffic, controls);
    road_add("three", 300.0, 0.0, 0.0, 10.0);
    step(traffic, controls);
    assert_string_equal(road.cars[0].key, "junctionModel.ignoreIDs");
    assert_string_equal(road.cars[0].value, "two three");
    assert_string_equal(road.cars[1].value, "one three");
    assert_string_equal(road.cars[2].value, "one two");

    // Nothing new, nothing sent.
    int commands = road.commands;
    step(traffic, controls);
    assert_int_equal(road.commands, commands);
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
}

static void attentive_drivers_get_no_command(void **unused)
{
    (void)unused;
    cp_traffic *traffic = road_open(0.1);
    cp_controls *controls = create(traffic, 0.0, 1);
    road_add("one", 0.0, 0.0, 0.0, 10.0);
    road_add("two", 100.0, 0.0, 0.0, 10.0);
    step(traffic, controls);
    step(traffic, controls);
    assert_int_equal(road.commands, 0);
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
}

// Does "a" overlook "b" with this seed, when third joins before, between or after (or not at all)?
static bool overlooks(uint64_t seed, int third_at, double step_s)
{
    cp_traffic *traffic = road_open(step_s);
    cp_controls *controls = create(traffic, 0.5, seed);
    const char *ids[] = {"a", "b"};
    uint32_t number_of_a = 0;
    for (int k = 0; k < 3; k++) {
        if (k == third_at)
            road_add("third", 500.0, 0.0, 0.0, 10.0);
        if (k == 0)
            number_of_a = road.count;
        if (k < 2)
            road_add(ids[k], 100.0 * k, 0.0, 0.0, 10.0);
        step(traffic, controls);
    }
    bool does = has_word(road.cars[number_of_a].value, "b");
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
    return does;
}

static void a_pair_is_drawn_for_itself(void **unused)
{
    (void)unused;
    int yes = 0;
    for (uint64_t seed = 0; seed < 200; seed++) {
        bool alone = overlooks(seed, -1, 0.1);
        yes += alone;
        for (int third_at = 0; third_at < 3; third_at++)
            assert_int_equal(overlooks(seed, third_at, 0.1), alone);
        assert_int_equal(overlooks(seed, -1, 0.05), alone);
    }
    // 100 expected, standard deviation 7.
    assert_in_range(yes, 70, 130);
}

static void fault_is_with_who_overlooked_the_one_close_by(void **unused)
{
    (void)unused;
    cp_traffic *traffic = road_open(0.1);
    cp_controls *controls = create(traffic, 1.0, 1);
    road_add("one", 0.0, 0.0, 0.0, 10.0);
    road_add("two", 8.0, 2.0, 3.0, 0.0);
    road_add("far", 200.0, 0.0, 0.0, 10.0);
    step(traffic, controls);
    assert_true(cp_controls_is_at_fault(controls, 0));
    assert_true(cp_controls_is_at_fault(controls, 1));
    assert_false(cp_controls_is_at_fault(controls, 2));
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
}

// Waiting opposite somebody overlooked is no error yet; setting off is, from that moment, towards
// him alone. One who comes from afar is an error from a driver's time to react on.
static void error_towards_one_begins_when_he_matters(void **unused)
{
    (void)unused;
    cp_traffic *traffic = road_open(0.1);
    cp_controls *controls = create(traffic, 1.0, 1);
    road_add("waiting", 0.0, 0.0, 0.0, 0.0);
    road_add("opposite", 10.0, 3.0, 3.14, 0.0);
    road_add("coming", 100.0, 3.0, 3.14, 10.0);
    for (int k = 0; k < 20; k++)
        step(traffic, controls);
    assert_true(isinf(cp_controls_error_since_s(controls, 0, 1)));

    // Off at 2 s; the one who comes is at 80 m then, and within 15 m + 3 s * 10 m/s at 5.5 s or,
    // as both move, a little before.
    road.cars[0].state.speed_m_s = 1.0;
    double coming_since_s = INFINITY;
    for (int k = 0; k < 40; k++) {
        step(traffic, controls);
        assert_true(fabs(cp_controls_error_since_s(controls, 0, 1) - 2.1) < 1e-9);
        double since_s = cp_controls_error_since_s(controls, 0, 2);
        coming_since_s = isinf(coming_since_s) ? since_s : coming_since_s;
        assert_true(since_s == coming_since_s);
    }
    assert_true(fabs(coming_since_s - 5.3) < 0.15);
    assert_false(cp_controls_errs_alone(controls, 0));

    // He stops: the error is over, and begins anew.
    road.cars[0].state.speed_m_s = 0.0;
    step(traffic, controls);
    assert_true(isinf(cp_controls_error_since_s(controls, 0, 1)));
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(certain_drivers_overlook_everybody_both_ways),
        cmocka_unit_test(attentive_drivers_get_no_command),
        cmocka_unit_test(a_pair_is_drawn_for_itself),
        cmocka_unit_test(error_towards_one_begins_when_he_matters),
        cmocka_unit_test(fault_is_with_who_overlooked_the_one_close_by),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
