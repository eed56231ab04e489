/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"
#include "control/lane_ahead.h"
#include "core/units.h"

/* A road east, a junction in which it turns left or goes straight on, and the roads behind:
 * 0 west road; 1 turning and 2 straight inside; 3 north road; 4 east road, which climbs. */
static const cp_lane_point WEST[] = {{0, 0, 0, 0}, {100, 0, 0, 100}};
static const cp_lane_point TURNING[] = {{100, 0, 0, 0}, {110, 10, 0, 14.142}};
static const cp_lane_point STRAIGHT[] = {{100, 0, 0, 0}, {120, 0, 0, 20}};
static const cp_lane_point NORTH[] = {{110, 10, 0, 0}, {110, 100, 0, 90}};
static const cp_lane_point EAST[] = {{120, 0, 0, 0}, {220, 0, 10, 100}};
static const cp_lane_link FROM_WEST[] = {{3, 1}, {4, 2}}, TO_NORTH[] = {{3, CP_LANE_NONE}},
                          TO_EAST[] = {{4, CP_LANE_NONE}};

static cp_lane_map *make_map(void)
{
    const cp_lane lanes[] = {
        {.point = WEST, .point_count = 2, .link = FROM_WEST, .link_count = 2, .width_m = 3.2},
        {.point = TURNING, 2, TO_NORTH, 1, 3.2, .edge = 1, .is_inside = true},
        {.point = STRAIGHT, 2, TO_EAST, 1, 3.2, .edge = 2, .is_inside = true},
        {.point = NORTH, .point_count = 2, .width_m = 3.2, .edge = 3},
        {.point = EAST, .point_count = 2, .width_m = 3.2, .edge = 4}};
    cp_lane_map *map = NULL;
    cp_error error = {0};
    assert_int_equal(cp_lane_map_create(lanes, 5, &map, &error), CP_OK);
    return map;
}

static cp_vehicle_motion at(double x_m, double y_m, double yaw_rad, uint32_t lane)
{
    return (cp_vehicle_motion){.after = {.lane = lane,
                                         .front_x_m = x_m,
                                         .front_y_m = y_m,
                                         .yaw_rad = yaw_rad,
                                         .speed_m_s = 10,
                                         .length_m = 4,
                                         .width_m = 2}};
}

static void the_way_follows_the_route_or_goes_straight_on(void **unused)
{
    (void)unused;
    cp_lane_map *map = make_map();
    cp_lane_ahead ahead;
    const uint32_t north[] = {3};
    cp_vehicle_motion car = at(90, 0, 0, 0);
    assert_int_equal(cp_lane_map_next(map, 0, CP_LANE_NONE), 2);
    assert_int_equal(cp_lane_map_next(map, 0, 3), 1);

    // Straight on: as far as the road goes, and beyond.
    assert_true(cp_lane_ahead_lay(map, &car, 0.0, NULL, 0, false, 200, &ahead));
    cp_rectangle there = cp_lane_ahead_at(&ahead, 25, 4, 2);
    assert_near(there.centre_m.x, 113, 1e-9);
    assert_near(there.centre_m.y, 0, 1e-9);
    cp_vehicle_state place = car.after;
    cp_lane_ahead_place(&ahead, 80, &place);
    assert_int_equal(place.lane, 4);
    assert_near(place.lane_position_m, 50, 1e-9);
    assert_near(place.elevation_m, 5, 1e-9);
    assert_true(ahead.ends_m == INFINITY);
    assert_near(cp_lane_ahead_way_to_m(&ahead, 4, 50), 80, 1e-9);
    assert_true(cp_lane_ahead_way_to_m(&ahead, 3, 50) == INFINITY);

    // On its route: round the corner, front and rear both on the way.
    assert_true(cp_lane_ahead_lay(map, &car, 0.0, north, 1, true, 200, &ahead));
    there = cp_lane_ahead_at(&ahead, 10 + sqrt(200) + 2, 4, 2);
    cp_vec2 front = cp_vec2_add(there.centre_m, cp_vec2_scale(cp_vec2_heading(there.yaw_rad), 2));
    assert_near(front.x, 110, 1e-9);
    assert_near(front.y, 12, 1e-9);
    assert_true(there.yaw_rad > CP_PI / 4 && there.yaw_rad < CP_PI / 2);
    assert_near(ahead.ends_m, 10 + sqrt(200) + 90, 1e-9);
    cp_lane_map_destroy(map);
}

static void who_is_beside_the_middle_stays_beside_it(void **unused)
{
    (void)unused;
    cp_lane_map *map = make_map();
    cp_lane_ahead ahead;
    const uint32_t north[] = {3};
    cp_vehicle_motion car = at(90, -0.5, 0, 0);
    assert_true(cp_lane_ahead_lay(map, &car, 0.0, north, 1, true, 200, &ahead));
    // Half a metre to the right of the lane north is x = 110.5.
    cp_rectangle there = cp_lane_ahead_at(&ahead, 80, 4, 2);
    assert_near(there.centre_m.x, 110.5, 1e-9);
    assert_near(there.yaw_rad, CP_PI / 2, 1e-9);

    // Against the lane, as an overtaker drives: back along it and straight on.
    car = at(90, -0.5, CP_PI, 0);
    assert_true(cp_lane_ahead_lay(map, &car, 0.0, NULL, 0, false, 200, &ahead));
    there = cp_lane_ahead_at(&ahead, 100, 4, 2);
    assert_near(there.centre_m.x, -8, 1e-9);
    assert_near(there.centre_m.y, -0.5, 1e-9);

    // Nowhere near its lane, or on none: not known.
    car = at(90, -9, 0, 0);
    assert_false(cp_lane_ahead_lay(map, &car, 0.0, NULL, 0, false, 200, &ahead));
    car = at(90, 0, 0, 77);
    assert_false(cp_lane_ahead_lay(map, &car, 0.0, NULL, 0, false, 200, &ahead));
    cp_lane_map_destroy(map);
}

static void who_drifts_goes_on_drifting(void **unused)
{
    (void)unused;
    cp_lane_map *map = make_map();
    cp_lane_ahead ahead;
    cp_vehicle_motion car = at(20, 0.3, atan(0.05), 0);
    assert_true(cp_lane_ahead_lay(map, &car, 0.05, NULL, 0, false, 200, &ahead));
    // In a straight line, like the car itself.
    cp_rectangle there = cp_lane_ahead_at(&ahead, 50, 4, 2);
    assert_near(there.yaw_rad, atan(0.05), 1e-9);
    cp_vec2 front = cp_vec2_add(there.centre_m, cp_vec2_scale(cp_vec2_heading(there.yaw_rad), 2));
    assert_near(front.x, 20 + 50 * cos(atan(0.05)), 1e-9);
    assert_near(front.y, 0.3 + 50 * sin(atan(0.05)), 1e-9);
    cp_lane_map_destroy(map);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_way_follows_the_route_or_goes_straight_on),
        cmocka_unit_test(who_is_beside_the_middle_stays_beside_it),
        cmocka_unit_test(who_drifts_goes_on_drifting),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
