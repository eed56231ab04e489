/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/counterfactual.h"

#include "analysis/pair_risk.h"

#include <math.h>
#include <stdlib.h>

/* The pairs of one treatment in a slice. */
typedef struct pairs {
    const cp_study_data *data;
    const cp_comparison *comparison;
    const cp_replication_set *set; /* of the baseline */
    cp_resampling resampling;
    size_t permutations;
    const cp_model_ensemble *ensemble; /* may be NULL */
    size_t count;
    const cp_study_pair **pair;
    size_t *cluster; /* of each pair */
} pairs;

static bool valid(const cp_study_pair *pair)
{
    return pair->outcome != CP_OUTCOME_INVALID;
}

// The two crash again with each other: what severity conditional on crashing is about.
static bool crashes_again(const cp_study_pair *pair)
{
    return pair->outcome == CP_OUTCOME_MITIGATED || pair->outcome == CP_OUTCOME_AGGRAVATED ||
           pair->outcome == CP_OUTCOME_UNCHANGED;
}

static void gather(pairs *p, size_t variant)
{
    p->count = 0;
    size_t last = SIZE_MAX, cluster = SIZE_MAX;
    for (size_t k = 0; k < p->data->pair_count; k++) {
        const cp_study_pair *pair = &p->data->pair[k];
        const cp_study_crash *crash = &p->data->crash[pair->crash];
        if (pair->variant != variant ||
            !cp_slice_has_frontal_crash(p->data, p->comparison->slice, crash))
            continue;
        if (crash->replication != last) { // pairs come replication by replication
            last = crash->replication;
            cluster = cp_replication_set_cluster(p->set, last);
        }
        if (cluster == SIZE_MAX)
            continue;
        p->pair[p->count] = pair;
        p->cluster[p->count++] = cluster;
    }
}

// Both vehicles inside validity with the baseline.
static bool inside(const pairs *p, const cp_study_pair *pair)
{
    return p->data->crash[pair->crash].inside;
}

static void count_outcomes(const pairs *p, cp_counterfactual_figures *figures)
{
    figures->crashes = p->count;
    for (size_t k = 0; k < p->count; k++) {
        const cp_study_pair *pair = p->pair[k];
        figures->outcome[pair->outcome]++;
        figures->outcome_olc[pair->outcome_olc]++;
        figures->valid += valid(pair);
        if (valid(pair)) {
            figures->new_crashes += pair->new_crashes;
            figures->vanished_crashes += pair->vanished_crashes;
        } else
            figures->reason[pair->reason]++;
        if (!inside(p, pair))
            continue;
        figures->inside_crashes++;
        figures->inside_outcome[pair->outcome]++;
        figures->inside_valid += valid(pair);
        figures->inside_treated_outside +=
            crashes_again(pair) && !(pair->treated_inside[0] && pair->treated_inside[1]);
    }
}

// Share of each outcome among the valid pairs, of all or of those inside with the baseline. An
// outcome that never happened cannot show how it scatters: no interval trusts less than the others
// do.
static cp_status figure_shares(const pairs *p, bool of_inside, cp_interval *share, cp_error *error)
{
    double *events = calloc(p->set->count + 1, sizeof *events);
    double *pairs_of = calloc(p->set->count + 1, sizeof *pairs_of);
    cp_status status = CP_OK;
    double widest = 1.0;
    if (!events || !pairs_of)
        status = cp_fail_memory(error, "outcomes");
    for (int turn = 0; turn < 2 && status == CP_OK; turn++) {
        for (int outcome = CP_OUTCOME_CHANGED_OPPONENT; outcome < CP_OUTCOME_NO_OLC; outcome++) {
            for (size_t c = 0; c < p->set->count; c++)
                events[c] = pairs_of[c] = 0.0;
            for (size_t k = 0; k < p->count; k++) {
                if (of_inside && !inside(p, p->pair[k]))
                    continue;
                events[p->cluster[k]] += (int)p->pair[k]->outcome == outcome;
                pairs_of[p->cluster[k]] += valid(p->pair[k]);
            }
            cp_exposure exposure = {p->set->count, events, pairs_of};
            cp_widening widening;
            share[outcome] =
                cp_share_widened(&exposure, p->set->stratum, turn ? widest : 1.0, 0.95, &widening);
            widest = fmax(widest, turn ? 1.0 : widening.factor_1);
        }
    }
    free(events);
    free(pairs_of);
    return status;
}

// Treated minus baseline over the valid pairs, or over those that crash again. rows: the pairs of
// the study, or the same by a set of the ensemble.
static cp_status changes(const pairs *p, const cp_study_pair *rows, bool olc, int which,
                         bool of_inside, cp_sample *sample, cp_error *error)
{
    double *difference = calloc(p->count + 1, sizeof *difference);
    size_t *cluster = calloc(p->count + 1, sizeof *cluster);
    cp_status status = CP_OK;
    size_t count = 0;
    if (!difference || !cluster) {
        status = cp_fail_memory(error, "paired severity");
        goto done;
    }
    for (size_t k = 0; k < p->count; k++) {
        const cp_study_pair *pair = &rows[p->pair[k] - p->data->pair];
        const double *severity = olc ? pair->olc_g : pair->closing_speed_m_s;
        double change = severity[1] - severity[0];
        if (isnan(change) || !(which == CP_PAIRED_ALL ? valid(pair) : crashes_again(pair)) ||
            (of_inside && !inside(p, pair)))
            continue;
        difference[count] = change;
        cluster[count++] = p->cluster[k];
    }
    status = cp_sample_create(difference, cluster, count, p->set->count, sample, error);

done:
    free(difference);
    free(cluster);
    return status;
}

static cp_status figure_severity(const pairs *p, bool olc, int which, bool of_inside,
                                 cp_paired *paired, cp_error *error)
{
    cp_sample sample = {0};
    cp_status status = changes(p, p->data->pair, olc, which, of_inside, &sample, error);
    if (status == CP_OK)
        status = cp_paired_compare(&sample, &p->resampling, p->permutations, paired, error);
    cp_sample_destroy(&sample);
    return status;
}

// The model's part of Hodges and Lehmann's change of OLC.
static cp_status figure_model(const pairs *p, int which, cp_counterfactual_figures *figures,
                              cp_error *error)
{
    const cp_model_ensemble *ensemble = p->ensemble;
    if (!ensemble || ensemble->count < CP_MODEL_SETS_MIN)
        return CP_OK;
    cp_estimate *of_set = calloc(ensemble->count, sizeof *of_set);
    cp_status status = of_set ? CP_OK : cp_fail_memory(error, "the model's uncertainty");
    for (size_t m = 0; m < ensemble->count && status == CP_OK; m++) {
        cp_sample sample = {0};
        const cp_study_data by_set = cp_model_ensemble_study(ensemble, p->data, m);
        status = changes(p, by_set.pair, true, which, false, &sample, error);
        if (status == CP_OK)
            of_set[m] = cp_estimate_of(cp_paired_hodges_lehmann(&sample, NULL));
        cp_sample_destroy(&sample);
    }
    const cp_paired *own = &figures->olc_g[which];
    if (status == CP_OK)
        figures->olc_model[which] =
            cp_model_part_of(cp_estimate_of(own->hodges_lehmann), own->hodges_lehmann_interval,
                             of_set, ensemble->count);
    free(of_set);
    return status;
}

// Expected injured drivers of the baseline's crashes and of what became of them, by replication.
// A pair without a known probability on either side is left out of both.
static void sum_injuries(const pairs *p, const cp_study_risk *risk, double *expected[2],
                         cp_injury_sum sum[2])
{
    for (int side = 0; side < 2; side++) {
        sum[side] = (cp_injury_sum){0};
        for (size_t c = 0; c < p->set->count; c++)
            expected[side][c] = 0.0;
    }
    for (size_t k = 0; k < p->count; k++) {
        const cp_study_pair *pair = p->pair[k];
        double own[2] = {0.0, 0.0}, gradient[2][CP_RISK_PARAMETERS_MAX] = {{0.0}, {0.0}};
        if (!valid(pair))
            continue;
        for (size_t role = 0; role < 2; role++)
            for (int side = 0; side < 2; side++)
                own[side] +=
                    cp_pair_risk(p->data, pair, risk, role, side == 1, 1.0, gradient[side]);
        if (isnan(own[0]) || isnan(own[1]))
            continue;
        for (int side = 0; side < 2; side++) {
            expected[side][p->cluster[k]] += own[side];
            sum[side].expected += own[side];
            for (size_t c = 0; c < CP_RISK_PARAMETERS_MAX; c++)
                sum[side].gradient[c] += gradient[side][c];
        }
    }
}

// Were the risk of every driver outside validity, or without a predictor, anything from 0 to 1.
static void bound_benefit(const pairs *p, const cp_study_risk *risk, double bound[2])
{
    double known[2] = {0.0, 0.0}, open[2] = {0.0, 0.0};
    for (size_t k = 0; k < p->count; k++) {
        const cp_study_pair *pair = p->pair[k];
        if (!valid(pair))
            continue;
        for (size_t role = 0; role < 2; role++) {
            const cp_study_vehicle *vehicle = &p->data->vehicle[2 * pair->crash + role];
            bool is_known[2] = {vehicle->validity == 0,
                                pair->treated_inside[role] || pair->outcome == CP_OUTCOME_AVOIDED};
            bool counted[2] = {!risk->frontal_only || vehicle->frontal,
                               !risk->frontal_only || pair->treated_frontal[role] ||
                                   pair->outcome == CP_OUTCOME_AVOIDED};
            for (int side = 0; side < 2; side++) {
                double own = cp_pair_risk(p->data, pair, risk, role, side == 1, 1.0, NULL);
                bool counts = is_known[side] && !isnan(own);
                known[side] += counts ? own : 0.0;
                open[side] += !counts && counted[side];
            }
        }
    }
    bound[0] = 1.0 - (known[1] + open[1]) / known[0];
    bound[1] = 1.0 - known[1] / (known[0] + open[0]);
}

static cp_status figure_benefit(const pairs *p, cp_counterfactual_figures *figures, cp_error *error)
{
    double *expected[2] = {calloc(p->set->count + 1, sizeof(double)),
                           calloc(p->set->count + 1, sizeof(double))};
    cp_status status = CP_OK;
    if (!expected[0] || !expected[1])
        status = cp_fail_memory(error, "expected injuries");
    for (size_t k = 0; k < p->data->risk_count && status == CP_OK; k++) {
        cp_benefit_figures *benefit = &figures->benefit[k];
        const cp_risk_function *function = &p->data->risk[k].function;
        cp_injury_sum sum[2];
        sum_injuries(p, &p->data->risk[k], expected, sum);
        cp_exposure ratio = {p->set->count, expected[1], expected[0]};
        for (size_t c = 0; c < p->set->count; c++) {
            benefit->baseline += expected[0][c];
            benefit->treatment += expected[1][c];
        }
        benefit->benefit_1 = 1.0 - cp_rate(&ratio);
        cp_interval interval;
        status = cp_rate_bootstrap(&ratio, p->set->stratum, p->data->seed, &interval, error);
        benefit->parameters_se_1 = cp_injury_ratio_se(function, &sum[0], &sum[1]);
        interval = cp_risk_widened(1.0 - benefit->benefit_1, interval, benefit->parameters_se_1,
                                   function->freedom);
        benefit->interval = (cp_interval){interval.status, 1.0 - interval.high, 1.0 - interval.low};
        bound_benefit(p, &p->data->risk[k], benefit->bound);
        if (interval.status == CP_INTERVAL_TOO_FEW_CRASHES)
            benefit->bound[0] = benefit->bound[1] = NAN;
    }
    free(expected[0]);
    free(expected[1]);
    return status;
}

static cp_status figure_treatment(pairs *p, cp_counterfactual_figures *figures, cp_error *error)
{
    gather(p, figures->variant);
    count_outcomes(p, figures);
    figures->benefit = calloc(p->data->risk_count + 1, sizeof *figures->benefit);
    if (!figures->benefit)
        return cp_fail_memory(error, "expected injuries");
    cp_status status = figure_shares(p, false, figures->share, error);
    if (status == CP_OK)
        status = figure_shares(p, true, figures->inside_share, error);
    if (status == CP_OK)
        status = figure_severity(p, true, CP_PAIRED_ALL, true, &figures->inside_olc_g, error);
    for (int which = 0; which < CP_PAIRED_COUNT && status == CP_OK; which++) {
        status = figure_severity(p, true, which, false, &figures->olc_g[which], error);
        if (status == CP_OK)
            status =
                figure_severity(p, false, which, false, &figures->closing_speed_m_s[which], error);
        if (status == CP_OK)
            status = figure_model(p, which, figures, error);
    }
    return status == CP_OK ? figure_benefit(p, figures, error) : status;
}

enum { P_OF_TREATMENT = 2 * CP_PAIRED_COUNT };

static double *p_of(cp_counterfactual_figures *c, size_t number, bool adjusted)
{
    size_t which = number / 2;
    if (number % 2 == 0)
        return adjusted ? &c->p_holm[which] : &c->olc_g[which].signed_rank.p;
    return adjusted ? &c->speed_p_holm[which] : &c->closing_speed_m_s[which].signed_rank.p;
}

// Every p-value that is printed is of one family.
static cp_status adjust(cp_comparison *comparison, cp_error *error)
{
    size_t count = P_OF_TREATMENT * comparison->counterfactual_count;
    double *p = calloc(count + 1, sizeof *p);
    if (!p)
        return cp_fail_memory(error, "Holm's adjustment");
    cp_counterfactual_figures *c = comparison->counterfactual;
    for (size_t k = 0; k < count; k++)
        p[k] = *p_of(&c[k / P_OF_TREATMENT], k % P_OF_TREATMENT, false);
    cp_status status = cp_holm_adjust(p, count, error);
    for (size_t k = 0; k < count; k++)
        *p_of(&c[k / P_OF_TREATMENT], k % P_OF_TREATMENT, true) = p[k];
    free(p);
    return status;
}

cp_status cp_counterfactual_outcomes(const cp_study_data *data, cp_slice slice,
                                     const cp_replication_set *set,
                                     cp_counterfactual_figures *figures, cp_error *error)
{
    const cp_comparison comparison = {.slice = slice};
    pairs p = {.data = data, .comparison = &comparison, .set = set};
    p.pair = calloc(data->pair_count + 1, sizeof *p.pair);
    p.cluster = calloc(data->pair_count + 1, sizeof *p.cluster);
    cp_status status = p.pair && p.cluster ? CP_OK : cp_fail_memory(error, "counterfactual pairs");
    if (status == CP_OK) {
        gather(&p, figures->variant);
        count_outcomes(&p, figures);
        status = figure_shares(&p, false, figures->share, error);
    }
    free(p.pair);
    free(p.cluster);
    return status;
}

cp_status cp_compare_counterfactual(const cp_study_data *data, const cp_comparison_options *options,
                                    cp_comparison *comparison, cp_error *error)
{
    cp_replication_set set;
    cp_status status =
        cp_replication_set_create(data, comparison->slice, comparison->baseline, &set, error);
    if (status != CP_OK)
        return status;
    pairs p = {.data = data, .comparison = comparison, .set = &set};
    p.permutations = options->permutations;
    p.ensemble = options->ensemble;
    p.resampling = cp_resampling_default();
    p.resampling.repetitions = options->repetitions;
    p.resampling.seed = data->seed;
    p.resampling.cluster_count[0] = set.count;
    p.resampling.stratum[0] = set.stratum;
    p.pair = calloc(data->pair_count + 1, sizeof *p.pair);
    p.cluster = calloc(data->pair_count + 1, sizeof *p.cluster);
    comparison->counterfactual =
        calloc(data->variant_count + 1, sizeof *comparison->counterfactual);
    if (!p.pair || !p.cluster || !comparison->counterfactual)
        status = cp_fail_memory(error, "counterfactual pairs");
    for (size_t v = 0; v < data->variant_count && status == CP_OK; v++) {
        if (v == comparison->baseline)
            continue;
        cp_counterfactual_figures *figures =
            &comparison->counterfactual[comparison->counterfactual_count++];
        figures->variant = v;
        status = figure_treatment(&p, figures, error);
    }
    if (status == CP_OK)
        status = adjust(comparison, error);
    free(p.pair);
    free(p.cluster);
    cp_replication_set_destroy(&set);
    return status;
}
