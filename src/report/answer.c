/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/answer.h"

#include "core/memory_stream.h"

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
    snprintf(text, CP_ESTIMATE_TEXT_SIZE, number[0] == '<' ? "Holm p < %.20s" : "Holm p = %.20s",
             number + (number[0] == '<'));
    return text;
}

// "95 % interval 0.33 to 0.67", an open end as infinity.
static void write_interval(FILE *out, cp_interval interval, int digits, const char *kind)
{
    fprintf(out, "95 %% %s ", kind);
    if (isinf(interval.low))
        fputs("−∞", out);
    else
        fprintf(out, "%.*f", digits, interval.low);
    if (isinf(interval.high))
        fputs(" to ∞", out);
    else
        fprintf(out, " to %.*f", digits, interval.high);
}

static const char *plural(size_t count)
{
    return count == 1 ? "" : "es";
}

// What the interval trusts: resamples, or counts with the scatter that replications show.
static const char *ratio_kind(const cp_contrast_figures *c)
{
    if (c->rate_ratio_bootstrap.status == CP_INTERVAL_VALUE)
        return "bootstrap interval";
    return isnan(c->rate_ratio_widening.dispersion_1)
               ? "Poisson interval, which trusts that replications differ by chance only,"
               : "interval of Poisson counts widened by their dispersion";
}

static void write_ratio(FILE *out, const cp_contrast_figures *c)
{
    if (isnan(c->rate_ratio)) {
        fputs("a rate ratio cannot be given, as the baseline had no frontal crash", out);
        return;
    }
    fprintf(out, "had %.2f times the rate of frontal crashes (", c->rate_ratio);
    write_interval(out, cp_rate_ratio_interval(c), 2, ratio_kind(c));
    char p[CP_ESTIMATE_TEXT_SIZE];
    if (!isnan(c->rate_p_holm))
        fprintf(out, ", %s", p_phrase(c->rate_p_holm, p));
    fprintf(out, "; %zu against %zu frontal crash%s)", c->frontal_crashes[1], c->frontal_crashes[0],
            plural(c->frontal_crashes[0]));
}

// Of crashes above the headline severity, with what the range leaves open.
static void write_exceedance(FILE *out, const cp_exceedance_ratio *r)
{
    fprintf(out, "Crashes above an OLC of %g g: ", r->x);
    if (isnan(r->ratio)) {
        fputs("none with the baseline", out);
    } else {
        fprintf(out, "%.2f times the rate (", r->ratio);
        write_interval(out, r->interval, 2, "interval");
        fprintf(out, "; %zu against %zu", r->crashes[1], r->crashes[0]);
        // From the least that the one bound leaves to the most that the other does.
        cp_interval reach = {CP_INTERVAL_VALUE, r->bound_interval[0].low,
                             r->bound_interval[1].high};
        fputs("; with severities outside the validated range unknown, ", out);
        if (r->bound_interval[0].status == CP_INTERVAL_VALUE &&
            r->bound_interval[1].status == CP_INTERVAL_VALUE)
            write_interval(out, reach, 2, "interval");
        else
            fputs("nothing is known", out);
        fputc(')', out);
    }
    fputs(". ", out);
}

// A median that censoring hides is said in words.
static void write_median(FILE *out, cp_estimate median)
{
    char text[CP_ESTIMATE_TEXT_SIZE];
    if (median.relation == CP_NO_VALUE)
        fputs("below every value (all left-censored)", out);
    else
        fprintf(out, "%s g", cp_estimate_text(median, 1, text));
}

// What of a figure's uncertainty is the traffic's and what the crash model's. unit: " g" or "".
static void write_model_part(FILE *out, const char *what, const char *unit, int digits,
                             const cp_model_part *p, const cp_comparison *comparison)
{
    char text[CP_ESTIMATE_TEXT_SIZE];
    if (p->sets == 0)
        return;
    if (p->status != CP_INTERVAL_VALUE) {
        fprintf(out,
                "What the %zu parameter sets of the vehicle models say of %s is not known (%s)",
                p->sets, what, cp_interval_status_text(p->status));
    } else if (p->combined.status == CP_INTERVAL_VALUE) {
        fprintf(out, "With the uncertainty of the crash model %s is %s%s (", what,
                cp_estimate_text(p->estimate, digits, text), unit);
        write_interval(out, p->combined, digits, "interval");
        fputs("): from replications ", out);
        write_interval(out, p->replications, digits, "interval");
        fprintf(
            out,
            ", from the model’s ensemble of %zu parameter sets ±%.*f%s, combined as the root of "
            "the sum of squares",
            p->sets, digits, p->half_width, unit);
    } else {
        fprintf(
            out,
            "Of the uncertainty of %s, ±%.*f%s (95 %%) is the crash model’s, by its ensemble of "
            "%zu parameter sets; replications give no interval (%s)",
            what, digits, p->half_width, unit, p->sets,
            cp_interval_status_text(p->combined.status));
    }
    size_t without = 0;
    for (size_t k = 0; k < comparison->variant_count; k++)
        without += comparison->variant[k].without_sets;
    if (without > 0)
        fprintf(out, "; %zu vehicle%s of models without such sets count as certain", without,
                without == 1 ? "" : "s");
    fputs(".\n", out);
}

// Of the difference of medians; where replications are too few for its interval, of Cliff's delta.
static void write_model_of_contrast(FILE *out, const cp_contrast_figures *c,
                                    const cp_comparison *comparison)
{
    if (c->median_model.combined.status != CP_INTERVAL_VALUE &&
        c->delta_model.combined.status == CP_INTERVAL_VALUE)
        write_model_part(out, "Cliff’s δ", "", 2, &c->delta_model, comparison);
    else
        write_model_part(out, "the difference of the medians", " g", 1, &c->median_model,
                         comparison);
}

static void write_severity(FILE *out, const cp_study_data *data, const cp_comparison *comparison,
                           const cp_contrast_figures *c)
{
    const cp_contrast *olc = &c->severity[CP_QUANTITY_OLC];
    const cp_superiority *s = &olc->superiority;
    const char *treatment = data->variant[c->variant].name;
    const char *baseline = data->variant[comparison->baseline].name;
    if (isnan(s->cliffs_delta)) {
        fputs("Its OLC cannot be compared: no scenario has vehicles with an OLC in both.\n", out);
        return;
    }
    fputs("Median OLC of the frontally struck vehicles", out);
    if (comparison->slice.scenario == CP_SLICE_ALL && data->scenario_count > 1)
        fputs(", at the same mix of scenarios", out);
    fputs(": ", out);
    write_median(out, olc->median[1]);
    fputs(" against ", out);
    write_median(out, olc->median[0]);
    fprintf(out, " (Cliff’s δ = %.2f, ", s->cliffs_delta);
    if (s->status == CP_INTERVAL_VALUE) {
        char p[CP_ESTIMATE_TEXT_SIZE];
        write_interval(out, s->interval, 2, "interval");
        fprintf(out, ", %s", p_phrase(c->severity_p_holm[CP_QUANTITY_OLC], p));
    } else if (!isnan(s->p)) {
        char p[CP_ESTIMATE_TEXT_SIZE];
        fprintf(out, "completely apart, which leaves no interval, %s at most",
                p_phrase(c->severity_p_holm[CP_QUANTITY_OLC], p));
    } else {
        fprintf(out, "%s for an interval or a test", cp_interval_status_text(s->status));
    }
    fprintf(out, "; %zu against %zu vehicles", olc->compared[1], olc->compared[0]);

    // What is missing is said: vehicles of scenarios that only one has, and those without an OLC.
    const cp_variant_figures *figures[2] = {cp_comparison_variant(comparison, comparison->baseline),
                                            cp_comparison_variant(comparison, c->variant)};
    const char *name[2] = {baseline, treatment};
    for (int g = 0; g < 2; g++) {
        size_t with = figures[g]->description[CP_QUANTITY_OLC][CP_SCOPE_ALL].count;
        if (with > olc->compared[g])
            fprintf(out,
                    "; %zu of %s not compared, for want of a partner or of a crash of the "
                    "other in their scenario",
                    with - olc->compared[g], name[g]);
        if (figures[g]->simulation_failed > 0)
            fprintf(out, "; %zu of %s without a simulated crash", figures[g]->simulation_failed,
                    name[g]);
    }
    fputs(").\n", out);
    write_model_of_contrast(out, c, comparison);
}

static void write_contrast(FILE *out, const cp_study_data *data, const cp_comparison *comparison,
                           const cp_contrast_figures *c)
{
    fprintf(out, "Against %s, over ", data->variant[comparison->baseline].name);
    if (data->paired)
        fprintf(out, "the %zu seeds that both finished", c->replications[1]);
    else
        fprintf(out, "%zu against %zu replications", c->replications[1], c->replications[0]);
    if (c->partnerless[0] + c->partnerless[1] > 0)
        fprintf(out, " (%zu more without a partner are left out)",
                c->partnerless[0] + c->partnerless[1]);
    fprintf(out, ", %s%s ", data->variant[c->variant].name, isnan(c->rate_ratio) ? ":" : "");
    write_ratio(out, c);
    fputs(". ", out);
    write_exceedance(out, &c->above[CP_EXCEEDED_OLC]);
    write_severity(out, data, comparison, c);
}

// What a treatment made of the baseline's crashes: outcomes first, then severity over all of them.
static void write_pairs(FILE *out, const cp_study_data *data, const cp_comparison *comparison,
                        const cp_counterfactual_figures *c)
{
    double valid = c->valid ? (double)c->valid : NAN, percent = 100.0 / valid;
    const cp_paired *olc = &c->olc_g[CP_PAIRED_ALL];
    fprintf(out, "With %s %zu of %zu valid baseline crashes were avoided (",
            data->variant[c->variant].name, c->outcome[CP_OUTCOME_AVOIDED], c->valid);
    if (c->valid)
        fprintf(out, "%.0f %%", percent * (double)c->outcome[CP_OUTCOME_AVOIDED]);
    cp_interval share = c->share[CP_OUTCOME_AVOIDED];
    if (share.status == CP_INTERVAL_VALUE)
        fprintf(out, ", 95 %% interval %.0f to %.0f", 100.0 * share.low, 100.0 * share.high);
    fprintf(out,
            "), %zu mitigated, %zu unchanged, %zu aggravated by closing speed (%zu by OLC) and "
            "%zu with another opponent",
            c->outcome[CP_OUTCOME_MITIGATED], c->outcome[CP_OUTCOME_UNCHANGED],
            c->outcome[CP_OUTCOME_AGGRAVATED], c->outcome_olc[CP_OUTCOME_AGGRAVATED],
            c->outcome[CP_OUTCOME_CHANGED_OPPONENT]);
    if (c->new_crashes > 0.0)
        fprintf(out, ", and %g new crash%s between others", c->new_crashes,
                plural((size_t)c->new_crashes));
    if (!isnan(olc->hodges_lehmann)) {
        char p[CP_ESTIMATE_TEXT_SIZE];
        fprintf(out,
                "; the OLC of the crash (the larger of its frontally struck vehicles) changed by "
                "%.1f g (Hodges–Lehmann, avoided = 0 g",
                olc->hodges_lehmann);
        if (olc->hodges_lehmann_interval.status == CP_INTERVAL_VALUE)
            fprintf(out, ", 95 %% interval %.1f to %.1f", olc->hodges_lehmann_interval.low,
                    olc->hodges_lehmann_interval.high);
        else
            fprintf(out, ", %s for an interval",
                    cp_interval_status_text(olc->hodges_lehmann_interval.status));
        if (!isnan(c->p_holm[CP_PAIRED_ALL]))
            fprintf(out, ", %s", p_phrase(c->p_holm[CP_PAIRED_ALL], p));
        fputc(')', out);
    }
    if (c->crashes > c->valid)
        fprintf(out, "; %zu more could not be judged", c->crashes - c->valid);
    fprintf(out, ". Of the %zu valid ones inside the validated range with %s, %zu were avoided.\n",
            c->inside_valid, "the baseline", c->inside_outcome[CP_OUTCOME_AVOIDED]);
    write_model_part(out, "the change of OLC", " g", 1, &c->olc_model[CP_PAIRED_ALL], comparison);
}

static void write_counts(FILE *out, const cp_study_data *data, const cp_comparison *comparison)
{
    for (size_t k = 0; k < comparison->variant_count; k++) {
        const cp_variant_figures *v = &comparison->variant[k];
        fprintf(out,
                "%s%zu frontal crash%s with %s (%zu of them front-front with both vehicles "
                "inside the validated range)",
                k == 0                              ? ""
                : k + 1 < comparison->variant_count ? ", "
                                                    : " and ",
                v->frontal_crashes, plural(v->frontal_crashes), data->variant[v->variant].name,
                v->front_front_inside);
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
    FILE *out = cp_memory_stream(answer, &size);
    if (!out)
        return cp_fail_memory(error, "the answer of a comparison");

    // Contrasts first: they are what was asked.
    for (size_t k = 0; k < comparison->contrast_count; k++)
        write_contrast(out, data, comparison, &comparison->contrast[k]);
    for (size_t k = 0; k < comparison->counterfactual_count; k++)
        write_pairs(out, data, comparison, &comparison->counterfactual[k]);
    // A paragraph each, then one on what it all rests on.
    fputs("In all: ", out);
    write_counts(out, data, comparison);
    if (data->unfinished > 0)
        fprintf(out, "; not counted: %zu planned replication%s that failed or did not finish",
                data->unfinished, data->unfinished == 1 ? "" : "s");
    fputs(". All conditional on the assumed driver errors (", out);
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
