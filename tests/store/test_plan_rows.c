/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/fixture.h"

#define DONE "SELECT count(*) FROM replication WHERE status = 'done'"

static void same_plan_again_changes_nothing(void **state)
{
    small_plan plan;
    cp_error error = {0};
    cp_store *store = open_planned(*state, &plan);
    finish_replication_with(store, &plan, 0, NULL, 0);
    assert_ok(cp_plan_rows_write(store, &plan.rows, &error), &error);
    assert_true(number_of(store, "SELECT count(*) FROM replication") == 4);
    assert_true(number_of(store, DONE) == 1);
    cp_store_close(store);
}

static void plan_can_grow_and_shrink_where_nothing_is_done(void **state)
{
    small_plan plan;
    cp_error error = {0};
    cp_store *store = open_planned(*state, &plan);
    finish_replication_with(store, &plan, 0, NULL, 0);
    plan.rows.replication_count = 2;
    assert_ok(cp_plan_rows_write(store, &plan.rows, &error), &error);
    assert_true(number_of(store, "SELECT count(*) FROM replication") == 2);
    plan.rows.replication_count = 4;
    assert_ok(cp_plan_rows_write(store, &plan.rows, &error), &error);
    assert_true(number_of(store, "SELECT count(*) FROM replication") == 4);
    assert_true(number_of(store, DONE) == 1);
    cp_store_close(store);
}

static void contradiction_is_refused_by_name(void **state)
{
    small_plan plan;
    cp_error error = {0};
    cp_store *store = open_planned(*state, &plan);
    finish_replication_with(store, &plan, 1, NULL, 0);
    plan.variant[1].functions = "[{\"function\":\"other\"}]";
    strcpy(plan.replication[1].configuration_hash, "changed");
    assert_int_equal(cp_plan_rows_write(store, &plan.rows, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "variant aeb: functions was '[{\"function\":\"aeb\"}]'"));
    assert_non_null(strstr(error.text, "is now '[{\"function\":\"other\"}]'"));

    // Refused means untouched.
    assert_true(number_of(store, "SELECT count(*) FROM variant WHERE functions LIKE '%other%'") ==
                0);
    cp_store_close(store);
}

// A replication of a counterfactual study depends on treatments that are not its own variant, and
// any on the vehicle models there are.
static void difference_is_found_where_it_is(void **state)
{
    small_plan plan;
    cp_error error = {0};
    cp_store *store = open_planned(*state, &plan);
    finish_replication_with(store, &plan, 0, NULL, 0);
    strcpy(plan.replication[0].configuration_hash, "changed");
    assert_int_equal(cp_plan_rows_write(store, &plan.rows, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "the section counterfactual has changed, or"));
    plan.model.name = "bus";
    assert_int_equal(cp_plan_rows_write(store, &plan.rows, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "vehicle model bus was 'not part of the study'"));
    plan.model.name = "car";
    cp_store_close(store);

    char command[256];
    const fixture *f = *state;
    snprintf(command, sizeof command, "sqlite3 '%s' \"UPDATE study SET design = 'counterfactual'\"",
             f->db);
    assert_int_equal(system(command), 0);
    assert_ok(cp_store_open(f->db, CP_STORE_WRITE, &store, &error), &error);
    plan.rows.study.design = "counterfactual";
    plan.variant[1].functions = "[]";
    assert_int_equal(cp_plan_rows_write(store, &plan.rows, &error), CP_BAD_INPUT);
    assert_non_null(
        strstr(error.text, "treatment aeb was '[{\"function\":\"aeb\"}]', is now '[]'"));
    cp_store_close(store);
}

static void other_seed_is_refused_by_name(void **state)
{
    small_plan plan;
    cp_error error = {0};
    cp_store *store = open_planned(*state, &plan);
    finish_replication_with(store, &plan, 0, NULL, 0);
    plan.rows.study.seed = 8;
    for (size_t k = 0; k < 4; k++) {
        plan.replication[k].seed += 1000;
        plan.replication[k].id = cp_replication_row_id("crossing", plan.variant[k % 2].name, "",
                                                       plan.replication[k].seed);
    }
    assert_int_equal(cp_plan_rows_write(store, &plan.rows, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "seed was '7', is now '8'"));
    cp_store_close(store);
}

static void finished_replications_cannot_be_dropped(void **state)
{
    small_plan plan;
    cp_error error = {0};
    cp_store *store = open_planned(*state, &plan);
    finish_replication_with(store, &plan, 3, NULL, 0);
    plan.rows.replication_count = 2;
    assert_int_equal(cp_plan_rows_write(store, &plan.rows, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "plans it no more"));
    assert_true(number_of(store, DONE) == 1);
    cp_store_close(store);
}

static void comparing_tells_what_is_done_and_changes_nothing(void **state)
{
    small_plan plan;
    cp_error error = {0};
    cp_planned_state known[4];
    size_t dropped = 0;
    cp_store *store = open_planned(*state, &plan);
    finish_replication_with(store, &plan, 2, NULL, 0);
    assert_ok(cp_plan_rows_compare(store, &plan.rows, known, &dropped, &error), &error);
    assert_int_equal(known[0], CP_PLANNED_WAITING);
    assert_int_equal(known[2], CP_PLANNED_DONE);
    assert_int_equal(dropped, 0);

    // One replaced by another: one is new, one would be dropped.
    plan.replication[3].seed = 999;
    plan.replication[3].id = cp_replication_row_id("crossing", "aeb", "", 999);
    assert_ok(cp_plan_rows_compare(store, &plan.rows, known, &dropped, &error), &error);
    assert_int_equal(known[3], CP_PLANNED_NEW);
    assert_int_equal(dropped, 1);

    // A contradiction is an error, and the states are there nevertheless.
    strcpy(plan.replication[2].configuration_hash, "changed");
    assert_int_equal(cp_plan_rows_compare(store, &plan.rows, known, &dropped, &error),
                     CP_BAD_INPUT);
    assert_int_equal(known[2], CP_PLANNED_DONE);
    assert_true(number_of(store, "SELECT count(*) FROM replication WHERE seed = 999") == 0);

    // Of another study nothing is known.
    plan.rows.study.name = "large";
    assert_int_equal(cp_plan_rows_compare(store, &plan.rows, known, &dropped, &error),
                     CP_BAD_INPUT);
    assert_int_equal(known[2], CP_PLANNED_UNKNOWN);
    plan.rows.study.name = "small";

    // A connection that only reads can do it too.
    cp_store *reader = NULL;
    assert_ok(cp_store_open(cp_store_path(store), CP_STORE_READ, &reader, &error), &error);
    strcpy(plan.replication[2].configuration_hash, "configuration 2");
    assert_ok(cp_plan_rows_compare(reader, &plan.rows, known, &dropped, &error), &error);
    cp_store_close(reader);
    cp_store_close(store);
}

static void sweeps_are_rows(void **state)
{
    small_plan plan;
    cp_error error = {0};
    cp_sweep_row sweep[2] = {{true, 0, "crossing", "scenarios.crossing.red_light.share_1", 0.25},
                             {false, 1, "aeb", "variants.aeb.aeb.ttc_s", 1.5}};
    cp_store *store = open_planned(*state, &plan);
    plan.rows.sweep = sweep;
    plan.rows.sweep_count = 2;
    plan.variant[1].functions = "[{\"function\":\"aeb\",\"parameters\":{\"delay_s\":0.1,"
                                "\"ttc_s\":1.5},\"equipment\":{\"van\":0.5}}]";
    assert_ok(cp_plan_rows_write(store, &plan.rows, &error), &error);
    assert_true(number_of(store, "SELECT w.value FROM sweep_value AS w JOIN variant AS v ON v.id = "
                                 "w.owner_id WHERE v.name = 'aeb' AND w.owner = 'variant'") == 1.5);
    assert_true(number_of(store, "SELECT w.value FROM sweep_value AS w JOIN scenario AS s ON s.id "
                                 "= w.owner_id WHERE w.owner = 'scenario'") == 0.25);
    assert_true(number_of(store, "SELECT sum(swept * value) FROM variant_parameter") == 1.5);
    assert_true(number_of(store, "SELECT count(*) FROM variant_parameter WHERE base = 'aeb'") == 3);
    assert_true(number_of(store, "SELECT value FROM variant_parameter WHERE parameter = "
                                 "'equipment.van' AND NOT swept AND variant = 'aeb'") == 0.5);
    plan.rows.sweep_count = 0;
    assert_ok(cp_plan_rows_write(store, &plan.rows, &error), &error);
    assert_true(number_of(store, "SELECT count(*) FROM sweep_value") == 0);
    cp_store_close(store);
}

static void another_study_is_refused(void **state)
{
    small_plan plan;
    cp_error error = {0};
    cp_store *store = open_planned(*state, &plan);
    plan.rows.study.name = "large";
    assert_int_equal(cp_plan_rows_write(store, &plan.rows, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "holds the study 'small', not 'large'"));
    cp_store_close(store);
}

static void id_collision_is_an_error(void **state)
{
    small_plan plan;
    cp_error error = {0};
    cp_store *store = open_planned(*state, &plan);
    plan.replication[0].seed = 12345; // another natural key under the same id
    assert_int_equal(cp_plan_rows_write(store, &plan.rows, &error), CP_STORE_FAILED);
    plan.replication[1].id = plan.replication[2].id;
    assert_int_equal(cp_plan_rows_write(store, &plan.rows, &error), CP_STORE_FAILED);
    cp_store_close(store);
}

static void row_ids_are_fixed_for_good(void **state)
{
    (void)state;
    // printf 'crossing|aeb||100' | sha256sum, first 39 bits
    FILE *shell = popen("printf 'crossing|aeb||100' | sha256sum", "r");
    char hex[12] = "";
    assert_non_null(shell);
    assert_non_null(fgets(hex, sizeof hex, shell));
    while (fgetc(shell) != EOF)
        continue;
    assert_int_equal(pclose(shell), 0);
    assert_true(cp_replication_row_id("crossing", "aeb", "", 100) ==
                (int64_t)(strtoull(hex, NULL, 16) >> 5));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(same_plan_again_changes_nothing, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(plan_can_grow_and_shrink_where_nothing_is_done,
                                        fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(contradiction_is_refused_by_name, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(difference_is_found_where_it_is, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(other_seed_is_refused_by_name, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(finished_replications_cannot_be_dropped, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(comparing_tells_what_is_done_and_changes_nothing,
                                        fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(sweeps_are_rows, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(another_study_is_refused, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(id_collision_is_an_error, fixture_begin, fixture_end),
        cmocka_unit_test(row_ids_are_fixed_for_good),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
