/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/fixture.h"

static int take(cp_store *store, const small_plan *plan, size_t k)
{
    cp_error error = {0};
    int attempt = -1;
    assert_ok(cp_claim_take(store, plan->replication[k].id, plan->replication[k].configuration_hash,
                            &SOMEBODY, &attempt, &error),
              &error);
    return attempt;
}

static bool nobody_lives(const cp_owner *owner)
{
    assert_string_equal(owner->host, SOMEBODY.host);
    assert_int_equal(owner->pid, SOMEBODY.pid);
    assert_int_equal(owner->process_start, SOMEBODY.process_start);
    return false;
}

static bool everybody_lives(const cp_owner *owner)
{
    (void)owner;
    return true;
}

static void queue_is_in_order_of_number(void **state)
{
    small_plan plan;
    cp_error error = {0};
    int64_t *ids = NULL;
    size_t count = 0;
    cp_store *store = open_planned(*state, &plan);
    assert_ok(cp_claim_waiting(store, &ids, &count, &error), &error);
    assert_int_equal(count, 4);
    for (size_t k = 0; k < 4; k++)
        assert_true(ids[k] == plan.replication[k].id);
    free(ids);
    cp_store_close(store);
}

static void a_claim_is_exclusive(void **state)
{
    small_plan plan;
    cp_error error = {0};
    int64_t *ids = NULL;
    size_t count = 0;
    cp_store *store = open_planned(*state, &plan);
    assert_int_equal(take(store, &plan, 0), 1);
    assert_int_equal(take(store, &plan, 0), 0);
    assert_ok(cp_claim_waiting(store, &ids, &count, &error), &error);
    assert_int_equal(count, 3);
    free(ids);
    cp_store_close(store);
}

static void changed_configuration_is_not_claimed(void **state)
{
    small_plan plan;
    cp_error error = {0};
    int attempt = 0;
    cp_store *store = open_planned(*state, &plan);
    assert_int_equal(
        cp_claim_take(store, plan.replication[0].id, "another", &SOMEBODY, &attempt, &error),
        CP_BAD_INPUT);
    assert_int_equal(attempt, 0);
    assert_true(number_of(store, "SELECT count(*) FROM attempt") == 0);
    cp_store_close(store);
}

static void dead_owners_lose_their_claims(void **state)
{
    small_plan plan;
    cp_error error = {0};
    size_t released = 0;
    cp_store *store = open_planned(*state, &plan);
    take(store, &plan, 0);
    take(store, &plan, 1);
    assert_ok(cp_claim_release_dead(store, everybody_lives, &released, &error), &error);
    assert_int_equal(released, 0);
    assert_int_equal(take(store, &plan, 0), 0);
    assert_ok(cp_claim_release_dead(store, nobody_lives, &released, &error), &error);
    assert_int_equal(released, 2);
    assert_true(number_of(store, "SELECT count(*) FROM attempt WHERE outcome = 'lost'") == 2);
    assert_int_equal(take(store, &plan, 0), 2);
    cp_store_close(store);
}

static void failure_keeps_its_message_and_can_be_tried_again(void **state)
{
    small_plan plan;
    cp_error error = {0};
    bool ended = false;
    cp_store *store = open_planned(*state, &plan);
    take(store, &plan, 0);
    assert_ok(cp_claim_end_of(store, plan.replication[0].id, SOMEBODY.host, SOMEBODY.pid,
                              CP_CLAIM_FAILED, 1.5, "SUMO's last words", &ended, &error),
              &error);
    assert_true(ended);
    assert_true(number_of(store, "SELECT count(*) FROM replication WHERE status = 'failed'") == 1);
    assert_true(number_of(store, "SELECT count(*) FROM attempt WHERE message = 'SUMO''s last "
                                 "words' AND wall_time_s = 1.5") == 1);

    // It is over: nothing more to end.
    assert_ok(cp_claim_end_of(store, plan.replication[0].id, SOMEBODY.host, SOMEBODY.pid,
                              CP_CLAIM_FAILED, 1.5, NULL, &ended, &error),
              &error);
    assert_false(ended);
    assert_int_equal(take(store, &plan, 0), 2);
    cp_store_close(store);
}

static void failure_before_the_claim_is_recorded(void **state)
{
    small_plan plan;
    cp_error error = {0};
    cp_store *store = open_planned(*state, &plan);
    assert_ok(
        cp_claim_record_failure(store, plan.replication[2].id, &SOMEBODY, 0.1, "no start", &error),
        &error);
    assert_true(number_of(store, "SELECT count(*) FROM attempt WHERE outcome = 'failed'") == 1);
    finish_replication_with(store, &plan, 2, NULL, 0);
    assert_ok(
        cp_claim_record_failure(store, plan.replication[2].id, &SOMEBODY, 0.1, "too late", &error),
        &error);
    assert_true(number_of(store, "SELECT count(*) FROM replication WHERE status = 'done'") == 1);
    assert_true(number_of(store, "SELECT count(*) FROM attempt") == 2);
    cp_store_close(store);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(queue_is_in_order_of_number, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(a_claim_is_exclusive, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(changed_configuration_is_not_claimed, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(dead_owners_lose_their_claims, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(failure_keeps_its_message_and_can_be_tried_again,
                                        fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(failure_before_the_claim_is_recorded, fixture_begin,
                                        fixture_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
