/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/cross_validation.h"

#include "core/log.h"
#include "core/rng.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const char *const KIND_WORD[CP_CROSS_KINDS] = {"fold", "speed", "offset", "angle",
                                                      "neighbour-fold"};

void cp_cross_title(const cp_cross_validation *cross, char title[80])
{
    if (cross->kind == CP_CROSS_FOLDS)
        snprintf(title, 80, "%zu-fold cross-validation", cross->part_count);
    else if (cross->kind == CP_CROSS_NEIGHBOURS)
        snprintf(title, 80, "%zu-fold cross-validation, neighbours apart", cross->part_count);
    else
        snprintf(title, 80, "One %s left out at a time", KIND_WORD[cross->kind]);
}

// In random order, as that key draws.
static void shuffle(cp_rng_key key, size_t *item, size_t count)
{
    for (size_t k = count; k > 1; k--) {
        size_t other = (size_t)(cp_rng_uniform(key, k) * (double)k);
        size_t keep = item[k - 1];
        item[k - 1] = item[other];
        item[other] = keep;
    }
}

// Fold of every case: dealt out in turn, then shuffled.
static size_t deal_folds(const cp_fit *fit, size_t *part)
{
    for (size_t k = 0; k < fit->reference.count; k++)
        part[k] = k % fit->folds;
    shuffle(cp_rng_key_text(cp_rng_key_seed(fit->seed), "folds"), part, fit->reference.count);
    return fit->folds;
}

// Whether a case comes before another in the table: by speed, offset, angle, then as given.
static bool is_before(const cp_reference_case *cases, size_t one, size_t other)
{
    const cp_reference_case *a = &cases[one], *b = &cases[other];
    if (a->speed_km_h != b->speed_km_h)
        return a->speed_km_h < b->speed_km_h;
    if (a->offset_mm != b->offset_mm)
        return a->offset_mm < b->offset_mm;
    return a->angle_deg != b->angle_deg ? a->angle_deg < b->angle_deg : one < other;
}

static size_t rank_of(const cp_reference *reference, size_t index)
{
    size_t rank = 0;
    for (size_t k = 0; k < reference->count; k++)
        rank += is_before(reference->cases, k, index);
    return rank;
}

// Every fold gets one of so many neighbours in the table: drawn anew for each block of them.
static size_t deal_neighbours(const cp_fit *fit, size_t *part)
{
    cp_rng_key key = cp_rng_key_text(cp_rng_key_seed(fit->seed), "neighbour folds");
    for (size_t k = 0; k < fit->reference.count; k++) {
        size_t rank = rank_of(&fit->reference, k), fold[CP_FOLDS_MAX];
        for (size_t f = 0; f < fit->neighbour_folds; f++)
            fold[f] = f;
        shuffle(cp_rng_key_number(key, rank / fit->neighbour_folds), fold, fit->neighbour_folds);
        part[k] = fold[rank % fit->neighbour_folds];
    }
    return fit->neighbour_folds;
}

static double level_of(const cp_reference_case *row, cp_cross_kind kind)
{
    return kind == CP_CROSS_SPEED    ? row->speed_km_h
           : kind == CP_CROSS_OFFSET ? row->offset_mm
                                     : row->angle_deg;
}

// Cases of one level of a variable are one part; levels in order of first appearance.
static size_t part_levels(const cp_fit *fit, cp_cross_kind kind, size_t *part)
{
    const cp_reference_case *cases = fit->reference.cases;
    size_t parts = 0;
    for (size_t k = 0; k < fit->reference.count; k++) {
        part[k] = parts;
        for (size_t j = 0; j < k && part[k] == parts; j++)
            if (level_of(&cases[j], kind) == level_of(&cases[k], kind))
                part[k] = part[j];
        parts += part[k] == parts;
    }
    return parts;
}

static void part_stem(const cp_fit *fit, cp_cross_kind kind, size_t part, char stem[4096])
{
    snprintf(stem, 4096, "%s.%s%zu", fit->output_path, KIND_WORD[kind], part + 1);
}

// Mean absolute errors of the cases a fit has seen and of those it has not.
static void log_part(const cp_fit *fit, const bool *use, const double *olc_g)
{
    double sum_g[2] = {0.0, 0.0};
    size_t cases[2] = {0, 0};
    for (size_t k = 0; k < fit->reference.count; k++) {
        sum_g[use[k]] += fabs(olc_g[k] - fit->reference.cases[k].olc_g);
        cases[use[k]]++;
    }
    cp_log_info("cross-validation: fitted to %zu configurations by %.3f g, the %zu held out "
                "predicted by %.3f g",
                cases[1], sum_g[1] / (double)cases[1], cases[0], sum_g[0] / (double)cases[0]);
}

size_t cp_cross_deal(const cp_fit *fit, cp_cross_kind kind, size_t *part)
{
    return kind == CP_CROSS_FOLDS        ? deal_folds(fit, part)
           : kind == CP_CROSS_NEIGHBOURS ? deal_neighbours(fit, part)
                                         : part_levels(fit, kind, part);
}

// Fit without each part in turn, predict the part.
static cp_status predict_parts(const cp_fit *fit, cp_cross_validation *cross, bool *use,
                               cp_fit_work *work, cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t p = 0; status == CP_OK && p < cross->part_count; p++) {
        cp_log_info("cross-validation: %s %zu of %zu", KIND_WORD[cross->kind], p + 1,
                    cross->part_count);
        for (size_t k = 0; k < fit->reference.count; k++)
            use[k] = cross->part[k] != p;
        char stem[4096];
        part_stem(fit, cross->kind, p, stem);
        cp_vehicle_model model;
        double value = 0.0;
        status =
            cp_fit_search(fit, use, stem, fit->seed + (uint32_t)p + 1, &model, &value, work, error);
        for (size_t k = 0; status == CP_OK && k < fit->reference.count; k++)
            if (!use[k])
                cross->held_out_g[k] = work->olc_g[k];
        if (status == CP_OK)
            log_part(fit, use, work->olc_g);
    }
    return status;
}

cp_status cp_cross_validate(const cp_fit *fit, cp_cross_kind kind, cp_cross_validation *cross,
                            cp_error *error)
{
    size_t count = fit->reference.count;
    *cross = (cp_cross_validation){.kind = kind,
                                   .part = calloc(count, sizeof(size_t)),
                                   .held_out_g = calloc(count, sizeof(double))};
    bool *use = calloc(count, sizeof *use);
    cp_fit_work work;
    cp_status status = cp_fit_work_create(fit, &work, error);
    if (cross->held_out_g == NULL || cross->part == NULL || use == NULL)
        status = cp_fail_memory(error, "cross-validation");
    if (status == CP_OK) {
        cross->part_count = cp_cross_deal(fit, kind, cross->part);
        status = predict_parts(fit, cross, use, &work, error);
    }
    if (status == CP_OK)
        status = cp_validate_olc(fit->reference.cases, cross->held_out_g, count, &cross->validation,
                                 error);
    free(use);
    cp_fit_work_destroy(&work);
    return status;
}

void cp_cross_validation_destroy(cp_cross_validation *cross)
{
    free(cross->part);
    free(cross->held_out_g);
    *cross = (cp_cross_validation){0};
}

void cp_cross_validation_forget(const cp_fit *fit, const cp_cross_validation *cross)
{
    for (size_t p = 0; p < cross->part_count; p++) {
        char stem[4096];
        part_stem(fit, cross->kind, p, stem);
        cp_fit_search_forget(fit, stem);
    }
}
