/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "traffic/sumo_bridge.h"

#include "core/geometry.h"
#include "core/units.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// Defined in asked_in_cpp.cpp.
extern const char *version_by_cpp(void);
extern double sumo_angle_deg(const char *vehicle);
extern double sumo_speed_m_s(const char *vehicle);

static const char *configuration(char path[1024], const char *name)
{
    snprintf(path, 1024, "%s/tests/traffic/straight/%s.sumocfg", getenv("CRASHPULSE_SOURCE"), name);
    return path;
}

static void start(uint64_t seed, double step_length_s)
{
    char path[1024];
    cp_error error = {0};
    if (sumo_bridge_start(configuration(path, "straight"), seed, step_length_s, NULL, 0, &error) !=
        CP_OK)
        fail_msg("%s", error.text);
}

static const cp_vehicle_state *step(size_t *count)
{
    const cp_vehicle_state *states;
    cp_error error = {0};
    if (sumo_bridge_step(&states, count, &error) != CP_OK)
        fail_msg("%s", error.text);
    return states;
}

static const cp_vehicle_state *find(const cp_vehicle_state *states, size_t count, const char *id)
{
    for (size_t k = 0; k < count; k++)
        if (strcmp(sumo_bridge_vehicle_id(states[k].vehicle), id) == 0)
            return &states[k];
    return NULL;
}

static const cp_vehicle_state *run_until(double time_s, size_t *count)
{
    const cp_vehicle_state *states;
    do
        states = step(count);
    while (sumo_bridge_time_s() < time_s - 1e-9);
    return states;
}

// The vehicle id after the next step that ends at or after time_s.
static const cp_vehicle_state *find_at(double time_s, const char *id)
{
    size_t count;
    const cp_vehicle_state *states = run_until(time_s, &count);
    return find(states, count, id);
}

static void states_come_in_our_frame(void **unused)
{
    (void)unused;
    start(1, 0.1);
    size_t count;
    const cp_vehicle_state *states = run_until(11.0, &count);
    assert_int_equal(count, 3);
    const cp_vehicle_state *first = find(states, count, "first");
    const cp_vehicle_state *oncoming = find(states, count, "oncoming");
    const cp_vehicle_state *northbound = find(states, count, "northbound");
    assert_non_null(first);
    assert_non_null(oncoming);
    assert_non_null(northbound);

    // Inserted in the step that ends at 1.1 s, then 20 m/s.
    double driven_m = 20.0 * (11.0 - 1.1);
    assert_true(first->yaw_rad == 0.0);
    assert_true(oncoming->yaw_rad == CP_PI);
    assert_true(northbound->yaw_rad == CP_PI / 2);
    assert_true(fabs(northbound->front_x_m - 3000.0) < 1e-6);
    assert_true(fabs(northbound->front_y_m - (100.0 + driven_m)) < 1e-6);
    assert_true(fabs(first->front_x_m - (100.0 + driven_m)) < 1e-6);
    assert_true(fabs(first->front_y_m + 1.6) < 1e-6);
    assert_true(fabs(oncoming->front_x_m - (1700.0 - driven_m)) < 1e-6);
    assert_true(fabs(oncoming->front_y_m - 1.6) < 1e-6);
    assert_true(fabs(first->lane_position_m - (100.0 + driven_m)) < 1e-6);
    assert_true(first->speed_m_s == 20.0);
    assert_true(first->length_m == 4.5 && first->width_m == 1.8);
    assert_string_equal(sumo_bridge_type_id(first->type), "exact");
    assert_string_equal(sumo_bridge_lane_id(first->lane), "east_0");
    assert_string_equal(sumo_bridge_lane_id(oncoming->lane), "west_0");
    assert_string_equal(sumo_bridge_vehicle_id(CP_NO_NUMBER), "");
    sumo_bridge_stop();
}

static void vehicles_are_announced_when_they_come_and_go(void **unused)
{
    (void)unused;
    start(1, 0.1);
    size_t come = 0, there = 0, count = 0;
    uint32_t numbers[3] = {CP_NO_NUMBER, CP_NO_NUMBER, CP_NO_NUMBER};
    while (sumo_bridge_time_s() < 100.0 && (come < 3 || there > 0)) {
        const cp_vehicle_state *states = step(&count);
        const uint32_t *vehicles;
        size_t listed;
        cp_error error = {0};
        assert_int_equal(sumo_bridge_departed(&vehicles, &listed, &error), CP_OK);
        for (size_t k = 0; k < listed && come < 3; k++)
            numbers[come++] = vehicles[k];
        there = 0;
        for (size_t k = 0; k < count; k++)
            for (size_t i = 0; i < 3; i++)
                there += states[k].vehicle == numbers[i];
    }
    assert_int_equal(come, 3);
    assert_int_equal(there, 0);
    // 1900 m at 20 m/s for the last.
    assert_true(fabs(sumo_bridge_time_s() - (1.1 + 95.0)) < 0.25);
    sumo_bridge_stop();
}

static void a_broken_configuration_says_why(void **unused)
{
    (void)unused;
    static const char *const CASE[][2] = {{"missing_net", "nowhere.net.xml"},
                                          {"malformed_net", "malformed.net.xml"},
                                          {"not_there", "not_there.sumocfg"}};
    char path[1024];
    for (size_t k = 0; k < 3; k++) {
        cp_error error = {0};
        cp_status status =
            sumo_bridge_start(configuration(path, CASE[k][0]), 1, 0.1, NULL, 0, &error);
        assert_int_equal(status, CP_BAD_INPUT);
        assert_int_equal(error.status, CP_BAD_INPUT);
        assert_non_null(strstr(error.text, CASE[k][0]));
        assert_non_null(strstr(error.text, CASE[k][1]));
        assert_null(strstr(error.text, "Process Error"));
        assert_null(strchr(error.text, '\n'));
    }
    // Malformed XML comes with its place.
    cp_error error = {0};
    assert_int_equal(
        sumo_bridge_start(configuration(path, "malformed_net"), 1, 0.1, NULL, 0, &error),
        CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "At line/column 6/"));

    // Without a simulation nothing works, and nothing breaks.
    const cp_vehicle_state *states;
    size_t count;
    assert_int_equal(sumo_bridge_step(&states, &count, &error), CP_TRAFFIC_FAILED);
    assert_int_equal(sumo_bridge_remove(0, &error), CP_TRAFFIC_FAILED);
    start(1, 0.1);
    sumo_bridge_stop();
    sumo_bridge_stop();
}

static void further_options_reach_sumo(void **unused)
{
    (void)unused;
    char path[1024];
    const char *const unknown[] = {"--no-such-option", "1"};
    cp_error error = {0};
    assert_int_equal(sumo_bridge_start(configuration(path, "straight"), 1, 0.1, unknown, 2, &error),
                     CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "no-such-option"));

    const char *const lateral[] = {"--lateral-resolution", "0.8"};
    assert_int_equal(sumo_bridge_start(configuration(path, "straight"), 7, 0.1, lateral, 2, &error),
                     CP_OK);
    const char *line = sumo_bridge_command_line();
    assert_non_null(strstr(line, "--lateral-resolution 0.8"));
    assert_non_null(strstr(line, "--step-method.ballistic true"));
    assert_non_null(strstr(line, "--seed 7"));
    sumo_bridge_stop();
    assert_string_equal(sumo_bridge_version(), version_by_cpp());
    assert_true(strncmp(sumo_bridge_version(), "SUMO ", 5) == 0);
}

// Sum over everything that a state holds of traffic with random drivers.
static double fingerprint(uint64_t seed)
{
    start(seed, 0.1);
    double sum = 0.0;
    size_t count;
    for (int k = 0; k < 1500; k++) {
        const cp_vehicle_state *states = step(&count);
        for (size_t i = 0; i < count; i++)
            sum += (double)(i + 1) * (states[i].front_x_m + states[i].speed_m_s);
    }
    sumo_bridge_stop();
    return sum;
}

static void the_same_seed_gives_the_same_traffic(void **unused)
{
    (void)unused;
    double one = fingerprint(1);
    assert_true(one == fingerprint(1));
    assert_true(one != fingerprint(2));
}

static void a_removed_vehicle_is_gone(void **unused)
{
    (void)unused;
    start(1, 0.1);
    const cp_vehicle_state *first = find_at(5.0, "first");
    assert_non_null(first);
    uint32_t vehicle = first->vehicle;
    cp_error error = {0};
    assert_int_equal(sumo_bridge_remove(vehicle, &error), CP_OK);
    assert_null(find_at(0.0, "first"));
    assert_non_null(find_at(0.0, "oncoming"));

    // Commands to it are refused with its id; the name stays known.
    assert_int_equal(sumo_bridge_set_speed(vehicle, 3.0, &error), CP_TRAFFIC_FAILED);
    assert_non_null(strstr(error.text, "first"));
    assert_string_equal(sumo_bridge_vehicle_id(vehicle), "first");
    sumo_bridge_stop();
}

static void commanded_braking_is_exact(void **unused)
{
    (void)unused;
    const double step_s = 0.05, deceleration_m_s2 = 8.0;
    start(1, step_s);
    const cp_vehicle_state *first = find_at(5.0, "first");
    assert_non_null(first);
    uint32_t vehicle = first->vehicle;
    double speed_m_s = first->speed_m_s, from_m = first->front_x_m;
    int mode;
    cp_error error = {0};
    assert_int_equal(sumo_bridge_speed_mode(vehicle, &mode, &error), CP_OK);
    assert_int_equal(mode, 31);
    assert_int_equal(sumo_bridge_set_speed_mode(vehicle, 27, &error), CP_OK);
    while (speed_m_s > 0.0) {
        speed_m_s = fmax(speed_m_s - deceleration_m_s2 * step_s, 0.0);
        assert_int_equal(sumo_bridge_set_speed(vehicle, speed_m_s, &error), CP_OK);
        first = find_at(0.0, "first");
        assert_non_null(first);
        assert_true(fabs(first->speed_m_s - speed_m_s) < 1e-9);
    }
    // v^2 / 2a.
    assert_true(fabs(first->front_x_m - from_m - 20.0 * 20.0 / 2.0 / deceleration_m_s2) < 1e-6);

    // Handed back, it drives off.
    assert_int_equal(sumo_bridge_set_speed(vehicle, -1.0, &error), CP_OK);
    assert_int_equal(sumo_bridge_set_speed_mode(vehicle, mode, &error), CP_OK);
    first = find_at(sumo_bridge_time_s() + 2.0, "first");
    assert_non_null(first);
    assert_true(first->speed_m_s > 3.0);
    sumo_bridge_stop();
}

// Lanes of a network file.
static unsigned lanes_of(const char *path)
{
    char line[4096];
    unsigned lanes = 0;
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    while (fgets(line, sizeof line, file) != NULL)
        lanes += strstr(line, "<lane ") != NULL;
    fclose(file);
    return lanes;
}

static void every_lane_has_random_numbers_of_its_own(void **unused)
{
    (void)unused;
    char path[1024], net[1024], words[64];
    cp_error error = {0};
    snprintf(path, sizeof path, "%s/sumo_scenarios/town/town.sumocfg", getenv("CRASHPULSE_BUILD"));
    snprintf(net, sizeof net, "%s/sumo_scenarios/town/town.net.xml", getenv("CRASHPULSE_BUILD"));
    unsigned lanes = lanes_of(net);
    assert_true(lanes > 64);
    if (sumo_bridge_start(path, 1, 0.1, NULL, 0, &error) != CP_OK)
        fail_msg("%s", error.text);
    snprintf(words, sizeof words, " --thread-rngs %u ", lanes);
    assert_non_null(strstr(sumo_bridge_command_line(), words));
    sumo_bridge_stop();
}

// Of vehicles that stand or drive straight on not everything is asked: what is told instead is what
// SUMO says, in bends and in lane changes that take time too.
static void headings_and_speeds_are_those_of_sumo(void **unused)
{
    (void)unused;
    char path[1024];
    cp_error error = {0};
    size_t count, read = 0, turning = 0, standing = 0;
    snprintf(path, sizeof path, "%s/sumo_scenarios/town/town.sumocfg", getenv("CRASHPULSE_BUILD"));
    if (sumo_bridge_start(path, 1, 0.1, NULL, 0, &error) != CP_OK)
        fail_msg("%s", error.text);
    for (int k = 0; k < 900; k++) {
        const cp_vehicle_state *states = step(&count);
        for (size_t vehicle = 0; vehicle < count; vehicle++) {
            const char *id = sumo_bridge_vehicle_id(states[vehicle].vehicle);
            double yaw_rad = cp_rad_from_deg(90.0 - sumo_angle_deg(id));
            assert_true(fabs(cp_wrap_angle(states[vehicle].yaw_rad - yaw_rad)) <= 1e-8);
            assert_true(states[vehicle].speed_m_s == sumo_speed_m_s(id));
            turning += fabs(sin(2.0 * yaw_rad)) > 1e-3;
            standing += states[vehicle].speed_m_s == 0.0;
        }
        read += count;
    }
    sumo_bridge_stop();
    assert_true(turning > 1000 && standing > 1000 && read > 50000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(states_come_in_our_frame),
        cmocka_unit_test(vehicles_are_announced_when_they_come_and_go),
        cmocka_unit_test(a_broken_configuration_says_why),
        cmocka_unit_test(further_options_reach_sumo),
        cmocka_unit_test(the_same_seed_gives_the_same_traffic),
        cmocka_unit_test(a_removed_vehicle_is_gone),
        cmocka_unit_test(commanded_braking_is_exact),
        cmocka_unit_test(every_lane_has_random_numbers_of_its_own),
        cmocka_unit_test(headings_and_speeds_are_those_of_sumo),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
