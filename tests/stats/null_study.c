/* SPDX-License-Identifier: GPL-3.0-or-later */
// Two identical variants, other seeds: p-values must be uniform. null_study [STUDIES
// [PERMUTATIONS]] prints the table of null_study.md. `cmake --build build --target null_study`
// writes it.
#include "stats/null_study.h"

int main(int argc, char **argv)
{
    size_t studies = argc > 1 ? strtoul(argv[1], NULL, 10) : 200;
    size_t permutations = argc > 2 ? strtoul(argv[2], NULL, 10) : 999;
    printf("p-values of %zu studies of two identical variants, %zu permutations each: share at or "
           "below 5 %%,\nlargest distance of their distribution from uniform, and the p of that "
           "distance (Kolmogorov).\nBold: that p is below 1 %%.\n\n",
           studies, permutations);
    printf("| test | replications | crashes | ρ | design | ≤ 5 %% | distance | p |\n"
           "|---|---|---|---|---|---|---|---|\n");
    double *p = calloc(NULL_TESTS * studies, sizeof *p);
    if (!p)
        abort();
    for (int paired = 0; paired < 2; paired++) {
        for (int c = 0; c < 2; c++) {
            simulated_design d = {.replications = 20,
                                  .mean_crashes = 6.0,
                                  .rho = c ? 0.5 : 0.0,
                                  .rate_ratio = 1.0,
                                  .paired = paired};
            null_p_values(&d, 50000, studies, permutations, p);
            for (int test = 0; test < NULL_TESTS; test++) {
                null_summary s = null_summary_of(p + (size_t)test * studies, studies);
                printf(s.p < 0.01 ? "| %s | %zu | %g | %g | %s | %.1f %% | %.3f | **%.3f** |\n"
                                  : "| %s | %zu | %g | %g | %s | %.1f %% | %.3f | %.3f |\n",
                       NULL_TEST_TEXT[test], d.replications, d.mean_crashes, d.rho,
                       paired ? "paired" : "independent", 100.0 * s.rejected_1, s.distance, s.p);
            }
        }
    }
    free(p);
    return 0;
}
