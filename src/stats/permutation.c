/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/permutation.h"

#include "core/rng.h"

#include <gsl/gsl_sort.h>

#include <stdlib.h>

cp_status cp_permutation_create(const cp_resampling *resampling, cp_permutation *permutation,
                                cp_error *error)
{
    size_t first = resampling->cluster_count[0], count = first + resampling->cluster_count[1];
    *permutation = (cp_permutation){.resampling = resampling, .cluster_count = count};
    permutation->label = calloc(count + 1, sizeof *permutation->label);
    permutation->member = calloc(count + 1, sizeof *permutation->member);
    permutation->end = calloc(count + 1, sizeof *permutation->end);
    double *key = calloc(count + 1, sizeof *key);
    if (!permutation->label || !permutation->member || !permutation->end || !key) {
        free(key);
        cp_permutation_destroy(permutation);
        return cp_fail_memory(error, "a permutation test");
    }

    // Clusters of one stratum stand together, whichever group they came from.
    for (size_t k = 0; k < count; k++) {
        const size_t *stratum = resampling->stratum[k >= first];
        key[k] = stratum ? (double)stratum[k >= first ? k - first : k] : 0.0;
    }
    gsl_sort_index(permutation->member, key, 1, count);
    for (size_t begin = 0, end; begin < count; begin = end) {
        for (end = begin;
             end < count && key[permutation->member[end]] == key[permutation->member[begin]]; end++)
            ;
        for (size_t place = begin; place < end; place++)
            permutation->end[place] = end;
    }
    free(key);
    cp_permutation_set(permutation, 0);
    return CP_OK;
}

void cp_permutation_destroy(cp_permutation *permutation)
{
    free(permutation->label);
    free(permutation->member);
    free(permutation->end);
    *permutation = (cp_permutation){0};
}

void cp_permutation_set(cp_permutation *permutation, size_t number)
{
    const cp_resampling *r = permutation->resampling;
    unsigned char *label = permutation->label;
    for (size_t k = 0; k < permutation->cluster_count; k++)
        label[k] = k >= r->cluster_count[0];
    if (number == 0)
        return;
    cp_rng_key key = cp_rng_key_text(cp_rng_key_seed(r->seed), "permutation");
    key = cp_rng_key_number(key, number);

    // Paired: a coin for every seed. Else: shuffle the labels within each stratum (Durstenfeld).
    for (size_t place = 0; place < permutation->cluster_count; place++) {
        if (r->paired) {
            if (place < r->cluster_count[0] && cp_rng_uniform(key, place) < 0.5) {
                label[place] = 1;
                label[r->cluster_count[0] + place] = 0;
            }
            continue;
        }
        size_t left = permutation->end[place] - place;
        size_t other = place + (size_t)(cp_rng_uniform(key, place) * (double)left);
        unsigned char held = label[permutation->member[place]];
        label[permutation->member[place]] = label[permutation->member[other]];
        label[permutation->member[other]] = held;
    }
}
