/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/judged.h"

#include "store/query.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "builders/small_study.h"

typedef struct fixture {
    cp_store *store;
    cp_study_data data;
    cp_judged judged[CP_SCOPE_COUNT];
} fixture;

static const cp_slice ALL = {CP_SLICE_ALL, CP_SLICE_ALL, NULL};

static int set_up(void **state)
{
    static fixture f;
    cp_error error = {0};
    cp_comparison_options options = {.repetitions = 400};
    f = (fixture){.store = open_study("small_counterfactual.db")};
    if (cp_study_data_read(f.store, &f.data, &error) != CP_OK)
        fail_msg("%s", error.text);
    for (int scope = 0; scope < CP_SCOPE_COUNT; scope++)
        if (cp_judged_create(&f.data, 0, ALL, scope, &options, &f.judged[scope], &error) != CP_OK)
            fail_msg("%s", error.text);
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    for (int scope = 0; scope < CP_SCOPE_COUNT; scope++)
        cp_judged_destroy(&f->judged[scope]);
    cp_study_data_destroy(&f->data);
    cp_store_close(f->store);
    return 0;
}

// The crashes judged with every treatment, said in SQL.
#define JUDGED                                                                                     \
    "WITH judged AS (SELECT crash_id FROM counterfactual_pair WHERE baseline_crash_type LIKE "     \
    "'front-%%' GROUP BY crash_id HAVING sum(outcome = 'invalid' OR baseline_olc_g IS NULL OR "    \
    "treated_olc_g IS NULL) = 0), delta_v AS (SELECT crash_id, variant_id, max(delta_v_m_s) AS v " \
    "FROM counterfactual_vehicle WHERE frontal = 1 GROUP BY 1, 2) "

static double asked(fixture *f, const char *sql, const char *variant, double x)
{
    char text[2048];
    double value = NAN;
    cp_error error = {0};
    snprintf(text, sizeof text, sql, variant, x);
    if (cp_query_number(f->store, text, &value, &error) != CP_OK)
        fail_msg("%s: %s", text, error.text);
    return value;
}

static void every_variant_is_drawn_over_the_same_crashes(void **state)
{
    fixture *f = *state;
    const cp_judged *j = &f->judged[CP_SCOPE_ALL];
    double crashes = asked(f, JUDGED "SELECT count(*) FROM judged", "", 0.0);
    assert_true(crashes > 20.0);
    assert_int_equal(j->crashes, (size_t)crashes);
    assert_true(j->left_out > 0); // the study has pairs that are invalid
    assert_int_equal(j->variant_count, 3);
    assert_int_equal(j->variant[0].variant, 0);
    for (size_t k = 0; k < j->variant_count; k++)
        for (int what = 0; what < CP_EXCEEDED_COUNT; what++)
            assert_int_equal(j->variant[k].sample[what].count, j->crashes);
    assert_int_equal(j->variant[0].avoided, 0);
    assert_true(f->judged[CP_SCOPE_INSIDE].crashes < j->crashes);
    assert_true(f->judged[CP_SCOPE_INSIDE].crashes > 0);
}

static size_t above(const cp_sample *sample, double x)
{
    size_t count = 0;
    for (size_t k = 0; k < sample->count; k++)
        count += sample->value[k] > x;
    return count;
}

// What lies above a severity with a treatment, crash by crash, and how many were avoided.
static void severities_agree_with_sql(void **state)
{
    fixture *f = *state;
    for (size_t k = 1; k < 3; k++) {
        const cp_judged_variant *v = &f->judged[CP_SCOPE_ALL].variant[k];
        const char *name = f->data.variant[v->variant].name;
        assert_int_equal(
            v->avoided, (size_t)asked(f,
                                      JUDGED "SELECT count(*) FROM counterfactual_pair JOIN judged "
                                             "USING (crash_id) WHERE variant = '%s' AND outcome = "
                                             "'avoided'",
                                      name, 0.0));
        assert_true(v->avoided > 0);
        assert_true(cp_sample_censored(&v->sample[CP_EXCEEDED_OLC]) >= v->avoided);
        for (double x = 0.0; x < 30.0; x += 5.0) {
            assert_int_equal(above(&v->sample[CP_EXCEEDED_OLC], x),
                             (size_t)asked(f,
                                           JUDGED
                                           "SELECT count(*) FROM counterfactual_pair JOIN judged "
                                           "USING (crash_id) WHERE variant = '%s' AND "
                                           "treated_olc_g > %g",
                                           name, x));
            assert_int_equal(above(&v->sample[CP_EXCEEDED_DELTA_V], x),
                             (size_t)asked(f,
                                           JUDGED
                                           "SELECT count(*) FROM delta_v JOIN judged USING "
                                           "(crash_id) JOIN variant AS a ON a.id = variant_id "
                                           "WHERE a.name = '%s' AND v > %g",
                                           name, x));
        }
    }
}

// The curve counts the sample's crashes, over the vehicle-km of the baseline.
static void the_curve_is_the_sample_per_vehicle_km(void **state)
{
    fixture *f = *state;
    double km = asked(f, "SELECT sum(vehicle_km) FROM replication WHERE status = 'done'%s", "", 0);
    for (size_t k = 0; k < 3; k++) {
        const cp_judged_variant *v = &f->judged[CP_SCOPE_ALL].variant[k];
        for (int what = 0; what < CP_EXCEEDED_COUNT; what++) {
            const cp_exceedance *e = &v->curve[what][k + 3];
            assert_int_equal(e->crashes, above(&v->sample[what], e->x));
            assert_true(fabs(e->rate - 1e6 * (double)e->crashes / km) < 1e-6 * e->rate + 1e-12);
            assert_int_equal(e->interval.status, CP_INTERVAL_VALUE);
            assert_true(e->interval.low <= e->rate && e->rate < e->interval.high);
        }
    }
}

static void no_pairs_nothing_judged(void **state)
{
    fixture *f = *state;
    cp_study_data none = f->data;
    cp_judged judged;
    cp_error error = {0};
    cp_comparison_options options = {.repetitions = 400};
    none.pair_count = 0;
    assert_int_equal(cp_judged_create(&none, 0, ALL, CP_SCOPE_ALL, &options, &judged, &error),
                     CP_OK);
    assert_int_equal(judged.variant_count, 0);
    assert_null(cp_judged_find(&judged, 0));
    cp_judged_destroy(&judged);
    assert_ptr_equal(cp_judged_find(&f->judged[0], 0), &f->judged[0].variant[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_variant_is_drawn_over_the_same_crashes),
        cmocka_unit_test(severities_agree_with_sql),
        cmocka_unit_test(the_curve_is_the_sample_per_vehicle_km),
        cmocka_unit_test(no_pairs_nothing_judged),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
