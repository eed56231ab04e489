/* SPDX-License-Identifier: GPL-3.0-or-later */
// How often each test rejects and each interval holds the truth where severity is the same in both
// variants and their crash rates are not. null_study [STUDIES [RESAMPLES [PERMUTATIONS]]] prints
// the tables of null_study.md; `cmake --build build --target null_study` writes it.
#include "stats/null_study.h"

enum { RATIOS = 4, CLUSTERINGS = 2, REPLICATIONS = 4, CRASHES = 3 };
static const double RATIO[RATIOS] = {1.0, 0.5, 0.2, 0.05};
static const double RHO[CLUSTERINGS] = {0.0, 0.3};
static const size_t REPLICATION_COUNT[REPLICATIONS] = {5, 10, 20, 50};
static const double CRASH_COUNT[CRASHES] = {3.0, 10.0, 30.0};

/* Given in fewer studies than this there is no row to speak of. */
#define GIVEN_LEAST 0.05

static void print_heading(bool tests)
{
    printf("| ratio | ρ | replications | crashes | given |");
    for (int f = 0; f < NULL_COUNT; f++)
        if (NULL_IS_TEST[f] == tests)
            printf(" %s |", NULL_TEXT[f]);
    printf("\n|---|---|---|---|---|");
    for (int f = 0; f < NULL_COUNT; f++)
        if (NULL_IS_TEST[f] == tests)
            printf("---|");
    printf("\n");
}

static void print_row(const simulated_design *d, double crashes, double studies,
                      const null_counts *c, bool tests)
{
    printf("| %g | %g | %zu | %g | %.0f |", d->rate_ratio, d->rho, d->replications, crashes,
           100.0 * c->given[NULL_SEVERITY] / studies);
    for (int f = 0; f < NULL_COUNT; f++) {
        if (NULL_IS_TEST[f] != tests)
            continue;
        double percent = 100.0 * c->hits[f] / c->given[f];
        bool inside = tests ? percent >= 3.0 && percent <= 7.0 : percent >= 93.0 && percent <= 97.0;
        if (c->given[f] < GIVEN_LEAST * studies)
            printf(" – |");
        else
            printf(inside || NULL_IS_OLD[f] ? " %.1f |" : " **%.1f** |", percent);
    }
    printf("\n");
}

static void simulate_cells(bool paired, size_t studies, size_t resamples, size_t permutations)
{
    enum { CELLS = RATIOS * CLUSTERINGS * REPLICATIONS * CRASHES };
    static null_counts counts[CELLS];
    static simulated_design design[CELLS];
    for (size_t cell = 0; cell < CELLS; cell++) {
        counts[cell] = (null_counts){{0.0}, {0.0}};
        size_t rest = cell / CRASHES;
        design[cell] =
            null_cell(REPLICATION_COUNT[rest % REPLICATIONS], CRASH_COUNT[cell % CRASHES],
                      RHO[rest / REPLICATIONS % CLUSTERINGS],
                      RATIO[rest / REPLICATIONS / CLUSTERINGS], paired);
        for (size_t k = 0; k < studies; k++)
            null_study(&design[cell], 50000 + k, resamples, permutations, &counts[cell]);
    }
    for (int tests = 1; tests >= 0; tests--) {
        printf("\n## %s, %s seeds\n\n", tests ? "Size of the tests" : "Coverage of the intervals",
               paired ? "paired" : "independent");
        print_heading(tests);
        for (size_t cell = 0; cell < CELLS; cell++)
            print_row(&design[cell], CRASH_COUNT[cell % CRASHES], (double)studies, &counts[cell],
                      tests);
    }
    fflush(stdout);
}

int main(int argc, char **argv)
{
    size_t studies = argc > 1 ? strtoul(argv[1], NULL, 10) : 1000;
    size_t resamples = argc > 2 ? strtoul(argv[2], NULL, 10) : 400;
    size_t permutations = argc > 3 ? strtoul(argv[3], NULL, 10) : 199;
    printf(
        "# Size of every test, coverage of every interval\n\n"
        "%zu simulated studies a row, %zu resamples, %zu permutations. Severity is the same in "
        "both variants, the\ntreatment's crash rate is `ratio` times the baseline's; `crashes` "
        "are to be expected in the treatment, in all\nreplications; ρ of the variance of counts "
        "and of log severities lies between replications. `given`: per cent\nof the studies with "
        "severities enough for a test (others say \"too few crashes\"). Sizes are per cent of p "
        "≤ 0.05,\ncoverages per cent of 95 %% intervals that hold the truth, both of those given; "
        "–: given in less than 5 %%.\nBold: outside 3 to 7, or 93 to 97. Standard error of an "
        "entry where all are given: %.1f. \"old\" is how it was\ndone before: whole "
        "replications permuted, intervals whatever the resamples were.\n",
        studies, resamples, permutations, 100.0 * sqrt(0.95 * 0.05 / (double)studies));
    for (int paired = 0; paired < 2; paired++)
        simulate_cells(paired, studies, resamples, permutations);
    return 0;
}
