/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact/impact.h"

#include "core/rng.h"
#include "core/units.h"
#include "impact/detector.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "builders/assert_near.h"
#include "builders/drive.h"

static const char *name_of(const void *context, uint32_t vehicle)
{
    (void)context;
    return vehicle == 0 ? "a" : "b";
}

/* First contact of two cars that drive until 3 s. */
static cp_impact collide(const drive *one, const drive *other, double dt_s)
{
    cp_detector *detector;
    assert_int_equal(cp_detector_create(&detector, NULL), CP_OK);
    cp_impact first = {0};
    size_t count = 0;
    for (int step = 1; step * dt_s < 3.0 && count == 0; step++) {
        cp_vehicle_motion motion[2] = {drive_motion(one, 0, step * dt_s, dt_s),
                                       drive_motion(other, 1, step * dt_s, dt_s)};
        cp_detector_scene scene = {.motions = motion,
                                   .count = 2,
                                   .step_length_s = dt_s,
                                   .time_s = step * dt_s,
                                   .vehicle_id = name_of};
        const cp_impact *impact;
        assert_int_equal(cp_detector_scan(detector, &scene, &impact, &count, NULL), CP_OK);
        if (count > 0)
            first = impact[0];
    }
    assert_int_equal(count, 1);
    cp_detector_destroy(detector);
    return first;
}

static cp_vehicle_model model(double cg_to_front_m)
{
    return (cp_vehicle_model){.length_m = 4.86, .width_m = 1.85, .cg_to_front_m = cg_to_front_m};
}

static void an_oncoming_offset_crash_is_described(void **state)
{
    (void)state;
    drive a = {.speed_m_s = 15.0};
    drive b = {.x_m = 31.0, .y_m = 0.6, .yaw_rad = CP_PI, .speed_m_s = 10.0};
    cp_impact impact = collide(&a, &b, 0.1);
    cp_vehicle_model model_a = model(2.05), model_b = model(1.9);
    cp_crash_description d = cp_impact_describe(&impact, &model_a, &model_b);
    assert_near(d.speed_m_s[0], 15.0, 1e-9);
    assert_near(d.speed_m_s[1], 10.0, 1e-9);
    assert_near(d.closing_speed_m_s, 25.0, 1e-9);
    assert_near(d.lateral_offset_m, 0.6, 1e-9);
    assert_near(d.angle_rad, 0.0, 1e-9);
    assert_near(d.overlap_1, 1.2 / 1.8, 1e-9); // of SUMO's 1.8 m, not the model's 1.85 m

    cp_crash_configuration c = cp_impact_configuration(&impact, &model_a, &model_b);
    assert_false(c.against_barrier);
    assert_near(c.vehicle[0].cog_m.x, 18.6 - 2.05, 1e-9);
    assert_near(c.vehicle[1].cog_m.x, 18.6 + 1.9, 1e-9);
    assert_near(c.vehicle[1].cog_m.y, 0.6, 1e-9);
    assert_near(c.vehicle[0].velocity_m_s.x, 15.0, 1e-9);
    assert_near(c.vehicle[1].velocity_m_s.x, -10.0, 1e-9);
    assert_int_equal(c.side[0], CP_SIDE_FRONT);
    assert_int_equal(c.side[1], CP_SIDE_FRONT);
}

static void a_crossing_crash_is_described(void **state)
{
    (void)state;
    drive a = {.speed_m_s = 10.0};
    drive b = {.x_m = 10.9, .y_m = -9.75, .yaw_rad = CP_PI / 2, .speed_m_s = 12.0};
    cp_impact impact = collide(&a, &b, 0.1);
    cp_vehicle_model m = model(2.0);
    cp_crash_description d = cp_impact_describe(&impact, &m, &m);
    assert_near(d.closing_speed_m_s, hypot(10.0, 12.0), 1e-9);
    assert_near(d.angle_rad, -CP_PI / 2, 1e-9);
    assert_near(d.lateral_offset_m, 2.25, 1e-9);
    assert_near(d.overlap_1, 1.0, 1e-9);
}

static void a_rear_impact_is_described(void **state)
{
    (void)state;
    drive a = {.speed_m_s = 10.0}, b = {.x_m = 14.5, .y_m = -0.9, .speed_m_s = 5.0};
    cp_impact impact = collide(&a, &b, 0.1);
    cp_vehicle_model m = model(2.0);
    cp_crash_description d = cp_impact_describe(&impact, &m, &m);
    assert_near(d.closing_speed_m_s, 5.0, 1e-9);
    assert_near(fabs(d.angle_rad), CP_PI, 1e-9);
    assert_near(d.lateral_offset_m, -0.9, 1e-9);
    assert_near(d.overlap_1, 0.5, 1e-9);
}

static void a_turning_car_is_a_rigid_body(void **state)
{
    (void)state;
    // a's front runs on a circle of 10 m radius; its rear swings out, so the centre of gravity
    // moves outwards relative to the heading. Steps short enough for the chord to be the tangent.
    drive a = {.x_m = 0.0, .y_m = 0.0, .speed_m_s = 8.0, .yaw_rate_rad_s = 0.8};
    drive b = {.x_m = 8.0, .y_m = 3.0, .yaw_rad = CP_PI, .length_m = 4.0, .speed_m_s = 1.0};
    cp_impact impact = collide(&a, &b, 0.001);
    assert_int_equal(impact.vehicle[0], 0);
    assert_near(impact.yaw_rate_rad_s[0], 0.8, 1e-9);
    cp_vehicle_model m = model(2.0);
    cp_crash_configuration c = cp_impact_configuration(&impact, &m, &m);
    double yaw_rad = c.vehicle[0].yaw_rad;
    cp_vec2 local = cp_vec2_rotate(c.vehicle[0].velocity_m_s, -yaw_rad);
    assert_near(local.x, 8.0, 2e-3);
    assert_near(local.y, -0.8 * 2.0, 5e-3);
    assert_near(c.vehicle[0].yaw_rate_rad_s, 0.8, 1e-9);

    // The velocity of any point follows, also the contact point's in the closing speed.
    cp_crash_description d = cp_impact_describe(&impact, &m, &m);
    cp_vec2 front_m = {impact.state[0].front_x_m, impact.state[0].front_y_m};
    cp_vec2 at_contact = cp_point_velocity(cp_vec2_scale(cp_vec2_heading(yaw_rad), 8.0), 0.8,
                                           cp_vec2_sub(impact.contact_m, front_m));
    assert_near(d.closing_speed_m_s, hypot(at_contact.x + 1.0, at_contact.y), 5e-3);
}

static void mirrored_crashes_have_mirrored_descriptions(void **state)
{
    (void)state;
    cp_rng_key key = cp_rng_key_seed(9);
    cp_vehicle_model m = model(2.0);
    for (uint64_t run = 0; run < 100; run++) {
        drive a = {.speed_m_s = 5.0 + 20.0 * cp_rng_uniform(key, 4 * run)};
        drive b = {.x_m = 15.0,
                   .y_m = 2.0 * cp_rng_uniform(key, 4 * run + 1) - 1.0,
                   .yaw_rad = CP_PI + cp_rng_uniform(key, 4 * run + 2) - 0.5,
                   .speed_m_s = 1.0 + 3.0 * cp_rng_uniform(key, 4 * run + 3)};
        drive flipped = b;
        flipped.y_m *= -1.0;
        flipped.yaw_rad *= -1.0;
        cp_impact one = collide(&a, &b, 0.1), other = collide(&a, &flipped, 0.1);
        cp_crash_description d = cp_impact_describe(&one, &m, &m);
        cp_crash_description e = cp_impact_describe(&other, &m, &m);
        assert_near(d.lateral_offset_m, -e.lateral_offset_m, 1e-9);
        assert_near(d.angle_rad, -e.angle_rad, 1e-9);
        assert_near(d.closing_speed_m_s, e.closing_speed_m_s, 1e-9);
        assert_int_equal(isnan(d.overlap_1), isnan(e.overlap_1));
        if (!isnan(d.overlap_1))
            assert_near(d.overlap_1, e.overlap_1, 1e-9);
    }
}

static void verdicts_have_their_texts(void **state)
{
    (void)state;
    assert_string_equal(cp_contact_verdict_text(CP_CONTACT_CONFIRMED), "confirmed");
    assert_string_equal(cp_contact_verdict_text(CP_CONTACT_GRAZE), "graze");
    assert_string_equal(cp_contact_verdict_text(CP_CONTACT_AT_INSERTION), "overlap_at_insertion");
    assert_string_equal(cp_contact_verdict_text(CP_CONTACT_ROADS_APART), "no_common_road");
    assert_string_equal(cp_contact_verdict_text(CP_CONTACT_LONG_TURNING), "long_vehicle_turning");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_oncoming_offset_crash_is_described),
        cmocka_unit_test(a_crossing_crash_is_described),
        cmocka_unit_test(a_rear_impact_is_described),
        cmocka_unit_test(a_turning_car_is_a_rigid_body),
        cmocka_unit_test(mirrored_crashes_have_mirrored_descriptions),
        cmocka_unit_test(verdicts_have_their_texts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
