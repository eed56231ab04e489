/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/comparison.h"

#include "analysis/grouping.h"
#include "analysis/quantity.h"
#include "analysis/slice_sample.h"
#include "report/answer.h"
#include "report/comparison_json.h"
#include "store/query.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "builders/small_study.h"

static const cp_slice EVERYTHING = {CP_SLICE_ALL, CP_SLICE_ALL, NULL};

typedef struct fixture {
    cp_store *store;
    cp_study_data data;
    cp_comparison comparison;
} fixture;

static int set_up(void **state)
{
    static fixture f;
    cp_error error = {0};
    cp_comparison_options options = cp_comparison_options_default();
    f = (fixture){.store = open_small_study()};
    if (cp_study_data_read(f.store, &f.data, &error) != CP_OK ||
        cp_compare(&f.data, 0, EVERYTHING, &options, &f.comparison, &error) != CP_OK)
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

// One number asked of the views, for a variant.
static double asked(fixture *f, const char *column, const char *view, const char *variant)
{
    char sql[256];
    double value = NAN;
    cp_error error = {0};
    snprintf(sql, sizeof sql, "SELECT %s FROM %s WHERE variant = '%s'", column, view, variant);
    if (cp_query_number(f->store, sql, &value, &error) != CP_OK)
        fail_msg("%s", error.text);
    return value;
}

static void figures_agree_with_the_views(void **state)
{
    fixture *f = *state;
    assert_int_equal(f->comparison.variant_count, 2);
    for (size_t k = 0; k < 2; k++) {
        const cp_variant_figures *v = &f->comparison.variant[k];
        const char *name = f->data.variant[v->variant].name;
        assert_int_equal(v->replications, asked(f, "replications", "crash_rate_by_variant", name));
        assert_int_equal(v->crashes, asked(f, "crashes", "olc_by_variant", name));
        assert_int_equal(v->frontal_crashes, asked(f, "frontal_crashes", "olc_by_variant", name));
        assert_int_equal(v->frontal_vehicles, asked(f, "frontal_vehicles", "olc_by_variant", name));
        assert_int_equal(v->inside, asked(f, "inside_validity", "olc_by_variant", name));
        assert_int_equal(v->simulation_failed,
                         asked(f, "simulation_failed", "olc_by_variant", name));
        assert_int_equal(v->description[CP_QUANTITY_OLC][CP_SCOPE_ALL].censored,
                         asked(f, "censored", "olc_by_variant", name));
        assert_int_equal(v->description[CP_QUANTITY_OLC][CP_SCOPE_ALL].count,
                         v->frontal_vehicles - v->simulation_failed);
        double median = asked(f, "olc_median_g", "olc_by_variant", name);
        double rate = asked(f, "frontal_crashes_per_million_km", "crash_rate_by_variant", name);
        assert_true(fabs(v->description[CP_QUANTITY_OLC][CP_SCOPE_ALL].median.value - median) <
                    1e-9);
        assert_true(fabs(v->rate - rate) < 1e-6 * rate);
        assert_true(v->rate_widened.low < rate && rate < v->rate_widened.high);
    }
}

// Sixteen replications a variant: no bootstrap interval, but a p-value.
static void few_replications_give_p_and_no_interval(void **state)
{
    fixture *f = *state;
    const cp_contrast_figures *c = &f->comparison.contrast[0];
    assert_int_equal(f->comparison.contrast_count, 1);
    assert_int_equal(c->replications[0], 16);
    assert_int_equal(c->rate_ratio_bootstrap.status, CP_INTERVAL_TOO_FEW_REPLICATIONS);
    assert_int_equal(c->severity[CP_QUANTITY_OLC].median_interval.status,
                     CP_INTERVAL_TOO_FEW_REPLICATIONS);
    assert_true(c->rate_p > 0.0 && c->rate_p < 0.05);
    assert_true(c->rate_ratio > 0.4 && c->rate_ratio < 0.6);
    assert_true(c->severity[CP_QUANTITY_OLC].superiority.cliffs_delta < 0.0);
}

// Slices of a filter cover everything once; a slice of rates keeps the whole exposure.
static void slices_add_up(void **state)
{
    fixture *f = *state;
    cp_error error = {0};
    cp_comparison_options options = {.repetitions = 10, .permutations = 0};
    size_t by_scenario = 0, by_type = 0;
    for (size_t s = 0; s < f->data.scenario_count; s++) {
        cp_comparison part;
        assert_int_equal(
            cp_compare(&f->data, 0, (cp_slice){s, CP_SLICE_ALL, NULL}, &options, &part, &error),
            CP_OK);
        by_scenario += part.variant[0].frontal_crashes;
        assert_int_equal(part.variant[0].replications, 8);
        cp_comparison_destroy(&part);
    }
    for (size_t t = 0; t < f->data.crash_type_count; t++) {
        cp_comparison part;
        assert_int_equal(
            cp_compare(&f->data, 0, (cp_slice){CP_SLICE_ALL, t, NULL}, &options, &part, &error),
            CP_OK);
        by_type += part.variant[0].frontal_crashes;
        assert_true(part.variant[0].vehicle_km == f->comparison.variant[0].vehicle_km);
        cp_comparison_destroy(&part);
    }
    assert_int_equal(by_scenario, f->comparison.variant[0].frontal_crashes);
    assert_int_equal(by_type, f->comparison.variant[0].frontal_crashes);
}

static void same_database_same_json(void **state)
{
    fixture *f = *state;
    cp_error error = {0};
    cp_comparison again;
    cp_comparison_options options = cp_comparison_options_default();
    assert_int_equal(cp_compare(&f->data, 0, EVERYTHING, &options, &again, &error), CP_OK);
    json_t *first = cp_comparison_json(&f->data, &f->comparison);
    json_t *second = cp_comparison_json(&f->data, &again);
    assert_non_null(first);
    assert_true(json_equal(first, second));
    json_decref(first);
    json_decref(second);
    cp_comparison_destroy(&again);
}

static void answer_names_crashes_validity_and_assumptions(void **state)
{
    fixture *f = *state;
    cp_error error = {0};
    char *answer = NULL, expected[128];
    assert_int_equal(cp_comparison_answer(&f->data, &f->comparison, &answer, &error), CP_OK);
    for (size_t k = 0; k < 2; k++) {
        const cp_variant_figures *v = &f->comparison.variant[k];
        snprintf(expected, sizeof expected,
                 k == 0 ? "%zu frontal crashes with %s (%zu of them front-front"
                        : "%zu frontal crashes with %s (%zu)",
                 v->frontal_crashes, f->data.variant[k].name, v->front_front_inside);
        assert_non_null(strstr(answer, expected));
    }
    assert_non_null(strstr(answer, "left_turn: failed_to_see with probability 0.05"));
    assert_non_null(strstr(answer, "head_on_overtaking: risky_overtaking with probability 0.1"));
    assert_non_null(strstr(answer, "conditional on the assumed driver errors"));
    free(answer);
}

// How often an error happens, not everything about it.
static void answer_says_how_often_drivers_err(void **state)
{
    fixture *f = *state;
    cp_error error = {0};
    char *answer = NULL;
    json_t *kept = f->data.scenario[0].driver_errors;
    f->data.scenario[0].driver_errors = json_pack(
        "[{s:s, s:{s:f, s:f}}, {s:s, s:{s:f}}]", "model", "lane_drift", "parameters",
        "duration_mean_s", 5.0, "rate_per_h", 20.0, "model", "own", "parameters", "length_m", 3.0);
    assert_int_equal(cp_comparison_answer(&f->data, &f->comparison, &answer, &error), CP_OK);
    assert_non_null(strstr(answer, "lane_drift rate_per_h = 20, own length_m = 3"));
    json_decref(f->data.scenario[0].driver_errors);
    f->data.scenario[0].driver_errors = kept;
    free(answer);
}

// A seed that only one variant finished has no partner and is left out of the paired comparison.
static void pairs_are_the_seeds_both_finished(void **state)
{
    (void)state;
    cp_study_replication replication[] = {
        {.variant = 0, .number = 0, .seed = 70, .vehicle_km = 1.0},
        {.variant = 1, .number = 0, .seed = 70, .vehicle_km = 2.0},
        {.variant = 0, .number = 1, .seed = 71, .vehicle_km = 3.0},
        {.variant = 1, .number = 2, .seed = 72, .vehicle_km = 4.0},
        {.variant = 0, .number = 3, .seed = 73, .vehicle_km = 5.0},
        {.variant = 1, .number = 3, .seed = 73, .vehicle_km = 6.0},
    };
    cp_study_data data = {.replication = replication, .replication_count = 6};
    cp_replication_set a, b;
    cp_error error = {0};
    assert_int_equal(cp_replication_set_create(&data, EVERYTHING, 0, &a, &error), CP_OK);
    assert_int_equal(cp_replication_set_create(&data, EVERYTHING, 1, &b, &error), CP_OK);
    cp_replication_set_match(&data, &a, &b);
    assert_int_equal(a.count, 2);
    assert_int_equal(b.count, 2);
    assert_true(a.vehicle_km[0] == 1.0 && b.vehicle_km[0] == 2.0);
    assert_true(a.vehicle_km[1] == 5.0 && b.vehicle_km[1] == 6.0);
    cp_replication_set_destroy(&a);
    cp_replication_set_destroy(&b);
}

// MAIS3+ of NASS-CDS in SQL, over the drivers struck on their front, delta-v without the rebound of
// 0.1 that the small study has throughout; the benefit from the rates.
static void injuries_agree_with_sql(void **state)
{
    fixture *f = *state;
    size_t k = 0;
    while (strcmp(f->data.risk[k].name, "NASS-CDS") != 0 ||
           strcmp(f->data.risk[k].level, "MAIS3+") != 0)
        k++;
    double rate[2];
    for (size_t v = 0; v < 2; v++) {
        char sql[512];
        double expected = NAN, inside = NAN;
        cp_error error = {0};
        for (int scope = 0; scope < 2; scope++) {
            snprintf(
                sql, sizeof sql,
                "SELECT sum(1.0 / (1.0 + exp(7.047922 - 0.1024961 * 3.6 * w.delta_v_m_s / 1.1)))"
                " FROM crash_vehicle AS w JOIN variant AS v ON v.id = w.variant_id"
                " WHERE v.name = '%s' AND w.contact_side = 'front' %s",
                f->data.variant[v].name, scope ? "AND w.validity = 'inside'" : "");
            if (cp_query_number(f->store, sql, scope ? &inside : &expected, &error) != CP_OK)
                fail_msg("%s", error.text);
        }
        const cp_variant_figures *figures = &f->comparison.variant[v];
        assert_true(fabs(figures->injury[CP_SCOPE_ALL][k].expected - expected) < 1e-9 * expected);
        assert_true(fabs(figures->injury[CP_SCOPE_INSIDE][k].expected - inside) < 1e-9 * inside);
        rate[v] = figures->injury[CP_SCOPE_ALL][k].rate;
        assert_true(fabs(rate[v] - 1e6 * expected / figures->vehicle_km) < 1e-6 * rate[v]);
    }
    const cp_benefit_figures *benefit = &f->comparison.contrast[0].benefit[k];
    assert_true(fabs(benefit->benefit_1 - (1.0 - rate[1] / rate[0])) < 1e-9);
}

// --where and --by against SQL; their groups add up to the whole.
static void groups_agree_with_sql(void **state)
{
    fixture *f = *state;
    cp_error error = {0};
    cp_grouping g;
    cp_comparison_options options = {.repetitions = 10, .permutations = 0, .above = {10.0, 5.0}};
    const char *where = "closing_speed_m_s > 12 AND validity <> 'angle' -- a comment";
    assert_int_equal(
        cp_grouping_create(f->store, &f->data, "left_turn", "validity", where, &g, &error), CP_OK);
    assert_true(g.count >= 2);
    size_t vehicles = 0, above = 0;
    double wanted = 0.0;
    for (size_t k = 0; k < g.count; k++) {
        cp_comparison part;
        assert_int_equal(cp_compare(&f->data, 0, g.slice[k], &options, &part, &error), CP_OK);
        vehicles += part.variant[0].frontal_vehicles;
        above += part.variant[0].above[CP_EXCEEDED_OLC].crashes;
        assert_int_equal(part.variant[0].replications, 8);
        cp_comparison_destroy(&part);
    }
    // Crashes above the headline severity by the chosen vehicles of each group.
    if (cp_query_number(f->store,
                        "SELECT count(*) FROM (SELECT DISTINCT crash_id, validity FROM "
                        "frontal_vehicle WHERE closing_speed_m_s > 12 AND validity <> 'angle' AND "
                        "variant = 'baseline' AND scenario = 'left_turn' AND olc_g > 10)",
                        &wanted, &error) != CP_OK)
        fail_msg("%s", error.text);
    assert_int_equal(above, (size_t)wanted);
    assert_true(wanted > 0.0);
    if (cp_query_number(f->store,
                        "SELECT count(*) FROM frontal_vehicle WHERE closing_speed_m_s > 12 AND"
                        " validity <> 'angle' AND variant = 'baseline' AND scenario = 'left_turn'",
                        &wanted, &error) != CP_OK)
        fail_msg("%s", error.text);
    assert_int_equal(vehicles, (size_t)wanted);
    assert_true(wanted > 0.0);
    cp_grouping_destroy(&g);
    assert_int_equal(cp_grouping_create(f->store, &f->data, "right_turn", NULL, NULL, &g, &error),
                     CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "left_turn, head_on_overtaking"));
    assert_int_equal(cp_grouping_create(f->store, &f->data, NULL, "crash_id", NULL, &g, &error),
                     CP_BAD_INPUT);
}

// Every variant has the same names in the same order, and no name twice in a scope.
static void quantities_have_names_of_their_own(void **state)
{
    fixture *f = *state;
    cp_quantities list[2] = {{0}, {0}}, contrast = {0};
    cp_quantities_of_contrast(&f->data, &f->comparison.contrast[0], &contrast);
    for (size_t k = 0; k < contrast.count; k++)
        for (size_t j = 0; j < k; j++)
            assert_false(contrast.row[j].scope == contrast.row[k].scope &&
                         strcmp(contrast.row[j].name, contrast.row[k].name) == 0);
    cp_quantities_destroy(&contrast);
    for (size_t v = 0; v < 2; v++)
        cp_quantities_of_variant(&f->data, &f->comparison.variant[v], &list[v]);
    assert_false(list[0].failed);
    assert_int_equal(list[0].count, list[1].count);
    for (size_t k = 0; k < list[0].count; k++) {
        assert_string_equal(list[0].row[k].name, list[1].row[k].name);
        for (size_t j = 0; j < k; j++)
            if (list[0].row[j].scope == list[0].row[k].scope)
                assert_string_not_equal(list[0].row[j].name, list[0].row[k].name);
    }
    cp_quantities_destroy(&list[0]);
    cp_quantities_destroy(&list[1]);
}

static void unknown_baseline_names_the_variants(void **state)
{
    fixture *f = *state;
    cp_error error = {0};
    size_t variant;
    assert_int_equal(cp_study_data_variant(&f->data, "esp", &variant, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "baseline, aeb"));
    assert_int_equal(cp_study_data_variant(&f->data, NULL, &variant, &error), CP_OK);
    assert_int_equal(variant, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(figures_agree_with_the_views),
        cmocka_unit_test(few_replications_give_p_and_no_interval),
        cmocka_unit_test(slices_add_up),
        cmocka_unit_test(same_database_same_json),
        cmocka_unit_test(answer_names_crashes_validity_and_assumptions),
        cmocka_unit_test(answer_says_how_often_drivers_err),
        cmocka_unit_test(pairs_are_the_seeds_both_finished),
        cmocka_unit_test(injuries_agree_with_sql),
        cmocka_unit_test(groups_agree_with_sql),
        cmocka_unit_test(quantities_have_names_of_their_own),
        cmocka_unit_test(unknown_baseline_names_the_variants),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
