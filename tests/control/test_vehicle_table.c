/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/vehicle_table.h"

#include "control/scripted_road.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

/* What is kept: a number, and memory of its own. */
typedef struct note {
    int number;
    int *owned;
} note;

static int released;

static void release(void *item)
{
    note *own = item;
    free(own->owned);
    released++;
}

static note *take(cp_vehicle_table *table, uint32_t vehicle)
{
    void *item;
    cp_error error = {0};
    assert_int_equal(cp_vehicle_table_take(table, vehicle, &item, &error), CP_OK);
    return item;
}

static cp_traffic *open_road(void)
{
    cp_error error = {0};
    cp_traffic *traffic = road_open(0.1);
    for (int k = 0; k < ROAD_CARS; k++) {
        char id[16];
        snprintf(id, sizeof id, "car%d", k);
        road_add(id, 10.0 * k, 0.0, 0.0, 1.0);
    }
    assert_int_equal(cp_traffic_step(traffic, &error), CP_OK);
    return traffic;
}

static void what_is_kept_of_a_vehicle_is_found_again(void **unused)
{
    (void)unused;
    cp_vehicle_table table = cp_vehicle_table_create(sizeof(note), NULL);
    assert_null(cp_vehicle_table_find(&table, 3));
    // In any order, more than there is room for at first.
    for (uint32_t k = 0; k < 300; k++) {
        note *fresh = take(&table, k * 7 % 300 + 1000);
        assert_true(fresh->number == 0 && fresh->owned == NULL);
        fresh->number = (int)k;
    }
    for (uint32_t k = 0; k < 300; k++) {
        const note *kept = cp_vehicle_table_find(&table, k * 7 % 300 + 1000);
        assert_non_null(kept);
        assert_int_equal(kept->number, k);
        assert_ptr_equal(take(&table, k * 7 % 300 + 1000), kept);
    }
    assert_int_equal(table.count, 300);
    cp_vehicle_table_destroy(&table);
    assert_null(cp_vehicle_table_find(&table, 1000));
}

// Whoever goes is dropped with what his item owns, the others stay; who comes back begins anew.
static void of_those_who_go_nothing_is_kept(void **unused)
{
    (void)unused;
    cp_error error = {0};
    for (unsigned gone = 0; gone < 1u << ROAD_CARS; gone += 5) {
        cp_traffic *traffic = open_road();
        cp_vehicle_table table = cp_vehicle_table_create(sizeof(note), release);
        for (uint32_t k = 0; k < ROAD_CARS; k++)
            *take(&table, k) = (note){(int)k, malloc(sizeof(int))};
        released = 0;
        int leave = 0;
        for (uint32_t k = 0; k < ROAD_CARS; k++) {
            road.cars[k].is_there = !(gone >> k & 1u);
            leave += !road.cars[k].is_there;
        }
        assert_int_equal(cp_traffic_step(traffic, &error), CP_OK);
        assert_int_equal(cp_vehicle_table_prune(&table, traffic, &error), CP_OK);
        assert_int_equal(released, leave);
        assert_int_equal(table.count, ROAD_CARS - leave);
        for (uint32_t k = 0; k < ROAD_CARS; k++) {
            const note *kept = cp_vehicle_table_find(&table, k);
            assert_int_equal(kept == NULL, gone >> k & 1u);
            if (kept != NULL)
                assert_int_equal(kept->number, k);
            else
                assert_int_equal(take(&table, k)->number, 0);
        }
        cp_vehicle_table_destroy(&table);
        assert_int_equal(released, leave + ROAD_CARS);
        cp_traffic_destroy(traffic);
    }
}

// Vehicles come and go for long: no more room than for those there at once.
static void hours_take_no_more_room(void **unused)
{
    (void)unused;
    cp_error error = {0};
    cp_traffic *traffic = open_road();
    cp_vehicle_table table = cp_vehicle_table_create(sizeof(note), NULL);
    for (uint32_t k = 0; k < 100000; k++) {
        take(&table, ROAD_CARS + k); // never on the road
        assert_int_equal(cp_vehicle_table_prune(&table, traffic, &error), CP_OK);
    }
    assert_int_equal(table.count, 0);
    assert_true(table.capacity <= 64 && table.row_of.room <= 256);
    cp_vehicle_table_destroy(&table);
    cp_traffic_destroy(traffic);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_kept_of_a_vehicle_is_found_again),
        cmocka_unit_test(of_those_who_go_nothing_is_kept),
        cmocka_unit_test(hours_take_no_more_room),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
