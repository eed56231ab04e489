/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/field_words.h"

#include "core/memory_stream.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

static const cp_field_variant *baseline_of(const cp_comparison *comparison)
{
    const cp_variant_figures *figures = cp_comparison_variant(comparison, comparison->baseline);
    return figures ? figures->field : NULL;
}

static void write_apart(FILE *out, const cp_field_shape *s, const char *name)
{
    const cp_field_number *v = &s->number[CP_FIELD_VALUE_DELTA_V];
    fprintf(out, "Beside the field (%s): the baseline's %zu vehicles struck on their front", name,
            s->vehicles);
    if (v->known > 0)
        fprintf(
            out,
            " have a median delta-v without rebound of %.1f km/h, the field's %.1f km/h (largest "
            "distance of the distribution functions %.2f, mean distance %.1f km/h)",
            v->median[1], v->median[0], v->distance[0].largest_1, v->distance[0].mean);
    fprintf(out, ".");
}

// Classes of which one of the two has none and the other one in a hundred or more.
static void write_missing(FILE *out, const cp_field_shape *s, bool of_study)
{
    size_t written = 0;
    for (int m = 0; m < CP_FIELD_MARGIN_COUNT; m++)
        for (size_t k = 0; k < CP_FIELD_MARGIN_CLASSES[m]; k++) {
            const cp_field_class *c = &s->of[m][k];
            double there = of_study ? c->field_1 : c->study_1;
            bool none = of_study ? c->vehicles == 0 : !(c->field_1 > 0.0);
            if (!none || !(there >= 0.01))
                continue;
            fprintf(out, "%s%s %s (%.0f %%)", written ? ", " : ": ", CP_FIELD_MARGIN_TEXT[m],
                    cp_field_class_text((cp_field_margin)m, k), 100.0 * there);
            written++;
        }
}

static void write_warnings(FILE *out, const cp_field_shape *s)
{
    if (s->never_made_1 >= 0.005) {
        fprintf(
            out,
            " Warning: %.0f %% of the field's vehicles are of a crash type, delta-v and overlap "
            "together that the study never makes; no weight can stand for them",
            100.0 * s->never_made_1);
        write_missing(out, s, true);
        fprintf(out, ".");
    }
    if (s->never_seen_1 > 0.0) {
        fprintf(out, " Warning: %.1f %% of the study's are of ones that the field never has",
                100.0 * s->never_seen_1);
        write_missing(out, s, false);
        fprintf(out, ".");
    }
}

static void write_weights(FILE *out, const cp_field_variant *v, const cp_field_request *request)
{
    const cp_field_shape *s = &v->shape;
    size_t margins = 0;
    fprintf(out, " Weighted by ");
    for (int m = 0; m < CP_FIELD_MARGIN_COUNT; m++)
        if (request->margin[m])
            fprintf(out, "%s%s", margins++ ? ", " : "", CP_FIELD_MARGIN_TEXT[m]);
    fprintf(out, " they count like %.0f of equal weight (largest weight %.1f times the mean",
            s->effective, s->largest_weight);
    if (s->capped > 0)
        fprintf(out, ", %zu at the cap of %g", s->capped, request->cap);
    fprintf(out, "; margins met to within %.1f %%)", 100.0 * v->gap_1);
    if (s->effective < CP_RAKED_EFFECTIVE_MIN)
        fprintf(out, ", too few for intervals (%d)", CP_RAKED_EFFECTIVE_MIN);
    fprintf(out, ". The field's shares are taken as known.");
}

static void write_treatments(FILE *out, const cp_comparison *comparison)
{
    size_t unlike = 0;
    bool delta_v_too = false;
    for (size_t k = 0; k < comparison->contrast_count; k++) {
        const cp_field_contrast *c = comparison->contrast[k].field;
        unlike += c ? c->unlike : 0;
        delta_v_too |= c && c->delta_v_too;
    }
    if (comparison->counterfactual_count > 0)
        fprintf(out, " A pair keeps the weight of the baseline's crash.");
    if (comparison->contrast_count == 0)
        return;
    fprintf(out, " A treated crash takes the weight of baseline crashes of its classes.");
    if (delta_v_too)
        fprintf(
            out,
            " Delta-v is what treatments change, so treatments are compared with weights of the "
            "other margins; 'by delta-v too' is right only where the study makes too few or too "
            "many crashes of a class in both variants alike, and else hides a treatment that "
            "makes crashes milder.");
    if (unlike > 0)
        fprintf(out,
                " Warning: %zu treated vehicles are of a class the baseline has none of and take "
                "the nearest one's factor.",
                unlike);
}

cp_status cp_field_words(const cp_comparison *comparison, const cp_field_request *request,
                         char **words, cp_error *error)
{
    size_t size = 0;
    *words = NULL;
    FILE *out = cp_memory_stream(words, &size);
    if (!out)
        return cp_fail_memory(error, "what to say of a field");
    const cp_field_variant *v = baseline_of(comparison);
    if (v) {
        write_apart(out, &v->shape, request->table->name);
        write_warnings(out, &v->shape);
        write_weights(out, v, request);
        write_treatments(out, comparison);
        if (request->table->bias)
            fprintf(out, " Of the field's delta-v: %s.", request->table->bias);
    }
    int failed = ferror(out);
    if (fclose(out) != 0 || failed) {
        free(*words);
        *words = NULL;
        return cp_fail_memory(error, "what to say of a field");
    }
    return CP_OK;
}
