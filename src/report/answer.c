/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/answer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *cp_estimate_text(cp_estimate estimate, int digits, char text[CP_ESTIMATE_TEXT_SIZE])
{
    static const char *const SIGN[] = {
        [CP_EXACTLY] = "", [CP_LESS_THAN] = "<", [CP_MORE_THAN] = ">"};
    if (estimate.relation == CP_NO_VALUE)
        snprintf(text, CP_ESTIMATE_TEXT_SIZE, "n/a");
    else
        snprintf(text, CP_ESTIMATE_TEXT_SIZE, "%s%.*f", SIGN[estimate.relation], digits,
                 estimate.value);
    return text;
}

const char *cp_p_text(double p, char text[CP_ESTIMATE_TEXT_SIZE])
{
    if (isnan(p))
        snprintf(text, CP_ESTIMATE_TEXT_SIZE, "n/a");
    else if (p < 0.001)
        snprintf(text, CP_ESTIMATE_TEXT_SIZE, "<0.001");
    else
        snprintf(text, CP_ESTIMATE_TEXT_SIZE, "%.3f", p);
    return text;
}

static const char *p_phrase(double p, char text[CP_ESTIMATE_TEXT_SIZE])
{
    char number[CP_ESTIMATE_TEXT_SIZE];
    cp_p_text(p, number);
    snprintf(text, CP_ESTIMATE_TEXT_SIZE, number[0] == '<' ? "p < %.20s" : "p = %.20s",
             number + (number[0] == '<'));
    return text;
}

// The bootstrap interval where there is one, else the one that trusts the Poisson law.
static void write_ratio(FILE *out, const cp_contrast_figures *c)
{
    if (isnan(c->rate_ratio)) {
        fputs("rate ratio undefined, the baseline had no frontal crash", out);
        return;
    }
    bool bootstrap = c->rate_ratio_bootstrap.status == CP_INTERVAL_VALUE;
    cp_interval interval = bootstrap ? c->rate_ratio_bootstrap : c->rate_ratio_poisson;
    fprintf(out, "%.2f times the rate of frontal crashes (95 %% %s %.2f–%.2f", c->rate_ratio,
            bootstrap ? "bootstrap interval" : "Poisson interval", interval.low, interval.high);
    char p[CP_ESTIMATE_TEXT_SIZE];
    fprintf(out, ", %s)", p_phrase(c->rate_p_holm, p));
}

static void write_contrast(FILE *out, const cp_study_data *data, const cp_comparison *comparison,
                           const cp_contrast_figures *c)
{
    const cp_variant_figures *treatment = cp_comparison_variant(comparison, c->variant);
    const cp_variant_figures *baseline = cp_comparison_variant(comparison, comparison->baseline);
    char median[2][CP_ESTIMATE_TEXT_SIZE], p[CP_ESTIMATE_TEXT_SIZE];
    const cp_contrast *olc = &c->severity[CP_QUANTITY_OLC][CP_SCOPE_ALL];
    fprintf(out, "%s had ", data->variant[c->variant].name);
    write_ratio(out, c);
    fprintf(out,
            " and a median OLC of %s g against %s g over the frontally struck vehicles of its own "
            "crashes (",
            cp_estimate_text(treatment->description[CP_QUANTITY_OLC][CP_SCOPE_ALL].median, 1,
                             median[0]),
            cp_estimate_text(baseline->description[CP_QUANTITY_OLC][CP_SCOPE_ALL].median, 1,
                             median[1]));
    if (isnan(olc->cliffs_delta))
        fputs("nothing to compare)", out);
    else
        fprintf(out, "Cliff’s δ = %.2f, %s)", olc->cliffs_delta,
                p_phrase(c->severity_p_holm[CP_QUANTITY_OLC][CP_SCOPE_ALL], p));
}

// What a treatment made of the baseline's crashes: outcomes first, then severity over all of them.
static void write_pairs(FILE *out, const cp_study_data *data, const cp_counterfactual_figures *c)
{
    double valid = c->valid ? (double)c->valid : NAN, percent = 100.0 / valid;
    const cp_paired *olc = &c->olc_g[CP_PAIRED_ALL];
    fprintf(out, "with %s %zu of %zu valid baseline crashes were avoided (%.0f %%",
            data->variant[c->variant].name, c->outcome[CP_OUTCOME_AVOIDED], c->valid,
            percent * (double)c->outcome[CP_OUTCOME_AVOIDED]);
    cp_interval share = c->share[CP_OUTCOME_AVOIDED];
    if (share.status == CP_INTERVAL_VALUE)
        fprintf(out, ", 95 %% interval %.0f–%.0f", 100.0 * share.low, 100.0 * share.high);
    fprintf(out, "), %zu mitigated, %zu unchanged, %zu aggravated and %zu with another opponent",
            c->outcome[CP_OUTCOME_MITIGATED], c->outcome[CP_OUTCOME_UNCHANGED],
            c->outcome[CP_OUTCOME_AGGRAVATED], c->outcome[CP_OUTCOME_CHANGED_OPPONENT]);
    if (!isnan(olc->hodges_lehmann)) {
        char p[CP_ESTIMATE_TEXT_SIZE];
        fprintf(out, ", and OLC changed by %.1f g (Hodges–Lehmann, avoided = 0 g",
                olc->hodges_lehmann);
        if (olc->hodges_lehmann_interval.status == CP_INTERVAL_VALUE)
            fprintf(out, ", 95 %% interval %.1f to %.1f", olc->hodges_lehmann_interval.low,
                    olc->hodges_lehmann_interval.high);
        fprintf(out, ", %s)", p_phrase(c->p_holm[CP_PAIRED_ALL], p));
    }
    if (c->crashes > c->valid)
        fprintf(out, "; %zu more could not be judged", c->crashes - c->valid);
}

static void write_counts(FILE *out, const cp_study_data *data, const cp_comparison *comparison)
{
    for (size_t k = 0; k < comparison->variant_count; k++) {
        const cp_variant_figures *v = &comparison->variant[k];
        fprintf(out,
                "%s%zu frontal crashes with %s (%zu of them front-front with both vehicles "
                "inside the validated range)",
                k == 0                              ? ""
                : k + 1 < comparison->variant_count ? ", "
                                                    : " and ",
                v->frontal_crashes, data->variant[v->variant].name, v->front_front_inside);
    }
}

static bool says_how_often(const char *name)
{
    return strstr(name, "probability") != NULL || strncmp(name, "rate_", 5) == 0;
}

// Parameters that say how often; all of them for a model without any.
static void write_parameters(FILE *out, const json_t *parameters)
{
    const char *name;
    json_t *value;
    bool any = false;
    json_object_foreach((json_t *)parameters, name, value) any |= says_how_often(name);
    const char *separator = " ";
    json_object_foreach((json_t *)parameters, name, value)
    {
        if (!json_is_number(value) || (any && !says_how_often(name)))
            continue;
        if (strcmp(name, "probability_1") == 0)
            fprintf(out, "%swith probability %g", separator, json_number_value(value));
        else
            fprintf(out, "%s%s = %g", separator, name, json_number_value(value));
        separator = ", ";
    }
}

static void write_driver_errors(FILE *out, const cp_study_data *data, cp_slice slice)
{
    const char *separator = "";
    for (size_t k = 0; k < data->scenario_count; k++) {
        if (slice.scenario != CP_SLICE_ALL && slice.scenario != k)
            continue;
        fprintf(out, "%s%s: ", separator, data->scenario[k].name);
        separator = "; ";
        size_t index;
        json_t *model;
        if (json_array_size(data->scenario[k].driver_errors) == 0)
            fputs("none", out);
        json_array_foreach(data->scenario[k].driver_errors, index, model)
        {
            const char *name = json_string_value(json_object_get(model, "model"));
            fprintf(out, "%s%s", index ? ", " : "", name ? name : "?");
            write_parameters(out, json_object_get(model, "parameters"));
        }
    }
}

const cp_variant_figures *cp_comparison_variant(const cp_comparison *comparison, size_t variant)
{
    for (size_t k = 0; k < comparison->variant_count; k++)
        if (comparison->variant[k].variant == variant)
            return &comparison->variant[k];
    return NULL;
}

cp_status cp_comparison_answer(const cp_study_data *data, const cp_comparison *comparison,
                               char **answer, cp_error *error)
{
    *answer = NULL;
    size_t size = 0;
    FILE *out = open_memstream(answer, &size);
    if (!out)
        return cp_fail_memory(error, "the answer of a comparison");

    // Contrasts first: they are what was asked.
    for (size_t k = 0; k < comparison->contrast_count; k++) {
        if (k == 0)
            fprintf(out, "Against %s, ", data->variant[comparison->baseline].name);
        write_contrast(out, data, comparison, &comparison->contrast[k]);
        fputs(k + 1 < comparison->contrast_count ? "; " : ", from ", out);
    }
    write_counts(out, data, comparison);
    for (size_t k = 0; k < comparison->counterfactual_count; k++) {
        fputs("; ", out);
        write_pairs(out, data, &comparison->counterfactual[k]);
    }
    fputs(", all conditional on the assumed driver errors (", out);
    write_driver_errors(out, data, comparison->slice);
    fputs("): these are not accident rates of real traffic.", out);
    int failed = ferror(out);
    if (fclose(out) != 0 || failed) {
        free(*answer);
        *answer = NULL;
        return cp_fail_memory(error, "the answer of a comparison");
    }
    return CP_OK;
}
