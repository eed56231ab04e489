/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/pooled.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

void cp_pooled_destroy(cp_pooled *pooled)
{
    free(pooled->value);
    free(pooled->cluster);
    free(pooled->group);
    free(pooled->size);
    free(pooled->stratum);
    free(pooled->factor);
    free(pooled->times);
    *pooled = (cp_pooled){0};
}

cp_status cp_pooled_create(const cp_sample *a, const cp_sample *b, const size_t *stratum_a,
                           const size_t *stratum_b, cp_pooled *pooled, cp_error *error)
{
    size_t count = a->count + b->count, clusters = a->cluster_count + b->cluster_count;
    *pooled = (cp_pooled){.sample = {a, b}, .count = count, .strata = 1, .lowest = {NAN, NAN}};
    pooled->value = calloc(count + 1, sizeof *pooled->value);
    pooled->cluster = calloc(count + 1, sizeof *pooled->cluster);
    pooled->group = calloc(count + 1, sizeof *pooled->group);
    pooled->size = calloc(clusters + 1, sizeof *pooled->size);
    pooled->stratum = calloc(clusters + 1, sizeof *pooled->stratum);
    pooled->times = calloc(clusters + 1, sizeof *pooled->times);
    if (pooled->stratum) {
        for (size_t c = 0; c < clusters; c++) {
            bool of_a = c < a->cluster_count;
            const size_t *stratum = of_a ? stratum_a : stratum_b;
            size_t own = stratum ? stratum[of_a ? c : c - a->cluster_count] : 0;
            pooled->stratum[c] = own;
            pooled->strata = own >= pooled->strata ? own + 1 : pooled->strata;
        }
        pooled->factor = calloc(2 * pooled->strata, sizeof *pooled->factor);
    }
    if (!pooled->value || !pooled->cluster || !pooled->group || !pooled->size || !pooled->stratum ||
        !pooled->factor || !pooled->times) {
        cp_pooled_destroy(pooled);
        return cp_fail_memory(error, "two samples");
    }

    // Merge the two sorted samples.
    for (size_t i = 0, j = 0, k = 0; k < count; k++) {
        bool from_a = j == b->count || (i < a->count && a->value[i] <= b->value[j]);
        pooled->value[k] = from_a ? a->value[i] : b->value[j];
        pooled->cluster[k] =
            (uint32_t)(from_a ? a->cluster[i++] : a->cluster_count + b->cluster[j++]);
        pooled->group[k] = !from_a;
    }
    for (size_t k = 0; k < count; k++) {
        pooled->size[pooled->cluster[k]]++;
        double *lowest = &pooled->lowest[pooled->group[k]];
        if (isnan(*lowest) && isfinite(pooled->value[k]))
            *lowest = pooled->value[k];
    }
    return CP_OK;
}

/* The two samples of a resample; how much each observation of a cluster counts stands in times of
 * pooled. */
typedef struct mix {
    const cp_pooled *pooled;
    const unsigned *weight[2];
    double *factor[2]; /* of each stratum */
    double total[2];   /* of all that count */
} mix;

static void fill_times(const mix *m)
{
    const cp_pooled *p = m->pooled;
    size_t offset[2] = {0, p->sample[0]->cluster_count};
    for (int g = 0; g < 2; g++)
        for (size_t c = 0; c < p->sample[g]->cluster_count; c++)
            p->times[offset[g] + c] =
                (m->weight[g] ? m->weight[g][c] : 1.0) * m->factor[g][p->stratum[offset[g] + c]];
}

static mix mix_of(const cp_pooled *p, const unsigned *weight_a, const unsigned *weight_b)
{
    mix m = {
        .pooled = p, .weight = {weight_a, weight_b}, .factor = {p->factor, p->factor + p->strata}};
    for (size_t s = 0; s < 2 * p->strata; s++)
        p->factor[s] = 0.0;
    size_t offset[2] = {0, p->sample[0]->cluster_count};
    for (int g = 0; g < 2; g++) {
        for (size_t c = 0; c < p->sample[g]->cluster_count; c++) {
            double size = (m.weight[g] ? m.weight[g][c] : 1.0) * p->size[offset[g] + c];
            m.factor[g][p->stratum[offset[g] + c]] += size;
            m.total[g] += size;
        }
    }
    if (p->strata == 1) {
        m.factor[0][0] = m.factor[1][0] = m.total[0] > 0.0 && m.total[1] > 0.0;
        fill_times(&m);
        return m;
    }

    // From counts to weights; those of a sample add up to its observations in what is compared.
    double sum = 0.0, compared[2] = {0.0, 0.0};
    for (size_t s = 0; s < p->strata; s++) {
        double a = m.factor[0][s], b = m.factor[1][s];
        bool both = a > 0.0 && b > 0.0;
        sum += both ? a * b / (a + b) : 0.0;
        compared[0] += both ? a : 0.0;
        compared[1] += both ? b : 0.0;
    }
    for (size_t s = 0; s < p->strata; s++) {
        double a = m.factor[0][s], b = m.factor[1][s];
        bool both = a > 0.0 && b > 0.0;
        m.factor[0][s] = both ? b / (a + b) * compared[0] / sum : 0.0;
        m.factor[1][s] = both ? a / (a + b) * compared[1] / sum : 0.0;
    }
    m.total[0] = compared[0];
    m.total[1] = compared[1];
    fill_times(&m);
    return m;
}

/* The two order statistics a quantile lies between (type 7), found while walking up. */
typedef struct picker {
    double lower; /* rank from 0 */
    double share; /* of the way to the next */
    double low;
    double high;
} picker;

static picker picker_for(double total, double p)
{
    // Weights are sums of fractions: a rank that is a whole number but for rounding is one.
    double place = p * (total - 1.0), whole = nearbyint(place);
    if (fabs(place - whole) < 1e-9 * fmax(1.0, total))
        place = whole;
    double lower = floor(place);
    return (picker){.lower = lower, .share = place - lower, .low = NAN, .high = NAN};
}

// count observations of one value stand behind passed others. An order statistic is the value in
// the middle of its place, so that weights that are no whole numbers pull it to neither side.
static void pick(picker *p, double passed, double count, double value)
{
    double middle = p->lower + 0.5, slack = 1e-9 * fmax(1.0, passed + count);
    if (middle >= passed - slack && middle < passed + count - slack)
        p->low = value;
    if (middle + 1.0 >= passed - slack && middle + 1.0 < passed + count - slack)
        p->high = value;
}

static double picked(const picker *p)
{
    // Below lies no value to interpolate from: the quantile is censored too.
    if (p->share <= 0.0 || isinf(p->low) || isnan(p->high))
        return p->low;
    return p->low + p->share * (p->high - p->low);
}

/* Everything one walk gives of a sample. */
typedef struct figures {
    double value[CP_POOLED_COUNT];
    double finite_sum; /* of weighted values that are not censored */
    double censored;   /* weight of the others */
} figures;

/* One sample while its observations are walked up. */
typedef struct climb {
    picker median, p90;
    double passed;
    double wait; /* nothing is to be picked up to here */
    figures of;
} climb;

static climb climb_for(double total)
{
    climb c = {.median = picker_for(total, 0.5),
               .p90 = picker_for(total, 0.9),
               .of = {{NAN, NAN, NAN}, 0.0, 0.0}};
    c.wait = c.median.lower;
    return c;
}

// Near the place of a quantile. Behind it is far from it: the slack is below 1 up to 10^9
// observations.
static void pick_both(climb *c, double count, double value)
{
    pick(&c->median, c->passed, count, value);
    pick(&c->p90, c->passed, count, value);
    if (c->passed > c->p90.lower + 3.0)
        c->wait = INFINITY;
    else if (c->passed > c->median.lower + 3.0)
        c->wait = c->p90.lower;
}

// count observations of one value; none change nothing.
static inline void climb_on(climb *c, double count, double value)
{
    if (!(count > 0.0))
        return;
    if (c->passed + count > c->wait)
        pick_both(c, count, value);
    c->passed += count;
    if (isinf(value))
        c->of.censored += count;
    else
        c->of.finite_sum += count * value;
}

static void walk(const mix *m, figures of[2])
{
    const cp_pooled *p = m->pooled;
    climb sample[2] = {climb_for(m->total[0]), climb_for(m->total[1])};
    for (size_t begin = 0, end; begin < p->count; begin = end) {
        double value = p->value[begin];
        end = begin + 1;
        if (end == p->count || p->value[end] != value) {
            climb_on(&sample[p->group[begin]], p->times[p->cluster[begin]], value);
            continue;
        }
        double tied[2] = {0.0, 0.0};
        for (end = begin; end < p->count && p->value[end] == value; end++)
            tied[p->group[end]] += p->times[p->cluster[end]];
        climb_on(&sample[0], tied[0], value);
        climb_on(&sample[1], tied[1], value);
    }
    for (size_t g = 0; g < 2; g++) {
        of[g] = sample[g].of;
        if (m->total[g] <= 0.0)
            continue;
        of[g].value[CP_POOLED_MEAN] = of[g].censored > 0.0 ? NAN : of[g].finite_sum / m->total[g];
        of[g].value[CP_POOLED_MEDIAN] = picked(&sample[g].median);
        of[g].value[CP_POOLED_P90] = picked(&sample[g].p90);
    }
}

void cp_pooled_differences(const cp_pooled *pooled, const unsigned *weight_a,
                           const unsigned *weight_b, double difference[CP_POOLED_COUNT])
{
    mix m = mix_of(pooled, weight_a, weight_b);
    figures of[2];
    walk(&m, of);
    // Two censored quantiles: -INFINITY - -INFINITY is NAN, the difference does not exist.
    for (int f = 0; f < CP_POOLED_COUNT; f++)
        difference[f] = of[1].value[f] - of[0].value[f];
}

cp_estimate cp_pooled_estimate(const cp_pooled *pooled, int sample, int figure)
{
    mix m = mix_of(pooled, NULL, NULL);
    figures of[2];
    walk(&m, of);
    const figures *own = &of[sample];
    double lowest = pooled->lowest[sample], value = own->value[figure];
    if (m.total[sample] <= 0.0 || isnan(lowest))
        return (cp_estimate){CP_NO_VALUE, NAN};
    if (figure == CP_POOLED_MEAN && own->censored > 0.0)
        return (cp_estimate){CP_LESS_THAN,
                             (own->finite_sum + own->censored * lowest) / m.total[sample]};
    return isinf(value) ? (cp_estimate){CP_LESS_THAN, lowest} : (cp_estimate){CP_EXACTLY, value};
}

size_t cp_pooled_compared(const cp_pooled *pooled, int sample)
{
    return (size_t)llround(mix_of(pooled, NULL, NULL).total[sample]);
}

// Calls for the difference of the two functions after each value; ties move together.
static double largest_distance(const mix *m, const double *centre, double *difference)
{
    const cp_pooled *p = m->pooled;
    double passed[2] = {0.0, 0.0}, largest = 0.0;
    for (size_t begin = 0, end; begin < p->count; begin = end) {
        for (end = begin; end < p->count && p->value[end] == p->value[begin]; end++)
            passed[p->group[end]] += p->times[p->cluster[end]];
        double apart = passed[1] / m->total[1] - passed[0] / m->total[0];
        for (size_t k = begin; difference && k < end; k++)
            difference[k] = apart;
        double off = fabs(apart - (centre ? centre[begin] : 0.0));
        largest = off > largest ? off : largest;
    }
    return largest;
}

double cp_pooled_distance(const cp_pooled *pooled, const unsigned *weight_a,
                          const unsigned *weight_b, const double *centre)
{
    mix m = mix_of(pooled, weight_a, weight_b);
    return m.total[0] > 0.0 && m.total[1] > 0.0 ? largest_distance(&m, centre, NULL) : NAN;
}

void cp_pooled_centre(const cp_pooled *pooled, double *centre)
{
    mix m = mix_of(pooled, NULL, NULL);
    if (m.total[0] > 0.0 && m.total[1] > 0.0)
        largest_distance(&m, NULL, centre);
}
