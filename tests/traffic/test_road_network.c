/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "traffic/road_network.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "builders/assert_near.h"

/* A road west-east of 100 m, junction J, 100 m more; from J a stub of 8 m to junction K and 50 m
 * beyond; a motorway that crosses everything without a junction. */
enum { WEST, WEST_BACK, EAST, EAST_BACK, INSIDE, STUB, BEYOND, INSIDE_K, MOTORWAY, LANES };

static const cp_road_lane LANE[LANES] = {
    [WEST] = {"west", NULL, 100.0, 0, 0, 100, 0},
    [WEST_BACK] = {"-west", NULL, 100.0, 100, 4, 0, 4},
    [EAST] = {"east", NULL, 100.0, 110, 0, 210, 0},
    [EAST_BACK] = {"-east", NULL, 100.0, 210, 4, 110, 4},
    [INSIDE] = {":J_0", "J", 10.0, 100, 0, 110, 0},
    [STUB] = {"stub", NULL, 8.0, 105, 5, 105, 13},
    [BEYOND] = {"beyond", NULL, 50.0, 105, 14, 105, 64},
    [INSIDE_K] = {":K_0", "K", 1.0, 105, 13, 105, 14},
    [MOTORWAY] = {"motorway", NULL, 300.0, 50, -150, 50, 150},
};
static const cp_road_connection CONNECTION[] = {
    {WEST, EAST, INSIDE},
    {EAST_BACK, WEST_BACK, INSIDE},
    {WEST, STUB, INSIDE},
    {STUB, BEYOND, INSIDE_K},
};

static cp_road_network *build(void)
{
    cp_road_network *network;
    cp_error error = {0};
    if (cp_road_network_create(LANE, LANES, CONNECTION, sizeof CONNECTION / sizeof CONNECTION[0],
                               &network, &error) != CP_OK)
        fail_msg("%s", error.text);
    return network;
}

static double distance(const cp_road_network *network, uint32_t one, double at_m, uint32_t other,
                       double other_at_m, double reach_m)
{
    double there = cp_road_distance_m(network, (cp_road_place){one, at_m},
                                      (cp_road_place){other, other_at_m}, reach_m);
    double back = cp_road_distance_m(network, (cp_road_place){other, other_at_m},
                                     (cp_road_place){one, at_m}, reach_m);
    assert_true(there == back);
    return there;
}

static void both_directions_are_one_road(void **state)
{
    (void)state;
    cp_road_network *network = build();
    assert_near(distance(network, WEST, 30.0, WEST, 34.0, 20.0), 4.0, 1e-12);
    // 30 m from the west end, and 68 m from the east end: 2 m apart.
    assert_near(distance(network, WEST, 30.0, WEST_BACK, 68.0, 20.0), 2.0, 1e-12);
    assert_near(distance(network, EAST, 30.0, EAST_BACK, 70.0, 20.0), 0.0, 1e-12);
    assert_true(isinf(distance(network, WEST, 30.0, WEST, 60.0, 20.0)));
    cp_road_network_destroy(network);
}

static void roads_meet_over_junctions(void **state)
{
    (void)state;
    cp_road_network *network = build();
    assert_near(distance(network, WEST, 97.0, EAST, 6.0, 20.0), 9.0, 1e-12);
    assert_near(distance(network, WEST, 97.0, INSIDE, 3.0, 20.0), 3.0, 1e-12);
    assert_near(distance(network, EAST_BACK, 98.0, WEST_BACK, 1.0, 20.0), 3.0, 1e-12);
    // Over two junctions and the stub between them.
    assert_near(distance(network, WEST, 97.0, BEYOND, 2.0, 20.0), 13.0, 1e-12);
    assert_near(distance(network, INSIDE, 0.0, INSIDE_K, 0.0, 20.0), 8.0, 1e-12);
    assert_true(isinf(distance(network, WEST, 97.0, BEYOND, 2.0, 12.0)));
    cp_road_network_destroy(network);
}

static void a_road_that_only_crosses_does_not_meet(void **state)
{
    (void)state;
    cp_road_network *network = build();
    for (uint32_t lane = 0; lane < MOTORWAY; lane++)
        assert_true(isinf(distance(network, lane, 50.0, MOTORWAY, 150.0, 100.0)));
    assert_true(isinf(distance(network, WEST, 0.0, 4711, 0.0, 100.0)));
    cp_road_network_destroy(network);
}

static void without_lanes_inside_junctions_ends_join_all_the_same(void **state)
{
    (void)state;
    cp_road_lane lane[3] = {LANE[WEST], LANE[EAST], LANE[BEYOND]};
    cp_road_connection connection[2] = {{0, 1, CP_ROAD_NONE}, {0, 2, CP_ROAD_NONE}};
    cp_road_network *network;
    assert_int_equal(cp_road_network_create(lane, 3, connection, 2, &network, NULL), CP_OK);
    assert_near(distance(network, 1, 2.0, 2, 3.0, 20.0), 5.0, 1e-12);
    assert_near(distance(network, 0, 95.0, 2, 3.0, 20.0), 8.0, 1e-12);
    cp_road_network_destroy(network);
    assert_int_equal(cp_road_network_create(NULL, 0, NULL, 0, &network, NULL), CP_OK);
    cp_road_network_destroy(network);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(both_directions_are_one_road),
        cmocka_unit_test(roads_meet_over_junctions),
        cmocka_unit_test(a_road_that_only_crosses_does_not_meet),
        cmocka_unit_test(without_lanes_inside_junctions_ends_join_all_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
