/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/counterfactual_rows.h"

#include "store/fixture.h"

static cp_crash_row crash_of(double closing_speed_m_s, double olc_g_a, double olc_g_b)
{
    cp_result_rows results = {0};
    add_crash(&results, 5.0, olc_g_a, olc_g_b);
    cp_crash_row crash = results.crash[0];
    crash.description.closing_speed_m_s = closing_speed_m_s;
    free(results.crash);
    return crash;
}

static void olc_of_a_crash_is_the_larger_of_the_fronts(void **state)
{
    (void)state;
    cp_crash_row crash = crash_of(20, 15.0, 25.0);
    assert_true(cp_crash_row_olc_g(&crash) == 25.0);
    crash.vehicle[1].side = CP_SIDE_LEFT;
    assert_true(cp_crash_row_olc_g(&crash) == 15.0);
    crash.vehicle[0].severity.olc.status = CP_OLC_NO_DECELERATION;
    assert_true(cp_crash_row_olc_g(&crash) == 0.0);
    crash.vehicle[0].severity.olc.status = CP_OLC_SIMULATION_FAILED;
    assert_true(isnan(cp_crash_row_olc_g(&crash)));
    crash.vehicle[0].side = CP_SIDE_REAR;
    assert_true(isnan(cp_crash_row_olc_g(&crash)));
    cp_crash_row_destroy(&crash);
}

// A baseline replication with two crashes: the first reproduced, mitigated and shown step by step;
// the second without a checkpoint.
static void fill(cp_result_rows *results)
{
    add_crash(results, 10.0, 20.0, 30.0);
    add_crash(results, 20.0, 20.0, 30.0);
    results->counterfactual = calloc(1, sizeof *results->counterfactual);
    assert_non_null(results->counterfactual);
    for (size_t k = 0; k < 2; k++) {
        cp_null_treatment_row *null = cp_counterfactual_rows_add_null(results->counterfactual);
        cp_counterfactual_row *row = cp_counterfactual_rows_add(results->counterfactual);
        assert_true(null != NULL && row != NULL);
        null->crash = row->crash = k;
        null->variant = "baseline";
        row->variant = "aeb";
        null->lead_s = 4.0;
        null->status = k == 0 ? CP_NULL_REPRODUCED : CP_NULL_NO_CHECKPOINT;
        null->checkpoint_s = k == 0 ? 5.0 : NAN;
        row->outcome = row->outcome_olc = k == 0 ? CP_OUTCOME_MITIGATED : CP_OUTCOME_INVALID;
        row->reason = null->status;
        if (k > 0)
            continue;
        row->has_crash = true;
        row->treated = crash_of(8, 10.0, NAN);
        row->sample = calloc(4, sizeof *row->sample);
        assert_non_null(row->sample);
        row->sample_count = 4;
        for (int i = 0; i < 4; i++)
            row->sample[i] =
                (cp_sample_row){.role = i % 2, .time_s = 9 + i / 2, .ttc_s = i < 2 ? NAN : 1.5};
    }
}

static void commit(cp_store *store, const small_plan *plan, cp_result_rows *results)
{
    cp_error error = {0};
    assert_ok(cp_claim_take(store, results->replication_id, plan->replication[0].configuration_hash,
                            &SOMEBODY, &results->attempt, &error),
              &error);
    assert_ok(cp_result_rows_commit(store, results, &error), &error);
    cp_result_rows_destroy(results);
}

static void pairs_are_stored_and_add_up(void **state)
{
    const fixture *f = *state;
    small_plan plan;
    cp_store *store = open_planned(f, &plan);
    cp_result_rows results = {.replication_id = plan.replication[0].id, .counters = strdup("{}")};
    fill(&results);
    commit(store, &plan, &results);
    assert_true(number_of(store, "SELECT count(*) FROM counterfactual_pair") == 2);
    assert_true(number_of(store, "SELECT mitigated + invalid FROM counterfactual_outcomes") == 2);
    assert_true(number_of(store, "SELECT crashes FROM counterfactual_outcomes_by_olc") == 2);
    assert_true(number_of(store, "SELECT sum(reproduced) FROM null_treatment_check") == 1);
    assert_true(number_of(store, "SELECT sum(without_checkpoint) FROM null_treatment_check") == 1);
    assert_true(number_of(store, "SELECT baseline_olc_g FROM counterfactual_pair "
                                 "WHERE outcome = 'mitigated'") == 30);
    assert_true(number_of(store, "SELECT treated_olc_g FROM counterfactual_pair "
                                 "WHERE outcome = 'mitigated'") == 10);
    assert_true(number_of(store, "SELECT treated_closing_speed_m_s FROM counterfactual_pair "
                                 "WHERE outcome = 'mitigated'") == 8);
    assert_true(number_of(store, "SELECT count(*) FROM counterfactual_sample "
                                 "WHERE role = 'b' AND number < 2") == 2);
    assert_true(number_of(store, "SELECT count(ttc_s) FROM counterfactual_sample") == 2);

    // Treated crashes are no crashes of the study.
    assert_true(number_of(store, "SELECT count(*) FROM crash") == 2);
    assert_true(number_of(store, "SELECT sum(crashes) FROM olc_by_variant") == 2);
    cp_store_close(store);
}

static void treatments_without_replications_stay(void **state)
{
    const fixture *f = *state;
    small_plan plan;
    cp_store *store = NULL;
    cp_error error = {0};
    small_plan_fill(&plan);
    plan.rows.study.design = "counterfactual";
    plan.replication[1] = plan.replication[2];
    plan.rows.replication_count = 2;
    assert_ok(cp_store_open(f->db, CP_STORE_CREATE, &store, &error), &error);
    assert_ok(cp_plan_rows_write(store, &plan.rows, &error), &error);
    assert_true(number_of(store, "SELECT count(*) FROM variant") == 2);
    // A treatment planned no more goes.
    plan.rows.variant_count = 1;
    assert_ok(cp_plan_rows_write(store, &plan.rows, &error), &error);
    assert_true(number_of(store, "SELECT count(*) FROM variant") == 1);
    cp_store_close(store);
}

static void an_older_database_is_brought_up_to_date(void **state)
{
    const fixture *f = *state;
    char command[1024];
    cp_store *store = NULL;
    cp_error error = {0};
    const char *source = getenv("CRASHPULSE_SOURCE");
    assert_non_null(source);
    // Schema 001 alone, with a study in it.
    snprintf(command, sizeof command,
             "(cat '%s/db/schema/001_initial.sql'; echo \"INSERT INTO study VALUES (1, 'old', "
             "NULL, 'paired_seeds', 7, 2, 60, 0, 0.05, '{}', 'study: old', '22'); "
             "PRAGMA application_id = 0x43504c53; PRAGMA user_version = 1;\") | sqlite3 '%s'",
             source, f->db);
    assert_int_equal(system(command), 0);
    assert_ok(cp_store_open(f->db, CP_STORE_WRITE, &store, &error), &error);
    assert_true(number_of(store, "PRAGMA user_version") == CP_STORE_VERSION);
    assert_true(number_of(store, "SELECT seed FROM study WHERE name = 'old'") == 7);
    assert_true(number_of(store, "SELECT count(*) FROM counterfactual") == 0);
    cp_store_close(store);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(olc_of_a_crash_is_the_larger_of_the_fronts),
        cmocka_unit_test_setup_teardown(pairs_are_stored_and_add_up, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(treatments_without_replications_stay, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(an_older_database_is_brought_up_to_date, fixture_begin,
                                        fixture_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
