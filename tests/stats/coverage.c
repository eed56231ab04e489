/* SPDX-License-Identifier: GPL-3.0-or-later */
// How often 95 % intervals hold the truth: coverage [REPETITIONS [RESAMPLES [WHICH]]] prints the
// table of coverage.md, which `cmake --build build --target coverage` writes. WHICH is independent
// (default), paired, or plain: BCa without the expansion for few clusters, independent design.
#include "builders/simulated_study.h"
#include "stats/band.h"
#include "stats/contrast.h"

#include <string.h>

enum { MEAN, MEDIAN, P90, DELTA, RATIO, BAND, FIGURES };

static const char *const FIGURE[FIGURES] = {"mean",      "median",     "p90",
                                            "Cliff's δ", "rate ratio", "ECDF band"};

/* Over the studies of a cell: intervals given, and those of them that hold the truth. */
typedef struct counts {
    double given[FIGURES];
    double held[FIGURES];
} counts;

static void count(counts *c, int figure, cp_interval i, double truth)
{
    if (i.status != CP_INTERVAL_VALUE)
        return;
    c->given[figure]++;
    c->held[figure] += i.low <= truth && truth <= i.high;
}

// Whether the band of the baseline holds the true distribution function at every step.
static bool band_holds(const cp_sample *sample, const cp_resampling *r)
{
    cp_resampling one = *r;
    one.cluster_count[1] = 0;
    one.paired = false;
    cp_band band;
    cp_error error = {0};
    if (cp_band_of_ecdf(sample, &one, &band, &error) != CP_OK)
        abort();
    for (size_t k = 0; k < sample->count; k++) {
        double truth = gsl_cdf_ugaussian_P((log(sample->value[k]) - SIMULATED_MU) / SIMULATED_SD);
        double n = (double)sample->count;
        if (truth < (double)(k + 1) / n - band.half_width_1 ||
            truth > (double)k / n + band.half_width_1)
            return false;
    }
    return band.status == CP_INTERVAL_VALUE;
}

static void repetition(const simulated_design *d, uint64_t seed, size_t resamples, bool expanded,
                       counts *covered)
{
    simulated_variant a = simulate_variant(d, seed, 0), b = simulate_variant(d, seed, 1);
    simulated_truth truth = simulated_truth_of(d);
    cp_resampling r = cp_resampling_default();
    r.cluster_count[0] = r.cluster_count[1] = d->replications;
    r.repetitions = resamples;
    r.seed = seed;
    r.paired = d->paired;
    r.expanded = expanded;
    cp_contrast c;
    cp_interval ratio;
    cp_exposure ea = simulated_exposure(&a), eb = simulated_exposure(&b);
    cp_error error = {0};
    if (cp_contrast_samples(&a.sample, &b.sample, &r, &c, &error) != CP_OK ||
        cp_rate_ratio_bootstrap(&ea, &eb, &r, &ratio, &error) != CP_OK)
        abort();
    count(covered, MEAN, c.mean_interval, truth.mean_difference);
    count(covered, MEDIAN, c.median_interval, truth.median_difference);
    count(covered, P90, c.p90_interval, truth.p90_difference);
    count(covered, DELTA, c.superiority.interval, truth.cliffs_delta);
    count(covered, RATIO, ratio, truth.rate_ratio);
    covered->given[BAND]++;
    covered->held[BAND] += expanded && band_holds(&a.sample, &r);
    simulated_variant_destroy(&a);
    simulated_variant_destroy(&b);
}

static void print_cell(const simulated_design *d, size_t repetitions, size_t resamples,
                       bool expanded)
{
    counts covered = {{0.0}, {0.0}};
    for (size_t k = 0; k < repetitions; k++)
        repetition(d, 1000 + k, resamples, expanded, &covered);
    printf("| %s | %zu | %g | %g | %s |", expanded ? "expanded" : "plain", d->replications,
           d->mean_crashes, d->rho, d->paired ? "paired" : "independent");
    for (int f = 0; f < FIGURES; f++) {
        // Given in half of the studies or fewer: only of odd ones.
        if ((f == BAND && !expanded) || covered.given[f] <= 0.5 * (double)repetitions) {
            printf(" – |");
            continue;
        }
        double percent = 100.0 * covered.held[f] / covered.given[f];
        bool outside = percent < 93.0 || percent > 97.0;
        printf(outside ? " **%.1f** |" : " %.1f |", percent);
    }
    printf("\n");
    fflush(stdout);
}

int main(int argc, char **argv)
{
    size_t repetitions = argc > 1 ? strtoul(argv[1], NULL, 10) : 1000;
    size_t resamples = argc > 2 ? strtoul(argv[2], NULL, 10) : 1000;
    printf("Per cent of %zu simulated studies whose 95 %% interval, where one is given, holds the "
           "truth, %zu "
           "resamples each.\n–: given in half of them or fewer. Bold: outside 93–97. Standard "
           "error of an entry: %.1f.\n\n",
           repetitions, resamples, 100.0 * sqrt(0.95 * 0.05 / (double)repetitions));
    printf("| BCa | replications | crashes | ρ | design |");
    for (int f = 0; f < FIGURES; f++)
        printf(" %s |", FIGURE[f]);
    printf("\n|---|---|---|---|---|---|---|---|---|---|---|\n");
    const char *which = argc > 3 ? argv[3] : "independent";
    for (int n = 0; n < 3; n++)
        for (int m = 0; m < 2; m++)
            for (int c = 0; c < 2; c++) {
                simulated_design d = {.replications = (const size_t[]){20, 40, 100}[n],
                                      .mean_crashes = m ? 10.0 : 3.0,
                                      .rho = c ? 0.3 : 0.0,
                                      .rate_ratio = 0.7,
                                      .shift = -0.2,
                                      .paired = strcmp(which, "paired") == 0};
                print_cell(&d, repetitions, resamples, strcmp(which, "plain") != 0);
            }
    return 0;
}
