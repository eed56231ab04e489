/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/function_request.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

/* What of a request is let through, field by field. */

static const uint32_t ALL = CRASHPULSE_BRAKES | CRASHPULSE_WARNS | CRASHPULSE_STEERS |
                            CRASHPULSE_LIMITS | CRASHPULSE_DRIVES;

static void nothing_is_fine_for_whoever(void **unused)
{
    (void)unused;
    char wrong[256];
    crashpulse_request request = cp_function_request_none();
    assert_true(cp_function_request_check(&request, 0, wrong, sizeof wrong));
}

/* A field, a value in its range, values that are not, and what a function must do to ask for it. */
typedef struct field {
    size_t offset;
    const char *name;
    double good, bad[2];
    uint32_t needs;
} field;

static void every_field_is_checked(void **unused)
{
    (void)unused;
    const uint32_t any = UINT32_MAX;
    const field fields[] = {
        {offsetof(crashpulse_request, acceleration_m_s2),
         "acceleration_m_s2",
         -8.0,
         {-20.1, 20.1},
         CRASHPULSE_BRAKES},
        {offsetof(crashpulse_request, acceleration_m_s2),
         "acceleration_m_s2",
         1.0,
         {-1e9, 1e9},
         CRASHPULSE_DRIVES},
        {offsetof(crashpulse_request, since_s), "since_s", 3.0, {-1e10, 1e10}, any},
        {offsetof(crashpulse_request, steer_mean_1),
         "steer_mean_1",
         0.1,
         {-1.1, 1.1},
         CRASHPULSE_STEERS},
        {offsetof(crashpulse_request, steer_end_1),
         "steer_end_1",
         -0.1,
         {-1.1, 1.1},
         CRASHPULSE_STEERS},
        {offsetof(crashpulse_request, steer_since_s),
         "steer_since_s",
         3.0,
         {-1e10, 1e10},
         CRASHPULSE_STEERS},
        {offsetof(crashpulse_request, announced_s),
         "announced_s",
         3.0,
         {-1e10, 1e10},
         CRASHPULSE_STEERS},
        {offsetof(crashpulse_request, warned_s), "warned_s", 3.0, {-1e10, 1e10}, CRASHPULSE_WARNS},
        {offsetof(crashpulse_request, speed_factor_1),
         "speed_factor_1",
         1.0,
         {0.0, 10.1},
         CRASHPULSE_LIMITS},
        {offsetof(crashpulse_request, target_ttc_s), "target_ttc_s", 1.0, {-0.1, 1e10}, any},
    };
    for (size_t k = 0; k < sizeof fields / sizeof *fields; k++) {
        const field *of = &fields[k];
        const double values[] = {of->good, of->bad[0], of->bad[1], NAN, INFINITY, -INFINITY};
        char wrong[256] = "";
        for (size_t v = 0; v < sizeof values / sizeof *values; v++) {
            crashpulse_request request = cp_function_request_none();
            memcpy((char *)&request + of->offset, &values[v], sizeof values[v]);
            bool is_let_through = cp_function_request_check(&request, ALL, wrong, sizeof wrong);
            assert_int_equal(is_let_through, v == 0);
            assert_true(v == 0 || strstr(wrong, of->name) != NULL);
        }
        // Only of who does it.
        crashpulse_request request = cp_function_request_none();
        memcpy((char *)&request + of->offset, &of->good, sizeof of->good);
        if (of->needs == any)
            continue;
        assert_false(cp_function_request_check(&request, ALL & ~of->needs, wrong, sizeof wrong));
        assert_true(cp_function_request_check(&request, of->needs, wrong, sizeof wrong));
    }
}

static void back_on_the_path_is_steering(void **unused)
{
    (void)unused;
    char wrong[256];
    crashpulse_request request = cp_function_request_none();
    request.is_back = true;
    assert_true(cp_function_request_check(&request, CRASHPULSE_STEERS, wrong, sizeof wrong));
    assert_false(cp_function_request_check(&request, CRASHPULSE_BRAKES, wrong, sizeof wrong));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(nothing_is_fine_for_whoever),
                                       cmocka_unit_test(every_field_is_checked),
                                       cmocka_unit_test(back_on_the_path_is_steering)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
