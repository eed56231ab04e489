/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control.h"

#include "control/brake.h"
#include "control/scripted_road.h"
#include "control/ttc.h"
#include "core/units.h"
#include "impact/approach.h"
#include "impact/footprint.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

/* Impact speed with AEB against the exact motion of the same two cars: the request at the instant
 * the TTC crosses the threshold, dead time, jerk, deceleration. At steps of 0.05 s, oncoming,
 * crossing and turning targets, down to 2 m/s at impact. */

#define STEP_S 0.05
#define TOLERANCE_M_S 0.3
#define DELAY_S 0.25 /* latency and dead time */
#define JERK_M_S3 30.0
#define DECELERATION_M_S2 8.0

/* Own car straight ahead from (0, 0) with its front; the target as said. */
typedef struct encounter {
    double own_m_s;
    double x_m, y_m, yaw_rad; /* the target's front at the beginning */
    double target_m_s;
    double curvature_1_m; /* of the target's way, left positive */
    double ttc_s;         /* the function's threshold */
} encounter;

static const char *const NAMES[] = {"ttc_s",
                                    "deceleration_m_s2",
                                    "dead_time_s",
                                    "sensor_latency_s",
                                    "jerk_m_s3",
                                    "sensor_confirmation_s",
                                    "required_deceleration_m_s2",
                                    "sensor_field_of_view_deg",
                                    "sensor_range_m",
                                    "speed_min_m_s",
                                    NULL};

// ---- exact ---------------------------------------------------------------------------------

static cp_moving_rectangle exact_at(const encounter *e, double own_way_m, double own_m_s,
                                    double time_s, bool is_own)
{
    cp_moving_rectangle moving = {.rectangle = {.length_m = 4.5, .width_m = 1.8}};
    if (is_own) {
        moving.rectangle.centre_m = (cp_vec2){own_way_m - 2.25, 0.0};
        moving.velocity_m_s = (cp_vec2){own_m_s, 0.0};
        return moving;
    }
    cp_vec2 heading = cp_vec2_heading(e->yaw_rad);
    moving.rectangle.centre_m =
        cp_vec2_sub((cp_vec2){e->x_m, e->y_m}, cp_vec2_scale(heading, 2.25));
    moving.rectangle.yaw_rad = e->yaw_rad;
    moving.velocity_m_s = cp_vec2_scale(heading, e->target_m_s);
    moving.yaw_rate_rad_s = e->curvature_1_m * e->target_m_s;
    moving.rectangle = cp_moving_rectangle_at(&moving, time_s);
    moving.velocity_m_s = cp_vec2_scale(cp_vec2_heading(moving.rectangle.yaw_rad), e->target_m_s);
    return moving;
}

// Way of the own car under the brake: the closed form of constant jerk, then constant deceleration.
static double exact_way_m(const encounter *e, const cp_brake *brake, double time_s)
{
    double after_s = fmax(0.0, time_s - brake->start_s);
    double rise_s = brake->deceleration_m_s2 / brake->jerk_m_s3;
    double rising_s = fmin(after_s, rise_s), held_s = after_s - rising_s;
    double held_from_m_s = 0.5 * brake->jerk_m_s3 * rise_s * rise_s;
    double lost_m = brake->jerk_m_s3 * rising_s * rising_s * rising_s / 6.0;
    if (held_s > 0.0)
        lost_m += held_from_m_s * held_s + 0.5 * brake->deceleration_m_s2 * held_s * held_s;
    return e->own_m_s * time_s - lost_m;
}

// Own speed at the first touch of the exact motion; NAN when there is none.
static double exact_impact_m_s(const encounter *e, double *impact_s)
{
    const double fine_s = 5e-4;
    cp_brake brake = {INFINITY, JERK_M_S3, DECELERATION_M_S2, 0.0};
    for (double time_s = 0.0; time_s < 12.0; time_s += fine_s) {
        double speed_m_s = e->own_m_s - cp_brake_speed_loss_m_s(&brake, time_s);
        if (speed_m_s <= 0.0)
            return NAN;
        cp_moving_rectangle own =
            exact_at(e, exact_way_m(e, &brake, time_s), speed_m_s, time_s, true);
        cp_moving_rectangle target = exact_at(e, 0.0, 0.0, time_s, false);
        if (cp_rectangle_separation(&own.rectangle, &target.rectangle) <= 0.0) {
            *impact_s = time_s;
            return speed_m_s;
        }
        if (brake.start_s == INFINITY && cp_ttc_s(&own, &target, e->ttc_s) < e->ttc_s)
            brake.start_s = time_s + DELAY_S;
    }
    return NAN;
}

// ---- stepped -------------------------------------------------------------------------------

static cp_traffic *open_with(const encounter *e, cp_controls **controls)
{
    const double values[] = {
        e->ttc_s, DECELERATION_M_S2, 0.15, DELAY_S - 0.15, JERK_M_S3, 0.0, 0.0, 180.0, 200.0, 0.0};
    cp_error error = {0};
    cp_traffic *traffic = road_open(STEP_S);
    cp_control_settings settings = road_settings(CP_CONTROL_FUNCTION, "aeb", NAMES, values);
    // Only the own car has it.
    const char *const ids[2] = {"own", "own"};
    assert_int_equal(cp_controls_create(NULL, 0, 5, 1, traffic, controls, &error), CP_OK);
    assert_int_equal(cp_controls_add_treatment(*controls, &settings, 1, 5, 1, ids, &error), CP_OK);
    road_add("own", 0.0, 0.0, 0.0, e->own_m_s);
    road_add("target", e->x_m, e->y_m, e->yaw_rad, e->target_m_s)->curvature_1_m = e->curvature_1_m;
    return traffic;
}

static double stepped_impact_m_s(const encounter *e, double *impact_s)
{
    cp_controls *controls;
    cp_traffic *traffic = open_with(e, &controls);
    cp_error error = {0};
    double found_m_s = NAN;
    while (isnan(found_m_s) && road.time_s < 12.0) {
        assert_int_equal(cp_traffic_step(traffic, &error), CP_OK);
        assert_int_equal(cp_controls_step(controls, &error), CP_OK);
        const cp_vehicle_motion *own = cp_traffic_motion_of(traffic, 0);
        const cp_vehicle_motion *target = cp_traffic_motion_of(traffic, 1);
        double fraction;
        if (own->was_present && cp_first_contact(own, target, STEP_S, &fraction)) {
            found_m_s = cp_motion_at(own, STEP_S, fraction).speed_m_s;
            // The first step only puts the cars there.
            *impact_s = road.time_s - (1.0 - fraction) * STEP_S - STEP_S;
        }
        if (own->after.speed_m_s < 0.01)
            break;
    }
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
    return found_m_s;
}

// Thresholds from late to early, so that the impact speed falls from the approach speed to nothing:
// everywhere within the tolerance, and some of them near 2 m/s.
static void assert_as_exact(encounter e)
{
    bool is_slow_one_seen = false;
    int impacts = 0;
    double worst_m_s = 0.0;
    for (e.ttc_s = 0.3; e.ttc_s < 2.5; e.ttc_s += 0.02) {
        double exact_s = 0.0, stepped_s = 0.0;
        double exact_m_s = exact_impact_m_s(&e, &exact_s);
        if (!(exact_m_s >= 2.0))
            continue;
        double stepped_m_s = stepped_impact_m_s(&e, &stepped_s);
        if (!(fabs(stepped_m_s - exact_m_s) <= TOLERANCE_M_S))
            fail_msg("threshold %.2f s: %.3f m/s, exactly %.3f (%.3f s, %.3f)", e.ttc_s,
                     stepped_m_s, exact_m_s, stepped_s, exact_s);
        worst_m_s = fmax(worst_m_s, fabs(stepped_m_s - exact_m_s));
        is_slow_one_seen |= exact_m_s < 3.5;
        impacts++;
    }
    print_message("%d impacts, largest difference %.3f m/s\n", impacts, worst_m_s);
    assert_true(is_slow_one_seen);
    assert_true(impacts >= 20);
}

static void oncoming(void **unused)
{
    (void)unused;
    // Closing, full overlap and half; the impact speed is the own car's.
    assert_as_exact((encounter){14.0, 61.3, 0.0, CP_PI, 6.0, 0.0, 0.0});
    assert_as_exact((encounter){20.0, 97.7, 0.9, CP_PI, 4.0, 0.0, 0.0});
}

static void crossing(void **unused)
{
    (void)unused;
    // A slow one crosses from the right and is in the way for seconds.
    assert_as_exact((encounter){15.0, 48.2, -2.0, CP_PI / 2.0, 1.2, 0.0, 0.0});
    // From the left, obliquely.
    assert_as_exact((encounter){12.0, 38.9, 2.5, -CP_PI / 3.0, 1.0, 0.0, 0.0});
}

static void turning(void **unused)
{
    (void)unused;
    // An oncoming car turns left across the way, radius 9 m.
    assert_as_exact((encounter){15.0, 52.4, 3.4, CP_PI, 2.0, 1.0 / 9.0, 0.0});
    // One comes out of a side road and turns right, radius 8 m.
    assert_as_exact((encounter){13.0, 42.3, -5.2, 0.75 * CP_PI, 1.5, -1.0 / 8.0, 0.0});
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(oncoming),
        cmocka_unit_test(crossing),
        cmocka_unit_test(turning),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
