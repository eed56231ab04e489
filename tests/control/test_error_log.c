/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/error_log.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const double STEP_S = 0.05;

static void note(cp_error_log *log, size_t control, uint32_t vehicle, uint32_t other, double now_s)
{
    cp_error error = {0};
    assert_int_equal(cp_error_log_note(log, control, vehicle, other, now_s, STEP_S, &error), CP_OK);
}

static const cp_logged_error *find(const cp_error_log *log, size_t control, uint32_t vehicle,
                                   uint32_t other)
{
    const cp_logged_error *found = NULL;
    for (size_t k = 0; k < log->count; k++)
        if (log->errors[k].control == control && log->errors[k].vehicle == vehicle &&
            log->errors[k].other == other) {
            assert_null(found); // each once
            found = &log->errors[k];
        }
    return found;
}

static void an_error_lasts_while_it_is_noted(void **unused)
{
    (void)unused;
    cp_error_log log = {0};
    for (int k = 0; k <= 20; k++)
        note(&log, 1, 7, CP_EVERYBODY, 10.0 + k * STEP_S);
    const cp_logged_error *found = find(&log, 1, 7, CP_EVERYBODY);
    assert_non_null(found);
    assert_true(found->since_s == 10.0 && found->until_s == 11.0);
    assert_null(find(&log, 0, 7, CP_EVERYBODY));
    assert_null(find(&log, 1, 7, 8));

    // A step without it, and it is another one.
    note(&log, 1, 7, CP_EVERYBODY, 11.1);
    found = find(&log, 1, 7, CP_EVERYBODY);
    assert_true(found->since_s == 11.1 && found->until_s == 11.1);
    cp_error_log_destroy(&log);
}

static void many_are_kept_apart_and_forgotten_in_time(void **unused)
{
    (void)unused;
    cp_error_log log = {0};
    cp_error error = {0};
    // Two steps of 40 drivers times 50 others, and one that goes on.
    for (int step = 0; step < 2; step++)
        for (uint32_t ego = 0; ego < 40; ego++)
            for (uint32_t foe = 0; foe < 50; foe++)
                note(&log, ego % 3, ego, foe, 1.0 + step * STEP_S);
    assert_int_equal(log.count, 2000);
    for (uint32_t ego = 0; ego < 40; ego++)
        for (uint32_t foe = 0; foe < 50; foe++) {
            const cp_logged_error *found = find(&log, ego % 3, ego, foe);
            assert_true(found->since_s == 1.0 && found->until_s == 1.0 + STEP_S);
        }
    for (int k = 2; k < 200; k++) {
        double now_s = 1.0 + k * STEP_S;
        assert_int_equal(cp_error_log_tidy(&log, now_s, &error), CP_OK);
        note(&log, 0, 0, 0, now_s);
        // Whatever may still be asked is there.
        if (now_s <= 1.0 + STEP_S + CP_ERROR_MEMORY_S)
            assert_int_equal(log.count, 2000);
    }
    assert_int_equal(log.count, 1);
    assert_true(find(&log, 0, 0, 0)->since_s == 1.0);
    cp_error_log_destroy(&log);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_error_lasts_while_it_is_noted),
        cmocka_unit_test(many_are_kept_apart_and_forgotten_in_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
