/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/comparison.h"
#include "analysis/field_comparison.h"
#include "report/field_page.h"
#include "report/field_words.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/small_study.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static cp_field_table nass(void)
{
    cp_field_table table;
    cp_error error = {0};
    if (cp_field_table_read("nass", &table, &error) != CP_OK)
        fail_msg("%s", error.text);
    return table;
}

// A table of a test; the file is gone again afterwards.
static cp_status read_text(const char *text, cp_field_table *table, cp_error *error)
{
    char path[] = "/tmp/field_XXXXXX";
    int file = mkstemp(path);
    assert_true(file >= 0 && write(file, text, strlen(text)) == (ssize_t)strlen(text));
    close(file);
    cp_status status = cp_field_table_read(path, table, error);
    unlink(path);
    return status;
}

// ---- the table -------------------------------------------------------------------------------

// Shares, their standard errors and the median of the extract's own README.
static void table_inside_is_the_field(void **state)
{
    (void)state;
    cp_field_table t = nass();
    cp_field_share share[CP_FIELD_CLASSES_MAX];
    cp_error error = {0};
    assert_int_equal(t.count, 22941);
    assert_int_equal(t.strata, 12);
    assert_int_equal(t.clusters, 27);
    assert_string_equal(t.name, "NASS-CDS 2000-2015");
    assert_non_null(strstr(t.bias, "23 % low on average"));
    assert_non_null(strstr(t.bias, "over 228 frontals"));
    assert_int_equal(cp_field_table_shares(&t, CP_FIELD_TYPE, share, &error), CP_OK);
    const double wanted[3][2] = {{0.244, 0.010}, {0.493, 0.018}, {0.262, 0.012}};
    for (int k = 0; k < 3; k++) {
        assert_true(fabs(share[k].share_1 - wanted[k][0]) < 0.002);
        assert_true(fabs(share[k].se_1 - wanted[k][1]) < 0.001);
    }
    // Half of the weight at most 17 km/h.
    double below = 0.0, above = 0.0, all = 0.0;
    for (size_t k = 0; k < t.count; k++) {
        below += t.value[CP_FIELD_VALUE_DELTA_V][k] < 17.0 ? t.weight[k] : 0.0;
        above += t.value[CP_FIELD_VALUE_DELTA_V][k] > 17.0 ? t.weight[k] : 0.0;
        all += t.weight[k];
    }
    assert_true(below < 0.5 * all && above < 0.5 * all);
    cp_field_table_destroy(&t);
}

static void wrong_tables_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        const char *words;
    } CASE[] = {
        {"weight,crash_type\n1,front-side\n", "column delta_v_kmh is missing"},
        {"weight,crash_type,delta_v_kmh\n0,front-side,20\n",
         ":2: weight must be a number between 1e-09 and"},
        {"# x\nweight,crash_type,delta_v_kmh\n1,front-side,-20\n",
         ":3: delta_v_kmh must be a number between 0 and 400, found '-20'"},
        {"weight,crash_type,delta_v_kmh,overlap_1\n1,front-side,20,64\n",
         ":2: overlap_1 must be a number between 0 and 1, found '64'"},
        {"weight,crash_type,delta_v_kmh\n1,side-side,20\n", "found 'side-side'"},
        {"\x1f\x8b\x08 and no more", "what gzip packed is damaged"},
    };
    for (size_t k = 0; k < sizeof CASE / sizeof *CASE; k++) {
        cp_field_table t;
        cp_error error = {0};
        assert_int_equal(read_text(CASE[k].text, &t, &error), CP_BAD_INPUT);
        if (!strstr(error.text, CASE[k].words))
            fail_msg("case %zu: %s", k, error.text);
        cp_field_table_destroy(&t);
    }
}

static void blanks_are_unknown(void **state)
{
    (void)state;
    cp_field_table t;
    cp_error error = {0};
    assert_int_equal(
        read_text("\xef\xbb\xbf# name: mine\nweight,crash_type,delta_v_kmh,pdof_deg\r\n"
                  "2,,20,-30\r\n1,front-rear,,\r\n",
                  &t, &error),
        CP_OK);
    assert_string_equal(t.name, "mine");
    assert_null(t.bias);
    assert_int_equal(t.clusters, 0);
    assert_int_equal(cp_field_table_class(&t, 0, CP_FIELD_TYPE), CP_FIELD_UNKNOWN);
    assert_int_equal(cp_field_table_class(&t, 0, CP_FIELD_DELTA_V), 3);
    assert_int_equal(cp_field_table_class(&t, 1, CP_FIELD_DELTA_V), CP_FIELD_UNKNOWN);
    assert_int_equal(cp_field_table_class(&t, 1, CP_FIELD_OVERLAP), CP_FIELD_UNKNOWN);
    assert_true(t.value[CP_FIELD_VALUE_PDOF][0] == 30.0);
    cp_field_share share[CP_FIELD_CLASSES_MAX];
    assert_int_equal(cp_field_table_shares(&t, CP_FIELD_TYPE, share, &error), CP_OK);
    assert_true(share[2].share_1 == 1.0 && isnan(share[2].se_1));
    cp_field_table_destroy(&t);
}

// ---- a study beside it -----------------------------------------------------------------------

typedef struct fixture {
    cp_store *store;
    cp_study_data data;
    cp_field_table table;
    cp_field_study study;
    cp_field_request request;
    cp_comparison comparison;
} fixture;

static void begin(fixture *f, const char *file, cp_field_table table, double cap,
                  const bool margin[CP_FIELD_MARGIN_COUNT], bool exact)
{
    cp_error error = {0};
    size_t baseline = 0;
    *f = (fixture){.store = open_study(file), .table = table};
    assert_int_equal(cp_study_data_read(f->store, &f->data, &error), CP_OK);
    assert_int_equal(cp_study_data_variant(&f->data, NULL, &baseline, &error), CP_OK);
    assert_int_equal(cp_field_study_read(f->store, &f->data, &f->study, &error), CP_OK);
    f->request =
        (cp_field_request){.table = &f->table, .study = &f->study, .exact = exact, .cap = cap};
    memcpy(f->request.margin, margin, sizeof f->request.margin);
    cp_comparison_options options = cp_comparison_options_default();
    options.repetitions = options.permutations = 99;
    options.field = &f->request;
    cp_slice slice = {CP_SLICE_ALL, CP_SLICE_ALL, NULL};
    if (cp_compare(&f->data, baseline, slice, &options, &f->comparison, &error) != CP_OK)
        fail_msg("%s", error.text);
}

static void end(fixture *f)
{
    cp_comparison_destroy(&f->comparison);
    cp_field_study_destroy(&f->study);
    cp_field_table_destroy(&f->table);
    cp_study_data_destroy(&f->data);
    cp_store_close(f->store);
}

static const bool ALL[CP_FIELD_MARGIN_COUNT] = {true, true, true};

static void assert_same(double found, double wanted)
{
    if (!(fabs(found - wanted) <= 1e-9 * fmax(1.0, fabs(wanted))))
        fail_msg("found %.12g, expected %.12g", found, wanted);
}

// What is not weighted is what the comparison has.
static void unweighted_figures_are_those_of_the_comparison(void **state)
{
    (void)state;
    fixture f;
    begin(&f, "small_study.db", nass(), INFINITY, ALL, false);
    for (size_t v = 0; v < f.comparison.variant_count; v++) {
        const cp_variant_figures *own = &f.comparison.variant[v];
        const cp_raked_arm_figures *plain = &own->field->figures[0];
        assert_same(plain->rate[CP_FIELD_CRASH], own->rate);
        assert_same(plain->rate[CP_FIELD_ABOVE + CP_EXCEEDED_OLC],
                    own->above[CP_EXCEEDED_OLC].rate);
        assert_same(plain->quantile[CP_RAKED_MEDIAN],
                    own->description[CP_QUANTITY_OLC][CP_SCOPE_ALL].median.value);
        for (size_t k = 0; k < f.data.risk_count; k++)
            assert_same(plain->rate[CP_FIELD_INJURED + k], own->injury[CP_SCOPE_ALL][k].rate);
    }
    const cp_contrast_figures *c = &f.comparison.contrast[0];
    assert_same(c->field->figures[0].ratio[CP_FIELD_CRASH], c->rate_ratio);
    assert_same(c->field->figures[0].ratio[CP_FIELD_ABOVE], c->above[CP_EXCEEDED_OLC].ratio);
    for (size_t k = 0; k < f.data.risk_count; k++)
        assert_same(1.0 - c->field->figures[0].ratio[CP_FIELD_INJURED + k],
                    c->benefit[k].benefit_1);
    end(&f);
}

// The baseline weighted has the field's margins, over the classes that the study makes.
static void margins_are_met(void **state)
{
    (void)state;
    fixture f;
    begin(&f, "small_study.db", nass(), INFINITY, ALL, false);
    const cp_field_variant *v = f.comparison.variant[0].field;
    assert_true(v->weighted && v->gap_1 < 1e-6);
    for (int m = 0; m < CP_FIELD_MARGIN_COUNT; m++) {
        double made = 0.0;
        for (size_t k = 0; k < CP_FIELD_MARGIN_CLASSES[m]; k++)
            made += v->shape.of[m][k].vehicles ? v->shape.of[m][k].field_1 : 0.0;
        for (size_t k = 0; k < CP_FIELD_MARGIN_CLASSES[m]; k++)
            if (v->shape.of[m][k].vehicles)
                assert_true(fabs(v->shape.of[m][k].weighted_1 - v->shape.of[m][k].field_1 / made) <
                            1e-6);
    }
    assert_true(v->shape.effective < (double)v->shape.vehicles);
    assert_true(v->shape.number[CP_FIELD_VALUE_DELTA_V].distance[1].mean <
                v->shape.number[CP_FIELD_VALUE_DELTA_V].distance[0].mean);
    // A treatment is compared without delta-v, and with it beside.
    assert_true(f.comparison.contrast[0].field->delta_v_too);
    assert_false(f.comparison.variant[1].field->weighted);
    end(&f);
}

// A field of crash types alone: weights by hand, for crashes, injuries and the ratio.
static void weights_by_crash_type_agree_with_sums_by_hand(void **state)
{
    (void)state;
    fixture f;
    cp_field_table table;
    cp_error error = {0};
    const bool type_only[CP_FIELD_MARGIN_COUNT] = {true, false, false};
    const double target[3] = {0.2, 0.5, 0.3};
    assert_int_equal(read_text("weight,crash_type,delta_v_kmh\n2,front-front,20\n"
                               "5,front-side,20\n3,front-rear,20\n",
                               &table, &error),
                     CP_OK);
    begin(&f, "small_study.db", table, INFINITY, type_only, true);
    double count[2][3] = {{0.0}}, injured[2][3] = {{0.0}}, crashes[2][3] = {{0.0}}, all = 0.0;
    const cp_study_risk *risk = &f.data.risk[0];
    for (size_t k = 0; k < f.data.vehicle_count; k++) {
        const cp_study_vehicle *v = &f.data.vehicle[k];
        const cp_study_crash *crash = &f.data.crash[v->crash];
        size_t variant = f.data.replication[crash->replication].variant;
        const char *type = f.data.crash_type[crash->crash_type];
        unsigned char own = cp_field_type_class(type);
        if (!v->frontal)
            continue;
        double p = cp_risk_probability(&risk->function, v->predictor[risk->predictor], type);
        count[variant][own]++;
        injured[variant][own] += isnan(p) ? 0.0 : p;
        crashes[variant][own] += f.data.vehicle[k ^ 1].frontal ? 0.5 : 1.0;
        all += variant == 0;
    }
    double sum[2] = {0.0, 0.0}, hurt[2] = {0.0, 0.0};
    for (int variant = 0; variant < 2; variant++)
        for (int t = 0; t < 3; t++) {
            double weight = target[t] * all / count[0][t];
            sum[variant] += weight * crashes[variant][t];
            hurt[variant] += weight * injured[variant][t];
        }
    // Both variants drove the same distances in both scenarios.
    const cp_raked_figures *found = &f.comparison.contrast[0].field->figures[CP_FIELD_WEIGHTED];
    assert_same(found->ratio[CP_FIELD_CRASH], sum[1] / sum[0]);
    assert_same(found->ratio[CP_FIELD_INJURED], hurt[1] / hurt[0]);
    double km = f.comparison.variant[0].vehicle_km;
    assert_same(f.comparison.variant[0].field->figures[1].rate[CP_FIELD_INJURED],
                1e6 * hurt[0] / km);
    assert_false(f.comparison.contrast[0].field->delta_v_too);
    end(&f);
}

// Pairs: what is not weighted is the benefit of the pairs, and each keeps its baseline's weight.
static void pairs_keep_the_weight_of_the_baseline(void **state)
{
    (void)state;
    fixture f;
    begin(&f, "small_counterfactual.db", nass(), CP_FIELD_CAP, ALL, false);
    assert_true(f.comparison.counterfactual_count > 0);
    for (size_t k = 0; k < f.comparison.counterfactual_count; k++) {
        const cp_counterfactual_figures *c = &f.comparison.counterfactual[k];
        for (size_t r = 0; r < f.data.risk_count; r++)
            assert_same(1.0 - c->field->figures[0].ratio[CP_FIELD_INJURED + r],
                        c->benefit[r].benefit_1);
        double kept = 1.0 - (double)c->outcome[CP_OUTCOME_AVOIDED] / (double)c->valid;
        assert_same(c->field->figures[0].ratio[CP_FIELD_CRASH], kept);
        assert_false(c->field->delta_v_too);
        assert_true(c->field->figures[1].ratio[CP_FIELD_CRASH] > 0.0);
        assert_true(c->field->figures[1].arm[0].effective < c->field->figures[0].arm[0].effective);
    }
    end(&f);
}

static void words_tell_what_is_missing(void **state)
{
    (void)state;
    fixture f;
    char *words = NULL;
    cp_error error = {0};
    begin(&f, "small_study.db", nass(), CP_FIELD_CAP, ALL, false);
    assert_int_equal(cp_field_words(&f.comparison, &f.request, &words, &error), CP_OK);
    assert_non_null(strstr(words, "that the study never makes"));
    assert_non_null(strstr(words, "delta_v 10-15 km/h (24 %)"));
    assert_non_null(strstr(words, "of ones that the field never has"));
    assert_non_null(strstr(words, "WinSMASH's delta-v is 23 % low"));
    assert_non_null(strstr(words, "Delta-v is what treatments change"));
    free(words);
    end(&f);
}

// What a page lays under the study's delta-v.
static void curves_of_the_page_are_the_field_s(void **state)
{
    (void)state;
    json_t *page = json_object();
    cp_error error = {0};
    assert_int_equal(cp_field_page_add(page, &error), CP_OK);
    const json_t *field = json_object_get(page, "field"),
                 *curves = json_object_get(field, "curves");
    static const char *const NAME[] = {"all", "front-front", "front-side", "front-rear"};
    const int median[] = {17, 20, 16, 18}; // of the extract's README
    for (size_t k = 0; k < 4; k++) {
        const json_t *share = json_object_get(json_object_get(curves, NAME[k]), "share");
        double before = 0.0;
        assert_int_equal(json_array_size(share), json_array_size(json_object_get(field, "x")));
        for (size_t i = 0; i < json_array_size(share); i++) {
            double now = json_real_value(json_array_get(share, i));
            assert_true(now >= before && now <= 1.0);
            if (before < 0.5 && now >= 0.5)
                assert_true(i == (size_t)median[k]);
            before = now;
        }
        assert_true(before > 0.995);
    }
    json_decref(page);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(table_inside_is_the_field),
        cmocka_unit_test(wrong_tables_are_refused),
        cmocka_unit_test(blanks_are_unknown),
        cmocka_unit_test(unweighted_figures_are_those_of_the_comparison),
        cmocka_unit_test(margins_are_met),
        cmocka_unit_test(weights_by_crash_type_agree_with_sums_by_hand),
        cmocka_unit_test(pairs_keep_the_weight_of_the_baseline),
        cmocka_unit_test(words_tell_what_is_missing),
        cmocka_unit_test(curves_of_the_page_are_the_field_s),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
