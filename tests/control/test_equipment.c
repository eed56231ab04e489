/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/equipment.h"

#include "control/scripted_road.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

/* Which of the eight cars on the road have it: one bit each. */
static unsigned equipped(cp_equipment equipment, const char *prefix)
{
    cp_traffic *traffic = road_open(0.1);
    cp_error error = {0};
    unsigned bits = 0;
    for (int k = 0; k < ROAD_CARS; k++) {
        char id[16];
        snprintf(id, sizeof id, "%s%d", prefix, k);
        road_add(id, 10.0 * k, 0.0, 0.0, 1.0)->state.type = k % 2;
    }
    assert_int_equal(cp_traffic_step(traffic, &error), CP_OK);
    for (uint32_t k = ROAD_CARS; k-- > 0;) {
        bool has, again;
        assert_int_equal(cp_equipment_has(&equipment, traffic, k, &has, &error), CP_OK);
        assert_int_equal(cp_equipment_has(&equipment, traffic, k, &again, &error), CP_OK);
        assert_int_equal(has, again);
        bits |= (has ? 1u : 0u) << k;
    }
    size_t count = 0;
    for (int k = 0; k < ROAD_CARS; k++)
        count += bits >> k & 1u;
    assert_int_equal(equipment.equipped, count);
    cp_equipment_destroy(&equipment);
    cp_traffic_destroy(traffic);
    return bits;
}

static cp_equipment with(uint64_t seed, double penetration_1)
{
    return (cp_equipment){.key = cp_rng_key_seed(seed), .penetration_1 = penetration_1};
}

static void drawn_by_seed_and_id(void **unused)
{
    (void)unused;
    assert_int_equal(equipped(with(1, 0.0), "car"), 0);
    assert_int_equal(equipped(with(1, 1.0), "car"), 0xff);
    unsigned half = equipped(with(1, 0.5), "car");
    assert_int_equal(equipped(with(1, 0.5), "car"), half);
    assert_int_not_equal(equipped(with(2, 0.5), "car"), half);
    assert_int_not_equal(equipped(with(1, 0.5), "bus"), half);
    // Who has it at half has it at more.
    assert_int_equal(equipped(with(1, 0.8), "car") & half, half);
}

static void shares_by_vehicle_type(void **unused)
{
    (void)unused;
    char type[] = "type1";
    cp_equipment_share share = {type, 0.0};
    cp_equipment equipment = with(1, 1.0);
    equipment.shares = &share;
    equipment.share_count = 1;
    assert_int_equal(equipped(equipment, "car"), 0x55);
    assert_true(cp_equipment_is_any(&equipment));
    equipment.penetration_1 = 0.0;
    assert_false(cp_equipment_is_any(&equipment));
    share.penetration_1 = 1.0;
    assert_true(cp_equipment_is_any(&equipment));
    assert_int_equal(equipped(equipment, "car"), 0xaa);
}

static void only_those_named(void **unused)
{
    (void)unused;
    const char *const only[] = {"car2", "car5"};
    cp_equipment equipment = with(1, 1.0);
    equipment.only = only;
    equipment.only_count = 2;
    assert_int_equal(equipped(equipment, "car"), 0x24);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(drawn_by_seed_and_id),
        cmocka_unit_test(shares_by_vehicle_type),
        cmocka_unit_test(only_those_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
