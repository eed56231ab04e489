/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/convergence.h"

#include "analysis/comparison.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>

#include <cmocka.h>

#include "builders/small_study.h"

static const cp_slice ALL = {CP_SLICE_ALL, CP_SLICE_ALL, NULL};

typedef struct study {
    cp_store *store;
    cp_study_data data;
    cp_comparison comparison;
    cp_convergence convergence;
} study;

static study opened(const char *file)
{
    study s = {.store = open_study(file)};
    cp_error error = {0};
    cp_comparison_options options = {.repetitions = 200, .permutations = 99};
    if (cp_study_data_read(s.store, &s.data, &error) != CP_OK ||
        cp_compare(&s.data, 0, ALL, &options, &s.comparison, &error) != CP_OK ||
        cp_convergence_create(&s.data, 0, ALL, &s.convergence, &error) != CP_OK)
        fail_msg("%s", error.text);
    return s;
}

static void close_study(study *s)
{
    cp_convergence_destroy(&s->convergence);
    cp_comparison_destroy(&s->comparison);
    cp_study_data_destroy(&s->data);
    cp_store_close(s->store);
}

static void check_growth(const cp_convergence_series *series)
{
    assert_true(series->count > 2);
    for (size_t k = 1; k < series->count; k++)
        assert_true(series->point[k].replications > series->point[k - 1].replications);
}

// Over all replications the figure is the study's own.
static void the_last_ratio_is_the_study_s(void **state)
{
    (void)state;
    study s = opened("small_study.db");
    assert_int_equal(s.convergence.what, CP_CONVERGING_RATE_RATIO);
    assert_int_equal(s.convergence.count, 1);
    const cp_convergence_series *series = &s.convergence.series[0];
    const cp_contrast_figures *c = &s.comparison.contrast[0];
    const cp_convergence_point *last = &series->point[series->count - 1];
    check_growth(series);
    assert_int_equal(series->variant, c->variant);
    assert_int_equal(last->replications, c->replications[1]);
    assert_true(last->value == c->rate_ratio);
    assert_true(last->interval.low == c->rate_ratio_widened.low);
    assert_true(last->interval.high == c->rate_ratio_widened.high);
    close_study(&s);
}

static void the_last_share_is_the_study_s(void **state)
{
    (void)state;
    study s = opened("small_counterfactual.db");
    assert_int_equal(s.convergence.what, CP_CONVERGING_AVOIDED);
    assert_int_equal(s.convergence.count, s.comparison.counterfactual_count);
    for (size_t k = 0; k < s.convergence.count; k++) {
        const cp_convergence_series *series = &s.convergence.series[k];
        const cp_counterfactual_figures *c = &s.comparison.counterfactual[k];
        const cp_convergence_point *last = &series->point[series->count - 1];
        check_growth(series);
        assert_int_equal(last->replications, s.comparison.variant[0].replications);
        assert_true(last->value == (double)c->outcome[CP_OUTCOME_AVOIDED] / (double)c->valid);
        assert_true(last->interval.low == c->share[CP_OUTCOME_AVOIDED].low);
        assert_true(last->interval.high == c->share[CP_OUTCOME_AVOIDED].high);
    }
    close_study(&s);
}

// The first point has one replication of every scenario; of one scenario it is the plain ratio of
// two.
static void the_first_point_is_the_first_replications(void **state)
{
    (void)state;
    study s = opened("small_study.db");
    const cp_convergence_point *first = &s.convergence.series[0].point[0];
    double crashes[2] = {0.0, 0.0}, km[2] = {0.0, 0.0};
    size_t scenario = 0;
    int64_t number = s.data.replication[0].number;
    for (size_t k = 0; k < s.data.crash_count; k++) {
        const cp_study_replication *r = &s.data.replication[s.data.crash[k].replication];
        crashes[r->variant] +=
            s.data.crash[k].frontal && r->number == number && r->scenario == scenario;
    }
    for (size_t k = 0; k < s.data.replication_count; k++)
        if (s.data.replication[k].number == number && s.data.replication[k].scenario == scenario)
            km[s.data.replication[k].variant] = s.data.replication[k].vehicle_km;
    cp_convergence of_one;
    cp_error error = {0};
    cp_slice slice = {scenario, CP_SLICE_ALL, NULL};
    assert_int_equal(cp_convergence_create(&s.data, 0, slice, &of_one, &error), CP_OK);
    assert_int_equal(of_one.series[0].point[0].replications, 1);
    assert_true(crashes[0] > 0.0);
    assert_true(fabs(of_one.series[0].point[0].value - crashes[1] / km[1] / (crashes[0] / km[0])) <
                1e-12);
    assert_int_equal(first->replications, s.data.scenario_count);
    cp_convergence_destroy(&of_one);
    close_study(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_last_ratio_is_the_study_s),
        cmocka_unit_test(the_last_share_is_the_study_s),
        cmocka_unit_test(the_first_point_is_the_first_replications),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
