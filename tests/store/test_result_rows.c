/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/fixture.h"

#include "pulse/pulse_codec.h"
#include "store/stored_pulse.h"

#define MEDIAN "SELECT coalesce(olc_median_g, -1) FROM olc_by_variant WHERE variant = 'baseline'"

static void commit_is_complete(void **state)
{
    small_plan plan;
    cp_store *store = open_planned(*state, &plan);
    double olc_g[] = {20, 30};
    finish_replication_with(store, &plan, 0, olc_g, 2);
    assert_true(number_of(store, "SELECT count(*) FROM replication WHERE status = 'done' AND "
                                 "vehicle_km = 50") == 1);
    assert_true(number_of(store, "SELECT count(*) FROM attempt WHERE outcome = 'done'") == 1);
    assert_true(number_of(store,
                          "SELECT count(*) FROM crash JOIN crash_vehicle ON crash_id = id "
                          "WHERE crash.crash_type = 'front-front' AND "
                          "crash_vehicle.crash_type = 'front-front' AND t_v0_s IS NULL") == 4);
    assert_true(number_of(store, "SELECT max(id - replication_id * 16384) FROM crash") == 1);
    assert_true(number_of(store, "SELECT crashes_per_million_km FROM crash_rate_by_variant WHERE "
                                 "variant = 'baseline'") == 40000);
    cp_store_close(store);
}

static void median_counts_censored_below_all(void **state)
{
    small_plan plan;
    cp_store *store = open_planned(*state, &plan);
    // Vehicles a: 20, censored, 40; b: 30, censored, 50. In order: <, <, 20, 30, 40, 50.
    double olc_g[] = {20, NAN, 40};
    finish_replication_with(store, &plan, 0, olc_g, 3);
    assert_true(number_of(store, MEDIAN) == 25);
    assert_true(number_of(store, "SELECT censored FROM olc_by_variant WHERE variant = "
                                 "'baseline'") == 2);
    assert_true(number_of(store, "SELECT frontal_vehicles FROM olc_by_variant WHERE variant = "
                                 "'baseline'") == 6);
    // Two more censored: one of the two in the middle has no number, so the median has none.
    double more[] = {NAN};
    finish_replication_with(store, &plan, 2, more, 1);
    assert_true(number_of(store, MEDIAN) == -1);
    assert_true(number_of(store, "SELECT crashes FROM olc_by_variant WHERE variant = "
                                 "'baseline'") == 4);
    cp_store_close(store);
}

static void lost_claim_writes_nothing(void **state)
{
    small_plan plan;
    cp_error error = {0};
    bool ended = false;
    cp_store *store = open_planned(*state, &plan);
    cp_result_rows results = {.replication_id = plan.replication[0].id};
    assert_ok(cp_claim_take(store, results.replication_id, plan.replication[0].configuration_hash,
                            &SOMEBODY, &results.attempt, &error),
              &error);
    add_crash(&results, 1, 20, 20);
    assert_ok(cp_claim_end_of(store, results.replication_id, SOMEBODY.host, SOMEBODY.pid,
                              CP_CLAIM_LOST, 0, NULL, &ended, &error),
              &error);
    assert_int_equal(cp_result_rows_commit(store, &results, &error), CP_RUN_FAILED);
    assert_true(number_of(store, "SELECT count(*) FROM crash") == 0);
    assert_true(number_of(store, "SELECT count(*) FROM replication WHERE status = 'planned'") == 4);
    cp_result_rows_destroy(&results);
    cp_store_close(store);
}

// Something in the middle of a commit fails: nothing of it stays.
static void failed_commit_writes_nothing(void **state)
{
    small_plan plan;
    cp_error error = {0};
    cp_store *store = open_planned(*state, &plan);
    cp_result_rows results = {.replication_id = plan.replication[0].id};
    assert_ok(cp_claim_take(store, results.replication_id, plan.replication[0].configuration_hash,
                            &SOMEBODY, &results.attempt, &error),
              &error);
    add_crash(&results, 1, 20, 20);
    add_crash(&results, 2, 20, 20);
    strcpy(results.crash[1].vehicle[1].vehicle_model, "bus"); // no such model
    assert_int_equal(cp_result_rows_commit(store, &results, &error), CP_STORE_FAILED);
    assert_true(number_of(store, "SELECT count(*) FROM crash") == 0);
    assert_true(number_of(store, "SELECT count(*) FROM replication WHERE status = 'running'") == 1);
    cp_result_rows_destroy(&results);
    cp_store_close(store);
}

static void pulse_comes_back(void **state)
{
    small_plan plan;
    cp_error error = {0};
    cp_pulse pulse, back;
    cp_store *store = open_planned(*state, &plan);
    cp_result_rows results = {.replication_id = plan.replication[0].id};
    assert_ok(cp_claim_take(store, results.replication_id, plan.replication[0].configuration_hash,
                            &SOMEBODY, &results.attempt, &error),
              &error);
    add_crash(&results, 1, 20, 20);
    assert_ok(cp_pulse_create(&pulse, 201, 0.001, &error), &error);
    pulse.channel[CP_CHANNEL_VX][200] = -1.5;
    cp_crash_vehicle_row *vehicle = &results.crash[0].vehicle[1];
    assert_ok(cp_pulse_encode(&pulse, &vehicle->pulse, &vehicle->pulse_size, &error), &error);
    vehicle->sample_count = 201;
    vehicle->sample_interval_s = 0.001;
    assert_ok(cp_result_rows_commit(store, &results, &error), &error);
    int64_t crash_id = results.replication_id * 16384;
    bool there = false;
    assert_ok(cp_stored_pulse_read(store, crash_id, NULL, "b", &back, &there, &error), &error);
    assert_true(there);
    assert_int_equal(back.sample_count, 201);
    assert_true(fabs(back.channel[CP_CHANNEL_VX][200] + 1.5) < 1e-9);
    cp_pulse_destroy(&back);
    assert_ok(cp_stored_pulse_read(store, crash_id, NULL, "a", &back, &there, &error), &error);
    assert_false(there);
    cp_pulse_destroy(&pulse);
    cp_result_rows_destroy(&results);
    cp_store_close(store);
}

// Rows of a crash whose driver a erred and whose b has a function that brakes, as crash 0 of
// results.
static void fill_participants(cp_crash_row *crash)
{
    cp_participant_rows *rows = &crash->participants;
    rows->is_known = true;
    rows->error = calloc(2, sizeof *rows->error);
    rows->function = calloc(2, sizeof *rows->function);
    assert_true(rows->error != NULL && rows->function != NULL);
    rows->error_count = rows->function_count = 2;
    rows->error[0] = (cp_driver_error_row){0, 0, "failed_to_see", "opponent", 2.5, 0.0, true};
    rows->error[1] = (cp_driver_error_row){0, 2, "lane_drift", "everybody", 6.0, 3.5, false};
    rows->function[0] =
        (cp_function_row){0, 0, "aeb", "not_equipped", NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    rows->function[1] =
        (cp_function_row){1, 0, "aeb", "braking", NAN, 1.2, 1.0, NAN, NAN, 8.0, 7.5, 6.25};
    for (int role = 0; role < 2; role++) {
        crash->vehicle[role].mass_kg = 1400 + role;
        crash->vehicle[role].lane = strdup(":j_1_2_0");
        crash->vehicle[role].edge = strdup(":j_1_2");
        crash->vehicle[role].junction = role == 0 ? strdup("j_1") : NULL;
    }
}

static void how_a_crash_came_is_stored(void **state)
{
    small_plan plan;
    cp_error error = {0};
    cp_store *store = open_planned(*state, &plan);
    cp_result_rows results = {.replication_id = plan.replication[0].id};
    assert_ok(cp_claim_take(store, results.replication_id, plan.replication[0].configuration_hash,
                            &SOMEBODY, &results.attempt, &error),
              &error);
    add_crash(&results, 1, 20, 20);
    add_crash(&results, 2, 20, 20); // nothing known of it
    fill_participants(&results.crash[0]);
    cp_crash_vehicle_row *struck = &results.crash[0].vehicle[1];
    struck->intrusion_m = 0.25;
    struck->intrusion_zone = "rear_wheel";
    struck->severity.max_50ms_y_g = 7.5;
    assert_ok(cp_result_rows_commit(store, &results, &error), &error);
    assert_true(number_of(store,
                          "SELECT sum(error_count) FROM crash_vehicle WHERE crash_id % 16384 "
                          "= 0") == 2);
    assert_true(number_of(store,
                          "SELECT count(*) FROM crash_vehicle WHERE crash_id % 16384 = 1 AND "
                          "error_count IS NULL AND lane IS NULL") == 2);
    assert_true(number_of(store,
                          "SELECT count(*) FROM crash_vehicle WHERE mass_kg = 1401 AND role = "
                          "'b' AND lane = ':j_1_2_0' AND edge = ':j_1_2' AND junction IS "
                          "NULL") == 1);
    assert_true(number_of(store,
                          "SELECT count(*) FROM crash_vehicle WHERE intrusion_m = 0.25 AND role = "
                          "'b' AND intrusion_zone = 'rear_wheel' AND max_50ms_y_g = 7.5") == 1);
    assert_true(number_of(store, "SELECT count(*) FROM crash_cause WHERE driver_error = "
                                 "'failed_to_see' AND role = 'a' AND causes = 1 AND began_s = "
                                 "2.5") == 1);
    assert_true(number_of(store, "SELECT count(*) FROM crash_driver_error WHERE number = 2 AND "
                                 "is_cause = 0 AND ended_s = 3.5") == 1);
    assert_true(number_of(store,
                          "SELECT count(*) FROM function_at_contact WHERE role = 'b' AND state "
                          "= 'braking' AND requested_s = 1.2 AND braking_s = 1 AND "
                          "brake_request_m_s2 = 8 AND deceleration_m_s2 = 7.5 AND "
                          "speed_taken_off_m_s = 6.25 AND warned_s IS NULL") == 1);
    cp_result_rows_destroy(&results);
    cp_store_close(store);

    // The other way round: roles change, and the order with them.
    cp_crash_row crash = {0};
    cp_participant_rows swapped;
    fill_participants(&crash);
    assert_ok(cp_participant_rows_copy(&crash.participants, true, &swapped, &error), &error);
    assert_true(swapped.is_known && swapped.error[0].role == 1 && swapped.error[1].role == 1);
    assert_string_equal(swapped.function[0].state, "braking");
    assert_int_equal(swapped.function[0].role, 0);
    assert_int_equal(swapped.function[1].role, 1);
    cp_participant_rows_destroy(&swapped);
    cp_crash_row_destroy(&crash);
}

static void copies_cannot_lie(void **state)
{
    const fixture *f = *state;
    small_plan plan;
    cp_store *store = open_planned(f, &plan);
    double olc_g[] = {20};
    finish_replication_with(store, &plan, 0, olc_g, 1);
    cp_store_close(store);
    static const char *const LIE[] = {"UPDATE crash_vehicle SET variant_id = 1",
                                      "UPDATE crash_vehicle SET crash_type = 'rear-rear'",
                                      "UPDATE crash SET crash_type = 'rear-rear'",
                                      "UPDATE replication SET variant_id = scenario_id",
                                      "UPDATE crash_vehicle SET olc_g = NULL",
                                      "UPDATE crash_vehicle SET frontal = 0"};
    for (size_t k = 0; k < sizeof LIE / sizeof LIE[0]; k++) {
        char command[256];
        snprintf(command, sizeof command, "sqlite3 '%s' \"%s\" 2>/dev/null", f->db, LIE[k]);
        assert_int_not_equal(system(command), 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(commit_is_complete, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(median_counts_censored_below_all, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(lost_claim_writes_nothing, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(failed_commit_writes_nothing, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(pulse_comes_back, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(how_a_crash_came_is_stored, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(copies_cannot_lie, fixture_begin, fixture_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
