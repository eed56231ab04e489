/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"

#include "builders/crash_builder.h"
#include "crash/contact.h"

static const cp_outline WALL = {{1.0, 0.0}, {1.0, 0.0}, 1.0, 2.0, 0.0}; /* face at x = 0 */

static cp_outline outline(double x_m, double y_m, double yaw_rad, double half_length_m,
                          double half_width_m, double radius_m)
{
    return (cp_outline){
        {x_m, y_m}, cp_vec2_heading(yaw_rad), half_length_m, half_width_m, radius_m};
}

static void distance_is_exact_where_it_is_simple(void **state)
{
    (void)state;
    cp_outline box = outline(-1.5, 0.3, 0.0, 0.5, 0.25, 0.1);
    assert_near(cp_outline_distance(&box, &WALL), 1.0, 1e-12);
    // Rounded corner to rounded corner across a diagonal gap of (3, 4).
    cp_outline other = outline(1.5 + 3.0, 0.55 + 4.0, 0.0, 1.0, 0.5, 0.2);
    cp_outline corner = outline(0.0, 0.0, 0.0, 0.9, 0.45, 0.2);
    double expected_m = hypot(3.5 - 0.9 + 0.4, 4.05 - 0.45 + 0.4) - 0.4;
    assert_near(cp_outline_distance(&corner, &other), expected_m, 1e-12);
    // A square turned by 45 degrees reaches half its diagonal, less the rounding.
    cp_outline turned = outline(-1.0, 0.0, CP_PI / 4.0, 0.5, 0.5, 0.1);
    double reach_m = 0.4 * sqrt(2.0) + 0.1;
    assert_near(cp_outline_distance(&turned, &WALL), 1.0 - reach_m, 1e-12);
}

static void a_flat_face_touches_at_both_ends(void **state)
{
    (void)state;
    cp_outline box = outline(-0.49, 0.3, 0.0, 0.5, 0.25, 0.1);
    cp_manifold manifold = cp_outline_contact(&box, &WALL, 0.0);
    assert_int_equal(manifold.count, 2);
    assert_near(manifold.normal.x, 1.0, 1e-12);
    double low_m = fmin(manifold.point[0].position_m.y, manifold.point[1].position_m.y);
    double high_m = fmax(manifold.point[0].position_m.y, manifold.point[1].position_m.y);
    assert_near(low_m, 0.3 - 0.15, 1e-12);
    assert_near(high_m, 0.3 + 0.15, 1e-12);
    for (int k = 0; k < 2; k++) {
        assert_near(manifold.point[k].depth_m, 0.01, 1e-12);
        assert_near(manifold.point[k].position_m.x, 0.005, 1e-12);
    }
}

static void separated_outlines_do_not_touch(void **state)
{
    (void)state;
    cp_outline box = outline(-0.51, 0.0, 0.0, 0.5, 0.25, 0.1);
    assert_int_equal(cp_outline_contact(&box, &WALL, 0.0).count, 0);
    // Beside the wall's corner: bounding boxes overlap, roundings do not.
    cp_outline beside = outline(-0.45, 2.22, CP_PI / 4.0, 0.4, 0.4, 0.05);
    assert_true(cp_outline_distance(&beside, &WALL) > 0.0);
    assert_int_equal(cp_outline_contact(&beside, &WALL, 0.0).count, 0);
}

static void swapping_the_two_only_turns_the_normal(void **state)
{
    (void)state;
    int touching = 0;
    for (uint64_t k = 0; k < 2000; k++) {
        cp_outline a = outline(0.0, 0.0, crash_builder_draw("turn a", k, -3.1, 3.1), 0.8, 0.4, 0.1);
        cp_outline b =
            outline(crash_builder_draw("x", k, -2.0, 2.0), crash_builder_draw("y", k, -2.0, 2.0),
                    crash_builder_draw("turn b", k, -3.1, 3.1), 0.5, 0.3, 0.05);
        double distance_m = cp_outline_distance(&a, &b);
        assert_near(distance_m, cp_outline_distance(&b, &a), 1e-12);
        cp_manifold ab = cp_outline_contact(&a, &b, 0.0), ba = cp_outline_contact(&b, &a, 0.0);
        assert_int_equal(ab.count > 0, distance_m < 0.0);
        assert_int_equal(ab.count, ba.count);
        if (ab.count == 0)
            continue;
        touching++;
        assert_near(cp_vec2_length(ab.normal), 1.0, 1e-12);
        assert_near(cp_vec2_dot(ab.normal, ba.normal), -1.0, 1e-9);
        // The deepest point is as deep as the outlines overlap.
        double deepest_m = ab.point[0].depth_m;
        if (ab.count == 2)
            deepest_m = fmax(deepest_m, ab.point[1].depth_m);
        assert_near(deepest_m, -distance_m, 1e-9);
    }
    assert_true(touching > 300);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(distance_is_exact_where_it_is_simple),
        cmocka_unit_test(a_flat_face_touches_at_both_ends),
        cmocka_unit_test(separated_outlines_do_not_touch),
        cmocka_unit_test(swapping_the_two_only_turns_the_normal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
