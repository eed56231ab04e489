/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/plot.h"

#include "core/file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "report/small_study.h"

typedef struct fixture {
    cp_store *store;
    cp_study_data data;
    cp_comparison comparison;
} fixture;

static int set_up(void **state)
{
    static fixture f;
    cp_error error = {0};
    cp_comparison_options options = {.repetitions = 20, .permutations = 0};
    f = (fixture){.store = open_small_study()};
    if (cp_study_data_read(f.store, &f.data, &error) != CP_OK ||
        cp_compare(&f.data, 0, (cp_slice){CP_SLICE_ALL, CP_SLICE_ALL, NULL}, &options,
                   &f.comparison, &error) != CP_OK)
        fail_msg("%s", error.text);
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    cp_comparison_destroy(&f->comparison);
    cp_study_data_destroy(&f->data);
    cp_store_close(f->store);
    return 0;
}

// gnuplot itself draws every kind that this study has; a picture names every variant.
static void every_kind_is_drawn(void **state)
{
    fixture *f = *state;
    static const cp_plot_kind KIND[] = {CP_PLOT_RATES,  CP_PLOT_OLC,   CP_PLOT_DIFFERENCE,
                                        CP_PLOT_MAP,    CP_PLOT_SITES, CP_PLOT_SEVERITY,
                                        CP_PLOT_BENEFIT};
    for (size_t k = 0; k < sizeof KIND / sizeof *KIND; k++) {
        cp_error error = {0};
        char *svg = NULL;
        size_t size = 0;
        if (cp_plot_write(f->store, &f->data, &f->comparison, CP_SCOPE_ALL, KIND[k],
                          "test_plot.svg", &error) != CP_OK ||
            cp_file_read("test_plot.svg", &svg, &size, &error) != CP_OK)
            fail_msg("kind %zu: %s", k, error.text);
        assert_non_null(strstr(svg, "<svg"));
        assert_non_null(strstr(svg, "</svg>"));
        assert_non_null(strstr(svg, "aeb"));
        assert_null(strstr(svg, "NaN"));
        free(svg);
        unlink("test_plot.svg");
    }
    cp_error error = {0};
    char *pdf = NULL;
    size_t size = 0;
    assert_int_equal(cp_plot_write(f->store, &f->data, &f->comparison, CP_SCOPE_INSIDE, CP_PLOT_OLC,
                                   "test_plot.pdf", &error),
                     CP_OK);
    assert_int_equal(cp_file_read("test_plot.pdf", &pdf, &size, &error), CP_OK);
    assert_memory_equal(pdf, "%PDF-", 5);
    free(pdf);
    unlink("test_plot.pdf");
}

// The data of a figure are those of the comparison.
static void data_hold_the_figures(void **state)
{
    fixture *f = *state;
    cp_error error = {0};
    char *data = NULL, wanted[64];
    assert_int_equal(cp_plot_data(f->store, &f->data, &f->comparison, CP_SCOPE_ALL, CP_PLOT_RATES,
                                  &data, &error),
                     CP_OK);
    for (size_t k = 0; k < 2; k++) {
        const cp_variant_figures *v = &f->comparison.variant[k];
        snprintf(wanted, sizeof wanted, "\t%.9g\t%zu\t%.9g\t%.9g\n", v->rate, k,
                 v->rate_widened.low, v->rate_widened.high);
        assert_non_null(strstr(data, wanted));
    }
    free(data);
}

// Names are drawn as they stand: no shell, no gnuplot and no markup takes them for its own.
static void names_are_never_commands(void **state)
{
    static char *const NAME[] = {"`touch owned`",         "\"; system \"touch owned\"; #",
                                 "$(touch owned)",        "EOD\n!touch owned\n",
                                 "%s %n {/Bold x} \\042", "@owned"};
    fixture *f = *state;
    cp_error error = {0};
    cp_study_variant *variant = &f->data.variant[f->comparison.variant[1].variant];
    cp_study_risk *risk = &f->data.risk[0];
    cp_study_variant variant_before = *variant;
    cp_study_risk risk_before = *risk;
    for (size_t n = 0; n < sizeof NAME / sizeof *NAME; n++) {
        variant->name = risk->name = risk->level = NAME[n];
        for (int kind = 0; kind < CP_PLOT_KIND_COUNT; kind++) {
            if (kind == CP_PLOT_OUTCOMES || kind == CP_PLOT_CORRIDOR)
                continue; // not of this study
            char *svg = NULL;
            size_t size = 0;
            if (cp_plot_write(f->store, &f->data, &f->comparison, CP_SCOPE_ALL, (cp_plot_kind)kind,
                              "`touch owned`\" \".svg", &error) != CP_OK ||
                cp_file_read("`touch owned`\" \".svg", &svg, &size, &error) != CP_OK)
                fail_msg("kind %d: %s", kind, error.text);
            assert_non_null(strstr(svg, "</svg>"));
            if (NAME[n][0] == '`' || NAME[n][0] == '$' || NAME[n][0] == '@')
                assert_non_null(strstr(svg, NAME[n]));
            free(svg);
            unlink("`touch owned`\" \".svg");
            assert_int_equal(access("owned", F_OK), -1);
        }
    }
    *variant = variant_before;
    *risk = risk_before;
}

static void what_cannot_be_drawn_is_said(void **state)
{
    fixture *f = *state;
    cp_error error = {0};
    assert_int_equal(cp_plot_write(f->store, &f->data, &f->comparison, CP_SCOPE_ALL, CP_PLOT_RATES,
                                   "test_plot.png", &error),
                     CP_BAD_INPUT);
    assert_non_null(strstr(error.text, ".svg or .pdf"));
    assert_int_equal(cp_plot_write(f->store, &f->data, &f->comparison, CP_SCOPE_ALL,
                                   CP_PLOT_OUTCOMES, "test_plot.svg", &error),
                     CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "counterfactual"));
    // No pulses are stored in the invented study.
    assert_int_equal(cp_plot_write(f->store, &f->data, &f->comparison, CP_SCOPE_ALL,
                                   CP_PLOT_CORRIDOR, "test_plot.svg", &error),
                     CP_BAD_INPUT);
    assert_int_equal(access("test_plot.svg", F_OK), -1);
    assert_int_equal(cp_plot_write(f->store, &f->data, &f->comparison, CP_SCOPE_ALL, CP_PLOT_RATES,
                                   "no_such_folder/test.svg", &error),
                     CP_IO_FAILED);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_is_drawn),
        cmocka_unit_test(data_hold_the_figures),
        cmocka_unit_test(names_are_never_commands),
        cmocka_unit_test(what_cannot_be_drawn_is_said),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
