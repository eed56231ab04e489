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
static const cp_lane_link FROM_WEST[] = {{3, 1, false}, {4, 2, false}},
                          TO_NORTH[] = {{3, CP_LANE_NONE, false}},
                          TO_EAST[] = {{4, CP_LANE_NONE, false}};

static cp_lane_map *make_map(void)
{
    const cp_lane lanes[] = {
        {.point = WEST, .point_count = 2, .link = FROM_WEST, .link_count = 2, .width_m = 3.2},
        {.point = TURNING, 2, TO_NORTH, 1, .width_m = 3.2, .edge = 1, .is_inside = true},
        {.point = STRAIGHT, 2, TO_EAST, 1, .width_m = 3.2, .edge = 2, .is_inside = true},
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
    assert_int_equal(cp_lane_link_next(cp_lane_map_link(map, 0, CP_LANE_NONE)), 2);
    assert_int_equal(cp_lane_link_next(cp_lane_map_link(map, 0, 3)), 1);

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

// A road that meets another at a hook, as in imported maps: the lane inside the junction first goes
// back, then on. 0 road north, 1 inside, 2 road south-east; the sign says to give way.
static cp_lane_map *make_hook(void)
{
    static const cp_lane_point north[] = {{0, -60, 0, 0}, {0, 0, 0, 60}};
    static const cp_lane_point hook[] = {{0, 0, 0, 0}, {0.5, -1, 0, 1.118}, {2, -1.5, 0, 2.699}};
    static const cp_lane_point east[] = {{2, -1.5, 0, 0}, {60, -1.5, 0, 58}};
    static const cp_lane_link in[] = {{2, 1, true}}, out[] = {{2, CP_LANE_NONE, false}};
    const cp_lane lanes[] = {
        {.point = north, .point_count = 2, .link = in, .link_count = 1, .edge = 0},
        {.point = hook,
         .point_count = 3,
         .link = out,
         .link_count = 1,
         .edge = 1,
         .is_inside = true},
        {.point = east, .point_count = 2, .edge = 2}};
    cp_lane_map *map = NULL;
    cp_error error = {0};
    assert_int_equal(cp_lane_map_create(lanes, 3, &map, &error), CP_OK);
    return map;
}

static void who_comes_into_a_hook_drives_along_it(void **unused)
{
    (void)unused;
    cp_lane_map *map = make_hook();
    cp_lane_ahead ahead;
    // In from the road: the car still heads north, against the first piece of the lane.
    cp_vehicle_motion car = at(0.05, -0.1, CP_PI / 2, 1);
    car.before = at(0, -0.9, CP_PI / 2, 0).after;
    car.was_present = true;
    assert_true(cp_lane_ahead_lay(map, &car, 0.0, NULL, 0, false, 40, &ahead));
    assert_true(ahead.lane_step_1 > 0.0);
    cp_rectangle there = cp_lane_ahead_at(&ahead, 20, 4, 2);
    assert_near(there.centre_m.y, -1.5, 0.1);
    assert_true(there.centre_m.x > 10.0);

    // One that was on it, and came forward.
    car.before = at(0, 0, CP_PI / 2, 1).after;
    assert_true(cp_lane_ahead_lay(map, &car, 0.0, NULL, 0, false, 40, &ahead));
    assert_true(ahead.lane_step_1 > 0.0);
    cp_lane_map_destroy(map);
}

static void the_way_tells_where_others_go_first(void **unused)
{
    (void)unused;
    cp_lane_map *map = make_hook();
    cp_lane_ahead ahead;
    cp_vehicle_motion car = at(0, -30, CP_PI / 2, 0);
    assert_true(cp_lane_ahead_lay(map, &car, 0.0, NULL, 0, false, 60, &ahead));
    assert_int_equal(ahead.wait_count, 1);
    assert_near(ahead.wait_m[0], 30, 1e-9);
    // Past the sign there is none.
    car = at(0.5, -1, -CP_PI / 4, 1);
    assert_true(cp_lane_ahead_lay(map, &car, 0.0, NULL, 0, false, 60, &ahead));
    assert_int_equal(ahead.wait_count, 0);
    cp_lane_map_destroy(map);
}

static void a_long_body_lies_on_the_lanes_it_came_along(void **unused)
{
    (void)unused;
    // Round the corner with the front 8 m up the road north: the rear, 12 m behind, is on the lane
    // that turns, 4 m before its end.
    cp_lane_map *map = make_map();
    cp_lane_ahead ahead;
    double back_m = 4 / sqrt(2), yaw_rad = atan2(8 + back_m, back_m);
    cp_vehicle_motion bus = at(110, 18, yaw_rad, 3);
    bus.after.length_m = 12;
    assert_true(cp_lane_ahead_lay(map, &bus, 0.0, NULL, 0, false, 40, &ahead));
    // A metre further the rear is a metre further along that lane.
    cp_rectangle there = cp_lane_ahead_at(&ahead, 1, 12, 2);
    double later_m = 3 / sqrt(2);
    assert_near(there.yaw_rad, atan2(9 + later_m, later_m), 1e-6);
    cp_lane_map_destroy(map);
}

static void who_is_put_into_the_next_lane_has_not_come_aslant(void **unused)
{
    (void)unused;
    cp_lane_map *map = make_map();
    cp_lane_ahead ahead;
    cp_vehicle_motion car = at(50, 0, 0, 0);
    car.before = at(47.5, 3.2, 0, 0).after;
    car.was_present = true;
    assert_true(cp_is_put_aside(&car));
    assert_true(cp_lane_ahead_lay(map, &car, 0.0, NULL, 0, false, 40, &ahead));
    assert_near(cp_lane_ahead_at(&ahead, 0, 4, 2).yaw_rad, 0, 1e-9);
    // A car that turns moves aside, too, but as a body does.
    car.after = at(50, 0.3, 0.2, 0).after;
    car.before = at(49, 0, 0, 0).after;
    assert_false(cp_is_put_aside(&car));
    cp_lane_map_destroy(map);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_way_follows_the_route_or_goes_straight_on),
        cmocka_unit_test(who_is_beside_the_middle_stays_beside_it),
        cmocka_unit_test(who_drifts_goes_on_drifting),
        cmocka_unit_test(who_comes_into_a_hook_drives_along_it),
        cmocka_unit_test(the_way_tells_where_others_go_first),
        cmocka_unit_test(a_long_body_lies_on_the_lanes_it_came_along),
        cmocka_unit_test(who_is_put_into_the_next_lane_has_not_come_aslant),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
