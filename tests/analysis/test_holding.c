/* SPDX-License-Identifier: GPL-3.0-or-later */
// Small studies that once gave numbers which do not hold, each with what must be said instead.
#include "analysis/comparison.h"

#include "analysis/quantity.h"
#include "report/answer.h"
#include "report/comparison_json.h"
#include "report/plot.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "builders/invented_study.h"

static const cp_slice EVERYTHING = {CP_SLICE_ALL, CP_SLICE_ALL, NULL};

enum { SEEDS = 20 };

static cp_comparison compared(const invented_study *s)
{
    cp_comparison comparison;
    cp_error error = {0};
    cp_comparison_options options = cp_comparison_options_default();
    options.repetitions = 400;
    options.permutations = 199;
    if (cp_compare(&s->data, 0, EVERYTHING, &options, &comparison, &error) != CP_OK)
        fail_msg("%s", error.text);
    return comparison;
}

static char *answered(const invented_study *s, const cp_comparison *comparison)
{
    char *answer = NULL;
    cp_error error = {0};
    assert_int_equal(cp_comparison_answer(&s->data, comparison, &answer, &error), CP_OK);
    return answer;
}

// Severities 8 to 16 g that a crash's number tells, the same in both variants.
static double severity(size_t number)
{
    return 8.0 + (double)(number * 7 % 17) * 0.5;
}

static void add_baseline(invented_study *s, size_t each)
{
    for (size_t n = 0; n < SEEDS; n++)
        for (size_t k = 0; k < each; k++)
            invented_crash(s, invented_replication(SEEDS, 0, n, 0), severity(10 * n + k), true);
}

// Every interval of every figure that is given has a width, and no figure is not a number in JSON.
static void assert_no_width_is_zero(const invented_study *s, const cp_comparison *comparison)
{
    cp_quantities list = {0};
    for (size_t k = 0; k < comparison->variant_count; k++)
        cp_quantities_of_variant(&s->data, &comparison->variant[k], &list);
    for (size_t k = 0; k < comparison->contrast_count; k++)
        cp_quantities_of_contrast(&s->data, &comparison->contrast[k], &list);
    for (size_t k = 0; k < comparison->counterfactual_count; k++)
        cp_quantities_of_pairs(&s->data, &comparison->counterfactual[k], &list);
    for (size_t k = 0; k < list.count; k++) {
        const cp_quantity *q = &list.row[k];
        if (q->kind && q->interval.status == CP_INTERVAL_VALUE &&
            !(q->interval.high > q->interval.low))
            fail_msg("%s: %g to %g", q->name, q->interval.low, q->interval.high);
    }
    cp_quantities_destroy(&list);
    json_t *json = cp_comparison_json(&s->data, comparison);
    assert_non_null(json);
    json_decref(json);
}

// Once: p = 0.013 from one treated crash.
static void one_treated_crash_has_no_p(void **state)
{
    (void)state;
    invented_study *s = invented(1, SEEDS);
    add_baseline(s, 10);
    invented_crash(s, invented_replication(SEEDS, 0, 3, 1), 9.0, true);
    cp_comparison c = compared(s);
    const cp_contrast_figures *f = &c.contrast[0];
    for (int q = 0; q < CP_QUANTITIES_COMPARED; q++) {
        assert_int_equal(f->severity[q].superiority.status, CP_INTERVAL_TOO_FEW_CRASHES);
        assert_true(isnan(f->severity[q].superiority.p) && isnan(f->severity[q].distance_p));
        assert_int_equal(f->severity[q].median_interval.status, CP_INTERVAL_TOO_FEW_CRASHES);
    }
    assert_no_width_is_zero(s, &c);
    char *answer = answered(s, &c);
    assert_non_null(strstr(answer, "too few crashes for an interval or a test"));
    assert_non_null(strstr(answer, "1 against 200 frontal crashes"));
    assert_non_null(strstr(answer, "1 frontal crash with aeb"));
    free(answer);
    cp_comparison_destroy(&c);
    invented_destroy(s);
}

// Once: "0.00 times (0.00 to 0.00)" and a benefit of 100 (100 to 100).
static void no_treated_crash_leaves_an_upper_bound(void **state)
{
    (void)state;
    invented_study *s = invented(1, SEEDS);
    add_baseline(s, 1);
    cp_comparison c = compared(s);
    const cp_contrast_figures *f = &c.contrast[0];
    cp_interval ratio = cp_rate_ratio_interval(f);
    assert_true(f->rate_ratio == 0.0 && ratio.low == 0.0);
    // With 20 baseline crashes and none against them: some 3 / 20.
    assert_true(ratio.high > 0.1 && ratio.high < 0.3);
    assert_int_equal(f->rate_ratio_bootstrap.status, CP_INTERVAL_TOO_FEW_CRASHES);
    assert_int_equal(f->benefit[0].interval.status, CP_INTERVAL_TOO_FEW_CRASHES);
    assert_true(isnan(f->benefit[0].bound[0]) && isnan(f->benefit[0].bound[1]));
    for (int what = 0; what < CP_EXCEEDED_COUNT; what++)
        assert_true(f->above[what].bound_interval[0].low == 0.0 &&
                    f->above[what].bound_interval[1].high > 0.0);
    assert_true(c.variant[1].rate_widened.low == 0.0 && c.variant[1].rate_widened.high > 1e3);
    // The baseline's counts are all alike, and so is every resample.
    assert_int_equal(c.variant[0].rate_bootstrap.status, CP_INTERVAL_ALL_ALIKE);
    assert_no_width_is_zero(s, &c);
    char *data = NULL;
    cp_error error = {0};
    assert_int_equal(cp_plot_data(NULL, &s->data, &c, CP_SCOPE_ALL, CP_PLOT_BENEFIT, &data, &error),
                     CP_OK);
    // Every row is a point without a bar.
    for (const char *line = data; *line != '\0'; line = strchr(line, '\n') + 1)
        assert_memory_equal(strchr(line, '\n') - 8, "\tNaN\tNaN", 8);
    free(data);
    cp_comparison_destroy(&c);
    invented_destroy(s);
}

// Once: 0.99 to 1.04, where three against three say 0.14 to 7.5.
static void three_against_three_say_little(void **state)
{
    (void)state;
    invented_study *s = invented(1, SEEDS);
    for (size_t n = 0; n < 3; n++)
        for (size_t v = 0; v < 2; v++)
            invented_crash(s, invented_replication(SEEDS, 0, 4 * n, v), 9.0 + (double)n, true);
    cp_comparison c = compared(s);
    cp_interval ratio = cp_rate_ratio_interval(&c.contrast[0]);
    assert_true(ratio.low < 0.2 && ratio.high > 5.0);
    assert_no_width_is_zero(s, &c);
    cp_comparison_destroy(&c);
    invented_destroy(s);
}

// Once: 0.59 to 0.59 and no further replication needed, as each scenario had one only.
static void one_replication_a_scenario_shows_no_scatter(void **state)
{
    (void)state;
    invented_study *s = invented(SEEDS, 1);
    for (size_t n = 0; n < SEEDS; n++)
        for (size_t k = 0; k < 5 + n % 3; k++) {
            invented_crash(s, invented_replication(1, n, 0, 0), severity(k + n), true);
            if (k % 5 < 3)
                invented_crash(s, invented_replication(1, n, 0, 1), severity(2 * k + n), true);
        }
    cp_comparison c = compared(s);
    const cp_contrast_figures *f = &c.contrast[0];
    assert_int_equal(f->rate_ratio_bootstrap.status, CP_INTERVAL_TOO_FEW_REPLICATIONS);
    assert_int_equal(f->severity[0].median_interval.status, CP_INTERVAL_TOO_FEW_REPLICATIONS);
    assert_true(isnan(f->rate_ratio_widening.dispersion_1));
    cp_interval ratio = cp_rate_ratio_interval(f);
    assert_true(ratio.low < 0.8 * f->rate_ratio && ratio.high > 1.2 * f->rate_ratio);
    assert_true(f->rate_ratio_precision.replications_needed > 20.0);
    assert_no_width_is_zero(s, &c);
    char *answer = answered(s, &c);
    assert_non_null(strstr(answer, "which trusts that replications differ by chance only"));
    free(answer);
    cp_comparison_destroy(&c);
    invented_destroy(s);
}

// Once: a share of 0 to 0 of 245 pairs, none of them aggravated.
static void no_aggravated_pair_is_not_never(void **state)
{
    (void)state;
    invented_study *s = invented(1, SEEDS);
    s->data.counterfactual = true;
    s->data.paired = false;
    // Replications of the treatment do not exist.
    s->data.replication_count = 0;
    for (size_t n = 0; n < SEEDS; n++)
        s->replication[s->data.replication_count++] =
            (cp_study_replication){0, 0, (int64_t)n, (int64_t)n, 100.0, 2.0};
    for (size_t k = 0; k < 245; k++) {
        invented_crash(s, k % SEEDS, severity(k), k % 4 > 0);
        bool avoided = k * 5 % 7 < 3;
        cp_outcome outcome = avoided ? CP_OUTCOME_AVOIDED : CP_OUTCOME_MITIGATED;
        s->pair[s->data.pair_count++] = (cp_study_pair){
            .crash = k,
            .variant = 1,
            .outcome = outcome,
            .outcome_olc = outcome,
            .olc_g = {severity(k), avoided ? 0.0 : severity(k) - 3.0},
            .closing_speed_m_s = {1.2 * severity(k), avoided ? 0.0 : severity(k)},
            .predictor = {{avoided ? NAN : 5.0}, {avoided ? NAN : 5.0}},
            .treated_inside = {true, true},
        };
    }
    cp_comparison c = compared(s);
    const cp_counterfactual_figures *f = &c.counterfactual[0];
    cp_interval aggravated = f->share[CP_OUTCOME_AGGRAVATED];
    assert_int_equal(f->valid, 245);
    assert_true(aggravated.low == 0.0 && aggravated.high > 0.01 && aggravated.high < 0.05);
    // By the range of the baseline's crash: what the treatment did cannot move a crash across it.
    assert_int_equal(f->inside_crashes, 245 - 62);
    assert_int_equal(f->inside_outcome[CP_OUTCOME_AVOIDED] +
                         f->inside_outcome[CP_OUTCOME_MITIGATED],
                     f->inside_valid);
    assert_true(f->benefit[0].bound[0] < f->benefit[0].benefit_1 &&
                f->benefit[0].benefit_1 < f->benefit[0].bound[1]);
    assert_no_width_is_zero(s, &c);
    cp_comparison_destroy(&c);
    invented_destroy(s);
}

// Once: a benefit of 86 % inside the range from a treatment that moved crashes out of it, the same
// crashes with the same severity.
static void a_flag_alone_is_no_benefit(void **state)
{
    (void)state;
    invented_study *s = invented(1, SEEDS);
    for (size_t n = 0; n < SEEDS; n++)
        for (size_t k = 0; k < 5; k++)
            for (size_t v = 0; v < 2; v++)
                invented_crash(s, invented_replication(SEEDS, 0, n, v), severity(10 * n + k),
                               v == 0 || k == 0);
    cp_comparison c = compared(s);
    const cp_contrast_figures *f = &c.contrast[0];
    const cp_benefit_figures *b = &f->benefit[0];
    assert_true(fabs(b->benefit_1) < 1e-12);
    assert_true(b->bound[0] < 0.0 && b->bound[1] > 0.5);
    assert_true(fabs(f->severity[CP_QUANTITY_OLC].superiority.cliffs_delta) < 1e-12);
    assert_true(f->olc_bound[0].cliffs_delta < -0.7 && f->olc_bound[1].cliffs_delta > 0.7);
    for (int what = 0; what < CP_EXCEEDED_COUNT; what++) {
        const cp_exceedance_ratio *r = &f->above[what];
        if (r->crashes[0] == 0)
            continue;
        if (r->ratio != 1.0 || !(r->bound[0] < 1.0) || !(r->bound[1] > 1.5))
            fail_msg("%s: %g, %g to %g", CP_EXCEEDED_TEXT[what], r->ratio, r->bound[0],
                     r->bound[1]);
        assert_true(r->interval.low < 1.0 && r->interval.high > 1.0);
    }
    // Nothing is compared over those inside only.
    cp_quantities list = {0};
    cp_quantities_of_contrast(&s->data, f, &list);
    for (size_t k = 0; k < list.count; k++)
        assert_true(list.row[k].scope != CP_SCOPE_INSIDE);
    cp_quantities_destroy(&list);
    cp_comparison_destroy(&c);
    invented_destroy(s);
}

// Exceedance counts crashes, each by the larger of its frontally struck vehicles.
static void crashes_above_a_severity_are_counted_once(void **state)
{
    (void)state;
    invented_study *s = invented(1, SEEDS);
    invented_crash(s, 0, 16.0, true);
    s->vehicle[1].frontal = true;
    s->vehicle[1].olc_g = 18.0;
    s->vehicle[1].validity = 1;
    invented_crash(s, 2, 14.0, true);
    invented_crash(s, 4, -INFINITY, false);
    cp_comparison c = compared(s);
    // Closing speed is of the crash, OLC of the vehicle.
    assert_int_equal(c.variant[0].description[CP_QUANTITY_OLC][CP_SCOPE_ALL].count, 4);
    assert_int_equal(c.variant[0].description[CP_QUANTITY_CLOSING_SPEED][CP_SCOPE_ALL].count, 3);
    const cp_exceedance *e = &c.variant[0].above[CP_EXCEEDED_OLC];
    assert_true(e->x == 15.0);
    assert_int_equal(e->crashes, 1);
    assert_int_equal(e->least, 1);
    assert_int_equal(e->most, 2); // and the one outside, which may be anything
    assert_true(fabs(e->rate - 1e6 / 2000.0) < 1e-9);
    const cp_exceedance *curve = c.variant[0].curve[CP_EXCEEDED_OLC];
    assert_int_equal(curve[0].crashes, 2);
    assert_int_equal(curve[17].crashes, 1);
    assert_int_equal(curve[17].least, 0);
    assert_int_equal(curve[18].crashes, 0);
    cp_comparison_destroy(&c);

    // Of the vehicles that are chosen: without the one with 18 g no crash is above 17.
    unsigned char chosen[6] = {1, 0, 1, 1, 1, 1};
    cp_error error = {0};
    cp_comparison_options options = cp_comparison_options_default();
    assert_int_equal(cp_compare(&s->data, 0, (cp_slice){CP_SLICE_ALL, CP_SLICE_ALL, chosen},
                                &options, &c, &error),
                     CP_OK);
    assert_int_equal(c.variant[0].curve[CP_EXCEEDED_OLC][17].crashes, 0);
    assert_int_equal(c.variant[0].curve[CP_EXCEEDED_OLC][15].crashes, 1);
    cp_comparison_destroy(&c);
    invented_destroy(s);
}

// Once: medians over all replications stood beside the ratio over the seeds both had finished.
static void seeds_without_a_partner_count_nowhere(void **state)
{
    (void)state;
    invented_study *s = invented(1, SEEDS);
    add_baseline(s, 2);
    for (size_t n = 0; n < SEEDS; n++)
        for (size_t k = 0; k < 2; k++)
            invented_crash(s, invented_replication(SEEDS, 0, n, 1), severity(10 * n + k), true);
    cp_comparison c = compared(s);
    double whole = c.contrast[0].severity[0].median[0].value;
    cp_comparison_destroy(&c);

    // Another baseline replication that crashed very severely and whose partner failed.
    s->replication[s->data.replication_count++] =
        (cp_study_replication){0, 0, SEEDS, 70 + SEEDS, 100.0, 2.0};
    s->data.unfinished = 1;
    for (size_t k = 0; k < 100; k++)
        invented_crash(s, s->data.replication_count - 1, 40.0, true);
    c = compared(s);
    const cp_contrast_figures *f = &c.contrast[0];
    assert_int_equal(f->partnerless[0], 1);
    assert_int_equal(f->frontal_crashes[0], 40);
    assert_true(f->severity[0].median[0].value == whole);
    assert_true(f->rate_ratio == 1.0);
    char *answer = answered(s, &c);
    assert_non_null(
        strstr(answer, "over the 20 seeds that both finished (1 more without a partner"));
    assert_non_null(strstr(answer, "40 against 40 frontal crashes"));
    assert_non_null(strstr(answer, "100 of baseline not compared"));
    assert_non_null(strstr(answer, "not counted: 1 planned replication that failed"));
    free(answer);
    cp_comparison_destroy(&c);
    invented_destroy(s);
}

// Once: +2.6 g for a treatment that makes most crashes too mild for an OLC, and "median n/a g".
static void censored_vehicles_are_never_dropped(void **state)
{
    (void)state;
    for (int all = 0; all < 2; all++) {
        invented_study *s = invented(1, SEEDS);
        add_baseline(s, 2);
        for (size_t n = 0; n < SEEDS; n++)
            for (size_t k = 0; k < 2; k++)
                invented_crash(s, invented_replication(SEEDS, 0, n, 1),
                               all || n % 4 > 0 ? -INFINITY : 16.0, true);
        cp_comparison c = compared(s);
        const cp_contrast *olc = &c.contrast[0].severity[CP_QUANTITY_OLC];
        assert_true(olc->superiority.cliffs_delta < -0.4);
        assert_int_equal(olc->mean_difference.relation, all ? CP_NO_VALUE : CP_LESS_THAN);
        assert_true(olc->mean_interval.status != CP_INTERVAL_VALUE);
        assert_int_equal(
            c.variant[1].description[CP_QUANTITY_OLC][CP_SCOPE_ALL].mean_of_all.relation,
            all ? CP_NO_VALUE : CP_LESS_THAN);
        assert_no_width_is_zero(s, &c);
        char *answer = answered(s, &c);
        assert_null(strstr(answer, "n/a"));
        assert_non_null(strstr(answer, all ? "below every value (all left-censored)" : "<16.0 g"));
        free(answer);
        cp_comparison_destroy(&c);
        invented_destroy(s);
    }
}

// Once: "4.7 against 7.9 g, p < 0.001" of two scenarios that were equal within themselves.
static void scenarios_are_compared_within_themselves(void **state)
{
    (void)state;
    invented_study *s = invented(2, SEEDS);
    for (size_t n = 0; n < SEEDS; n++)
        for (size_t scenario = 0; scenario < 2; scenario++)
            for (size_t v = 0; v < 2; v++)
                for (size_t k = 0; k < (scenario == v ? 4 : 1); k++)
                    invented_crash(s, invented_replication(SEEDS, scenario, n, v),
                                   (scenario ? 12.0 : 4.0) + 0.1 * (double)((k * 5 + n * 3) % 11),
                                   true);
    cp_comparison c = compared(s);
    const cp_contrast *olc = &c.contrast[0].severity[CP_QUANTITY_OLC];
    assert_true(fabs(olc->superiority.cliffs_delta) < 0.2 && olc->superiority.p > 0.05);
    assert_true(fabs(olc->median[1].value - olc->median[0].value) < 0.5);
    assert_true(fabs(olc->mean_difference.value) < 0.2);
    char *answer = answered(s, &c);
    assert_non_null(strstr(answer, "at the same mix of scenarios"));
    free(answer);
    cp_comparison_destroy(&c);
    invented_destroy(s);
}

// A scenario in which the treatment never crashes has nothing to compare, and that is said.
static void a_scenario_without_treated_crashes_is_left_out(void **state)
{
    (void)state;
    invented_study *s = invented(2, SEEDS);
    for (size_t n = 0; n < SEEDS; n++)
        for (size_t scenario = 0; scenario < 2; scenario++)
            for (size_t v = 0; v < 2; v++)
                if (scenario == 0 || v == 0)
                    invented_crash(s, invented_replication(SEEDS, scenario, n, v),
                                   (scenario ? 20.0 : 5.0) + 0.1 * (double)(n * 3 % 11), true);
    cp_comparison c = compared(s);
    const cp_contrast *olc = &c.contrast[0].severity[CP_QUANTITY_OLC];
    assert_int_equal(olc->compared[0], SEEDS);
    assert_true(olc->median[0].value < 7.0);
    char *answer = answered(s, &c);
    assert_non_null(strstr(answer, "20 of baseline not compared"));
    free(answer);
    cp_comparison_destroy(&c);
    invented_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_treated_crash_has_no_p),
        cmocka_unit_test(no_treated_crash_leaves_an_upper_bound),
        cmocka_unit_test(three_against_three_say_little),
        cmocka_unit_test(one_replication_a_scenario_shows_no_scatter),
        cmocka_unit_test(no_aggravated_pair_is_not_never),
        cmocka_unit_test(a_flag_alone_is_no_benefit),
        cmocka_unit_test(crashes_above_a_severity_are_counted_once),
        cmocka_unit_test(seeds_without_a_partner_count_nowhere),
        cmocka_unit_test(censored_vehicles_are_never_dropped),
        cmocka_unit_test(scenarios_are_compared_within_themselves),
        cmocka_unit_test(a_scenario_without_treated_crashes_is_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
