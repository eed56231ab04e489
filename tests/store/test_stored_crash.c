/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/fixture.h"

#include "pulse/pulse_codec.h"
#include "store/stored_crash.h"

/* A crash goes into the database and comes out of it: simulated again it gives the stored bytes. */

#define CAR "vehicle: car\nparameters:\n  - {name: mass_kg, value: 1500.25}\n"

static cp_crash_configuration oblique(void)
{
    return (cp_crash_configuration){
        .barrier = cp_barrier_default(),
        .vehicle = {{.cog_m = {100.1, 200.2}, .yaw_rad = 0.1, .velocity_m_s = {14.9, 1.495}},
                    {.cog_m = {104.3, 200.9},
                     .yaw_rad = -3.0,
                     .velocity_m_s = {-12.4, -1.77},
                     .yaw_rate_rad_s = 0.05}},
        .side = {CP_SIDE_FRONT, CP_SIDE_FRONT}};
}

// A front-front crash of two equal cars, simulated and committed; its id comes back.
static int64_t commit_simulated(cp_store *store, const small_plan *plan)
{
    cp_error error = {0};
    cp_vehicle_model car;
    cp_crash_result result;
    cp_crash_configuration configuration = oblique();
    cp_crash_options options = cp_crash_options_default();
    options.duration_s = 0.15;
    assert_ok(cp_vehicle_model_parse("car", CAR, strlen(CAR), &car, &error), &error);
    assert_ok(cp_crash_simulate(&car, &car, &configuration, &options, &result, &error), &error);
    cp_result_rows rows = {.replication_id = plan->replication[0].id,
                           .counters = strdup("{}"),
                           .crash_options = cp_crash_options_json(&options)};
    assert_ok(cp_claim_take(store, rows.replication_id, plan->replication[0].configuration_hash,
                            &SOMEBODY, &rows.attempt, &error),
              &error);
    add_crash(&rows, 3.0, 20, 20);
    for (int role = 0; role < 2; role++) {
        cp_crash_vehicle_row *vehicle = &rows.crash[0].vehicle[role];
        cp_pulse record;
        vehicle->body = configuration.vehicle[role];
        assert_ok(cp_pulse_codec_record(&result.pulse[role], &record, &error), &error);
        assert_ok(cp_pulse_encode(&record, &vehicle->pulse, &vehicle->pulse_size, &error), &error);
        vehicle->sample_count = record.sample_count;
        vehicle->sample_interval_s = record.sample_interval_s;
        cp_pulse_destroy(&record);
    }
    assert_ok(cp_result_rows_commit(store, &rows, &error), &error);
    cp_result_rows_destroy(&rows);
    cp_crash_result_destroy(&result);
    return plan->replication[0].id * 16384;
}

static cp_store *open_simulated(const fixture *f, int64_t *id)
{
    small_plan plan;
    cp_error error = {0};
    cp_store *store = NULL;
    small_plan_fill(&plan);
    plan.model.yaml = CAR;
    assert_ok(cp_store_open(f->db, CP_STORE_CREATE, &store, &error), &error);
    assert_ok(cp_plan_rows_write(store, &plan.rows, &error), &error);
    *id = commit_simulated(store, &plan);
    return store;
}

static cp_stored_match simulate_again(cp_store *store, int64_t id)
{
    cp_error error = {0};
    cp_stored_crash crash;
    cp_crash_result result;
    cp_stored_match match;
    assert_ok(cp_stored_crash_read(store, id, NULL, &crash, &error), &error);
    assert_true(crash.model[0].mass_kg == 1500.25);
    assert_true(crash.options.duration_s == 0.15);
    assert_ok(cp_crash_simulate(&crash.model[0], &crash.model[1], &crash.configuration,
                                &crash.options, &result, &error),
              &error);
    assert_ok(cp_stored_crash_compare(store, &crash, &result, &match, &error), &error);
    cp_crash_result_destroy(&result);
    return match;
}

static void same_bytes_come_out(void **state)
{
    int64_t id = 0;
    cp_store *store = open_simulated(*state, &id);
    assert_int_equal(simulate_again(store, id), CP_STORED_SAME_BYTES);
    cp_store_close(store);
}

static void change(const fixture *f, const char *sql)
{
    char command[512];
    snprintf(command, sizeof command, "sqlite3 '%s' \"%s\"", f->db, sql);
    assert_int_equal(system(command), 0);
}

// A slightly faster car has another pulse.
static void another_state_is_noticed(void **state)
{
    int64_t id = 0;
    cp_store *store = open_simulated(*state, &id);
    change(*state, "UPDATE crash_vehicle SET velocity_x_m_s = velocity_x_m_s * 1.001 WHERE role = "
                   "'a'");
    assert_int_equal(simulate_again(store, id), CP_STORED_DIFFERENT);
    cp_store_close(store);
}

static void missing_pulse_is_no_match(void **state)
{
    int64_t id = 0;
    cp_store *store = open_simulated(*state, &id);
    change(*state, "DELETE FROM pulse WHERE role = 'b'");
    assert_int_equal(simulate_again(store, id), CP_STORED_NOTHING);
    cp_store_close(store);
}

static void errors_name_what_is_missing(void **state)
{
    int64_t id = 0;
    cp_error error = {0};
    cp_stored_crash crash;
    cp_store *store = open_simulated(*state, &id);
    assert_int_equal(cp_stored_crash_read(store, 12, NULL, &crash, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "has no crash 12"));
    assert_int_equal(cp_stored_crash_read(store, id, "nothing", &crash, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "has no variant 'nothing'"));
    assert_int_equal(cp_stored_crash_read(store, id, "aeb", &crash, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "became no crash under aeb"));
    change(*state, "UPDATE vehicle_model SET yaml = 'vehicle: car' || char(10) || 'colour: red'");
    assert_int_equal(cp_stored_crash_read(store, id, NULL, &crash, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "vehicle_model car:2: Unexpected key: colour"));
    cp_store_close(store);
}

static int library_begin(void **state)
{
    (void)state;
    return cp_crash_library_begin(NULL) == CP_OK ? 0 : 1;
}

static int library_end(void **state)
{
    (void)state;
    cp_crash_library_end();
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(same_bytes_come_out, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(another_state_is_noticed, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(missing_pulse_is_no_match, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(errors_name_what_is_missing, fixture_begin, fixture_end),
    };
    return cmocka_run_group_tests(tests, library_begin, library_end);
}
