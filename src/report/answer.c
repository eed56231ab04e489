/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/answer.h"

#include "core/memory_stream.h"
#include "report/conditions.h"

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

// Beyond this a ratio is no more than large.
#define RATIO_LARGE 1000.0

static void write_bound(FILE *out, double bound, int digits)
{
    if (isinf(bound))
        fputs(bound < 0.0 ? "−∞" : "∞", out);
    else if (bound > RATIO_LARGE)
        fprintf(out, "more than %g", RATIO_LARGE);
    else
        fprintf(out, "%.*f", digits, bound);
}

// "0.33 to 0.67", an open end as infinity.
static void write_range(FILE *out, cp_interval interval, int digits)
{
    write_bound(out, interval.low, digits);
    fputs(" to ", out);
    write_bound(out, interval.high, digits);
}

static const char *plural(size_t count)
{
    return count == 1 ? "" : "es";
}

// ---- a treatment with replications of its own
// ----------------------------------------------------

// What the interval trusts: resamples, or counts with the scatter that replications show.
static const char *ratio_kind(const cp_contrast_figures *c)
{
    if (c->rate_ratio_bootstrap.status == CP_INTERVAL_VALUE)
        return "Interval of the rate ratio by bootstrap over replications";
    return isnan(c->rate_ratio_widening.dispersion_1)
               ? "Interval of the rate ratio from Poisson counts, which trusts that replications "
                 "differ by chance only"
               : "Interval of the rate ratio from Poisson counts widened by their dispersion";
}

static void write_ratio(FILE *out, const cp_contrast_figures *c, const char *baseline)
{
    char p[CP_ESTIMATE_TEXT_SIZE];
    cp_interval interval = cp_rate_ratio_interval(c);
    bool has = interval.status == CP_INTERVAL_VALUE;
    if (isnan(c->rate_ratio)) {
        fprintf(out, "a rate ratio cannot be given, as %s had no frontal crash", baseline);
        return;
    }
    if (has)
        write_range(out, interval, 2);
    else
        write_bound(out, c->rate_ratio, 2);
    fprintf(out, " times the rate of frontal crashes with %s (", baseline);
    if (has)
        fprintf(out, "95 %% interval; estimate %.2f", c->rate_ratio);
    else
        fprintf(out, "no interval: %s", cp_interval_status_text(interval.status));
    if (!isnan(c->rate_p_holm))
        fprintf(out, ", %s", p_phrase(c->rate_p_holm, p));
    fprintf(out, ", %zu against %zu frontal crash%s)", c->frontal_crashes[1], c->frontal_crashes[0],
            plural(c->frontal_crashes[0]));
}

// Of crashes above the headline severity.
static void write_exceedance(FILE *out, const cp_exceedance_ratio *r, const char *baseline)
{
    if (isnan(r->ratio)) {
        fprintf(out, "none above an OLC of %g g with %s", r->x, baseline);
        return;
    }
    if (r->interval.status == CP_INTERVAL_VALUE)
        write_range(out, r->interval, 2);
    else
        write_bound(out, r->ratio, 2);
    fprintf(out, " times that of crashes above an OLC of %g g (estimate %.2f, %zu against %zu)",
            r->x, r->ratio, r->crashes[1], r->crashes[0]);
}

// What the range leaves open of that.
static void bound_condition(cp_conditions *to, const char *treatment, const cp_exceedance_ratio *r)
{
    char stem[160];
    cp_condition_draft d;
    if (isnan(r->ratio) || !cp_condition_begin(&d, to))
        return;
    snprintf(stem, sizeof stem,
             "With severities outside the validated range unknown, the ratio of crashes above %g g "
             "may be anything from",
             r->x);
    // From the least that the one bound leaves to the most that the other does.
    cp_interval reach = {CP_INTERVAL_VALUE, 0.0, INFINITY};
    if (r->bound_interval[0].status == CP_INTERVAL_VALUE &&
        r->bound_interval[1].status == CP_INTERVAL_VALUE) {
        reach.low = r->bound_interval[0].low;
        reach.high = r->bound_interval[1].high;
    }
    write_range(d.out, reach, 2);
    cp_condition_end(&d, to, treatment, stem);
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

static void write_severity(FILE *out, const cp_contrast_figures *c)
{
    char p[CP_ESTIMATE_TEXT_SIZE];
    const cp_contrast *olc = &c->severity[CP_QUANTITY_OLC];
    const cp_superiority *s = &olc->superiority;
    if (isnan(s->cliffs_delta)) {
        fputs("its OLC cannot be compared: no scenario has vehicles with an OLC in both", out);
        return;
    }
    fputs("where it crashes, OLC with Cliff’s δ ", out);
    if (s->status == CP_INTERVAL_VALUE) {
        write_range(out, s->interval, 2);
        fprintf(out, " (estimate %.2f, %s; median ", s->cliffs_delta,
                p_phrase(c->severity_p_holm[CP_QUANTITY_OLC], p));
    } else if (!isnan(s->p)) {
        fprintf(out, "%.2f (completely apart, which leaves no interval, %s at most; median ",
                s->cliffs_delta, p_phrase(c->severity_p_holm[CP_QUANTITY_OLC], p));
    } else {
        fprintf(out, "%.2f (%s for an interval or a test; median ", s->cliffs_delta,
                cp_interval_status_text(s->status));
    }
    write_median(out, olc->median[1]);
    fputs(" against ", out);
    write_median(out, olc->median[0]);
    fprintf(out, ", %zu against %zu vehicles)", olc->compared[1], olc->compared[0]);
}

// What is missing is said: vehicles of scenarios that only one has, and those without an OLC.
static void write_missing(FILE *out, const cp_study_data *data, const cp_comparison *comparison,
                          const cp_contrast_figures *c)
{
    const cp_contrast *olc = &c->severity[CP_QUANTITY_OLC];
    const size_t variant[2] = {comparison->baseline, c->variant};
    const char *separator = "Vehicles: ";
    for (int g = 0; g < 2; g++) {
        const cp_variant_figures *figures = cp_comparison_variant(comparison, variant[g]);
        const char *name = data->variant[variant[g]].name;
        size_t with = figures->description[CP_QUANTITY_OLC][CP_SCOPE_ALL].count;
        if (with > olc->compared[g]) {
            fprintf(out,
                    "%s%zu of %s not compared, for want of a partner or of a crash of the other in "
                    "their scenario",
                    separator, with - olc->compared[g], name);
            separator = "; ";
        }
        if (figures->simulation_failed > 0) {
            fprintf(out, "%s%zu of %s without a simulated crash", separator,
                    figures->simulation_failed, name);
            separator = "; ";
        }
    }
}

static void write_compared(FILE *out, const cp_study_data *data, const cp_contrast_figures *c)
{
    if (data->paired)
        fprintf(out, "Compared over the %zu seeds that both finished", c->replications[1]);
    else
        fprintf(out, "Compared over %zu against %zu replications", c->replications[1],
                c->replications[0]);
    if (c->partnerless[0] + c->partnerless[1] > 0)
        fprintf(out, " (%zu more without a partner are left out)",
                c->partnerless[0] + c->partnerless[1]);
}

// ---- the crash model's part
// ----------------------------------------------------------------------

// Vehicles whose model has no ensemble.
static void write_without_sets(FILE *out, const cp_comparison *comparison)
{
    size_t without = 0;
    for (size_t k = 0; k < comparison->variant_count; k++)
        without += comparison->variant[k].without_sets;
    if (without > 0)
        fprintf(out, "; %zu vehicle%s of models without such sets count as certain", without,
                without == 1 ? "" : "s");
}

/* A figure whose uncertainty is split. */
typedef struct split_figure {
    const char *what;
    const char *unit; /* " g" or "" */
    int digits;
    const cp_model_part *part;
} split_figure;

// What of a figure's uncertainty is the traffic's and what the crash model's.
static void write_both_parts(FILE *out, const split_figure *f)
{
    char text[CP_ESTIMATE_TEXT_SIZE];
    const cp_model_part *p = f->part;
    fprintf(out, "With the uncertainty of the crash model %s is ", f->what);
    write_range(out, p->combined, f->digits);
    fprintf(out, "%s (95 %%; estimate %s): from replications 95 %% interval ", f->unit,
            cp_estimate_text(p->estimate, f->digits, text));
    write_range(out, p->replications, f->digits);
    fprintf(out,
            ", from the model’s ensemble of %zu parameter sets ±%.*f%s, combined as the root of "
            "the sum of squares",
            p->sets, f->digits, p->half_width, f->unit);
}

static void model_condition(cp_conditions *to, const char *treatment,
                            const cp_comparison *comparison, const split_figure *f)
{
    char stem[320];
    const cp_model_part *p = f->part;
    cp_condition_draft d;
    if (p->sets == 0 || !cp_condition_begin(&d, to))
        return;
    bool known = p->status == CP_INTERVAL_VALUE, both = p->combined.status == CP_INTERVAL_VALUE;
    if (!known) {
        fprintf(d.out,
                "What the %zu parameter sets of the vehicle models say of %s is not known (%s)",
                p->sets, f->what, cp_interval_status_text(p->status));
    } else if (both) {
        write_both_parts(d.out, f);
    } else {
        snprintf(stem, sizeof stem,
                 "Replications give no interval of %s (%s); of its uncertainty the crash model’s "
                 "part, by its ensemble of %zu parameter sets, is (95 %%)",
                 f->what, cp_interval_status_text(p->combined.status), p->sets);
        fprintf(d.out, "±%.*f%s", f->digits, p->half_width, f->unit);
    }
    write_without_sets(d.out, comparison);
    cp_condition_end(&d, to, treatment, known && !both ? stem : NULL);
}

// Of the difference of medians; where replications are too few for its interval, of Cliff's delta.
static void model_condition_of_contrast(cp_conditions *to, const char *treatment,
                                        const cp_comparison *comparison,
                                        const cp_contrast_figures *c)
{
    bool of_delta = c->median_model.combined.status != CP_INTERVAL_VALUE &&
                    c->delta_model.combined.status == CP_INTERVAL_VALUE;
    const split_figure f =
        of_delta ? (split_figure){"Cliff’s δ", "", 2, &c->delta_model}
                 : (split_figure){"the difference of the medians", " g", 1, &c->median_model};
    model_condition(to, treatment, comparison, &f);
}

static void write_contrast(FILE *out, const cp_study_data *data, const cp_comparison *comparison,
                           const cp_contrast_figures *c)
{
    const char *baseline = data->variant[comparison->baseline].name;
    fprintf(out, "%s: ", data->variant[c->variant].name);
    write_ratio(out, c, baseline);
    fputs("; ", out);
    write_exceedance(out, &c->above[CP_EXCEEDED_OLC], baseline);
    fputs("; ", out);
    write_severity(out, c);
    fputs(".\n", out);
}

#define DELTA_IS                                                                                      \
    "Cliff’s δ, from -1 (every vehicle struck on the front less severely) to 1, compares the OLC " \
    "of those vehicles"

// The conditions of a treatment, one text each, so that equal ones are said once.
static void contrast_conditions(cp_conditions *to, const cp_study_data *data,
                                const cp_comparison *comparison, const cp_contrast_figures *c)
{
    const char *name = data->variant[c->variant].name;
    cp_condition_draft d;
    if (cp_condition_begin(&d, to)) {
        write_compared(d.out, data, c);
        cp_condition_end(&d, to, name, NULL);
    }
    if (!isnan(c->rate_ratio))
        cp_conditions_add(to, name, ratio_kind(c), NULL);
    bool mixed = comparison->slice.scenario == CP_SLICE_ALL && data->scenario_count > 1;
    if (!isnan(c->severity[CP_QUANTITY_OLC].superiority.cliffs_delta))
        cp_conditions_add(to, name, mixed ? DELTA_IS ", at the same mix of scenarios" : DELTA_IS,
                          NULL);
    if (cp_condition_begin(&d, to)) {
        write_missing(d.out, data, comparison, c);
        cp_condition_end(&d, to, name, NULL);
    }
    bound_condition(to, name, &c->above[CP_EXCEEDED_OLC]);
    model_condition_of_contrast(to, name, comparison, c);
}

// ---- a treatment of the baseline's crashes
// -------------------------------------------------------

static void write_change(FILE *out, const cp_counterfactual_figures *c)
{
    char p[CP_ESTIMATE_TEXT_SIZE];
    const cp_paired *olc = &c->olc_g[CP_PAIRED_ALL];
    bool has = olc->hodges_lehmann_interval.status == CP_INTERVAL_VALUE;
    if (isnan(olc->hodges_lehmann))
        return;
    fputs("; the OLC of a crash changed by ", out);
    if (has) {
        write_range(out, olc->hodges_lehmann_interval, 1);
        fprintf(out, " g (95 %% interval; estimate %.1f g", olc->hodges_lehmann);
    } else {
        fprintf(out, "%.1f g (%s for an interval", olc->hodges_lehmann,
                cp_interval_status_text(olc->hodges_lehmann_interval.status));
    }
    if (!isnan(c->p_holm[CP_PAIRED_ALL]))
        fprintf(out, ", %s", p_phrase(c->p_holm[CP_PAIRED_ALL], p));
    fputc(')', out);
}

// What a treatment made of the baseline's crashes: outcomes first, then severity over all of them.
static void write_pairs(FILE *out, const cp_study_data *data, const cp_comparison *comparison,
                        const cp_counterfactual_figures *c)
{
    cp_interval share = c->share[CP_OUTCOME_AVOIDED];
    size_t avoided = c->outcome[CP_OUTCOME_AVOIDED];
    double percent = c->valid ? 100.0 / (double)c->valid : NAN;
    fprintf(out, "%s: ", data->variant[c->variant].name);
    if (share.status == CP_INTERVAL_VALUE)
        fprintf(out, "%.0f to %.0f %% of the frontal crashes with %s avoided (95 %% interval; ",
                100.0 * share.low, 100.0 * share.high, data->variant[comparison->baseline].name);
    else
        fprintf(out, "of the frontal crashes with %s avoided (no interval; ",
                data->variant[comparison->baseline].name);
    fprintf(out, "%zu of %zu valid ones", avoided, c->valid);
    if (c->valid)
        fprintf(out, ", %.0f %%", percent * (double)avoided);
    fprintf(out,
            "), %zu mitigated, %zu unchanged, %zu aggravated by closing speed (%zu by OLC), "
            "%zu with another opponent",
            c->outcome[CP_OUTCOME_MITIGATED], c->outcome[CP_OUTCOME_UNCHANGED],
            c->outcome[CP_OUTCOME_AGGRAVATED], c->outcome_olc[CP_OUTCOME_AGGRAVATED],
            c->outcome[CP_OUTCOME_CHANGED_OPPONENT]);
    if (c->new_crashes > 0.0)
        fprintf(out, ", and %g new crash%s between others", c->new_crashes,
                plural((size_t)c->new_crashes));
    if (c->vanished_crashes > 0.0)
        fprintf(out, ", and %g crash%s between others vanished", c->vanished_crashes,
                plural((size_t)c->vanished_crashes));
    write_change(out, c);
    fputs(".\n", out);
}

static void pair_conditions(cp_conditions *to, const cp_study_data *data,
                            const cp_comparison *comparison, const cp_counterfactual_figures *c)
{
    const char *name = data->variant[c->variant].name;
    cp_condition_draft d;
    if (c->crashes > c->valid && cp_condition_begin(&d, to)) {
        fprintf(d.out, "%zu", c->crashes - c->valid);
        cp_condition_end(&d, to, name, "Crashes that could not be judged:");
    }
    if (!isnan(c->olc_g[CP_PAIRED_ALL].hodges_lehmann))
        cp_conditions_add(to, name,
                          "Change of OLC: Hodges and Lehmann’s estimate over all valid pairs, of "
                          "the larger of a crash’s frontally struck vehicles, avoided = 0 g",
                          NULL);
    if (cp_condition_begin(&d, to)) {
        char stem[160];
        snprintf(stem, sizeof stem, "Of those inside the validated range with %.80s avoided:",
                 data->variant[comparison->baseline].name);
        fprintf(d.out, "%zu of %zu", c->inside_outcome[CP_OUTCOME_AVOIDED], c->inside_valid);
        cp_condition_end(&d, to, name, stem);
    }
    const split_figure change = {"the change of OLC", " g", 1, &c->olc_model[CP_PAIRED_ALL]};
    model_condition(to, name, comparison, &change);
}

// ---- what it all rests on
// ------------------------------------------------------------------------

static void write_counts(FILE *out, const cp_study_data *data, const cp_comparison *comparison)
{
    for (size_t k = 0; k < comparison->variant_count; k++) {
        const cp_variant_figures *v = &comparison->variant[k];
        fprintf(out,
                k == 0 ? "%s%zu frontal crash%s with %s (%zu of them front-front with both "
                         "vehicles inside the validated range)"
                       : "%s%zu frontal crash%s with %s (%zu)",
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

cp_status cp_comparison_answer(const cp_study_data *data, const cp_comparison *comparison,
                               char **answer, cp_error *error)
{
    *answer = NULL;
    size_t size = 0;
    FILE *out = cp_memory_stream(answer, &size);
    if (!out)
        return cp_fail_memory(error, "the answer of a comparison");

    // A sentence a treatment first: they are what was asked. Then what holds for them, once.
    cp_conditions conditions = {0};
    for (size_t k = 0; k < comparison->contrast_count; k++) {
        write_contrast(out, data, comparison, &comparison->contrast[k]);
        contrast_conditions(&conditions, data, comparison, &comparison->contrast[k]);
    }
    for (size_t k = 0; k < comparison->counterfactual_count; k++) {
        write_pairs(out, data, comparison, &comparison->counterfactual[k]);
        pair_conditions(&conditions, data, comparison, &comparison->counterfactual[k]);
    }
    size_t treatments = comparison->contrast_count + comparison->counterfactual_count;
    if (treatments > 0)
        fputc('\n', out);
    cp_conditions_write(out, &conditions, treatments);
    bool no_memory = conditions.failed;
    cp_conditions_destroy(&conditions);
    fputs("In all: ", out);
    write_counts(out, data, comparison);
    if (data->unfinished > 0)
        fprintf(out, "; not counted: %zu planned replication%s that failed or did not finish",
                data->unfinished, data->unfinished == 1 ? "" : "s");
    fputs(". All conditional on the assumed driver errors (", out);
    write_driver_errors(out, data, comparison->slice);
    fputs("): these are not accident rates of real traffic.", out);
    no_memory |= ferror(out) != 0;
    if (fclose(out) != 0 || no_memory) {
        free(*answer);
        *answer = NULL;
        return cp_fail_memory(error, "the answer of a comparison");
    }
    return CP_OK;
}
