/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "traffic/straight_run.h"

#include "core/geometry.h"
#include "core/units.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define LENGTH_M 4.5

/* A vehicle under way far from the origin, and what is asked about it. */
typedef struct ride {
    cp_straight_run run;
    cp_vec2 front_m;
    double yaw_rad;
    int asked;
} ride;

static ride begin(double yaw_rad)
{
    return (ride){.front_m = {4321.0, -1234.5}, .yaw_rad = yaw_rad};
}

// A step of the front; the heading is asked when it must be. True when it was told.
static bool go(ride *car, double along_m, double sideways_m)
{
    cp_vec2 unit = cp_vec2_heading(car->yaw_rad);
    car->front_m.x += along_m * unit.x - sideways_m * unit.y;
    car->front_m.y += along_m * unit.y + sideways_m * unit.x;
    if (cp_straight_run_move(&car->run, car->front_m.x, car->front_m.y, LENGTH_M))
        return true;
    cp_straight_run_head(&car->run, car->yaw_rad);
    car->asked++;
    return false;
}

static void a_heading_is_told_after_a_length_straight_on(void **state)
{
    (void)state;
    for (int k = 0; k < 12; k++) {
        ride car = begin(cp_wrap_angle(k * CP_PI / 6.0));
        for (int step = 0; step <= 4; step++) // 4 m
            assert_false(go(&car, 1.0, 0.0));
        for (int step = 0; step < 300; step++) { // however fast, standing too
            assert_true(go(&car, 1.0 + cos(0.1 * step), 0.0));
            assert_true(fabs(cp_wrap_angle(car.run.yaw_rad - car.yaw_rad)) < 1e-15);
        }
        assert_int_equal(car.asked, 5);
    }
}

static void on_a_bend_it_is_always_asked(void **state)
{
    (void)state;
    ride car = begin(0.3);
    for (int step = 0; step < 100; step++) {
        car.yaw_rad += 1e-4; // 1 m at a time on a circle of 10 km
        assert_false(go(&car, 1.0, 0.0));
    }
    // Straight again: not before the rear is out of it too.
    for (int step = 0; step < 4; step++)
        assert_false(go(&car, 1.0, 0.0));
    assert_true(go(&car, 1.0, 0.0));
}

static void whoever_leaves_his_line_is_asked(void **state)
{
    (void)state;
    static const struct {
        double along_m, sideways_m;
    } LEAVES[] = {{1.0, 1e-6}, {1.0, -3.2}, {-0.1, 0.0}, {4.6, 0.0}};
    for (size_t k = 0; k < sizeof LEAVES / sizeof *LEAVES; k++) {
        ride car = begin(-2.0);
        for (int step = 0; step < 10; step++)
            go(&car, 1.0, 0.0);
        assert_true(go(&car, 1.0, 0.0));
        assert_false(go(&car, LEAVES[k].along_m, LEAVES[k].sideways_m));
        // And for a length from there.
        for (int step = 0; step < 4; step++)
            assert_false(go(&car, 1.0, 0.0));
        assert_true(go(&car, 1.0, 0.0));
    }
}

// The front keeps to a line, the rear has not come round yet.
static void a_heading_that_changes_on_the_line_begins_anew(void **state)
{
    (void)state;
    cp_straight_run run = {0};
    for (int step = 0; step < 10; step++) {
        assert_false(cp_straight_run_move(&run, 1.0 * step, 0.0, LENGTH_M));
        cp_straight_run_head(&run, step < 8 ? 1e-3 / (step + 1) : 0.0);
    }
    assert_true(run.yaw_rad == 0.0);
    assert_false(cp_straight_run_move(&run, 12.4, 0.0, LENGTH_M));
    cp_straight_run_head(&run, 0.0);
    assert_true(cp_straight_run_move(&run, 12.6, 0.0, LENGTH_M));
}

static void nothing_is_told_of_one_never_seen(void **state)
{
    (void)state;
    cp_straight_run run = {0};
    assert_false(cp_straight_run_move(&run, 0.0, 0.0, 0.0));
    cp_straight_run_head(&run, 0.0);
    assert_true(run.is_on);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_heading_is_told_after_a_length_straight_on),
        cmocka_unit_test(on_a_bend_it_is_always_asked),
        cmocka_unit_test(whoever_leaves_his_line_is_asked),
        cmocka_unit_test(a_heading_that_changes_on_the_line_begins_anew),
        cmocka_unit_test(nothing_is_told_of_one_never_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
