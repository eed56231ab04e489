/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/driver_error/ignored_foes.h"

#include "control/scripted_road.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

static void add(cp_ignored_foes *ignored, uint32_t ego, uint32_t foe, cp_ignore_reason reason)
{
    cp_error error = {0};
    assert_int_equal(cp_ignored_foes_add(ignored, ego, foe, reason, &error), CP_OK);
}

static void send(cp_ignored_foes *ignored, const cp_traffic *traffic)
{
    cp_error error = {0};
    assert_int_equal(cp_ignored_foes_send(ignored, traffic, &error), CP_OK);
}

static void sumo_is_told_what_changed_and_once(void **unused)
{
    (void)unused;
    cp_traffic *traffic = road_open(0.1);
    cp_ignored_foes *ignored;
    cp_error error = {0};
    assert_int_equal(cp_ignored_foes_create(&ignored, &error), CP_OK);
    for (int k = 0; k < 4; k++) {
        char id[8];
        snprintf(id, sizeof id, "car%d", k);
        road_add(id, 100.0 * k, 0.0, 0.0, 10.0);
    }
    assert_int_equal(cp_traffic_step(traffic, &error), CP_OK);
    add(ignored, 0, 1, CP_IGNORE_UNSEEN);
    add(ignored, 0, 2, CP_IGNORE_UNSEEN);
    add(ignored, 3, 1, CP_IGNORE_RED);
    send(ignored, traffic);
    assert_string_equal(road.cars[0].key, "junctionModel.ignoreIDs");
    assert_string_equal(road.cars[0].value, "car1 car2");
    assert_string_equal(road.cars[3].value, "car1");
    int commands = road.commands;
    send(ignored, traffic);
    assert_int_equal(road.commands, commands);

    // Two reasons: the first to end changes nothing.
    add(ignored, 0, 1, CP_IGNORE_RED);
    cp_ignored_foes_take_back(ignored, 0, 1, CP_IGNORE_UNSEEN);
    send(ignored, traffic);
    assert_int_equal(road.commands, commands);
    cp_ignored_foes_heed(ignored, 1, CP_IGNORE_RED);
    send(ignored, traffic);
    assert_string_equal(road.cars[0].value, "car2");
    assert_string_equal(road.cars[3].value, "");

    // Who has gone is forgotten.
    road.cars[2].is_there = false;
    assert_int_equal(cp_traffic_step(traffic, &error), CP_OK);
    add(ignored, 0, 3, CP_IGNORE_RED);
    send(ignored, traffic);
    assert_string_equal(road.cars[0].value, "car3");
    cp_ignored_foes_destroy(ignored);
    cp_traffic_destroy(traffic);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sumo_is_told_what_changed_and_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
