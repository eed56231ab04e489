/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "traffic/traffic.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static cp_traffic *create(void)
{
    static char path[1024];
    snprintf(path, sizeof path, "%s/tests/traffic/overpass/overpass.sumocfg",
             getenv("CRASHPULSE_BUILD"));
    cp_traffic_options options = {.sumocfg = path, .seed = 1, .step_length_s = 0.1};
    cp_traffic *traffic;
    cp_error error = {0};
    if (cp_traffic_create(&options, &traffic, &error) != CP_OK)
        fail_msg("%s", error.text);
    return traffic;
}

static const cp_vehicle_state *state_of(const cp_traffic *traffic, const char *id)
{
    size_t count;
    const cp_vehicle_motion *motions = cp_traffic_motions(traffic, &count);
    for (size_t k = 0; k < count; k++)
        if (strcmp(cp_traffic_vehicle_id(traffic, motions[k].after.vehicle), id) == 0)
            return &motions[k].after;
    return NULL;
}

/* Step until the two fronts are nearest; their relation there. */
static cp_road_relation relation_at_nearest(cp_traffic *traffic, const char *one, const char *other)
{
    cp_error error = {0};
    cp_road_relation relation = CP_ROADS_MEET;
    double nearest_m = INFINITY;
    for (int step = 0; step < 400; step++) {
        if (cp_traffic_step(traffic, &error) != CP_OK)
            fail_msg("%s", error.text);
        const cp_vehicle_state *a = state_of(traffic, one), *b = state_of(traffic, other);
        if (a == NULL || b == NULL)
            continue;
        double distance_m = hypot(a->front_x_m - b->front_x_m, a->front_y_m - b->front_y_m);
        if (distance_m >= nearest_m)
            continue;
        nearest_m = distance_m;
        if (cp_traffic_road_relation(traffic, a, b, &relation, &error) != CP_OK)
            fail_msg("%s", error.text);
    }
    assert_true(nearest_m < 15.0);
    return relation;
}

static void roads_that_only_cross_are_apart(void **state)
{
    (void)state;
    cp_traffic *traffic = create();
    assert_int_equal(relation_at_nearest(traffic, "above", "below"), CP_ROADS_APART);
    cp_traffic_destroy(traffic);
}

static void roads_of_a_junction_and_both_directions_meet(void **state)
{
    (void)state;
    cp_traffic *traffic = create();
    assert_int_equal(relation_at_nearest(traffic, "through", "crossing"), CP_ROADS_MEET);
    cp_traffic_destroy(traffic);
    traffic = create();
    assert_int_equal(relation_at_nearest(traffic, "through", "oncoming"), CP_ROADS_MEET);
    cp_traffic_destroy(traffic);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(roads_that_only_cross_are_apart),
        cmocka_unit_test(roads_of_a_junction_and_both_directions_meet),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
