/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/background_rows.h"

#include "store/fixture.h"
#include "store/merge.h"

static void open_with_plan(const char *db, cp_store **store)
{
    small_plan plan;
    cp_error error = {0};
    small_plan_fill(&plan);
    assert_ok(cp_store_open(db, CP_STORE_CREATE, store, &error), &error);
    assert_ok(cp_plan_rows_write(*store, &plan.rows, &error), &error);
}

// Some contacts, the last of them a crash.
static void write_run(cp_store *store, uint64_t seed, const char *hash, size_t contacts)
{
    cp_background_rows rows = {.scenario = "crossing",
                               .seed = seed,
                               .step_length_s = 0.05,
                               .simulated_s = 60.0,
                               .vehicle_km = 12.5,
                               .vehicle_h = 0.5,
                               .departed = 40,
                               .sumo_version = strdup("SUMO 1.15.0"),
                               .sumo_command_line = strdup("sumo -c crossing.sumocfg")};
    cp_error error = {0};
    snprintf(rows.configuration_hash, sizeof rows.configuration_hash, "%s", hash);
    for (size_t k = 0; k < contacts; k++) {
        cp_background_contact_row *contact = cp_background_rows_add_contact(&rows);
        bool is_crash = k + 1 == contacts;
        assert_non_null(contact);
        *contact = (cp_background_contact_row){.time_s = 10.0 + (double)k,
                                               .contact_m = {1.0, 2.0},
                                               .reason = is_crash ? "crash" : "graze",
                                               .crash_type = is_crash ? "front-side" : "",
                                               .closing_speed_m_s = is_crash ? 9.0 : NAN,
                                               .lateral_offset_m = is_crash ? 0.5 : NAN,
                                               .angle_rad = is_crash ? -1.5 : NAN,
                                               .vehicle = {strdup("a"), strdup("b")}};
    }
    assert_ok(cp_background_rows_write(store, &rows, &error), &error);
    cp_background_rows_destroy(&rows);
}

// The plan's only run has this hash.
static void drop_stale(cp_store *store, const char *hash)
{
    small_plan plan;
    cp_background_plan_row planned = {.scenario = 0, .seed = 7, .duration_s = 60.0};
    cp_error error = {0};
    small_plan_fill(&plan);
    snprintf(planned.configuration_hash, sizeof planned.configuration_hash, "%s", hash);
    plan.rows.background = &planned;
    plan.rows.background_count = hash[0] != '\0';
    assert_ok(cp_background_rows_drop_stale(store, &plan.rows, &error), &error);
}

static bool is_missing(cp_store *store, const char *hash)
{
    small_plan plan;
    cp_background_plan_row planned = {.scenario = 0, .seed = 7, .duration_s = 60.0};
    bool missing = false;
    cp_error error = {0};
    small_plan_fill(&plan);
    snprintf(planned.configuration_hash, sizeof planned.configuration_hash, "%s", hash);
    plan.rows.background = &planned;
    plan.rows.background_count = 1;
    assert_ok(cp_background_rows_missing(store, &plan.rows, &missing, &error), &error);
    return missing;
}

static void a_run_is_there_until_the_study_changes(void **state)
{
    const fixture *f = *state;
    cp_store *store = NULL;
    open_with_plan(f->db, &store);
    assert_true(is_missing(store, "aa"));
    write_run(store, 7, "aa", 3);
    assert_false(is_missing(store, "aa"));
    assert_true(is_missing(store, "bb"));
    assert_true(number_of(store, "SELECT crashes + 10 * other_contacts FROM "
                                 "background_by_scenario") == 21);

    // Another run beside it counts too; what is not planned any more goes, but for others' runs.
    write_run(store, 8, "", 2);
    assert_true(number_of(store, "SELECT crashes + 10 * other_contacts FROM "
                                 "background_by_scenario") == 32);
    write_run(store, 9, "bb", 1);
    assert_false(is_missing(store, "aa"));
    drop_stale(store, "");
    assert_false(is_missing(store, "aa"));
    drop_stale(store, "bb");
    assert_true(is_missing(store, "aa"));
    assert_false(is_missing(store, "bb"));
    assert_true(number_of(store, "SELECT sum(seed) FROM background_run") == 17);
    assert_true(number_of(store, "SELECT count(*) FROM background_contact") == 3);

    // The same again replaces it.
    write_run(store, 8, "", 4);
    assert_true(number_of(store, "SELECT count(*) FROM background_contact WHERE seed = 8") == 4);
    cp_store_close(store);
}

static void a_scenario_that_is_not_there_is_named(void **state)
{
    const fixture *f = *state;
    cp_store *store = NULL;
    cp_error error = {0};
    open_with_plan(f->db, &store);
    assert_int_equal(cp_background_rows_check(store, "town", &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "has no scenario 'town'"));
    cp_background_rows rows = {.scenario = "town"};
    assert_int_equal(cp_background_rows_write(store, &rows, &error), CP_BAD_INPUT);
    assert_true(number_of(store, "SELECT count(*) FROM background_run") == 0);
    cp_store_close(store);
}

// Rates beside the baseline's: negligible up to 5 %.
static void what_is_negligible_is_said_beside_the_baseline(void **state)
{
    const fixture *f = *state;
    cp_store *store = NULL;
    cp_error error = {0};
    open_with_plan(f->db, &store);
    assert_true(number_of(store, "SELECT is_negligible IS NULL FROM background_by_scenario") == 1);
    write_run(store, 7, "aa", 1);
    assert_true(number_of(store, "SELECT is_negligible FROM background_by_scenario") == 0);
    write_run(store, 7, "aa", 0);
    assert_true(number_of(store, "SELECT is_negligible FROM background_by_scenario") == 1);
    assert_true(number_of(store, "SELECT count(*) FROM background_run") == 1);

    // The baseline's two replications together drive twice as far and crash forty times, or less.
    cp_store_close(store);
    char command[1024];
    snprintf(command, sizeof command,
             "sqlite3 -bail '%s' \"UPDATE replication SET status = 'done', simulated_s = 60, "
             "vehicle_h = 0.5, vehicle_km = 12.5; WITH RECURSIVE n(k) AS (SELECT 0 UNION ALL "
             "SELECT k + 1 FROM n WHERE k < 19) INSERT INTO crash (id, replication_id, number, "
             "time_s, x_m, y_m, crash_type, closing_speed_m_s, lateral_offset_m, angle_rad, "
             "validity, shift_m) SELECT r.id * 16384 + k, r.id, k, 1, 0, 0, 'front-side', 9, 0, "
             "0, 'inside', 0 FROM replication AS r, n WHERE r.variant_id = (SELECT id FROM variant "
             "WHERE is_baseline)\"",
             f->db);
    assert_int_equal(system(command), 0);
    assert_ok(cp_store_open(f->db, CP_STORE_WRITE, &store, &error), &error);
    write_run(store, 7, "aa", 1);
    assert_true(number_of(store, "SELECT expected_crashes FROM background_by_scenario") == 2.0);
    assert_true(number_of(store, "SELECT baseline_crashes FROM background_by_scenario") == 40.0);
    assert_true(number_of(store, "SELECT is_negligible FROM background_by_scenario") == 1);
    assert_true(number_of(store, "SELECT count(*) FROM crash") == 40.0);
    cp_store_close(store);
    snprintf(command, sizeof command, "sqlite3 '%s' 'DELETE FROM crash WHERE number = 19'", f->db);
    assert_int_equal(system(command), 0);
    assert_ok(cp_store_open(f->db, CP_STORE_WRITE, &store, &error), &error);
    assert_true(number_of(store, "SELECT is_negligible FROM background_by_scenario") == 0);
    cp_store_close(store);
}

static void merging_takes_backgrounds_once_and_notices_other_results(void **state)
{
    const fixture *f = *state;
    char part[128];
    cp_store *store = NULL, *other = NULL;
    cp_merge_count count;
    cp_error error = {0};
    snprintf(part, sizeof part, "%s/part.db", f->folder);
    open_with_plan(f->db, &store);
    open_with_plan(part, &other);
    write_run(other, 7, "aa", 3);
    for (int again = 0; again < 2; again++) {
        assert_ok(cp_merge(store, part, &count, &error), &error);
        assert_true(number_of(store, "SELECT count(*) FROM background_run") == 1);
        assert_true(number_of(store, "SELECT count(*) FROM background_contact") == 3);
    }
    assert_false(is_missing(store, "aa"));

    // Of the same configuration, another result.
    write_run(other, 7, "aa", 2);
    assert_int_equal(cp_merge(store, part, &count, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "scenario crossing, variant background"));
    assert_true(number_of(store, "SELECT count(*) FROM background_contact") == 3);
    cp_store_close(other);
    cp_store_close(store);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_run_is_there_until_the_study_changes, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(a_scenario_that_is_not_there_is_named, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(what_is_negligible_is_said_beside_the_baseline,
                                        fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(merging_takes_backgrounds_once_and_notices_other_results,
                                        fixture_begin, fixture_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
