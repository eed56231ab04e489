/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pulse/pulse_codec.h"

#include "core/rng.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void assert_ok(cp_status status, const cp_error *error)
{
    if (status != CP_OK)
        fail_msg("%s: %s", cp_status_text(status), error->text);
}

// A crash of 200 ms: half a sine of deceleration, consistent velocity and displacement.
static void make_crash_pulse(cp_pulse *pulse, double interval_s)
{
    cp_error error = {0};
    size_t count = (size_t)lround(0.2 / interval_s) + 1;
    cp_rng_key noise = cp_rng_key_seed(5);
    assert_ok(cp_pulse_create(pulse, count, interval_s, &error), &error);
    double vx = 15.0, x = 0.0;
    for (size_t k = 0; k < count; k++) {
        double t = (double)k * interval_s;
        double ax = t < 0.1 ? -250.0 * sin(31.4159 * t) + 10 * cp_rng_normal(noise, k) : 0.0;
        pulse->channel[CP_CHANNEL_AX][k] = ax;
        pulse->channel[CP_CHANNEL_VX][k] = vx;
        pulse->channel[CP_CHANNEL_X][k] = x;
        pulse->channel[CP_CHANNEL_AY][k] = 0.1 * ax;
        pulse->channel[CP_CHANNEL_YAW_ACC][k] = ax;
        pulse->channel[CP_CHANNEL_YAW_RATE][k] = 0.1 * (15.0 - vx);
        pulse->channel[CP_CHANNEL_YAW][k] = 0.01 * x;
        vx += ax * interval_s;
        x += vx * interval_s;
    }
}

static void decodes_to_within_half_a_step(void **state)
{
    (void)state;
    cp_pulse pulse, back, again;
    cp_error error = {0};
    void *blob = NULL, *second = NULL;
    size_t size = 0, second_size = 0;
    make_crash_pulse(&pulse, 0.001);
    assert_ok(cp_pulse_encode(&pulse, &blob, &size, &error), &error);
    assert_ok(cp_pulse_decode(CP_PULSE_CODEC, blob, size, (int64_t)pulse.sample_count, 0.001, &back,
                              &error),
              &error);
    assert_int_equal(back.sample_count, pulse.sample_count);
    for (int c = 0; c < CP_CHANNEL_COUNT; c++)
        for (size_t k = 0; k < pulse.sample_count; k++)
            assert_true(fabs(back.channel[c][k] - pulse.channel[c][k]) <=
                        0.5 * CP_PULSE_RESOLUTION[c] * (1 + 1e-9));

    // The blob explains itself.
    cp_pulse alone;
    assert_ok(cp_pulse_decode_blob(blob, size, &alone, &error), &error);
    assert_int_equal(alone.sample_count, pulse.sample_count);
    assert_true(alone.sample_interval_s == 0.001);
    assert_memory_equal(alone.channel[0], back.channel[0], pulse.sample_count * sizeof(double));
    cp_pulse_destroy(&alone);

    // What was rounded once stays: the decoded pulse packs to the same bytes and values.
    assert_ok(cp_pulse_encode(&back, &second, &second_size, &error), &error);
    assert_int_equal(second_size, size);
    assert_memory_equal(second, blob, size);
    assert_ok(cp_pulse_decode(CP_PULSE_CODEC, second, size, (int64_t)pulse.sample_count, 0.001,
                              &again, &error),
              &error);
    for (int c = 0; c < CP_CHANNEL_COUNT; c++)
        assert_memory_equal(again.channel[c], back.channel[c], pulse.sample_count * sizeof(double));
    free(blob);
    free(second);
    cp_pulse_destroy(&pulse);
    cp_pulse_destroy(&back);
    cp_pulse_destroy(&again);
}

// A car that spins while it slides: displacements in the axes at first contact, velocities in the
// turning ones. What the codec predicts of them is so good that they cost next to nothing.
static void integrals_cost_little(void **state)
{
    (void)state;
    cp_pulse whole;
    cp_error error = {0};
    void *blob = NULL;
    size_t size = 0;
    const size_t count = 250;
    const double h = 0.001;
    assert_ok(cp_pulse_create(&whole, count, h, &error), &error);
    double vx = 15, vy = 0, yaw = 0, rate = 0, wx = 15, wy = 0, x = 0, y = 0;
    for (size_t k = 0; k < count; k++) {
        double t = (double)k * h, pulse = t < 0.1 ? sin(31.4159 * t) : 0.0;
        double ax = -150 * pulse, ay = 40 * pulse, acc = 120 * pulse;
        double values[CP_CHANNEL_COUNT] = {
            [CP_CHANNEL_AX] = ax,   [CP_CHANNEL_AY] = ay,         [CP_CHANNEL_VX] = vx,
            [CP_CHANNEL_VY] = vy,   [CP_CHANNEL_X] = x,           [CP_CHANNEL_Y] = y,
            [CP_CHANNEL_YAW] = yaw, [CP_CHANNEL_YAW_RATE] = rate, [CP_CHANNEL_YAW_ACC] = acc};
        for (int c = 0; c < CP_CHANNEL_COUNT; c++)
            whole.channel[c][k] = values[c];
        x += h * wx, y += h * wy;
        wx += h * (cos(yaw) * ax - sin(yaw) * ay), wy += h * (sin(yaw) * ax + cos(yaw) * ay);
        vx += h * ax, vy += h * ay, yaw += h * rate, rate += h * acc;
    }
    assert_true(yaw > 0.5);
    assert_ok(cp_pulse_encode(&whole, &blob, &size, &error), &error);
    print_message("a smooth pulse of 250 ms with a spin: %zu bytes\n", size);
    assert_true(size <= 500);
    free(blob);
    cp_pulse_destroy(&whole);
}

static void odd_intervals_are_kept(void **state)
{
    (void)state;
    const double intervals_s[] = {1.0 / 3000, 0.00048828125, 1e-12, 0.25};
    for (size_t k = 0; k < 4; k++) {
        cp_pulse pulse, back;
        cp_error error = {0};
        void *blob = NULL;
        size_t size = 0;
        assert_ok(cp_pulse_create(&pulse, 3, intervals_s[k], &error), &error);
        assert_ok(cp_pulse_encode(&pulse, &blob, &size, &error), &error);
        assert_ok(cp_pulse_decode_blob(blob, size, &back, &error), &error);
        assert_true(back.sample_interval_s == intervals_s[k]);
        cp_pulse_destroy(&pulse);
        assert_int_equal(cp_pulse_decode(2, blob, size, 3, 0.001, &pulse, &error), CP_BAD_INPUT);
        assert_non_null(strstr(error.text, "does not agree"));
        free(blob);
        cp_pulse_destroy(&back);
    }
}

static void two_pulses_fit_two_kilobytes(void **state)
{
    (void)state;
    cp_pulse pulse, record;
    cp_error error = {0};
    void *blob = NULL;
    size_t size = 0;
    make_crash_pulse(&pulse, 0.0005);
    assert_ok(cp_pulse_codec_record(&pulse, &record, &error), &error);
    assert_ok(cp_pulse_encode(&record, &blob, &size, &error), &error);
    print_message("one pulse of 200 ms: %zu bytes\n", size);
    assert_true(2 * size <= 2048);
    free(blob);
    cp_pulse_destroy(&pulse);
    cp_pulse_destroy(&record);
}

static void record_is_at_one_kilohertz(void **state)
{
    (void)state;
    cp_pulse pulse, record;
    cp_error error = {0};
    make_crash_pulse(&pulse, 0.0005);
    assert_ok(cp_pulse_codec_record(&pulse, &record, &error), &error);
    assert_int_equal(record.sample_count, 201);
    assert_true(fabs(record.sample_interval_s - 0.001) < 1e-12);
    // Velocities are samples of the original, accelerations are smoothed.
    assert_true(record.channel[CP_CHANNEL_VX][100] == pulse.channel[CP_CHANNEL_VX][200]);
    assert_true(record.channel[CP_CHANNEL_AX][100] != pulse.channel[CP_CHANNEL_AX][200]);
    cp_pulse_destroy(&record);
    cp_pulse_destroy(&pulse);
}

static void refuses_values_it_cannot_hold(void **state)
{
    (void)state;
    const double bad[] = {NAN, INFINITY, 1e12};
    for (size_t k = 0; k < 3; k++) {
        cp_pulse pulse;
        cp_error error = {0};
        void *blob = NULL;
        size_t size = 0;
        make_crash_pulse(&pulse, 0.001);
        pulse.channel[CP_CHANNEL_X][7] = bad[k];
        assert_int_equal(cp_pulse_encode(&pulse, &blob, &size, &error), CP_BAD_INPUT);
        assert_null(blob);
        assert_non_null(strstr(error.text, "x_m of sample 7"));
        cp_pulse_destroy(&pulse);
    }
}

// Hostile blobs: an error, never a wrong read, an overflow or a huge allocation (the sanitizers
// see).
static void survives_hostile_blobs(void **state)
{
    (void)state;
    cp_pulse pulse, back;
    cp_error error = {0};
    void *blob = NULL;
    size_t size = 0;
    make_crash_pulse(&pulse, 0.001);
    assert_ok(cp_pulse_encode(&pulse, &blob, &size, &error), &error);
    int64_t count = (int64_t)pulse.sample_count;

    assert_int_equal(cp_pulse_decode(99, blob, size, count, 0.001, &back, &error), CP_BAD_INPUT);
    const int64_t counts[] = {-1, 0, count - 1, count + 1, INT64_MAX};
    for (size_t k = 0; k < 5; k++)
        assert_int_equal(
            cp_pulse_decode(CP_PULSE_CODEC, blob, size, counts[k], 0.001, &back, &error),
            CP_BAD_INPUT);
    assert_int_equal(cp_pulse_decode(CP_PULSE_CODEC, blob, size, count, NAN, &back, &error),
                     CP_BAD_INPUT);
    for (size_t shorter = 0; shorter < size; shorter++)
        assert_int_equal(
            cp_pulse_decode(CP_PULSE_CODEC, blob, shorter, count, 0.001, &back, &error),
            CP_BAD_INPUT);

    // Any byte changed: refused, or the very pulse (a bit that says nothing); read as another
    // codec, refused or some pulse.
    cp_pulse whole;
    assert_ok(cp_pulse_decode(CP_PULSE_CODEC, blob, size, count, 0.001, &whole, &error), &error);
    unsigned char *bytes = blob;
    for (size_t k = 0; k < size; k++) {
        for (unsigned flip = 1; flip < 256; flip = flip * 2 + 1) {
            bytes[k] ^= (unsigned char)flip;
            for (int codec = 1; codec <= CP_PULSE_CODEC; codec++) {
                cp_status status = cp_pulse_decode(codec, blob, size, count, 0.001, &back, &error);
                assert_true(status == CP_OK || status == CP_BAD_INPUT);
                for (int c = 0; codec == CP_PULSE_CODEC && status == CP_OK && c < CP_CHANNEL_COUNT;
                     c++)
                    assert_memory_equal(back.channel[c], whole.channel[c],
                                        (size_t)count * sizeof(double));
                cp_pulse_destroy(&back);
            }
            bytes[k] ^= (unsigned char)flip;
        }
    }
    cp_pulse_destroy(&whole);
    free(blob);
    cp_pulse_destroy(&pulse);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(decodes_to_within_half_a_step),
        cmocka_unit_test(odd_intervals_are_kept),
        cmocka_unit_test(integrals_cost_little),
        cmocka_unit_test(two_pulses_fit_two_kilobytes),
        cmocka_unit_test(record_is_at_one_kilohertz),
        cmocka_unit_test(refuses_values_it_cannot_hold),
        cmocka_unit_test(survives_hostile_blobs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
