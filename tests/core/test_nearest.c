/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/nearest.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static const char *const NAMES[] = {"duration_s", "step_length_s", "seed", "aeb", "elk",
                                    NULL,         "replications"};
#define COUNT (sizeof NAMES / sizeof *NAMES)

static void misspelt_words_have_the_name_meant(void **state)
{
    (void)state;
    const struct {
        const char *word, *meant;
    } CASE[] = {{"duration", "duration_s"},
                {"duraton_s", "duration_s"},
                {"duration_ms", "duration_s"},
                {"step-length-s", "step_length_s"},
                {"Seed", "seed"},
                {"sede", "seed"},
                {"abe", "aeb"},
                {"replication", "replications"},
                {"step_lenght_s", "step_length_s"}};
    for (size_t k = 0; k < sizeof CASE / sizeof *CASE; k++) {
        const char *found = cp_nearest(CASE[k].word, NAMES, COUNT);
        assert_non_null(found);
        assert_string_equal(found, CASE[k].meant);
    }
}

static void words_far_from_all_have_none(void **state)
{
    (void)state;
    static const char *const WORDS[] = {"", "x", "colour", "abc", "networks", "e"};
    char text[CP_NEAREST_TEXT_SIZE];
    char endless[200];
    memset(endless, 'a', sizeof endless - 1);
    endless[sizeof endless - 1] = '\0';
    for (size_t k = 0; k < sizeof WORDS / sizeof *WORDS; k++)
        assert_null(cp_nearest(WORDS[k], NAMES, COUNT));
    assert_null(cp_nearest(endless, NAMES, COUNT));
    assert_string_equal(cp_nearest_text("colour", NAMES, COUNT, text), "");
    assert_string_equal(cp_nearest_text("sed", NAMES, COUNT, text), "; did you mean 'seed'?");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(misspelt_words_have_the_name_meant),
        cmocka_unit_test(words_far_from_all_have_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
