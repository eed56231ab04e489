/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control.h"

#include "builders/two_cars.h"
#include "control/brake.h"
#include "control/lookout.h"
#include "control/scripted_road.h"
#include "control/ttc.h"
#include "core/units.h"
#include "impact/approach.h"
#include "impact/footprint.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

/* Impact speed with AEB in SUMO itself against the exact motion of the same two cars: as
 * test_aeb_physics.c, but with SUMO's vehicles, on roads that SUMO does not know to meet
 * (two_cars/). A vehicle of SUMO has its front on the lane and its rear bumper's middle there too;
 * so does the exact one. */

#define STEP_S 0.05
#define TOLERANCE_M_S 0.3
#define DELAY_S 0.25 /* latency and dead time */
#define JERK_M_S3 30.0
#define DECELERATION_M_S2 8.0

// ---- exact ---------------------------------------------------------------------------------

// Way of the own car under the brake: the closed form of constant jerk, then constant deceleration.
static double exact_way_m(const two_cars *e, const cp_brake *brake, double time_s)
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

// Whether the two would touch within the threshold, the own car at the speed of now, the target on
// along its road (lookout.h, condition 2).
static bool is_threat(const two_cars *e, double way_m, double speed_m_s, double time_s)
{
    const double fine_s = 1e-3;
    double closest_m = 0.0; // falls by no more than twice the ways of both
    for (double later_s = 0.0; later_s < e->ttc_s; later_s += fine_s) {
        if (closest_m > 0.0) {
            closest_m -= 2.0 * (speed_m_s + e->target_m_s) * fine_s;
            continue;
        }
        cp_rectangle own = {{way_m + speed_m_s * later_s - 0.5 * TWO_CARS_LENGTH_M, 0.0},
                            0.0,
                            TWO_CARS_LENGTH_M,
                            TWO_CARS_WIDTH_M};
        cp_rectangle target = two_cars_target_at(e, time_s + later_s);
        closest_m = cp_rectangle_separation(&own, &target);
        if (closest_m <= 0.0)
            return true;
    }
    return false;
}

// Own speed at the first touch of the exact motion; NAN when there is none. *request_s: the
// instant at which the target becomes a threat.
static double exact_impact_m_s(const two_cars *e, double *impact_s, double *request_s)
{
    const double fine_s = 5e-4;
    cp_brake brake = {INFINITY, JERK_M_S3, DECELERATION_M_S2, 0.0};
    for (double time_s = 0.0; time_s < 12.0; time_s += fine_s) {
        double speed_m_s = e->own_m_s - cp_brake_speed_loss_m_s(&brake, time_s);
        if (speed_m_s <= 0.0)
            return NAN;
        double way_m = exact_way_m(e, &brake, time_s);
        cp_rectangle own = {
            {way_m - 0.5 * TWO_CARS_LENGTH_M, 0.0}, 0.0, TWO_CARS_LENGTH_M, TWO_CARS_WIDTH_M};
        cp_rectangle target = two_cars_target_at(e, time_s);
        if (cp_rectangle_separation(&own, &target) <= 0.0) {
            *impact_s = time_s;
            return speed_m_s;
        }
        if (brake.start_s == INFINITY && is_threat(e, way_m, speed_m_s, time_s)) {
            *request_s = time_s;
            brake.start_s = time_s + DELAY_S;
        }
    }
    return NAN;
}

// ---- in SUMO -------------------------------------------------------------------------------

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

static cp_traffic *open_with(const two_cars *e, cp_controls **controls)
{
    const double values[] = {
        e->ttc_s, DECELERATION_M_S2, 0.15, DELAY_S - 0.15, JERK_M_S3, 0.0, 0.0, 180.0, 200.0, 0.0};
    cp_control_settings settings = road_settings(CP_CONTROL_FUNCTION, "aeb", NAMES, values);
    // Only the own car has it.
    const char *const ids[2] = {"own", "own"};
    cp_traffic *traffic;
    cp_error error = {0};
    if (two_cars_open(e, STEP_S, &traffic, &error) != CP_OK ||
        cp_controls_create(NULL, 0, 5, 1, traffic, controls, &error) != CP_OK ||
        cp_controls_add_treatment(*controls, &settings, 1, 5, 1, ids, &error) != CP_OK)
        fail_msg("%s", error.text);
    return traffic;
}

/* What SUMO's run came to. */
typedef struct found {
    double impact_m_s; /* own speed; NAN without an impact */
    double impact_s;   /* from the beginning, as the exact one */
    double astray_m;   /* the target, from where it is exactly, at most */
} found;

static found in_sumo(const two_cars *e)
{
    cp_controls *controls;
    cp_traffic *traffic = open_with(e, &controls);
    cp_error error = {0};
    found result = {.impact_m_s = NAN};
    double begun_s = NAN;
    for (int k = 0; isnan(result.impact_m_s) && k * STEP_S < 12.0; k++) {
        if (cp_traffic_step(traffic, &error) != CP_OK ||
            cp_controls_step(controls, &error) != CP_OK)
            fail_msg("%s", error.text);
        const cp_vehicle_motion *own = two_cars_motion(traffic, "own");
        const cp_vehicle_motion *target = two_cars_motion(traffic, "target");
        if (own == NULL || target == NULL)
            break;
        // The first step only puts the cars there.
        double now_s = cp_traffic_time_s(traffic);
        begun_s = isnan(begun_s) ? now_s : begun_s;
        cp_rectangle exact = two_cars_target_at(e, now_s - begun_s);
        cp_rectangle there = cp_vehicle_rectangle(&target->after);
        result.astray_m =
            fmax(result.astray_m, cp_vec2_length(cp_vec2_sub(there.centre_m, exact.centre_m)));
        double fraction;
        if (own->was_present && cp_first_contact(own, target, STEP_S, &fraction)) {
            result.impact_m_s = cp_motion_at(own, STEP_S, fraction).speed_m_s;
            result.impact_s = now_s - begun_s - (1.0 - fraction) * STEP_S;
        }
        if (own->after.speed_m_s < 0.01)
            break;
    }
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
    return result;
}

// Thresholds from late to early, so that the impact speed falls from the approach speed to nothing:
// everywhere within the tolerance, and some of them near 2 m/s. Their distance and the step have no
// common measure, so that requests fall into every part of a step.
static void assert_as_exact(two_cars e)
{
    bool is_slow_one_seen = false;
    int impacts = 0;
    double worst_m_s = 0.0, worst_s = 0.0, astray_m = 0.0;
    for (e.ttc_s = 0.3; e.ttc_s < 2.5; e.ttc_s += 0.026) {
        double impact_s = 0.0, request_s = 0.0;
        double exact_m_s = exact_impact_m_s(&e, &impact_s, &request_s);
        if (!(exact_m_s >= 2.0))
            continue;
        found sumo = in_sumo(&e);
        if (!(fabs(sumo.impact_m_s - exact_m_s) <= TOLERANCE_M_S))
            fail_msg("%s, threshold %.3f s: %.3f m/s, exactly %.3f (at %.3f s, %.3f; requested at "
                     "%.3f)",
                     e.road, e.ttc_s, sumo.impact_m_s, exact_m_s, sumo.impact_s, impact_s,
                     request_s);
        worst_m_s = fmax(worst_m_s, fabs(sumo.impact_m_s - exact_m_s));
        worst_s = fmax(worst_s, fabs(sumo.impact_s - impact_s));
        astray_m = fmax(astray_m, sumo.astray_m);
        is_slow_one_seen |= exact_m_s < 3.5;
        impacts++;
    }
    print_message("%s: %d impacts, largest difference %.3f m/s, %.3f s; the target is %.3f m from "
                  "where it should be\n",
                  e.road, impacts, worst_m_s, worst_s, astray_m);
    assert_true(astray_m < 0.05);
    assert_true(is_slow_one_seen);
    assert_true(impacts >= 10);
}

static void rear_end(void **unused)
{
    (void)unused;
    // Slower ahead, in the same lane but for 0.4 m.
    assert_as_exact((two_cars){"ahead", 15.0, 30.0, 0.4, 0.0, 1.2, 0.0, 0.0, 0.0, 0.0});
}

static void oncoming(void **unused)
{
    (void)unused;
    assert_as_exact((two_cars){"oncoming", 14.0, 61.3, 0.0, CP_PI, 6.0, 0.0, 0.0, 0.0, 0.0});
    assert_as_exact((two_cars){"oncoming_half", 20.0, 97.7, 0.9, CP_PI, 4.0, 0.0, 0.0, 0.0, 0.0});
}

static void crossing(void **unused)
{
    (void)unused;
    // A slow one crosses from the right, another obliquely from the left.
    assert_as_exact((two_cars){"crossing", 15.0, 48.2, -2.0, CP_PI / 2.0, 1.2, 0.0, 0.0, 0.0, 0.0});
    assert_as_exact(
        (two_cars){"crossing_oblique", 12.0, 38.9, 2.5, -CP_PI / 3.0, 1.0, 0.0, 0.0, 0.0, 0.0});
}

static void turning(void **unused)
{
    (void)unused;
    // An oncoming car turns left across the way; one comes out of a side road and turns in.
    assert_as_exact(
        (two_cars){"turning_across", 12.0, 52.4, 3.4, CP_PI, 2.0, 9.0, CP_PI / 2.0, 0.0, 0.0});
    assert_as_exact(
        (two_cars){"turning_in", 13.0, 42.3, -9.0, CP_PI / 2.0, 3.0, 8.0, -CP_PI / 2.0, 0.0, 0.0});
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rear_end),
        cmocka_unit_test(oncoming),
        cmocka_unit_test(crossing),
        cmocka_unit_test(turning),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
