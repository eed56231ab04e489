/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pulse/pulse.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void a_new_pulse_is_all_zero_and_destroys_twice(void **state)
{
    (void)state;
    cp_error error = {0};
    cp_pulse pulse;
    assert_int_equal(cp_pulse_create(&pulse, 401, 0.0005, &error), CP_OK);
    assert_int_equal(pulse.sample_count, 401);
    for (int c = 0; c < CP_CHANNEL_COUNT; c++)
        for (size_t k = 0; k < 401; k++)
            assert_true(pulse.channel[c][k] == 0.0);
    cp_pulse_destroy(&pulse);
    cp_pulse_destroy(&pulse);
    cp_pulse_destroy(&(cp_pulse){0});
}

static void channels_do_not_share_storage(void **state)
{
    (void)state;
    cp_pulse pulse;
    assert_int_equal(cp_pulse_create(&pulse, 7, 0.001, NULL), CP_OK);
    for (int c = 0; c < CP_CHANNEL_COUNT; c++)
        for (size_t k = 0; k < 7; k++)
            pulse.channel[c][k] = 100.0 * c + (double)k;
    for (int c = 0; c < CP_CHANNEL_COUNT; c++)
        for (size_t k = 0; k < 7; k++)
            assert_true(pulse.channel[c][k] == 100.0 * c + (double)k);
    cp_pulse_destroy(&pulse);
}

static void filtering_smooths_accelerations_and_leaves_the_rest(void **state)
{
    (void)state;
    cp_error error = {0};
    cp_pulse raw, filtered;
    assert_int_equal(cp_pulse_create(&raw, 200, 0.0005, &error), CP_OK);
    for (int c = 0; c < CP_CHANNEL_COUNT; c++)
        raw.channel[c][100] = 1.0; // a spike in every channel
    assert_int_equal(cp_pulse_filtered(&raw, 60, &filtered, &error), CP_OK);
    for (int c = 0; c < CP_CHANNEL_COUNT; c++) {
        int acceleration = c == CP_CHANNEL_AX || c == CP_CHANNEL_AY || c == CP_CHANNEL_YAW_ACC;
        assert_true((filtered.channel[c][100] < 0.5) == acceleration);
        assert_true(raw.channel[c][100] == 1.0);
    }
    cp_pulse_destroy(&filtered);

    // Too coarse for the class: refused, nothing left behind.
    raw.sample_interval_s = 0.01;
    assert_int_equal(cp_pulse_filtered(&raw, 60, &filtered, &error), CP_BAD_INPUT);
    assert_null(filtered.channel[0]);
    cp_pulse_destroy(&raw);
}

static void csv_rows_carry_role_time_and_all_channels(void **state)
{
    (void)state;
    cp_pulse pulse;
    assert_int_equal(cp_pulse_create(&pulse, 2, 0.0005, NULL), CP_OK);
    for (int c = 0; c < CP_CHANNEL_COUNT; c++)
        pulse.channel[c][1] = (c + 1) / 3.0;
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_int_equal(cp_pulse_write_csv(&pulse, "b", file, NULL), CP_OK);
    fclose(file);
    assert_string_equal(text, "b,0,0,0,0,0,0,0,0,0,0\n"
                              "b,0.0005,0.3333333333,0.6666666667,1,1.333333333,1.666666667,2,"
                              "2.333333333,2.666666667,3\n");
    free(text);
    cp_pulse_destroy(&pulse);
}

static void a_full_disk_is_an_error(void **state)
{
    (void)state;
    FILE *file = fopen("/dev/full", "w");
    if (file == NULL)
        skip();
    setvbuf(file, NULL, _IONBF, 0);
    cp_pulse pulse;
    cp_error error = {0};
    assert_int_equal(cp_pulse_create(&pulse, 2, 0.0005, NULL), CP_OK);
    assert_int_equal(cp_pulse_write_csv(&pulse, "a", file, &error), CP_IO_FAILED);
    assert_non_null(strstr(error.text, "vehicle a"));
    fclose(file);
    cp_pulse_destroy(&pulse);
}

static void columns_are_those_of_the_csv_contract(void **state)
{
    (void)state;
    static const char *const CONTRACT[CP_CHANNEL_COUNT] = {
        "ax_m_s2", "ay_m_s2", "vx_m_s",         "vy_m_s",        "x_m",
        "y_m",     "yaw_rad", "yaw_rate_rad_s", "yaw_acc_rad_s2"};
    for (int c = 0; c < CP_CHANNEL_COUNT; c++)
        assert_string_equal(CP_PULSE_COLUMN[c], CONTRACT[c]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_new_pulse_is_all_zero_and_destroys_twice),
        cmocka_unit_test(channels_do_not_share_storage),
        cmocka_unit_test(filtering_smooths_accelerations_and_leaves_the_rest),
        cmocka_unit_test(csv_rows_carry_role_time_and_all_channels),
        cmocka_unit_test(a_full_disk_is_an_error),
        cmocka_unit_test(columns_are_those_of_the_csv_contract),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
