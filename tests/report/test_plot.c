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
static void script_holds_the_figures(void **state)
{
    fixture *f = *state;
    cp_error error = {0};
    char *script = NULL, wanted[64];
    assert_int_equal(cp_plot_script(f->store, &f->data, &f->comparison, CP_SCOPE_ALL, CP_PLOT_RATES,
                                    &script, &error),
                     CP_OK);
    for (size_t k = 0; k < 2; k++) {
        const cp_variant_figures *v = &f->comparison.variant[k];
        snprintf(wanted, sizeof wanted, "%.9g %zu %.9g %.9g\n", v->rate, k, v->rate_widened.low,
                 v->rate_widened.high);
        assert_non_null(strstr(script, wanted));
    }
    free(script);
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
        cmocka_unit_test(script_holds_the_figures),
        cmocka_unit_test(what_cannot_be_drawn_is_said),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
