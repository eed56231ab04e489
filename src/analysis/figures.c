/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/figures.h"

#include <stdlib.h>

const char *const CP_SCOPE_TEXT[CP_SCOPE_COUNT] = {"all", "inside"};
const char *const CP_PAIRED_TEXT[CP_PAIRED_COUNT] = {"all_pairs", "conditional_on_crashing"};

cp_comparison_options cp_comparison_options_default(void)
{
    cp_comparison_options options = {.repetitions = 2000, .permutations = 1999};
    for (int what = 0; what < CP_EXCEEDED_COUNT; what++)
        options.above[what] = CP_EXCEEDED_HEADLINE[what];
    return options;
}

cp_interval cp_rate_interval(const cp_variant_figures *figures)
{
    return figures->rate_bootstrap.status == CP_INTERVAL_VALUE ? figures->rate_bootstrap
                                                               : figures->rate_widened;
}

cp_interval cp_rate_ratio_interval(const cp_contrast_figures *figures)
{
    return figures->rate_ratio_bootstrap.status == CP_INTERVAL_VALUE ? figures->rate_ratio_bootstrap
                                                                     : figures->rate_ratio_widened;
}

void cp_comparison_destroy(cp_comparison *comparison)
{
    for (int scope = 0; scope < CP_SCOPE_COUNT; scope++)
        for (size_t k = 0; k < comparison->variant_count; k++)
            free(comparison->variant[k].injury[scope]);
    for (size_t k = 0; k < comparison->variant_count; k++)
        free(comparison->variant[k].field);
    for (size_t k = 0; k < comparison->contrast_count; k++) {
        free(comparison->contrast[k].benefit);
        free(comparison->contrast[k].field);
    }
    for (size_t k = 0; k < comparison->counterfactual_count; k++) {
        free(comparison->counterfactual[k].benefit);
        free(comparison->counterfactual[k].field);
    }
    free(comparison->counterfactual);
    free(comparison->variant);
    free(comparison->contrast);
    *comparison = (cp_comparison){0};
}

const cp_variant_figures *cp_comparison_variant(const cp_comparison *comparison, size_t variant)
{
    for (size_t k = 0; k < comparison->variant_count; k++)
        if (comparison->variant[k].variant == variant)
            return &comparison->variant[k];
    return NULL;
}
