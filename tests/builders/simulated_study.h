/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BUILDERS_SIMULATED_STUDY_H
#define BUILDERS_SIMULATED_STUDY_H

#include "core/rng.h"
#include "stats/rates.h"
#include "stats/sample.h"

#include <gsl/gsl_cdf.h>

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

/* Two variants of an invented study with known truth. A replication has a Poisson number of
 * crashes in proportion to its exposure; with correlation rho its mean is gamma-distributed so that
 * rho of the variance of the counts lies between replications. Severity is lognormal, exp(mu + 0.35
 * z), z standard normal with correlation rho within a replication; counts and severities are
 * independent. Paired: both variants share what is common to a replication. */

typedef struct simulated_design {
    size_t replications;
    double mean_crashes; /* of a replication of the baseline */
    double rho;
    double rate_ratio; /* treatment over baseline */
    double shift;      /* of mu, treatment minus baseline */
    bool paired;
} simulated_design;

#define SIMULATED_MU 3.0
#define SIMULATED_SD 0.35

typedef struct simulated_variant {
    cp_sample sample;
    double *events;
    double *exposure;
} simulated_variant;

static inline void simulated_variant_destroy(simulated_variant *v)
{
    cp_sample_destroy(&v->sample);
    free(v->events);
    free(v->exposure);
}

// Count with the mean given, by inversion.
static inline size_t simulated_poisson(cp_rng_key key, uint64_t counter, double mean)
{
    double u = cp_rng_uniform(key, counter), p = exp(-mean), sum = p;
    size_t n = 0;
    while (u > sum && n < 1000) {
        n++;
        p *= mean / (double)n;
        sum += p;
    }
    return n;
}

// Quantile of the gamma distribution with mean 1 and this variance. GSL's inverse gives up on
// shapes well below 1: then by bisection.
static inline double simulated_gamma(double u, double variance)
{
    if (variance < 1.0)
        return gsl_cdf_gamma_Pinv(u, 1.0 / variance, variance);
    double low = 0.0, high = 1e4 * variance;
    for (int k = 0; k < 200; k++) {
        double middle = k < 100 && low < 1e-300 ? high * 1e-3 : 0.5 * (low + high);
        if (middle < 1e-250)
            return 0.0;
        if (gsl_cdf_gamma_P(middle, 1.0 / variance, variance) >= u)
            high = middle;
        else
            low = middle;
    }
    return high;
}

/* Variant 0 (baseline) or 1 of the study with this seed. Ends the program without memory. */
static inline simulated_variant simulate_variant(const simulated_design *d, uint64_t seed,
                                                 int variant)
{
    simulated_variant v = {0};
    size_t room = (size_t)(20.0 * (d->mean_crashes + 5.0)) * d->replications, count = 0;
    double *value = calloc(room, sizeof *value);
    size_t *cluster = calloc(room, sizeof *cluster);
    v.events = calloc(d->replications, sizeof *v.events);
    v.exposure = calloc(d->replications, sizeof *v.exposure);
    cp_error error = {0};
    if (!value || !cluster || !v.events || !v.exposure)
        abort();
    double mu = SIMULATED_MU + (variant ? d->shift : 0.0);
    double mean = d->mean_crashes * (variant ? d->rate_ratio : 1.0);
    cp_rng_key study = cp_rng_key_number(cp_rng_key_text(cp_rng_key_seed(seed), "simulated"), 7);
    cp_rng_key own = cp_rng_key_number(study, 10 + (uint64_t)variant);
    cp_rng_key shared = d->paired ? study : own;
    for (size_t c = 0; c < d->replications; c++) {
        cp_rng_key key = cp_rng_key_number(own, c), common = cp_rng_key_number(shared, c);
        // Between-replication variance of the counts m^2 v with m^2 v / (m + m^2 v) = rho.
        double factor = 1.0;
        if (d->rho > 0.0) {
            double variance = d->rho / ((1.0 - d->rho) * d->mean_crashes);
            factor = simulated_gamma(cp_rng_uniform(common, 900001), variance);
        }
        v.exposure[c] = 90.0 + 20.0 * cp_rng_uniform(key, 900004);
        size_t n = simulated_poisson(key, 900002, mean * factor * v.exposure[c] / 100.0);
        double effect = cp_rng_normal(common, 900003);
        for (size_t k = 0; k < n && count < room; k++) {
            double z = sqrt(d->rho) * effect + sqrt(1.0 - d->rho) * cp_rng_normal(key, k);
            value[count] = exp(mu + SIMULATED_SD * z);
            cluster[count++] = c;
        }
        v.events[c] = (double)n;
    }
    if (cp_sample_create(value, cluster, count, d->replications, &v.sample, &error) != CP_OK)
        abort();
    free(value);
    free(cluster);
    return v;
}

static inline cp_exposure simulated_exposure(const simulated_variant *v)
{
    return (cp_exposure){v->sample.cluster_count, v->events, v->exposure};
}

/* The truth: figures of the two lognormal distributions. */
typedef struct simulated_truth {
    double mean_difference;
    double median_difference;
    double p90_difference;
    double cliffs_delta;
    double rate_ratio;
} simulated_truth;

static inline simulated_truth simulated_truth_of(const simulated_design *d)
{
    double a = exp(SIMULATED_MU), b = exp(SIMULATED_MU + d->shift);
    double mean = exp(0.5 * SIMULATED_SD * SIMULATED_SD);
    double p90 = exp(SIMULATED_SD * gsl_cdf_ugaussian_Pinv(0.9));
    return (simulated_truth){
        .mean_difference = (b - a) * mean,
        .median_difference = b - a,
        .p90_difference = (b - a) * p90,
        .cliffs_delta = 2.0 * gsl_cdf_ugaussian_P(d->shift / (SIMULATED_SD * sqrt(2.0))) - 1.0,
        .rate_ratio = d->rate_ratio,
    };
}

#endif
