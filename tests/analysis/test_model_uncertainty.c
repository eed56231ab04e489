/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/model_uncertainty.h"

#include "analysis/comparison.h"
#include "analysis/quantity.h"
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

/* Two parameter sets, by which every OLC is 1 g higher and 1 g lower (tests/sql/small_members.sql):
 * medians have a standard deviation of sqrt(2) g, differences none. */

typedef struct fixture {
    cp_store *store;
    cp_study_data data;
    cp_model_ensemble ensemble;
    cp_comparison comparison;
} fixture;

static void compare(fixture *f)
{
    cp_error error = {0};
    const cp_slice everything = {CP_SLICE_ALL, CP_SLICE_ALL, NULL};
    cp_comparison_options options = {
        .repetitions = 400, .permutations = 0, .ensemble = &f->ensemble};
    if (cp_compare(&f->data, 0, everything, &options, &f->comparison, &error) != CP_OK)
        fail_msg("%s", error.text);
}

static fixture open_fixture(const char *file)
{
    fixture f = {.store = open_study(file)};
    cp_error error = {0};
    if (cp_study_data_read(f.store, &f.data, &error) != CP_OK ||
        cp_model_ensemble_read(f.store, &f.data, &f.ensemble, &error) != CP_OK)
        fail_msg("%s", error.text);
    return f;
}

static void close_fixture(fixture *f)
{
    cp_comparison_destroy(&f->comparison);
    cp_model_ensemble_destroy(&f->ensemble);
    cp_study_data_destroy(&f->data);
    cp_store_close(f->store);
}

static void assert_near(double found, double expected)
{
    if (!(fabs(found - expected) < 1e-9))
        fail_msg("found %.12g, expected %.12g", found, expected);
}

// Medians by the sets, from the view; the variant's own is between them.
static double median_by_set(fixture *f, const char *variant, int set)
{
    char sql[256];
    double value = NAN;
    cp_error error = {0};
    snprintf(sql, sizeof sql,
             "SELECT olc_median_g FROM olc_by_variant_member WHERE variant = '%s' AND member = %d",
             variant, set);
    if (cp_query_number(f->store, sql, &value, &error) != CP_OK)
        fail_msg("%s", error.text);
    return value;
}

static void shared_error_moves_medians_and_no_difference(void **state)
{
    (void)state;
    fixture f = open_fixture("small_study_members.db");
    assert_int_equal(f.ensemble.count, 2);
    compare(&f);
    for (size_t k = 0; k < 2; k++) {
        const cp_variant_figures *v = &f.comparison.variant[k];
        const cp_model_part *p = &v->olc_median_model;
        const char *name = f.data.variant[v->variant].name;
        double median = v->description[CP_QUANTITY_OLC][CP_SCOPE_ALL].median.value;
        assert_int_equal(p->sets, 2);
        assert_int_equal(v->without_sets, 0);
        assert_near(p->estimate.value, median);
        assert_near(p->sd, sqrt(2.0));
        assert_near(p->mean, median);
        assert_near(median_by_set(&f, name, 0), median + 1.0);
        assert_near(median_by_set(&f, name, 1), median - 1.0);
        assert_int_equal(p->combined.status, CP_INTERVAL_TOO_FEW_REPLICATIONS);
    }
    const cp_contrast_figures *c = &f.comparison.contrast[0];
    assert_near(c->median_model.sd, 0.0);
    assert_near(c->median_model.mean, c->severity[CP_QUANTITY_OLC].median_difference.value);
    assert_near(c->delta_model.sd, 0.0);
    assert_near(c->delta_model.combined.low, c->severity[CP_QUANTITY_OLC].superiority.interval.low);
    assert_near(c->delta_model.combined.high,
                c->severity[CP_QUANTITY_OLC].superiority.interval.high);
    close_fixture(&f);
}

// A baseline whose models have no sets stays where it is, and the difference moves.
static void vehicles_without_sets_keep_their_own(void **state)
{
    (void)state;
    fixture f = open_fixture("small_study_members.db");
    for (size_t k = 0; k < f.data.vehicle_count; k++) {
        const cp_study_crash *crash = &f.data.crash[f.data.vehicle[k].crash];
        for (size_t m = 0; m < 2 && f.data.replication[crash->replication].variant == 0; m++)
            f.ensemble.olc_g[m * f.ensemble.vehicle_count + k] = NAN;
    }
    compare(&f);
    const cp_variant_figures *v = f.comparison.variant;
    assert_near(v[0].olc_median_model.sd, 0.0);
    assert_near(v[1].olc_median_model.sd, sqrt(2.0));
    assert_int_equal(v[0].without_sets, v[0].description[CP_QUANTITY_OLC][CP_SCOPE_ALL].count);
    assert_int_equal(v[1].without_sets, 0);
    const cp_contrast_figures *c = &f.comparison.contrast[0];
    assert_near(c->median_model.sd, sqrt(2.0));
    // A baseline 1 g nearer or farther is beaten more or less often; the interval grows by it.
    assert_true(c->delta_model.sd > 0.0);
    assert_true(c->delta_model.combined.low < c->delta_model.replications.low);
    assert_true(c->delta_model.combined.low >= -1.0 && c->delta_model.combined.high <= 1.0);
    close_fixture(&f);
}

// A left-censored vehicle lies below every value by a set, and one that failed gives none.
static void sets_order_censored_vehicles_below_all(void **state)
{
    (void)state;
    fixture f = open_fixture("small_study_members.db");
    double *first = f.ensemble.olc_g;
    size_t changed = 0;
    for (size_t k = 0; k < f.data.vehicle_count; k++) {
        const cp_study_crash *crash = &f.data.crash[f.data.vehicle[k].crash];
        if (isnan(first[k]) || f.data.replication[crash->replication].variant != 0)
            continue;
        first[k] = changed % 3 < 2 ? -INFINITY : changed % 2 ? INFINITY : first[k];
        changed++;
    }
    compare(&f);
    const cp_model_part *p = &f.comparison.variant[0].olc_median_model;
    assert_int_equal(p->status, CP_INTERVAL_CENSORED);
    assert_true(isnan(p->sd) && isnan(p->combined.low));
    assert_int_equal(f.comparison.contrast[0].median_model.status, CP_INTERVAL_CENSORED);
    assert_int_equal(f.comparison.contrast[0].delta_model.status, CP_INTERVAL_VALUE);
    const cp_study_data by_set = cp_model_ensemble_study(&f.ensemble, &f.data, 0);
    for (size_t k = 0; k < f.data.vehicle_count; k++)
        if (!isnan(first[k]))
            assert_int_equal(by_set.vehicle[k].olc, isfinite(first[k]) ? CP_OLC_KNOWN
                                                    : first[k] < 0.0   ? CP_OLC_CENSORED
                                                                       : CP_OLC_FAILED);
    close_fixture(&f);
}

// Both crashes of a pair move alike; against an avoided one the baseline's moves alone.
static void pairs_change_by_set_as_by_hand(void **state)
{
    (void)state;
    fixture f = open_fixture("small_counterfactual_members.db");
    assert_int_equal(f.ensemble.count, 2);
    for (size_t m = 0; m < 2; m++) {
        double shift = m == 0 ? 1.0 : -1.0;
        size_t avoided = 0, again = 0;
        const cp_study_data by_set = cp_model_ensemble_study(&f.ensemble, &f.data, m);
        for (size_t k = 0; k < f.data.pair_count; k++) {
            const cp_study_pair *own = &f.data.pair[k], *other = &by_set.pair[k];
            if (isnan(own->olc_g[0]) || isnan(own->olc_g[1]))
                continue;
            assert_near(other->olc_g[0], own->olc_g[0] + shift);
            assert_near(other->olc_g[1],
                        own->outcome == CP_OUTCOME_AVOIDED ? 0.0 : own->olc_g[1] + shift);
            avoided += own->outcome == CP_OUTCOME_AVOIDED;
            again += own->outcome == CP_OUTCOME_MITIGATED;
        }
        assert_true(avoided > 0 && again > 0);
    }
    compare(&f);
    const cp_counterfactual_figures *c = &f.comparison.counterfactual[0];
    const cp_model_part *crashing = &c->olc_model[CP_PAIRED_CRASHING];
    const cp_model_part *all = &c->olc_model[CP_PAIRED_ALL];
    assert_near(crashing->sd, 0.0);
    assert_near(crashing->combined.low, c->olc_g[CP_PAIRED_CRASHING].hodges_lehmann_interval.low);
    assert_true(all->sd > 0.0 && all->sd <= sqrt(2.0) + 1e-9);
    assert_true(all->combined.status == CP_INTERVAL_VALUE);
    double above = all->replications.high - all->estimate.value;
    assert_near(all->combined.high, all->estimate.value + hypot(above, all->half_width));

    // The baseline's own median has replications enough for an interval.
    const cp_model_part *median = &f.comparison.variant[0].olc_median_model;
    assert_int_equal(median->replications.status, CP_INTERVAL_VALUE);
    assert_true(median->replications.low < median->estimate.value &&
                median->estimate.value < median->replications.high);
    assert_near(median->sd, sqrt(2.0));
    close_fixture(&f);
}

static void answer_and_json_say_both_parts(void **state)
{
    (void)state;
    fixture f = open_fixture("small_counterfactual_members.db");
    cp_error error = {0};
    char *answer = NULL;
    compare(&f);
    assert_int_equal(cp_comparison_answer(&f.data, &f.comparison, &answer, &error), CP_OK);
    assert_non_null(strstr(answer, ", from the model’s ensemble of 2 parameter sets ±"));
    assert_non_null(strstr(answer, "): from replications 95 % interval "));
    free(answer);
    json_t *json = cp_comparison_json(&f.data, &f.comparison);
    const json_t *pairs = json_array_get(json_object_get(json, "counterfactual"), 0);
    const json_t *change = json_object_get(
        json_object_get(json_object_get(pairs, "model_uncertainty"), "olc_change_g"), "all_pairs");
    assert_near(json_real_value(json_object_get(change, "sd")),
                f.comparison.counterfactual[0].olc_model[CP_PAIRED_ALL].sd);
    json_decref(json);
    close_fixture(&f);
}

// Without an ensemble nothing is added, neither figure nor word.
static void without_an_ensemble_all_is_as_before(void **state)
{
    (void)state;
    fixture f = open_fixture("small_study.db");
    cp_error error = {0};
    char *answer = NULL;
    cp_quantities list = {0};
    assert_int_equal(f.ensemble.count, 0);
    compare(&f);
    cp_quantities_of_variant(&f.data, &f.comparison.variant[0], &list);
    for (size_t k = 0; k < list.count; k++)
        assert_null(strstr(list.row[k].name, "model"));
    assert_int_equal(cp_comparison_answer(&f.data, &f.comparison, &answer, &error), CP_OK);
    assert_null(strstr(answer, "parameter sets"));
    free(answer);
    cp_quantities_destroy(&list);
    close_fixture(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shared_error_moves_medians_and_no_difference),
        cmocka_unit_test(vehicles_without_sets_keep_their_own),
        cmocka_unit_test(sets_order_censored_vehicles_below_all),
        cmocka_unit_test(pairs_change_by_set_as_by_hand),
        cmocka_unit_test(answer_and_json_say_both_parts),
        cmocka_unit_test(without_an_ensemble_all_is_as_before),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
