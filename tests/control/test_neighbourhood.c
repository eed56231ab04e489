/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/neighbourhood.h"

#include "core/rng.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

#define CARS 500

static void count_visit(void *context, const cp_vehicle_motion *motion)
{
    int *visits = context;
    visits[motion->after.vehicle]++;
}

static void everybody_near_is_visited_once(void **unused)
{
    (void)unused;
    static cp_vehicle_motion motions[CARS];
    cp_rng_key key = cp_rng_key_seed(3);
    for (uint32_t k = 0; k < CARS; k++)
        motions[k].after = (cp_vehicle_state){
            .vehicle = k,
            .front_x_m = 1000.0 * cp_rng_uniform(key, 2 * k) - 500.0,
            .front_y_m = 1000.0 * cp_rng_uniform(key, 2 * k + 1) - 500.0,
        };
    cp_neighbourhood neighbourhood = {0};
    cp_error error = {0};
    // Growing fills, as traffic does.
    for (size_t count = 0; count <= CARS; count += 100) {
        assert_int_equal(cp_neighbourhood_fill(&neighbourhood, 90.0, motions, count, &error),
                         CP_OK);
        for (size_t k = 0; k < count; k++) {
            const cp_vehicle_state *own = &motions[k].after;
            int visits[CARS] = {0};
            cp_neighbourhood_visit(&neighbourhood, own->front_x_m, own->front_y_m, count_visit,
                                   visits);
            for (size_t i = 0; i < count; i++) {
                const cp_vehicle_state *other = &motions[i].after;
                bool is_near = hypot(other->front_x_m - own->front_x_m,
                                     other->front_y_m - own->front_y_m) <= 90.0;
                assert_int_equal(visits[i], is_near);
            }
        }
    }
    cp_neighbourhood_clear(&neighbourhood);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(everybody_near_is_visited_once)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
