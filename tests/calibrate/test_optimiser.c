/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"

#include "calibrate/optimiser.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// A bowl with its bottom at 0.1, 0.2, 0.3, ...
static double bowl(void *context, const double *point, size_t dimension)
{
    size_t *calls = context;
    (*calls)++;
    double value = 0.0;
    for (size_t k = 0; k < dimension; k++)
        value += (point[k] - 0.1 * (double)(k + 1)) * (point[k] - 0.1 * (double)(k + 1));
    return value;
}

static cp_optimiser_settings settings_of(const char *algorithm, size_t *calls)
{
    return (cp_optimiser_settings){.algorithm = algorithm,
                                   .dimension = 5,
                                   .population = 20,
                                   .seed = 7,
                                   .function = bowl,
                                   .context = calls};
}

static double best_after(const char *algorithm, size_t generations, double point[5])
{
    size_t calls = 0;
    cp_optimiser_settings settings = settings_of(algorithm, &calls);
    cp_optimiser *optimiser = NULL;
    cp_error error = {0};
    assert_int_equal(cp_optimiser_create(&settings, &optimiser, &error), CP_OK);
    for (size_t g = 0; g < generations; g++)
        assert_int_equal(cp_optimiser_evolve(optimiser, &error), CP_OK);
    double best = cp_optimiser_best(optimiser, point);
    cp_optimiser_destroy(optimiser);
    return best;
}

static void every_algorithm_finds_the_bottom(void **state)
{
    (void)state;
    double point[5];
    assert_true(best_after("de", 300, point) < 1e-4);
    assert_near(point[2], 0.3, 0.02);
    assert_true(best_after("sade", 300, point) < 1e-4);
    assert_true(best_after("cmaes", 10, point) < 1e-4);
}

static void the_same_seed_goes_the_same_way(void **state)
{
    (void)state;
    double one[5], two[5];
    assert_near(best_after("sade", 30, one), best_after("sade", 30, two), 0.0);
    assert_memory_equal(one, two, sizeof one);
}

static void a_restored_search_goes_on_as_if_never_stopped(void **state)
{
    (void)state;
    char path[] = "/tmp/optimiser_XXXXXX";
    int descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    close(descriptor);
    const char *const algorithms[] = {"de", "sade", "cmaes"};
    for (int a = 0; a < 3; a++) {
        size_t calls = 0;
        cp_optimiser_settings settings = settings_of(algorithms[a], &calls);
        cp_optimiser *first = NULL, *second = NULL;
        cp_error error = {0};
        double straight[5], resumed[5];
        best_after(algorithms[a], 12, straight);
        assert_int_equal(cp_optimiser_create(&settings, &first, &error), CP_OK);
        for (int g = 0; g < 5; g++)
            assert_int_equal(cp_optimiser_evolve(first, &error), CP_OK);
        assert_int_equal(cp_optimiser_save(first, path, &error), CP_OK);
        cp_optimiser_destroy(first);
        assert_int_equal(cp_optimiser_restore(&settings, path, &second, &error), CP_OK);
        assert_int_equal(cp_optimiser_generation(second), 5);
        for (int g = 5; g < 12; g++)
            assert_int_equal(cp_optimiser_evolve(second, &error), CP_OK);
        cp_optimiser_best(second, resumed);
        cp_optimiser_destroy(second);
        for (int k = 0; k < 5; k++)
            assert_near(resumed[k], straight[k], 1e-15);
    }
    unlink(path);
}

static void wrong_settings_are_refused(void **state)
{
    (void)state;
    size_t calls = 0;
    cp_optimiser_settings settings = settings_of("gradient", &calls);
    cp_optimiser *optimiser = NULL;
    cp_error error = {0};
    assert_int_equal(cp_optimiser_create(&settings, &optimiser, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "gradient"));
    settings = settings_of("de", &calls);
    settings.population = 3;
    assert_int_equal(cp_optimiser_create(&settings, &optimiser, &error), CP_BAD_INPUT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_algorithm_finds_the_bottom),
        cmocka_unit_test(the_same_seed_goes_the_same_way),
        cmocka_unit_test(a_restored_search_goes_on_as_if_never_stopped),
        cmocka_unit_test(wrong_settings_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
