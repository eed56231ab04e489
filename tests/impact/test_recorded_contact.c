/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact/recorded_contact.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "builders/assert_near.h"
#include "builders/drive.h"

#define STEPS_MAX 200

static const char *const IDS[2] = {"one", "other"};

/* A drive recorded at t = 0, dt, 2 dt, ... until end_s. */
typedef struct recording {
    cp_vehicle_state state[STEPS_MAX];
    double time_s[STEPS_MAX];
    cp_recorded_track track;
} recording;

static void record(recording *r, const drive *car, uint32_t number, double dt_s, double end_s)
{
    r->track = (cp_recorded_track){r->state, r->time_s, 0};
    for (size_t k = 0; (double)k * dt_s < end_s + 1e-9; k++) {
        assert_true(k < STEPS_MAX);
        r->time_s[k] = (double)k * dt_s;
        r->state[k] = drive_state(car, number, r->time_s[k]);
        r->track.count++;
    }
}

static cp_recorded_contact find(const recording *one, const recording *other, double dt_s)
{
    cp_recorded_contact contact;
    cp_error error = {0};
    const cp_recorded_track track[2] = {one->track, other->track};
    assert_int_equal(cp_recorded_contact_find(track, IDS, dt_s, NULL, &contact, &error), CP_OK);
    return contact;
}

/* Head on, fronts 30 m apart, 20 and 10 m/s: they touch after one second. */
static const drive EAST = {.x_m = 0.0, .speed_m_s = 20.0};
static const drive WEST = {.x_m = 30.0, .yaw_rad = 3.14159265358979323846, .speed_m_s = 10.0};

static void found_between_two_steps(void **unused)
{
    (void)unused;
    recording east, west;
    record(&east, &EAST, 0, 0.3, 1.5);
    record(&west, &WEST, 1, 0.3, 1.5);
    cp_recorded_contact contact = find(&east, &west, 0.3);
    assert_true(contact.is_found && !contact.is_carried && contact.gap_m < 0.0);
    assert_int_equal(contact.impact.verdict, CP_CONTACT_CONFIRMED);
    assert_near(contact.impact.time_s, 1.0, 1e-9);
    assert_near(contact.impact.contact_m.x, 20.0, 1e-9);
}

// The same when the record ends before, when one is set down elsewhere, when one comes later.
static void found_beyond_the_record(void **unused)
{
    (void)unused;
    recording east, west;
    record(&east, &EAST, 0, 0.1, 0.7);
    record(&west, &WEST, 1, 0.1, 1.5);
    cp_recorded_contact contact = find(&east, &west, 0.1);
    assert_true(contact.is_found && contact.is_carried);
    assert_near(contact.gap_m, 30.0 - 0.7 * 30.0, 1e-9);
    assert_near(contact.impact.time_s, 1.0, 1e-9);

    record(&east, &EAST, 0, 0.1, 1.5);
    for (size_t k = 8; k < east.track.count; k++)
        east.state[k].front_x_m += 7.0;
    contact = find(&east, &west, 0.1);
    assert_true(contact.is_found && contact.is_carried);
    assert_near(contact.impact.time_s, 1.0, 1e-9);
}

static void turning_is_carried_on(void **unused)
{
    (void)unused;
    // A quarter turn to the left in 2 s, cut off at half of it, into a standing car.
    drive turning = {.speed_m_s = 10.0, .yaw_rate_rad_s = 0.25 * 3.14159265358979323846};
    cp_vehicle_state end = drive_state(&turning, 0, 2.0);
    drive standing = {.x_m = end.front_x_m,
                      .y_m = end.front_y_m + 6.0,
                      .yaw_rad = -0.5 * 3.14159265358979323846,
                      .length_m = 4.5};
    recording one, other;
    record(&one, &turning, 0, 0.05, 1.0);
    record(&other, &standing, 1, 0.05, 1.0);
    cp_recorded_contact early = find(&one, &other, 0.05);
    record(&one, &turning, 0, 0.05, 3.0);
    record(&other, &standing, 1, 0.05, 3.0);
    cp_recorded_contact whole = find(&one, &other, 0.05);
    assert_true(early.is_carried && whole.is_found && !whole.is_carried);
    assert_near(early.impact.time_s, whole.impact.time_s, 0.01);
    assert_near(early.impact.state[0].yaw_rad, whole.impact.state[0].yaw_rad, 0.01);
}

static void those_who_pass_do_not_touch(void **unused)
{
    (void)unused;
    recording east, west;
    drive beside = WEST;
    beside.y_m = 2.5;
    record(&east, &EAST, 0, 0.1, 1.5);
    record(&west, &beside, 1, 0.1, 1.5);
    cp_recorded_contact contact = find(&east, &west, 0.1);
    assert_false(contact.is_found);
    assert_near(contact.gap_m, 0.7, 1e-9);

    // Never there together.
    west.track.count = 0;
    contact = find(&east, &west, 0.1);
    assert_false(contact.is_found);
    assert_true(isinf(contact.gap_m));
}

/* Steps of 1 s, and SUMO takes both away, or sets one down 8 m on, in the step in which they
 * collide: on at the speeds it reports, not at those of the step before, and never by way of the
 * new place. */
static void taken_away_in_the_step_of_the_report(void **unused)
{
    (void)unused;
    const drive braking = {.speed_m_s = 20.0};
    const drive crossing = {
        .x_m = 58.0, .y_m = -26.0, .yaw_rad = 0.5 * 3.14159265358979323846, .speed_m_s = 10.0};
    recording one, other;
    cp_error error = {0};
    cp_recorded_contact contact;
    for (int put = 0; put < 2; put++) {
        record(&one, &braking, 0, 1.0, put ? 3.0 : 2.0);
        record(&other, &crossing, 1, 1.0, put ? 3.0 : 2.0);
        if (put)
            one.state[3].front_x_m += 8.0;
        const cp_recorded_track track[2] = {one.track, other.track};
        // It braked from 20 to 18 m/s in that step, which the record does not have.
        const cp_recorded_report report = {3.0, {18.0, 10.0}};
        assert_int_equal(cp_recorded_contact_find(track, IDS, 1.0, &report, &contact, &error),
                         CP_OK);
        assert_true(contact.is_taken && contact.is_found && contact.is_carried);
        assert_true(contact.impact.time_s > 2.0 && contact.impact.time_s < 3.0);
        int of_one = contact.impact.vehicle[0] == 0 ? 0 : 1;
        assert_true(contact.impact.state[of_one].speed_m_s < 20.0);
        assert_true(contact.impact.state[of_one].front_x_m <= 58.0 + 1e-9);
    }

    // Seen in that step: nothing to carry on.
    record(&one, &EAST, 0, 0.1, 1.5);
    record(&other, &WEST, 1, 0.1, 1.5);
    const cp_recorded_track track[2] = {one.track, other.track};
    const cp_recorded_report report = {1.0, {20.0, 10.0}};
    assert_int_equal(cp_recorded_contact_find(track, IDS, 0.1, &report, &contact, &error), CP_OK);
    assert_true(contact.is_found && !contact.is_taken && !contact.is_carried);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(found_between_two_steps),
        cmocka_unit_test(found_beyond_the_record),
        cmocka_unit_test(turning_is_carried_on),
        cmocka_unit_test(taken_away_in_the_step_of_the_report),
        cmocka_unit_test(those_who_pass_do_not_touch),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
