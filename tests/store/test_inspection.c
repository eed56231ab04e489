/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/fixture.h"

#include "store/inspection.h"

/* A whole database, and one thing after the other broken in it behind the back of its triggers. */

static cp_store *open_finished(const fixture *f)
{
    small_plan plan;
    cp_store *store = open_planned(f, &plan);
    const double olc_g[] = {20, 30};
    finish_replication_with(store, &plan, 0, olc_g, 2);
    return store;
}

static void break_by(const fixture *f, const char *sql)
{
    char command[1024];
    snprintf(command, sizeof command,
             "sqlite3 -cmd '.dbconfig enable_trigger off' '%s' \"%s\" > /dev/null", f->db, sql);
    assert_int_equal(system(command), 0);
}

// Which check finds it, and the words it uses.
static void assert_found(const fixture *f, const char *what, const char *words)
{
    cp_store *store = NULL;
    cp_error error = {0};
    cp_inspection inspection;
    assert_ok(cp_store_open(f->db, CP_STORE_READ, &store, &error), &error);
    assert_ok(cp_inspection_run(store, &inspection, &error), &error);
    cp_store_close(store);
    assert_true(inspection.wrong > 0);
    for (int k = 0; k < inspection.count; k++) {
        if (strcmp(inspection.result[k].what, what) != 0)
            continue;
        assert_true(inspection.result[k].wrong > 0);
        if (strstr(inspection.result[k].first, words) == NULL)
            fail_msg("expected '%s', found '%s'", words, inspection.result[k].first);
        return;
    }
    fail_msg("no check of %s", what);
}

static void missing_vehicle(void **state)
{
    cp_store_close(open_finished(*state));
    break_by(*state, "DELETE FROM crash_vehicle WHERE role = 'b'");
    assert_found(*state, "vehicles of crashes", "has not one vehicle a and one b");
}

static void dangling_reference(void **state)
{
    cp_store_close(open_finished(*state));
    break_by(*state, "DELETE FROM vehicle_model");
    assert_found(*state, "references", "a row of crash_vehicle names one of vehicle_model");
}

static void copy_that_lies(void **state)
{
    cp_store_close(open_finished(*state));
    break_by(*state, "UPDATE crash_vehicle SET variant_id = 1 WHERE role = 'a'");
    assert_found(*state, "copies in crash_vehicle", "does not agree with its crash");
}

static void results_of_nobody(void **state)
{
    cp_store_close(open_finished(*state));
    break_by(*state, "UPDATE replication SET status = 'planned' WHERE status = 'done'");
    assert_found(*state, "results without status done", "is planned and has crashes");
}

static void error_that_is_not_counted(void **state)
{
    cp_store_close(open_finished(*state));
    break_by(*state, "INSERT INTO crash_driver_error SELECT crash_id, role, 0, 'lane_drift', "
                     "'everybody', 2, 0, 1 FROM crash_vehicle LIMIT 1");
    assert_found(*state, "driver errors of vehicles", "has not the no driver errors it counts");
    break_by(*state, "DELETE FROM crash_driver_error; UPDATE crash_vehicle SET error_count = 2");
    assert_found(*state, "driver errors of vehicles", "has not the 2 driver errors it counts");
}

static void function_that_is_missing(void **state)
{
    cp_store_close(open_finished(*state));
    break_by(*state, "UPDATE crash_vehicle SET error_count = 0; UPDATE variant SET functions = "
                     "json_array(json_object('function', 'aeb'))");
    assert_found(*state, "functions of vehicles", "has not one row for each function");
}

static void gap_in_numbers(void **state)
{
    cp_store_close(open_finished(*state));
    break_by(*state, "DELETE FROM crash_vehicle WHERE crash_id IN (SELECT id FROM crash WHERE "
                     "number = 0); DELETE FROM crash WHERE number = 0");
    assert_found(*state, "numbers of crashes", "has a gap");
}

static void damaged_pulse(void **state)
{
    cp_store_close(open_finished(*state));
    break_by(*state, "INSERT INTO pulse SELECT id, 'a', 2, 0.001, 100, x'28b52ffd00' FROM crash");
    assert_found(*state, "stored pulses", "damaged");
}

static void changed_vehicle_file(void **state)
{
    cp_store_close(open_finished(*state));
    break_by(*state, "UPDATE vehicle_model SET yaml = yaml || ' '");
    assert_found(*state, "hashes of vehicle files", "car");
}

static void torn_index(void **state)
{
    const fixture *f = *state;
    cp_store_close(open_finished(f));
    // An entry of an index goes, its row stays.
    break_by(f, "PRAGMA writable_schema = ON; UPDATE sqlite_schema SET sql = sql || ' WHERE number "
                "> 0' WHERE name = 'replication_status'");
    break_by(f, "INSERT INTO replication (id, scenario_id, variant_id, number, seed, "
                "configuration_hash) SELECT 1, scenario_id, variant_id, 0, 1, '' FROM replication "
                "LIMIT 1");
    break_by(f, "PRAGMA writable_schema = ON; UPDATE sqlite_schema SET sql = replace(sql, ' WHERE "
                "number > 0', '') WHERE name = 'replication_status'");
    assert_found(f, "file structure", "replication_status");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(missing_vehicle, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(dangling_reference, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(copy_that_lies, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(results_of_nobody, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(error_that_is_not_counted, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(function_that_is_missing, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(gap_in_numbers, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(damaged_pulse, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(changed_vehicle_file, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(torn_index, fixture_begin, fixture_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
