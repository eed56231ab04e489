/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"

#include "calibrate/drawn_starts.h"

#include <math.h>
#include <string.h>

enum { DIMENSION = 8 };

/* What a search does, counted. */
typedef struct ground {
    size_t calls;
    size_t descents;
    size_t fails_at;               /* that descent; 0: none */
    size_t evaluations[64];        /* of every descent */
    double first_point[DIMENSION]; /* where the first began */
} ground;

// A bowl with its bottom at 0.8 and five valleys across each coordinate.
static double value(void *context, const double *p, size_t dimension)
{
    ground *g = context;
    g->calls++;
    double sum = 0.0;
    for (size_t k = 0; k < dimension; k++) {
        assert_true(p[k] >= 0.0 && p[k] <= 1.0);
        double away = p[k] - 0.8;
        sum += away * away + 0.05 * (1.0 - cos(10.0 * 3.14159265358979 * away));
    }
    return sum;
}

// Down the slope, coordinate by coordinate, with shrinking steps: never out of a valley.
static cp_status descend(void *context, size_t evaluations, double *point)
{
    ground *g = context;
    if (g->descents == 0)
        memcpy(g->first_point, point, sizeof g->first_point);
    g->evaluations[g->descents++] = evaluations;
    if (g->descents == g->fails_at)
        return CP_RUN_FAILED;
    size_t last = g->calls + evaluations;
    double best = value(g, point, DIMENSION);
    for (double step = 0.03; g->calls + 2 * DIMENSION < last; step *= 0.8)
        for (size_t k = 0; k < DIMENSION; k++)
            for (int sign = -1; sign <= 1; sign += 2) {
                double was = point[k];
                point[k] = fmin(1.0, fmax(0.0, was + sign * step));
                double now = value(g, point, DIMENSION);
                if (now < best)
                    best = now;
                else
                    point[k] = was;
            }
    return CP_OK;
}

static const double KNOWN[DIMENSION] = {0.35, 0.4, 0.6, 0.2, 0.5, 0.45, 0.3, 0.65};

static double breed(ground *g, size_t count, size_t offspring, uint32_t seed, double *point)
{
    cp_error error = {0};
    cp_drawn_starts starts = {.value = value,
                              .descend = descend,
                              .context = g,
                              .known = KNOWN,
                              .dimension = DIMENSION,
                              .count = count,
                              .offspring = offspring,
                              .evaluations = 1600,
                              .seed = seed};
    assert_int_equal(cp_drawn_starts_search(&starts, point, &error), CP_OK);
    return value(g, point, DIMENSION);
}

static double search(ground *g, size_t count, uint32_t seed, double *point)
{
    return breed(g, count, 0, seed, point);
}

static void one_start_goes_down_from_what_is_known(void **state)
{
    (void)state;
    ground searched = {0}, alone = {0};
    double found[DIMENSION], expected[DIMENSION];
    search(&searched, 1, 5, found);
    memcpy(expected, KNOWN, sizeof expected);
    assert_int_equal(descend(&alone, 1600, expected), CP_OK);
    assert_memory_equal(found, expected, sizeof found);
    assert_int_equal(searched.descents, 1);
}

static void drawn_starts_find_a_deeper_valley(void **state)
{
    (void)state;
    ground one = {0}, many = {0};
    double point[DIMENSION];
    double trapped = search(&one, 1, 5, point);
    double found = search(&many, 16, 5, point);
    assert_true(trapped > 0.1);
    assert_true(found < 0.5 * trapped);
    assert_memory_equal(many.first_point, KNOWN, sizeof KNOWN);
}

// Six with an eighth of the evaluations, two with a quarter, the last with all.
static void quarters_are_left_and_go_further(void **state)
{
    (void)state;
    const size_t EXPECTED[] = {200, 200, 200, 200, 200, 200, 400, 400, 1600};
    ground g = {0};
    double point[DIMENSION];
    search(&g, 6, 5, point);
    assert_int_equal(g.descents, sizeof EXPECTED / sizeof *EXPECTED);
    assert_int_equal(g.descents, cp_drawn_starts_descents(6, 0));
    assert_memory_equal(g.evaluations, EXPECTED, sizeof EXPECTED);
}

// Every start and every child with an eighth of the evaluations, the best of all with all.
static void offspring_go_down_like_their_parents(void **state)
{
    (void)state;
    const size_t EXPECTED[] = {200, 200, 200, 200, 200, 200, 200, 1600};
    ground g = {0};
    double point[DIMENSION];
    breed(&g, 3, 4, 5, point);
    assert_int_equal(g.descents, sizeof EXPECTED / sizeof *EXPECTED);
    assert_int_equal(g.descents, cp_drawn_starts_descents(3, 4));
    assert_memory_equal(g.evaluations, EXPECTED, sizeof EXPECTED);
    assert_memory_equal(g.first_point, KNOWN, sizeof KNOWN);
}

// From several seeds: children come deeper than as many more drawn starts, and never end above what
// their parents alone come to.
static void offspring_find_what_starts_do_not(void **state)
{
    (void)state;
    int deeper = 0, shallower = 0;
    for (uint32_t seed = 1; seed <= 20; seed++) {
        ground g[3] = {{0}};
        double point[DIMENSION];
        double parents = search(&g[0], 10, seed, point);
        double bred = breed(&g[1], 10, 20, seed, point);
        double drawn = search(&g[2], 30, seed, point);
        assert_true(bred <= parents + 1e-3);
        deeper += bred < drawn - 1e-3;
        shallower += bred > drawn + 1e-3;
    }
    assert_true(deeper > 2 * shallower);
}

static void offspring_are_the_same_bits_by_the_same_seed(void **state)
{
    (void)state;
    ground g[3] = {{0}};
    double one[DIMENSION], again[DIMENSION], other[DIMENSION];
    breed(&g[0], 4, 6, 5, one);
    breed(&g[1], 4, 6, 5, again);
    breed(&g[2], 4, 6, 6, other);
    assert_memory_equal(one, again, sizeof one);
    assert_memory_not_equal(one, other, sizeof one);
}

static void a_seed_gives_the_same_bits(void **state)
{
    (void)state;
    ground g[3] = {{0}};
    double one[DIMENSION], again[DIMENSION], other[DIMENSION];
    search(&g[0], 9, 5, one);
    search(&g[1], 9, 5, again);
    search(&g[2], 9, 6, other);
    assert_memory_equal(one, again, sizeof one);
    assert_memory_not_equal(one, other, sizeof one);
    assert_int_equal(g[0].calls, g[1].calls);
}

static void a_descent_that_fails_ends_the_search(void **state)
{
    (void)state;
    ground g = {.fails_at = 3};
    double point[DIMENSION];
    cp_error error = {0};
    cp_drawn_starts starts = {.value = value,
                              .descend = descend,
                              .context = &g,
                              .known = KNOWN,
                              .dimension = DIMENSION,
                              .count = 5,
                              .evaluations = 1600,
                              .seed = 5};
    assert_int_equal(cp_drawn_starts_search(&starts, point, &error), CP_RUN_FAILED);
    assert_int_equal(g.descents, 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_start_goes_down_from_what_is_known),
        cmocka_unit_test(drawn_starts_find_a_deeper_valley),
        cmocka_unit_test(quarters_are_left_and_go_further),
        cmocka_unit_test(offspring_go_down_like_their_parents),
        cmocka_unit_test(offspring_find_what_starts_do_not),
        cmocka_unit_test(offspring_are_the_same_bits_by_the_same_seed),
        cmocka_unit_test(a_seed_gives_the_same_bits),
        cmocka_unit_test(a_descent_that_fails_ends_the_search),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
