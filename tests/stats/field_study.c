/* SPDX-License-Identifier: GPL-3.0-or-later */
// How often intervals of weighted figures hold the truth. field_study [STUDIES [RESAMPLES [ROW]]]
// prints the table of field_study.md; `cmake --build build --target field_study` writes it.
#include "stats/field_study.h"

int main(int argc, char **argv)
{
    size_t studies = argc > 1 ? strtoul(argv[1], NULL, 10) : 1000;
    size_t repetitions = argc > 2 ? strtoul(argv[2], NULL, 10) : 400;
    printf("# Coverage of weighted figures\n\n"
           "%zu simulated studies a row, %zu resamples: crashes of other types, overlaps and "
           "severities than the field has them,\nraked to its margins; `crashes` are to be "
           "expected of the baseline in a replication, the treatment has half of them,\nmilder "
           "by `shift` of the mean of their logarithm. ρ of the variance of counts and of log "
           "severities lies between\nreplications. `effective`: Kish's number of the baseline, "
           "per cent of its crashes. Per cent of the 95 %% intervals given\nthat hold the truth; "
           "bold: outside 93 to 97; –: given in less than 5 %%. The last two columns are for "
           "comparison: without\nweights (the truth is another one), and with weights that are "
           "not found anew in each resample. Standard error of an entry: %.1f.\n\n"
           "| replications | crashes | ρ | seeds | shift | effective |",
           studies, repetitions, 100.0 * sqrt(0.95 * 0.05 / (double)studies));
    for (int f = 0; f < FIELD_COUNT; f++)
        printf(" %s |", FIELD_TEXT[f]);
    printf("\n|---|---|---|---|---|---|");
    for (int f = 0; f < FIELD_COUNT; f++)
        printf("---|");
    printf("\n");
    static const size_t REPLICATIONS[] = {20, 40, 100};
    static const double CRASHES[] = {3.0, 10.0};
    for (size_t cell = 0; cell < 24; cell++) {
        if (argc > 3 && cell != strtoul(argv[3], NULL, 10))
            continue;
        simulated_design d = {.replications = REPLICATIONS[cell / 8],
                              .mean_crashes = CRASHES[cell / 4 % 2],
                              .rho = cell / 2 % 2 ? 0.3 : 0.0,
                              .paired = cell % 2,
                              .rate_ratio = 0.5,
                              .shift = cell % 2 ? -0.2 : 0.0};
        field_truth truth[2] = {field_truth_of(&d, 0), field_truth_of(&d, 1)};
        field_counts c = {{0.0}, {0.0}, 0.0};
        for (size_t k = 0; k < studies; k++)
            field_study(&d, 90000 + k, repetitions, true, truth, &c);
        printf("| %zu | %g | %g | %s | %g | %.0f |", d.replications, d.mean_crashes, d.rho,
               d.paired ? "paired" : "independent", d.shift, 100.0 * c.effective / (double)studies);
        for (int f = 0; f < FIELD_COUNT; f++) {
            double percent = 100.0 * c.hits[f] / c.given[f];
            if (c.given[f] < 0.05 * (double)studies)
                printf(" – |");
            else
                printf(percent >= 93.0 && percent <= 97.0 ? " %.1f |" : " **%.1f** |", percent);
        }
        printf("\n");
        fflush(stdout);
    }
    return 0;
}
