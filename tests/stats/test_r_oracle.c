/* SPDX-License-Identifier: GPL-3.0-or-later */
// Every estimator against R; the values and R's version stand in r_oracle.h, made by r_oracle.R.
#include "stats/band.h"
#include "stats/contrast.h"
#include "stats/describe.h"
#include "stats/paired.h"
#include "stats/precision.h"
#include "stats/rates.h"
#include "stats/risk_function.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "builders/assert_near.h"
#include "r_oracle.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))
#define assert_close(found, expected)                                                              \
    assert_near(found, expected, 1e-8 * fmax(fabs(expected), 1e-300))

enum { MOST = 128 };

// One value a cluster unless clusters are given.
static cp_sample sample_of(const double *value, const double *of, size_t count, size_t clusters)
{
    size_t cluster[MOST];
    for (size_t k = 0; k < count; k++)
        cluster[k] = of ? (size_t)of[k] : k;
    cp_sample sample;
    cp_error error = {0};
    assert_int_equal(
        cp_sample_create(value, cluster, count, clusters ? clusters : count, &sample, &error),
        CP_OK);
    return sample;
}

static cp_resampling resampling_of(size_t a, size_t b)
{
    cp_resampling r = cp_resampling_default();
    r.cluster_count[0] = a;
    r.cluster_count[1] = b;
    r.repetitions = 50;
    return r;
}

static void descriptions(void **state)
{
    (void)state;
    cp_sample x = sample_of(R_X, NULL, COUNT(R_X), 0), y = sample_of(R_Y, NULL, COUNT(R_Y), 0);
    cp_description dx = cp_describe(&x), dy = cp_describe(&y);
    const cp_estimate *of_x[] = {&dx.minimum, &dx.q25, &dx.median, &dx.q75,
                                 &dx.p90,     &dx.p95, &dx.maximum};
    const cp_estimate *of_y[] = {&dy.minimum, &dy.q25, &dy.median, &dy.q75,
                                 &dy.p90,     &dy.p95, &dy.maximum};
    for (size_t k = 0; k < 7; k++) {
        assert_close(of_x[k]->value, R_X_QUANTILES[k]);
        assert_close(of_y[k]->value, R_Y_QUANTILES[k]);
    }
    assert_close(dx.mean, R_X_MEAN_SD[0]);
    assert_close(dx.sd, R_X_MEAN_SD[1]);
    assert_close(cp_ecdf(&x, 20.0), R_X_ECDF_AT_20[0]);
    cp_sample_destroy(&x);
    cp_sample_destroy(&y);
}

static void rank_statistics(void **state)
{
    (void)state;
    cp_sample x = sample_of(R_X, NULL, COUNT(R_X), 0), y = sample_of(R_Y, NULL, COUNT(R_Y), 0);
    cp_resampling r = resampling_of(x.cluster_count, y.cluster_count);
    cp_contrast c;
    cp_error error = {0};
    assert_int_equal(cp_contrast_samples(&x, &y, &r, &c, &error), CP_OK);
    double pairs = (double)(x.count * y.count);
    assert_close(0.5 * (c.superiority.cliffs_delta + 1.0) * pairs, R_MANN_WHITNEY_U_P[0]);
    assert_close(c.distance, R_KS_D_P[0]);
    assert_close(c.superiority.cliffs_delta, R_CLIFFS_DELTA[0]);
    assert_close(c.median_difference.value, R_Y_QUANTILES[2] - R_X_QUANTILES[2]);
    assert_close(c.p90_difference.value, R_Y_QUANTILES[4] - R_X_QUANTILES[4]);
    cp_sample_destroy(&x);
    cp_sample_destroy(&y);
}

static void rank_statistics_with_ties(void **state)
{
    (void)state;
    double xt[MOST], yt[MOST];
    for (size_t k = 0; k < COUNT(R_X); k++)
        xt[k] = nearbyint(R_X[k] / 4.0);
    for (size_t k = 0; k < COUNT(R_Y); k++)
        yt[k] = nearbyint(R_Y[k] / 4.0);
    cp_sample x = sample_of(xt, NULL, COUNT(R_X), 0), y = sample_of(yt, NULL, COUNT(R_Y), 0);
    cp_resampling r = resampling_of(x.cluster_count, y.cluster_count);
    cp_contrast c;
    cp_error error = {0};
    assert_int_equal(cp_contrast_samples(&x, &y, &r, &c, &error), CP_OK);
    double pairs = (double)(x.count * y.count);
    assert_close(0.5 * (c.superiority.cliffs_delta + 1.0) * pairs, R_TIED_U[0]);
    assert_close(c.superiority.cliffs_delta, R_TIED_DELTA[0]);
    assert_close(c.distance, R_TIED_KS_D[0]);
    cp_sample_destroy(&x);
    cp_sample_destroy(&y);
}

static void assert_superiority(const cp_superiority *s, const double *expected)
{
    assert_close(s->cliffs_delta, expected[0]);
    assert_close(s->standard_error, expected[1]);
    assert_close(s->freedom, expected[2]);
    assert_close(s->p, expected[3]);
    assert_close(s->interval.low, expected[4]);
    assert_close(s->interval.high, expected[5]);
}

// Clusters of any size, ties, strata: delta, its jackknife, degrees of freedom, p and interval.
static void superiority_of_clusters(void **state)
{
    (void)state;
    enum { CLUSTERS = COUNT(R_RANK_STRATUM) };
    cp_sample a = sample_of(R_RANK_A, R_RANK_A_CLUSTER, COUNT(R_RANK_A), CLUSTERS);
    cp_sample b = sample_of(R_RANK_B, R_RANK_B_CLUSTER, COUNT(R_RANK_B), CLUSTERS);
    size_t stratum[CLUSTERS];
    for (size_t c = 0; c < CLUSTERS; c++)
        stratum[c] = (size_t)R_RANK_STRATUM[c];
    const double *const expected[2][2] = {{R_RANK_APART, R_RANK_PAIRED},
                                          {R_RANK_STRATA_APART, R_RANK_STRATA_PAIRED}};
    cp_contrast c;
    cp_error error = {0};
    for (int strata = 0; strata < 2; strata++) {
        for (int paired = 0; paired < 2; paired++) {
            cp_resampling r = resampling_of(CLUSTERS, CLUSTERS);
            r.paired = paired;
            r.stratum[0] = r.stratum[1] = strata ? stratum : NULL;
            assert_int_equal(cp_contrast_samples(&a, &b, &r, &c, &error), CP_OK);
            assert_superiority(&c.superiority, expected[strata][paired]);
        }
    }
    assert_close(c.mean_difference.value, R_MIXED_DIFFERENCE[0]);
    assert_close(c.median_difference.value, R_MIXED_DIFFERENCE[1]);
    assert_close(c.p90_difference.value, R_MIXED_DIFFERENCE[2]);
    cp_sample_destroy(&a);
    cp_sample_destroy(&b);
}

// Mantel and Haenszel's ratio and intervals widened by dispersion.
static void widened_rates(void **state)
{
    (void)state;
    enum { CLUSTERS = COUNT(R_MH_YA) };
    size_t stratum[CLUSTERS];
    for (size_t c = 0; c < CLUSTERS; c++)
        stratum[c] = (size_t)R_RANK_STRATUM[c];
    cp_exposure a = {CLUSTERS, R_MH_YA, R_MH_XA}, b = {CLUSTERS, R_MH_YB, R_MH_XB};
    for (int paired = 0; paired < 2; paired++) {
        const double *expected = paired ? R_MH_PAIRED : R_MH_APART;
        cp_resampling r = resampling_of(CLUSTERS, CLUSTERS);
        r.paired = paired;
        r.stratum[0] = r.stratum[1] = stratum;
        cp_widening w;
        cp_interval i = cp_rate_ratio_widened(&a, &b, &r, &w);
        assert_close(cp_rate_ratio(&a, &b, stratum, stratum), expected[0]);
        assert_close(w.dispersion_1, expected[1]);
        assert_close(w.factor_1, expected[2]);
        assert_close(i.low, expected[3]);
        assert_close(i.high, expected[4]);
    }
    cp_widening w;
    cp_interval i = cp_rate_widened(&a, stratum, 0.95, &w);
    assert_close(w.dispersion_1, R_WIDENED_RATE[0]);
    assert_close(w.factor_1, R_WIDENED_RATE[1]);
    assert_close(i.low, R_WIDENED_RATE[2]);
    assert_close(i.high, R_WIDENED_RATE[3]);
}

static void paired_statistics(void **state)
{
    (void)state;
    cp_sample d = sample_of(R_D, NULL, COUNT(R_D), 0);
    cp_resampling r = resampling_of(d.cluster_count, 0);
    cp_paired paired;
    cp_error error = {0};
    assert_int_equal(cp_paired_compare(&d, &r, 20000, &paired, &error), CP_OK);
    assert_close(paired.hodges_lehmann, R_HODGES_LEHMANN[0]);
    assert_near(paired.hodges_lehmann, R_HODGES_LEHMANN[1], 1e-4); // R bisects to this
    assert_close(paired.signed_rank.statistic, R_SIGNED_RANK_V_P[0]);
    double exact = R_SIGNED_RANK_V_P[1];
    assert_near(paired.signed_rank.p, exact, 4.0 * sqrt(exact * (1.0 - exact) / 20000.0) + 1e-4);
    cp_sample_destroy(&d);

    // An odd number of averages; then ties and zeros.
    d = sample_of(R_D, NULL, 21, 0);
    assert_close(cp_paired_hodges_lehmann(&d, NULL), R_HODGES_LEHMANN_ODD[0]);
    cp_sample_destroy(&d);
    double tied[MOST];
    for (size_t k = 0; k < COUNT(R_D); k++)
        tied[k] = nearbyint(R_D[k]);
    d = sample_of(tied, NULL, COUNT(R_D), 0);
    assert_int_equal(cp_paired_compare(&d, &r, 10, &paired, &error), CP_OK);
    assert_near(paired.hodges_lehmann, R_HODGES_LEHMANN_TIED[0], 1e-12);
    assert_close(paired.signed_rank.statistic, R_SIGNED_RANK_TIED_V[0]);
    cp_sample_destroy(&d);
}

// Weights mean copies: the estimate of a resample is that of the copied values.
static void hodges_lehmann_of_a_resample(void **state)
{
    (void)state;
    unsigned weight[COUNT(R_D)];
    double copied[3 * COUNT(R_D)];
    size_t count = 0;
    cp_sample d = sample_of(R_D, NULL, COUNT(R_D), 0);
    for (size_t k = 0; k < COUNT(R_D); k++) {
        weight[k] = (unsigned)(k * 7 % 3);
        for (unsigned w = 0; w < weight[k]; w++)
            copied[count++] = R_D[k];
    }
    cp_sample all = sample_of(copied, NULL, count, 0);
    assert_true(cp_paired_hodges_lehmann(&d, weight) == cp_paired_hodges_lehmann(&all, NULL));
    cp_sample_destroy(&all);
    cp_sample_destroy(&d);
}

static void counts_and_rates(void **state)
{
    (void)state;
    const double events[] = {0, 1, 5, 10, 100};
    for (size_t k = 0; k < 5; k++) {
        cp_interval i = cp_rate_garwood(events[k], 0.95);
        assert_near(i.low, R_GARWOOD[2 * k], 1e-8 * i.high);
        assert_close(i.high, R_GARWOOD[2 * k + 1]);
    }
    const double b = 31, a = 52, km_b = 8123.5, km_a = 7904.25;
    cp_exposure ea = {1, &a, &km_a}, eb = {1, &b, &km_b};
    cp_interval ratio = cp_rate_ratio_poisson(&ea, &eb, 0.95);
    assert_close(cp_rate_ratio(&ea, &eb, NULL, NULL), R_RATE_RATIO[0]);
    assert_close(ratio.low, R_RATE_RATIO[1]);
    assert_close(ratio.high, R_RATE_RATIO[2]);
    cp_exposure e = {COUNT(R_COUNTS), R_COUNTS, R_KM};
    assert_close(cp_rate_dispersion(&e, NULL), R_DISPERSION[0]);
    double p[COUNT(R_P)];
    cp_error error = {0};
    for (size_t k = 0; k < COUNT(R_P); k++)
        p[k] = R_P[k];
    assert_int_equal(cp_holm_adjust(p, COUNT(R_P), &error), CP_OK);
    for (size_t k = 0; k < COUNT(R_P); k++)
        assert_close(p[k], R_P_HOLM[k]);
}

static void risk_functions(void **state)
{
    (void)state;
    const double v[] = {2, 8, 15, 25};
    const struct {
        const char *form;
        const char *unit;
        double c[2];
        const double *expected;
    } cases[] = {
        {"logistic", "mph", {-3.761, 0.136}, R_RISK_LOGISTIC_MPH},
        {"log_logistic", "m/s", {-8.0, 3.0}, R_RISK_LOG_LOGISTIC},
        {"probit", "km/h", {-3.0, 0.15}, R_RISK_PROBIT},
        {"weibull", "m/s", {18.0, 2.5}, R_RISK_WEIBULL},
    };
    cp_error error = {0};
    cp_risk_function f;
    for (size_t k = 0; k < COUNT(cases); k++) {
        assert_int_equal(
            cp_risk_function_create(cases[k].form, cases[k].unit, cases[k].c, 2, &f, &error),
            CP_OK);
        for (size_t j = 0; j < 4; j++)
            assert_close(cp_risk_probability(&f, v[j], NULL), cases[k].expected[j]);
    }
    assert_true(cp_risk_probability(&f, 0.0, NULL) == 0.0 &&
                isnan(cp_risk_probability(&f, NAN, NULL)));
    assert_int_equal(cp_risk_function_create("cubic", "m/s", v, 2, &f, &error), CP_BAD_INPUT);
    assert_int_equal(cp_risk_function_create("logistic", "knots", v, 2, &f, &error), CP_BAD_INPUT);
    assert_int_equal(cp_risk_function_create("logistic", "m/s", v, 3, &f, &error), CP_BAD_INPUT);
}

static double mean_of_a(const unsigned *weight_a, const unsigned *weight_b, const void *context)
{
    (void)weight_b;
    return cp_sample_mean(context, weight_a);
}

static double variance_of_a(const unsigned *weight_a, const unsigned *weight_b, const void *context)
{
    (void)weight_b;
    const cp_sample *sample = context;
    double mean = cp_sample_mean(sample, weight_a), sum = 0.0, count = 0.0;
    for (size_t k = 0; k < sample->count; k++) {
        double weight = weight_a[sample->cluster[k]];
        sum += weight * (sample->value[k] - mean) * (sample->value[k] - mean);
        count += weight;
    }
    return sum / count;
}

// Two Monte Carlo intervals of 200 000 and 20 000 resamples agree to a fiftieth of their width.
static void bca_of_clusters_and_of_a_variance(void **state)
{
    (void)state;
    cp_sample clustered = sample_of(R_VALUE, R_CLUSTER, COUNT(R_VALUE), 25);
    cp_sample test_a = sample_of(R_TEST_A, NULL, COUNT(R_TEST_A), 0);
    const struct {
        const cp_sample *sample;
        cp_statistic statistic;
        double level_1;
        const double *expected;
    } cases[] = {{&clustered, mean_of_a, 0.95, R_CLUSTER_MEAN_BCA},
                 {&test_a, variance_of_a, 0.9, R_VARIANCE_BCA_90}};
    for (size_t k = 0; k < COUNT(cases); k++) {
        cp_resampling r = resampling_of(cases[k].sample->cluster_count, 0);
        r.repetitions = 20000;
        r.level_1 = cases[k].level_1;
        r.expanded = false;
        cp_interval i;
        cp_error error = {0};
        assert_int_equal(cp_bootstrap(&r, cases[k].statistic, cases[k].sample, &i, &error), CP_OK);
        double width = cases[k].expected[2] - cases[k].expected[1];
        assert_near(i.low, cases[k].expected[1], 0.02 * width);
        assert_near(i.high, cases[k].expected[2], 0.02 * width);

        // Expanded: both bounds further out.
        r.expanded = true;
        cp_interval wide;
        assert_int_equal(cp_bootstrap(&r, cases[k].statistic, cases[k].sample, &wide, &error),
                         CP_OK);
        assert_true(wide.low < i.low && wide.high > i.high);
    }
    cp_sample_destroy(&clustered);
    cp_sample_destroy(&test_a);
}

// Closed form: 400 independent values, one a cluster, 1.358 / sqrt(400), a little less as it is of
// a step function; all values of a cluster alike, as if there were only the clusters.
static void band_is_kolmogorovs_for_independent_values(void **state)
{
    (void)state;
    enum { CLUSTERS = 400, COPIES = 5 };
    static double value[CLUSTERS * COPIES];
    static size_t cluster[CLUSTERS * COPIES];
    for (size_t k = 0; k < CLUSTERS * COPIES; k++) {
        value[k] = (double)(k % CLUSTERS);
        cluster[k] = k % CLUSTERS;
    }
    for (size_t copies = 1; copies <= COPIES; copies += COPIES - 1) {
        cp_sample sample;
        cp_error error = {0};
        cp_band band;
        cp_resampling r = resampling_of(CLUSTERS, 0);
        r.repetitions = 4000;
        assert_int_equal(
            cp_sample_create(value, cluster, copies * CLUSTERS, CLUSTERS, &sample, &error), CP_OK);
        assert_int_equal(cp_band_of_ecdf(&sample, &r, &band, &error), CP_OK);
        assert_int_equal(band.status, CP_INTERVAL_VALUE);
        assert_near(band.half_width_1 * sqrt(CLUSTERS), 1.35, 0.05);
        r.cluster_count[0] = sample.cluster_count = 19;
        sample.count = 0;
        assert_int_equal(cp_band_of_ecdf(&sample, &r, &band, &error), CP_OK);
        assert_int_equal(band.status, CP_INTERVAL_TOO_FEW_REPLICATIONS);
        sample.cluster_count = CLUSTERS;
        cp_sample_destroy(&sample);
    }
}

static void precision_grows_with_the_square_root(void **state)
{
    (void)state;
    cp_precision p = cp_precision_of(2.0, (cp_interval){CP_INTERVAL_VALUE, 1.5, 2.7}, 40, 0.1);
    assert_close(p.half_width, 0.6);
    assert_close(p.relative_1, 0.3);
    assert_close(p.replications_needed, 360.0);
    p = cp_precision_of(2.0, (cp_interval){CP_INTERVAL_VALUE, -INFINITY, 2.7}, 40, 0.1);
    assert_true(isnan(p.half_width) && isnan(p.replications_needed));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(descriptions),
        cmocka_unit_test(rank_statistics),
        cmocka_unit_test(rank_statistics_with_ties),
        cmocka_unit_test(superiority_of_clusters),
        cmocka_unit_test(widened_rates),
        cmocka_unit_test(paired_statistics),
        cmocka_unit_test(hodges_lehmann_of_a_resample),
        cmocka_unit_test(counts_and_rates),
        cmocka_unit_test(risk_functions),
        cmocka_unit_test(bca_of_clusters_and_of_a_variance),
        cmocka_unit_test(band_is_kolmogorovs_for_independent_values),
        cmocka_unit_test(precision_grows_with_the_square_root),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
