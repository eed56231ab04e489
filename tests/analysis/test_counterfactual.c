/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/counterfactual.h"

#include "analysis/comparison.h"
#include "report/answer.h"
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
    cp_comparison comparison;
} fixture;

static int set_up(void **state)
{
    static fixture f;
    cp_error error = {0};
    cp_comparison_options options = {.repetitions = 400, .permutations = 199};
    f = (fixture){.store = open_study("small_counterfactual.db")};
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

static double asked(fixture *f, const char *sql, const char *variant)
{
    char text[1024];
    double value = NAN;
    cp_error error = {0};
    snprintf(text, sizeof text, sql, variant);
    if (cp_query_number(f->store, text, &value, &error) != CP_OK)
        fail_msg("%s", error.text);
    return value;
}

// Only the baseline has replications; each treatment has pairs.
static void outcomes_add_up_and_agree_with_the_view(void **state)
{
    fixture *f = *state;
    assert_int_equal(f->comparison.variant_count, 1);
    assert_int_equal(f->comparison.contrast_count, 0);
    assert_int_equal(f->comparison.counterfactual_count, 2);
    for (size_t k = 0; k < 2; k++) {
        const cp_counterfactual_figures *c = &f->comparison.counterfactual[k];
        const char *name = f->data.variant[c->variant].name;
        size_t sum = 0, by_olc = 0;
        for (int o = 0; o < CP_OUTCOME_NO_OLC; o++) {
            char sql[256];
            snprintf(sql, sizeof sql,
                     "SELECT count(*) FROM counterfactual_pair WHERE variant = '%%s' AND outcome ="
                     " '%s' AND baseline_crash_type LIKE 'front-%%%%'",
                     cp_outcome_text((cp_outcome)o));
            assert_int_equal(c->outcome[o], (size_t)asked(f, sql, name));
            sum += c->outcome[o];
        }
        for (int o = 0; o <= CP_OUTCOME_NO_OLC; o++)
            by_olc += c->outcome_olc[o];
        assert_int_equal(sum, c->crashes);
        assert_int_equal(by_olc, c->crashes);
        assert_int_equal(c->crashes, f->comparison.variant[0].frontal_crashes);
        assert_int_equal(c->valid, c->crashes - c->outcome[CP_OUTCOME_INVALID]);
        assert_int_equal(c->reason[CP_NULL_NO_CHECKPOINT], c->outcome[CP_OUTCOME_INVALID]);
        assert_true(c->outcome[CP_OUTCOME_INVALID] > 0 && c->outcome[CP_OUTCOME_AVOIDED] > 0);
        const cp_interval *share = &c->share[CP_OUTCOME_AVOIDED];
        double avoided = (double)c->outcome[CP_OUTCOME_AVOIDED] / (double)c->valid;
        assert_int_equal(share->status, CP_INTERVAL_VALUE);
        assert_true(0.0 < share->low && share->low < avoided && avoided < share->high);
    }
}

// Avoided counts 0 g in the headline; conditional on crashing only the pairs that crash again.
static void paired_severity_agrees_with_sql(void **state)
{
    fixture *f = *state;
    static const char *const MEAN[] = {
        "SELECT avg(treated_olc_g - baseline_olc_g) FROM counterfactual_pair WHERE variant = '%s'"
        " AND outcome <> 'invalid' AND baseline_crash_type LIKE 'front-%%'",
        "SELECT avg(treated_olc_g - baseline_olc_g) FROM counterfactual_pair WHERE variant = '%s'"
        " AND outcome IN ('mitigated', 'unchanged', 'aggravated')"
        " AND baseline_crash_type LIKE 'front-%%'"};
    for (size_t k = 0; k < 2; k++) {
        const cp_counterfactual_figures *c = &f->comparison.counterfactual[k];
        const char *name = f->data.variant[c->variant].name;
        for (int which = 0; which < CP_PAIRED_COUNT; which++) {
            const cp_paired *p = &c->olc_g[which];
            assert_true(fabs(p->mean - asked(f, MEAN[which], name)) < 1e-9);
            assert_int_equal(p->hodges_lehmann_interval.status, CP_INTERVAL_VALUE);
            assert_true(p->hodges_lehmann_interval.low <= p->hodges_lehmann &&
                        p->hodges_lehmann <= p->hodges_lehmann_interval.high);
        }
        assert_int_equal(c->olc_g[CP_PAIRED_ALL].count, c->valid);
        assert_int_equal(c->olc_g[CP_PAIRED_CRASHING].count, c->outcome[CP_OUTCOME_MITIGATED] +
                                                                 c->outcome[CP_OUTCOME_UNCHANGED] +
                                                                 c->outcome[CP_OUTCOME_AGGRAVATED]);
        assert_true(c->olc_g[CP_PAIRED_ALL].mean < c->olc_g[CP_PAIRED_CRASHING].mean);
        assert_true(c->p_holm[CP_PAIRED_ALL] >= c->olc_g[CP_PAIRED_ALL].signed_rank.p);
    }
}

// Expected injured drivers of the valid pairs before and after, avoided = 0, by NASS-CDS.
static void benefit_agrees_with_sql(void **state)
{
    fixture *f = *state;
#define RISK "sum(1.0 / (1.0 + exp(5.08188 - 0.08715096 * 3.6 * e.delta_v_without_rebound_m_s)))"
#define OF_VALID                                                                                   \
    " JOIN counterfactual_pair AS p ON p.crash_id = w.crash_id AND p.variant = '%s' AND"           \
    " p.outcome <> 'invalid' AND p.baseline_crash_type LIKE 'front-%%'"
    size_t mais2 = 0;
    while (strcmp(f->data.risk[mais2].name, "NASS-CDS") != 0 ||
           strcmp(f->data.risk[mais2].level, "MAIS2+") != 0)
        mais2++;
    for (size_t k = 0; k < 2; k++) {
        const cp_counterfactual_figures *c = &f->comparison.counterfactual[k];
        const char *name = f->data.variant[c->variant].name;
        double before = asked(f,
                              "SELECT " RISK " FROM crash_vehicle AS w JOIN"
                              " delta_v_without_rebound AS e USING (crash_id, role)" OF_VALID
                              " WHERE w.frontal = 1",
                              name);
        double after = asked(f,
                             "SELECT " RISK " FROM counterfactual_vehicle AS w JOIN"
                             " counterfactual_delta_v_without_rebound AS e USING (crash_id, "
                             "variant_id, role)" OF_VALID
                             " AND p.variant_id = w.variant_id WHERE w.frontal = 1",
                             name);
        const cp_benefit_figures *b = &c->benefit[mais2];
        assert_true(fabs(b->baseline - before) < 1e-9 * before);
        assert_true(fabs(b->treatment - after) < 1e-9 * after);
        assert_true(fabs(b->benefit_1 - (1.0 - after / before)) < 1e-12);
        assert_true(b->interval.low < b->benefit_1 && b->benefit_1 < b->interval.high);
    }
}

static void answer_tells_what_became_of_the_crashes(void **state)
{
    fixture *f = *state;
    cp_error error = {0};
    char *answer = NULL, expected[256];
    assert_int_equal(cp_comparison_answer(&f->data, &f->comparison, &answer, &error), CP_OK);
    // A sentence each, its interval first.
    const char *line = answer;
    for (size_t k = 0; k < 2; k++) {
        const cp_counterfactual_figures *c = &f->comparison.counterfactual[k];
        cp_interval share = c->share[CP_OUTCOME_AVOIDED];
        snprintf(expected, sizeof expected,
                 "%s: %.0f to %.0f %% of the frontal crashes with baseline avoided (95 %% "
                 "interval; %zu of %zu valid ones",
                 f->data.variant[c->variant].name, 100.0 * share.low, 100.0 * share.high,
                 c->outcome[CP_OUTCOME_AVOIDED], c->valid);
        assert_memory_equal(line, expected, strlen(expected));
        line = strchr(line, '\n') + 1;
    }
    // Then an empty line and the conditions, each once.
    assert_int_equal(*line, '\n');
    assert_null(strchr(line + 1, '\n'));
    assert_ptr_equal(strstr(answer, "Hodges and Lehmann"), strstr(line, "Hodges and Lehmann"));
    assert_null(strstr(strstr(line, "Hodges and Lehmann") + 1, "Hodges and Lehmann"));
    assert_non_null(strstr(answer, "could not be judged"));
    free(answer);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(outcomes_add_up_and_agree_with_the_view),
        cmocka_unit_test(paired_severity_agrees_with_sql),
        cmocka_unit_test(benefit_agrees_with_sql),
        cmocka_unit_test(answer_tells_what_became_of_the_crashes),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
