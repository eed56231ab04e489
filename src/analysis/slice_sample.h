/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_SLICE_SAMPLE_H
#define ANALYSIS_SLICE_SAMPLE_H

#include "analysis/figures.h"

/* From the rows of a study to what statistics take: exposures and samples by replication. */

bool cp_study_crash_front_front(const cp_study_data *data, const cp_study_crash *crash);

/* Whether a crash belongs to a slice; whether it does as a frontal one. */
bool cp_slice_has_crash(const cp_study_data *data, cp_slice slice, const cp_study_crash *crash);
bool cp_slice_has_frontal_crash(const cp_study_data *data, cp_slice slice,
                                const cp_study_crash *crash);

/* The finished replications of a variant in a slice; each is a cluster, its scenario a stratum. */
typedef struct cp_replication_set {
    size_t count;
    size_t *replication; /* index of each cluster's replication, ascending */
    size_t *stratum;
    double *frontal_crashes; /* in the slice */
    double *vehicle_km;
} cp_replication_set;

/* The caller destroys. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_replication_set_create(const cp_study_data *data, cp_slice slice,
                                                  size_t variant, cp_replication_set *set,
                                                  cp_error *error);
/* A zero-initialised set is fine too. */
void cp_replication_set_destroy(cp_replication_set *set);

/* Cluster of a replication in a set; SIZE_MAX when it is not there. */
size_t cp_replication_set_cluster(const cp_replication_set *set, size_t replication);

/* Leave in both sets only replications with a partner: same scenario, number and seed. Cluster k
 * of a is then the partner of cluster k of b. */
void cp_replication_set_match(const cp_study_data *data, cp_replication_set *a,
                              cp_replication_set *b);

/* Frontal crashes over vehicle-km; borrows from the set. */
cp_exposure cp_replication_set_exposure(const cp_replication_set *set);

/* A quantity of the frontally struck vehicles of the set's replications; scope is CP_SCOPE_... What
 * is the same for both vehicles (closing speed, offset, angle) counts once a crash. A
 * failed crash simulation gives no observation of OLC and delta-v. The caller destroys. Error:
 * CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_slice_sample(const cp_study_data *data, const cp_replication_set *set,
                                        cp_slice slice, int scope, cp_slice_quantity quantity,
                                        cp_sample *sample, cp_error *error);

/* OLC of the same vehicles with every one outside validity, or whose simulation failed, taken for
 * below all others (highest false) or above them. The caller destroys. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_slice_bound(const cp_study_data *data, const cp_replication_set *set,
                                       cp_slice slice, bool highest, cp_sample *sample,
                                       cp_error *error);

/* What a risk function says of the drivers of a slice. */
typedef struct cp_injury_sum {
    size_t drivers; /* of frontal crashes, whose risk it is, with a known predictor */
    size_t unknown; /* without */
    double expected;
    double gradient[CP_RISK_PARAMETERS_MAX]; /* of expected by the function's parameters */
} cp_injury_sum;

/* Relative standard error that the parameters leave to the ratio of two sums by the same function;
 * 0 without a covariance, NAN of nothing. */
double cp_injury_ratio_se(const cp_risk_function *function, const cp_injury_sum *a,
                          const cp_injury_sum *b);

/* Sum over the set; expected injured drivers of each replication are written to expected[cluster].
 */
void cp_slice_injuries(const cp_study_data *data, const cp_replication_set *set, cp_slice slice,
                       int scope, const cp_study_risk *risk, double *expected, cp_injury_sum *sum);

#endif
