/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/shard.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define PLANNED 23

// Ids in no order, as they are in a plan.
static int64_t id_of(size_t place)
{
    return (int64_t)(place * 7919 % 10007);
}

static void every_place_has_one_shard(void **state)
{
    (void)state;
    const cp_shard whole = {0, 0};
    for (size_t shards = 1; shards <= 5; shards++)
        for (size_t place = 0; place < PLANNED; place++) {
            size_t owners = 0;
            for (size_t number = 1; number <= shards; number++) {
                const cp_shard shard = {number, shards};
                owners += cp_shard_has(&shard, place);
            }
            assert_int_equal(owners, 1);
            assert_true(cp_shard_has(&whole, place));
        }
}

// Of what waits, in its own order; what is not planned is nobody's.
static void what_waits_is_shared_out(void **state)
{
    (void)state;
    cp_replication_row planned[PLANNED];
    for (size_t k = 0; k < PLANNED; k++)
        planned[k] = (cp_replication_row){.id = id_of(k)};
    const cp_plan_rows plan = {.replication = planned, .replication_count = PLANNED};
    size_t kept = 0;
    for (size_t number = 1; number <= 3; number++) {
        int64_t waiting[PLANNED];
        size_t count = 0;
        cp_error error = {0};
        for (size_t k = PLANNED; k-- > 5;)
            waiting[count++] = id_of(k);
        waiting[count++] = -1;
        const cp_shard shard = {number, 3};
        assert_int_equal(cp_shard_keep(&shard, &plan, waiting, &count, &error), CP_OK);
        size_t at = 0;
        for (size_t k = PLANNED; k-- > 5;)
            if (k % 3 == number - 1)
                assert_int_equal(waiting[at++], id_of(k));
        assert_int_equal(at, count);
        kept += count;
    }
    assert_int_equal(kept, PLANNED - 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_place_has_one_shard),
        cmocka_unit_test(what_waits_is_shared_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
