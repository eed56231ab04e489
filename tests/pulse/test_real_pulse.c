/* SPDX-License-Identifier: GPL-3.0-or-later */
/* OLC and severity of a measured pulse: NHTSA vehicle test 10146 (2018 Toyota Camry, 57.09 km/h,
 * full-width rigid barrier). The data stay outside the project; without them these tests skip. */
#include "core/file.h"
#include "core/units.h"
#include "pulse/severity.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "builders/assert_near.h"

#define V0_M_S (57.09 / 3.6)
#define INTERVAL_S 0.0001

/* One channel in m/s^2 with its zero (mean over -40..0 ms) removed, from first contact on. The
 * caller frees; NULL when the file is absent. */
static double *read_channel(int number, size_t *count)
{
    const char *source = getenv("CRASHPULSE_SOURCE");
    char path[4096], *text = NULL;
    snprintf(path, sizeof path, "%s/../shared/reference/nhtsa_v10146_camry_2018/v10146.%03d",
             source != NULL ? source : ".", number);
    size_t size = 0;
    if (cp_file_read(path, &text, &size, NULL) != CP_OK) {
        print_message("skipped: %s is not here\n", path);
        return NULL;
    }
    double *a_m_s2 = malloc(size * sizeof *a_m_s2), zero_g = 0.0;
    assert_non_null(a_m_s2);
    size_t zero_count = 0;
    *count = 0;
    for (char *place = text, *end;; place = end) {
        double time_s = strtod(place, &end), value_g = strtod(end, &end);
        if (end == place)
            break;
        if (time_s >= -0.04 - 1e-9 && time_s <= 1e-9) {
            zero_g += value_g;
            zero_count++;
        }
        if (time_s >= -1e-9)
            a_m_s2[(*count)++] = value_g;
    }
    free(text);
    for (size_t k = 0; k < *count; k++)
        a_m_s2[k] = (a_m_s2[k] - zero_g / (double)zero_count) * CP_G0_M_S2;
    return a_m_s2;
}

/* Pulse of the mean of two channels (the same number twice: one). False when absent. */
static bool read_pulse(int first, int second, cp_pulse *pulse)
{
    size_t count = 0, other_count = 0;
    double *one = read_channel(first, &count), *two = read_channel(second, &other_count);
    bool present = one != NULL && two != NULL;
    if (present) {
        assert_int_equal(count, other_count);
        assert_int_equal(cp_pulse_create(pulse, count, INTERVAL_S, NULL), CP_OK);
        double *ax = pulse->channel[CP_CHANNEL_AX], *vx = pulse->channel[CP_CHANNEL_VX];
        double *x = pulse->channel[CP_CHANNEL_X];
        vx[0] = V0_M_S;
        for (size_t k = 0; k < count; k++)
            ax[k] = 0.5 * (one[k] + two[k]);
        for (size_t k = 1; k < count; k++) {
            vx[k] = vx[k - 1] + 0.5 * (ax[k - 1] + ax[k]) * INTERVAL_S;
            x[k] = x[k - 1] + 0.5 * (vx[k - 1] + vx[k]) * INTERVAL_S;
        }
    }
    free(one);
    free(two);
    return present;
}

/* The published times are those of the first sample at or past the zero crossing. */
static double first_sample_ms(double time_s)
{
    return ceil(time_s / INTERVAL_S) * INTERVAL_S * 1000.0;
}

static void each_sensor_gives_its_published_figures(void **state)
{
    (void)state;
    static const struct {
        int channel;
        double olc_g, t_v0_ms, peak_g;
    } EXPECTED[] = {{93, 29.25, 74.3, 45.4},
                    {94, 29.57, 73.8, 39.6},
                    {99, 30.15, 72.5, 47.4},
                    {100, 29.49, 73.8, 40.6}};
    for (size_t k = 0; k < sizeof EXPECTED / sizeof EXPECTED[0]; k++) {
        cp_pulse pulse;
        cp_severity severity;
        if (!read_pulse(EXPECTED[k].channel, EXPECTED[k].channel, &pulse))
            skip();
        assert_int_equal(cp_severity_of_pulse(&pulse, 0.12, 1, &severity, NULL), CP_OK);
        cp_pulse_destroy(&pulse);
        assert_near(severity.olc.olc_g, EXPECTED[k].olc_g, 0.0101);
        assert_near(first_sample_ms(severity.t_v0_s), EXPECTED[k].t_v0_ms, 1e-6);
        assert_near(severity.peak_g, EXPECTED[k].peak_g, 0.0601);
    }
}

static void the_mean_of_both_sides(void **state)
{
    (void)state;
    cp_pulse pulse;
    cp_severity severity;
    if (!read_pulse(93, 94, &pulse))
        skip();
    assert_int_equal(cp_severity_of_pulse(&pulse, 0.1, 1, &severity, NULL), CP_OK);
    assert_near(severity.olc.olc_g, 29.41, 0.0101);
    assert_near(first_sample_ms(severity.t_v0_s), 74.0, 1e-6);
    assert_near(severity.peak_g, 40.9, 0.0601);
    assert_near(3.6 * severity.delta_v_m_s, 66.5, 0.0601);
    assert_near(severity.end_s, 0.113, 0.00051);
    assert_near(3.6 * (V0_M_S - pulse.channel[CP_CHANNEL_VX][2000]), 65.1, 0.0601);
    double crush_m = 0.0;
    for (size_t k = 0; k < pulse.sample_count; k++)
        crush_m = fmax(crush_m, pulse.channel[CP_CHANNEL_X][k]);
    assert_near(crush_m, 0.746, 0.00051);
    cp_pulse_destroy(&pulse);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_sensor_gives_its_published_figures),
        cmocka_unit_test(the_mean_of_both_sides),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
