/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/false_activations.h"

#include "stats/rates.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "builders/small_study.h"

static double number(const json_t *row, const char *name)
{
    const json_t *value = json_object_get(row, name);
    assert_true(json_is_number(value));
    return json_number_value(value);
}

static json_t *rows_of(cp_store *store)
{
    json_t *rows = NULL;
    cp_error error = {0};
    if (cp_false_activations_json(store, &rows, &error) != CP_OK)
        fail_msg("%s", error.text);
    cp_store_close(store);
    return rows;
}

// Eight replications of 4.5, 4.6, ... hours with 20, 21, ... activations: 188 in 38.8 h.
static void rates_are_of_all_replications_of_a_scenario(void **state)
{
    (void)state;
    double hours[8], events[8];
    for (int k = 0; k < 8; k++) {
        hours[k] = 4.5 + 0.1 * k;
        events[k] = 20 + k;
    }
    cp_exposure exposure = {8, events, hours};
    cp_widening widening;
    cp_interval wanted = cp_rate_widened(&exposure, NULL, 0.95, &widening);
    json_t *rows = rows_of(open_small_study());
    assert_int_equal(json_array_size(rows), 2); // the baseline has no function
    for (size_t k = 0; k < 2; k++) {
        const json_t *row = json_array_get(rows, k);
        assert_string_equal(json_string_value(json_object_get(row, "scenario")),
                            k == 0 ? "left_turn" : "head_on_overtaking");
        assert_string_equal(json_string_value(json_object_get(row, "function")), "aeb");
        assert_true(json_is_true(json_object_get(row, "has_errors")));
        assert_true(number(row, "activations") == 188.0);
        assert_true(fabs(number(row, "vehicle_h") - 38.8) < 1e-9);
        assert_true(fabs(number(row, "per_1000_h") - 1000.0 * 188.0 / 38.8) < 1e-6);
        assert_true(fabs(number(row, "low") - 1000.0 * wanted.low) < 1e-6);
        assert_true(fabs(number(row, "high") - 1000.0 * wanted.high) < 1e-6);
        // An earlier version has not counted these.
        assert_true(json_is_null(json_object_get(row, "without_error")));
        assert_true(json_is_null(json_object_get(row, "without_error_high")));
    }
    json_decref(rows);
}

static void activations_without_an_error_are_told_apart(void **state)
{
    (void)state;
    char command[9000], path[4096];
    snprintf(path, sizeof path, "%s/false_activations_test.db", getenv("CRASHPULSE_BUILD"));
    snprintf(command, sizeof command,
             "cp '%s/small_study.db' '%s' && sqlite3 '%s' \"UPDATE replication SET counters = "
             "json_set(counters, '$.\\\"aeb.activations_without_error\\\"', 1) WHERE counters <> "
             "'{}' AND scenario_id = 11\"",
             getenv("CRASHPULSE_BUILD"), path, path);
    assert_int_equal(system(command), 0);
    json_t *rows = rows_of(open_study("false_activations_test.db"));
    const json_t *row = json_array_get(rows, 0);
    assert_true(number(row, "without_error") == 8.0);
    assert_true(fabs(number(row, "without_error_per_1000_h") - 8000.0 / 38.8) < 1e-6);
    assert_true(number(row, "without_error_low") < 8000.0 / 38.8);
    assert_true(json_is_null(json_object_get(json_array_get(rows, 1), "without_error")));
    json_decref(rows);
    unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rates_are_of_all_replications_of_a_scenario),
        cmocka_unit_test(activations_without_an_error_are_told_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
