/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/field_oracle.h"
#include "stats/field_study.h"
#include "stats/weighted.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define COUNT(array) (sizeof(array) / sizeof *(array))

static void assert_close(double found, double wanted)
{
    if (!(fabs(found - wanted) <= 1e-7 * fmax(1.0, fabs(wanted))))
        fail_msg("found %.12g, R has %.12g", found, wanted);
}

enum { UNITS = COUNT(R_UNIT_SEVERITY), CLUSTERS = COUNT(R_EXPOSURE) };

/* The units of the R script. */
typedef struct r_units {
    cp_raking raking;
    size_t cluster[UNITS];
    cp_raking_classes classes[UNITS];
    double event[2 * UNITS];
    cp_raked raked;
} r_units;

static void set_margin(cp_raking *raking, size_t m, const double *target, size_t count)
{
    raking->margin[m].count = count;
    for (size_t k = 0; k < count; k++)
        raking->margin[m].target[k] = target[k];
}

static void make(r_units *u)
{
    *u = (r_units){.raking = {.count = 3, .cap = INFINITY}};
    set_margin(&u->raking, 0, R_TARGET_TYPE, COUNT(R_TARGET_TYPE));
    set_margin(&u->raking, 1, R_TARGET_BIN, COUNT(R_TARGET_BIN));
    set_margin(&u->raking, 2, R_TARGET_OVERLAP, COUNT(R_TARGET_OVERLAP));
    for (size_t k = 0; k < UNITS; k++) {
        u->cluster[k] = (size_t)R_UNIT_CLUSTER[k];
        u->classes[k].of[0] = (unsigned char)R_UNIT_TYPE[k];
        u->classes[k].of[1] = (unsigned char)R_UNIT_BIN[k];
        u->classes[k].of[2] = (unsigned char)R_UNIT_OVERLAP[k];
        u->event[2 * k] = 1.0;
        u->event[2 * k + 1] = R_UNIT_SEVERITY[k] > 15.0;
    }
    u->raked.raking = &u->raking;
    u->raked.events = 2;
    u->raked.arm[0] = (cp_raked_arm){.count = UNITS,
                                     .cluster = u->cluster,
                                     .classes = u->classes,
                                     .event = u->event,
                                     .severity = R_UNIT_SEVERITY,
                                     .severities = UNITS,
                                     .cluster_count = CLUSTERS,
                                     .exposure = R_EXPOSURE};
}

static cp_raked_figures figures_of(const cp_raked *raked)
{
    cp_raked_figures f;
    cp_error error = {0};
    cp_resampling resampling = cp_resampling_default();
    resampling.cluster_count[0] = raked->arm[0].cluster_count;
    resampling.repetitions = 10;
    assert_int_equal(cp_raked_of(raked, &resampling, &f, &error), CP_OK);
    return f;
}

static void weights_and_figures_agree_with_r(void **state)
{
    (void)state;
    r_units u;
    double weight[UNITS];
    make(&u);
    cp_raked_figures f = figures_of(&u.raked);
    cp_raked_weights(&u.raked, &f.factors, 0, weight);
    for (size_t k = 0; k < UNITS; k++)
        assert_close(weight[k], R_WEIGHTS[k]);
    assert_close(f.arm[0].effective, R_EFFECTIVE[0]);
    assert_close(f.arm[0].rate[0], R_RATES[0]);
    assert_close(f.arm[0].rate[1], R_RATES[1]);
    assert_close(f.arm[0].quantile[CP_RAKED_MEDIAN], R_QUANTILES[0]);
    assert_close(f.arm[0].quantile[CP_RAKED_P90], R_QUANTILES[1]);
    assert_true(f.factors.gap_1 < 1e-9);

    // So few effective units give no interval.
    assert_true(R_EFFECTIVE[0] < CP_RAKED_EFFECTIVE_MIN);
    assert_int_equal(f.arm[0].rate_interval[0].status, CP_INTERVAL_TOO_FEW_CRASHES);

    // Cut at twice the mean: what is left of the margins is told.
    u.raking.cap = 2.0;
    f = figures_of(&u.raked);
    cp_raked_weights(&u.raked, &f.factors, 0, weight);
    for (size_t k = 0; k < UNITS; k++)
        assert_close(weight[k], R_CAPPED[k]);
    assert_true(f.factors.gap_1 > 0.001);
}

// A resample is raked anew: the same as raking a sample in which units stand as often.
static void resamples_are_raked_anew(void **state)
{
    (void)state;
    r_units u;
    make(&u);
    size_t cluster[3 * UNITS], count = 0;
    cp_raking_classes classes[3 * UNITS];
    double event[6 * UNITS], severity[3 * UNITS], exposure[CLUSTERS];
    for (size_t k = 0; k < UNITS; k++)
        for (size_t n = 0; n < (size_t)R_TIMES[u.cluster[k]]; n++) {
            cluster[count] = u.cluster[k];
            classes[count] = u.classes[k];
            event[2 * count] = 1.0;
            event[2 * count + 1] = u.event[2 * k + 1];
            severity[count++] = R_UNIT_SEVERITY[k];
        }
    for (size_t c = 0; c < CLUSTERS; c++)
        exposure[c] = R_TIMES[c] * R_EXPOSURE[c];
    cp_raked copied = u.raked;
    copied.arm[0].count = copied.arm[0].severities = count;
    copied.arm[0].cluster = cluster;
    copied.arm[0].classes = classes;
    copied.arm[0].event = event;
    copied.arm[0].severity = severity;
    copied.arm[0].exposure = exposure;
    cp_raked_figures f = figures_of(&copied);
    assert_close(f.arm[0].rate[1], R_RESAMPLE[0]);
    assert_close(f.arm[0].quantile[CP_RAKED_MEDIAN], R_RESAMPLE[1]);

    // By multiplicities the quantile is the same.
    unsigned times[UNITS];
    double units[4 * 5 * 3] = {0.0}, room[4 * 5 * 3], weight[UNITS];
    cp_raking_factors factors;
    for (size_t k = 0; k < UNITS; k++) {
        times[k] = (unsigned)R_TIMES[u.cluster[k]];
        units[cp_raking_cell(&u.raking, &u.classes[k])] += times[k];
    }
    assert_int_equal(cp_raking_cells(&u.raking), COUNT(units));
    cp_raking_rake(&u.raking, units, room, &factors);
    for (size_t k = 0; k < UNITS; k++)
        weight[k] = cp_raking_weight(&u.raking, &factors, &u.classes[k]);
    assert_close(cp_weighted_quantile(R_UNIT_SEVERITY, weight, times, UNITS, 0.5), R_RESAMPLE[1]);
}

// Equal weights: what unweighted samples have.
static void equal_weights_are_none(void **state)
{
    (void)state;
    r_units u;
    make(&u);
    u.raked.raking = NULL;
    cp_raked_figures f = figures_of(&u.raked);
    cp_sample sample;
    cp_error error = {0};
    assert_int_equal(cp_sample_create(R_UNIT_SEVERITY, u.cluster, UNITS, CLUSTERS, &sample, &error),
                     CP_OK);
    assert_close(f.arm[0].quantile[0], cp_sample_quantile(&sample, NULL, 0.5));
    assert_close(f.arm[0].quantile[1], cp_sample_quantile(&sample, NULL, 0.9));
    cp_sample_destroy(&sample);
    assert_true(f.arm[0].effective == UNITS);

    // Among left-censored ones a quantile is left-censored.
    const double censored[] = {-INFINITY, -INFINITY, 3.0, 4.0}, ones[] = {1, 1, 1, 1};
    assert_true(isinf(cp_weighted_quantile(censored, ones, NULL, 4, 0.5)));
    assert_true(cp_weighted_quantile(censored, ones, NULL, 4, 1.0) == 4.0);
    assert_true(isnan(cp_weighted_quantile(censored, ones, (unsigned[]){0, 0, 0, 0}, 4, 0.5)));
}

// What the sample has none of drops out; a treated crash takes the nearest class's factor; what is
// not known leaves a weight alone; what the population has none of weighs nothing.
static void missing_classes(void **state)
{
    (void)state;
    cp_raking r = {.count = 2, .cap = INFINITY};
    r.margin[0] = (cp_raking_margin){.count = 3, .target = {0.5, 0.3, 0.2}, .ordered = true};
    r.margin[1] = (cp_raking_margin){.count = 2, .target = {1.0, 0.0}};
    double units[12] = {0.0}, room[12];
    cp_raking_factors f;
    cp_raking_classes first = {{0, 0}}, second = {{1, 0}}, foreign = {{1, 1}};
    cp_raking_classes unknown = {{0, CP_RAKING_UNKNOWN}}, third = {{2, 0}};
    units[cp_raking_cell(&r, &first)] = 4;
    units[cp_raking_cell(&r, &second)] = 4;
    units[cp_raking_cell(&r, &foreign)] = 2;
    units[cp_raking_cell(&r, &unknown)] = 2;
    cp_raking_rake(&r, units, room, &f);
    double w1 = cp_raking_weight(&r, &f, &first), w2 = cp_raking_weight(&r, &f, &second);
    double w0 = cp_raking_weight(&r, &f, &unknown);
    assert_true(cp_raking_weight(&r, &f, &foreign) == 0.0);
    assert_close(4 * w1 + 4 * w2 + 2 * w0, 12.0);
    assert_close((4 * w1 + 2 * w0) / (4 * w2), 0.5 / 0.3);
    assert_true(isnan(f.factor[0][2]));
    assert_close(cp_raking_weight(&r, &f, &third), w2);
}

static void distances_agree_with_r(void **state)
{
    (void)state;
    cp_weighted_distance d =
        cp_weighted_distance_of(R_DISTANCE_X, R_DISTANCE_WX, COUNT(R_DISTANCE_X), R_DISTANCE_Y,
                                R_DISTANCE_WY, COUNT(R_DISTANCE_Y));
    assert_close(d.largest_1, R_DISTANCES[0]);
    assert_close(d.mean, R_DISTANCES[1]);
    d = cp_weighted_distance_of(R_DISTANCE_X, R_DISTANCE_WX, COUNT(R_DISTANCE_X), R_DISTANCE_X,
                                R_DISTANCE_WX, COUNT(R_DISTANCE_X));
    assert_true(d.largest_1 < 1e-15 && d.mean < 1e-12);
}

// Expected injured by a function with terms, and what its parameters leave open.
static void risk_agrees_with_r(void **state)
{
    (void)state;
    static const char *const NAME[] = {"front-side", "front-rear", "35-54", "55-69", "70+", "F"};
    static const char *const OF[] = {
        CP_RISK_CRASH_TYPE, CP_RISK_CRASH_TYPE, "age", "age", "age", "sex"};
    cp_risk_function f;
    cp_error error = {0};
    assert_int_equal(cp_risk_function_create("logistic", "km/h", R_RISK, 2, &f, &error), CP_OK);
    for (size_t k = 0; k < 6; k++) {
        cp_risk_term term = {.add = R_RISK[2 + k], .share_1 = k < 2 ? 0.0 : R_RISK_SHARES[k - 2]};
        strcpy(term.name, NAME[k]);
        strcpy(term.of, OF[k]);
        assert_int_equal(cp_risk_function_add_term(&f, &term, &error), CP_OK);
    }
    assert_int_equal(
        cp_risk_function_set_covariance(&f, R_RISK_TRIANGLE, COUNT(R_RISK_TRIANGLE), 15.0, &error),
        CP_OK);
    double sum = 0.0, gradient[CP_RISK_PARAMETERS_MAX] = {0.0};
    for (size_t k = 0; k < COUNT(R_RISK_DELTA_V); k++)
        sum += cp_risk_add(&f, R_RISK_DELTA_V[k] / 3.6, k % 2 ? "front-side" : "front-front", 1.0,
                           gradient);
    double se = sqrt(cp_risk_variance(&f, gradient));
    assert_close(sum, R_RISK_EXPECTED_SE[0]);
    assert_close(se, R_RISK_EXPECTED_SE[1]);
    cp_interval i = cp_risk_widened(sum, (cp_interval){CP_INTERVAL_VALUE, sum / 1.3, sum * 1.5},
                                    se / sum, 15.0);
    assert_close(i.low, R_RISK_WIDENED[0]);
    assert_close(i.high, R_RISK_WIDENED[1]);
}

// Short version of the simulation whose table is field_study.md. Bounds are three standard errors
// around 93.
static void intervals_hold_the_truth(void **state)
{
    (void)state;
    enum { STUDIES = 120 };
    const simulated_design cells[] = {
        {20, 10.0, 0.3, 0.5, 0.0, false},
        {40, 10.0, 0.0, 0.5, -0.2, true},
    };
    for (size_t cell = 0; cell < COUNT(cells); cell++) {
        field_truth truth[2] = {field_truth_of(&cells[cell], 0), field_truth_of(&cells[cell], 1)};
        field_counts c = {{0.0}, {0.0}, 0.0};
        for (uint64_t k = 0; k < STUDIES; k++)
            field_study(&cells[cell], 90000 + k, 200, false, truth, &c);
        for (int f = 0; f < FIELD_FIXED; f++) {
            double share = c.hits[f] / c.given[f];
            if (f == FIELD_INJURED_ALONE || c.given[f] < 100.0)
                continue;
            if (share < 0.93 - 3.0 * sqrt(0.93 * 0.07 / c.given[f]))
                fail_msg("cell %zu, %s: holds %.3f of %g", cell, FIELD_TEXT[f], share, c.given[f]);
        }
        // The simulation can see an interval that leaves the coefficients out.
        assert_true(c.given[FIELD_INJURED] >= 100.0);
        assert_true(c.hits[FIELD_INJURED_ALONE] < 0.85 * c.given[FIELD_INJURED_ALONE]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(weights_and_figures_agree_with_r),
        cmocka_unit_test(resamples_are_raked_anew),
        cmocka_unit_test(equal_weights_are_none),
        cmocka_unit_test(missing_classes),
        cmocka_unit_test(distances_agree_with_r),
        cmocka_unit_test(risk_agrees_with_r),
        cmocka_unit_test(intervals_hold_the_truth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
