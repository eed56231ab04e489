/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/plot.h"

#include "analysis/comparison.h"
#include "core/file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "builders/small_study.h"

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
    static const cp_plot_kind KIND[] = {CP_PLOT_RATES,     CP_PLOT_OLC,        CP_PLOT_DIFFERENCE,
                                        CP_PLOT_MAP,       CP_PLOT_SITES,      CP_PLOT_SEVERITY,
                                        CP_PLOT_BENEFIT,   CP_PLOT_FOREST,     CP_PLOT_DELTA_V,
                                        CP_PLOT_ABOVE_OLC, CP_PLOT_CONVERGENCE};
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

static char *data_of(fixture *f, cp_plot_kind kind, int scope)
{
    cp_error error = {0};
    char *data = NULL;
    if (cp_plot_data(f->store, &f->data, &f->comparison, scope, kind, &data, &error) != CP_OK)
        fail_msg("%s", error.text);
    return data;
}

static size_t count_of(const char *text, const char *what)
{
    size_t count = 0;
    for (const char *c = text; (c = strstr(c, what)) != NULL; c += strlen(what))
        count++;
    return count;
}

// A row a scenario, each compared by itself, and the stratified ratio of all.
static void the_forest_has_every_scenario_and_all(void **state)
{
    fixture *f = *state;
    char *data = data_of(f, CP_PLOT_FOREST, CP_SCOPE_ALL), wanted[128];
    const cp_contrast_figures *all = &f->comparison.contrast[0];
    cp_interval interval = cp_rate_ratio_interval(all);
    snprintf(wanted, sizeof wanted, "\"aeb: all, stratified\"\t%.9g\t%zu\t%.9g\t%.9g\n",
             all->rate_ratio, f->data.scenario_count, interval.low, interval.high);
    assert_non_null(strstr(data, wanted));
    for (size_t s = 0; s < f->data.scenario_count; s++) {
        cp_comparison own;
        cp_error error = {0};
        cp_comparison_options options = {.repetitions = 20};
        assert_int_equal(
            cp_compare(&f->data, 0, (cp_slice){s, CP_SLICE_ALL, NULL}, &options, &own, &error),
            CP_OK);
        snprintf(wanted, sizeof wanted, "\"aeb: %s\"\t%.9g\t%zu\t", f->data.scenario[s].name,
                 own.contrast[0].rate_ratio, s);
        assert_non_null(strstr(data, wanted));
        cp_comparison_destroy(&own);
    }
    free(data);
}

// Rows of a block behind its head and the row that draws nothing.
static size_t rows_of_block(const char *data, const char *title)
{
    const char *block = strstr(data, title);
    assert_non_null(block);
    const char *end = strstr(block, "\n\n\n");
    size_t lines = 0;
    for (const char *c = block; *c && c != end; c++)
        lines += *c == '\n';
    return end ? lines - 1 : lines - 2;
}

// Networks have coordinates of their own: no map holds two of them.
static void every_network_has_a_map(void **state)
{
    fixture *f = *state;
    char *data = data_of(f, CP_PLOT_SITES, CP_SCOPE_ALL), title[128];
    for (size_t s = 0; s < f->data.scenario_count; s++)
        for (size_t v = 0; v < 2; v++) {
            size_t crashes = 0;
            for (size_t k = 0; k < f->data.crash_count; k++) {
                const cp_study_crash *crash = &f->data.crash[k];
                const cp_study_replication *r = &f->data.replication[crash->replication];
                crashes += crash->frontal && r->scenario == s && r->variant == v;
            }
            snprintf(title, sizeof title, "\"%s: %s\"", f->data.scenario[s].name,
                     f->data.variant[v].name);
            assert_int_equal(count_of(data, title), 1);
            assert_true(crashes > 3);
            assert_int_equal(rows_of_block(data, title), crashes);
        }
    free(data);
}

// A swept parameter's value is on the axis; what else is swept makes the lines.
static void dose_is_over_the_value(void **state)
{
    fixture *f = *state;
    json_t *before = json_deep_copy(json_object_get(f->data.about, "sweep"));
    json_t *sweep = json_pack(
        "[{s:s, s:s, s:s, s:s, s:f}, {s:s, s:s, s:s, s:s, s:f}, {s:s, s:s, s:s, s:s, s:f}]",
        "owner", "scenario", "name", f->data.scenario[0].name, "base", "road", "parameter",
        "scenarios.road.error.probability_1", "value", 0.1, "owner", "scenario", "name",
        f->data.scenario[1].name, "base", "road", "parameter", "scenarios.road.error.probability_1",
        "value", 0.5, "owner", "variant", "name", "aeb", "base", "brake", "parameter",
        "variants.brake.aeb.ttc_s", "value", 1.2);
    json_object_set_new(f->data.about, "sweep", sweep);
    char *data = data_of(f, CP_PLOT_DOSE, CP_SCOPE_ALL), wanted[128];
    assert_int_equal(count_of(data, "\"brake, ttc_s 1.2; road over probability_1\""), 1);
    assert_int_equal(count_of(data, "\"brake; road, probability_1 0.1 over ttc_s\""), 1);
    assert_int_equal(count_of(data, "\"brake; road, probability_1 0.5 over ttc_s\""), 1);
    for (size_t s = 0; s < 2; s++) {
        cp_comparison own;
        cp_error error = {0};
        cp_comparison_options options = {.repetitions = 20};
        assert_int_equal(
            cp_compare(&f->data, 0, (cp_slice){s, CP_SLICE_ALL, NULL}, &options, &own, &error),
            CP_OK);
        cp_interval interval = cp_rate_ratio_interval(&own.contrast[0]);
        snprintf(wanted, sizeof wanted, "%.6g\t%.6g\t%.6g\t%.6g\n", s ? 0.5 : 0.1,
                 own.contrast[0].rate_ratio, interval.low, interval.high);
        assert_int_equal(count_of(data, wanted), 1);
        cp_comparison_destroy(&own);
    }
    free(data);
    cp_error error = {0};
    assert_int_equal(cp_plot_write(f->store, &f->data, &f->comparison, CP_SCOPE_ALL, CP_PLOT_DOSE,
                                   "test_plot.svg", &error),
                     CP_OK);
    unlink("test_plot.svg");
    json_object_set_new(f->data.about, "sweep", before);
    assert_int_equal(cp_plot_write(f->store, &f->data, &f->comparison, CP_SCOPE_ALL, CP_PLOT_DOSE,
                                   "test_plot.svg", &error),
                     CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "sweep"));
}

// The curve of a risk function is the function.
static void risk_is_the_function(void **state)
{
    fixture *f = *state;
    char *data = data_of(f, CP_PLOT_RISK, CP_SCOPE_ALL), wanted[128];
    for (size_t k = 0; k < f->data.risk_count; k++) {
        snprintf(wanted, sizeof wanted, "\n50\t%.6g\tNaN",
                 cp_risk_probability(&f->data.risk[k].function, 50.0 / 3.6, "front-front"));
        assert_non_null(strstr(data, wanted));
    }
    free(data);
}

// Of a counterfactual study every figure has the treatments, each block or row its own.
static void treatments_are_in_every_figure(void **state)
{
    (void)state;
    static const cp_plot_kind KIND[] = {
        CP_PLOT_OLC,     CP_PLOT_DELTA_V,  CP_PLOT_SEVERITY,    CP_PLOT_MAP,
        CP_PLOT_SITES,   CP_PLOT_FOREST,   CP_PLOT_ABOVE_OLC,   CP_PLOT_ABOVE_DELTA_V,
        CP_PLOT_BENEFIT, CP_PLOT_OUTCOMES, CP_PLOT_CONVERGENCE, CP_PLOT_DIFFERENCE};
    fixture f = {.store = open_study("small_counterfactual.db")};
    cp_error error = {0};
    cp_comparison_options options = {.repetitions = 20};
    if (cp_study_data_read(f.store, &f.data, &error) != CP_OK ||
        cp_compare(&f.data, 0, (cp_slice){CP_SLICE_ALL, CP_SLICE_ALL, NULL}, &options,
                   &f.comparison, &error) != CP_OK)
        fail_msg("%s", error.text);
    for (size_t k = 0; k < sizeof KIND / sizeof *KIND; k++) {
        char *data = data_of(&f, KIND[k], CP_SCOPE_ALL);
        for (size_t v = 0; v < f.comparison.counterfactual_count; v++) {
            const char *name = f.data.variant[f.comparison.counterfactual[v].variant].name;
            if (strstr(data, name) == NULL)
                fail_msg("kind %zu has no %s", k, name);
        }
        free(data);
        // gnuplot gets one of each sort: a curve, a map, rows with intervals.
        bool drawn =
            KIND[k] == CP_PLOT_OLC || KIND[k] == CP_PLOT_SITES || KIND[k] == CP_PLOT_FOREST;
        if (drawn && cp_plot_write(f.store, &f.data, &f.comparison, CP_SCOPE_ALL, KIND[k],
                                   "test_plot.svg", &error) != CP_OK)
            fail_msg("kind %zu: %s", k, error.text);
        unlink("test_plot.svg");
    }

    // Every treated vehicle with an OLC is a point.
    size_t points = 0;
    for (size_t k = 0; k < f.data.vehicle_count; k++)
        points += f.data.vehicle[k].frontal && f.data.vehicle[k].olc == CP_OLC_KNOWN;
    for (size_t k = 0; k < f.data.treated_count; k++) {
        const cp_study_vehicle *v = &f.data.treated[k].vehicle;
        points += v->frontal && v->olc == CP_OLC_KNOWN;
    }
    char *data = data_of(&f, CP_PLOT_SEVERITY, CP_SCOPE_ALL);
    // A line a point; a block has a head, an empty row and, but for the first, two empty lines.
    size_t blocks = 1 + f.comparison.counterfactual_count;
    assert_int_equal(count_of(data, "\n"), points + 2 * blocks + 2 * (blocks - 1));
    free(data);
    cp_comparison_destroy(&f.comparison);
    cp_study_data_destroy(&f.data);
    cp_store_close(f.store);
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
            if (kind == CP_PLOT_OUTCOMES || kind == CP_PLOT_CORRIDOR || kind == CP_PLOT_DOSE)
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
        cmocka_unit_test(the_forest_has_every_scenario_and_all),
        cmocka_unit_test(every_network_has_a_map),
        cmocka_unit_test(dose_is_over_the_value),
        cmocka_unit_test(risk_is_the_function),
        cmocka_unit_test(treatments_are_in_every_figure),
        cmocka_unit_test(names_are_never_commands),
        cmocka_unit_test(what_cannot_be_drawn_is_said),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
