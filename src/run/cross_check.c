/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/cross_check.h"

#include <stdlib.h>
#include <string.h>

static cp_cross_check_pair make_pair(uint32_t vehicle_1, uint32_t vehicle_2)
{
    bool in_order = vehicle_1 < vehicle_2;
    return (cp_cross_check_pair){.low = in_order ? vehicle_1 : vehicle_2,
                                 .high = in_order ? vehicle_2 : vehicle_1};
}

static cp_status append(cp_cross_check_pair **pairs, size_t *count, cp_cross_check_pair pair,
                        cp_error *error)
{
    // Room doubles whenever the count is a power of two.
    if ((*count & (*count - 1)) == 0) {
        size_t room = *count == 0 ? 1 : 2 * *count;
        cp_cross_check_pair *larger = realloc(*pairs, room * sizeof **pairs);
        if (larger == NULL)
            return cp_fail_memory(error, "collisions");
        *pairs = larger;
    }
    (*pairs)[(*count)++] = pair;
    return CP_OK;
}

cp_status cp_cross_check_add_contact(cp_cross_check *check, uint32_t vehicle_1, uint32_t vehicle_2,
                                     const char *found_as, cp_error *error)
{
    cp_cross_check_pair pair = make_pair(vehicle_1, vehicle_2);
    pair.found_as = found_as;
    return append(&check->ours, &check->our_count, pair, error);
}

cp_status cp_cross_check_add_report(cp_cross_check *check, uint32_t collider, uint32_t victim,
                                    const char *type, double time_s, cp_error *error)
{
    // Repetitions follow soon: look from the end.
    cp_cross_check_pair pair = make_pair(collider, victim);
    for (size_t k = check->sumo_count; k > 0; k--)
        if (check->sumo[k - 1].low == pair.low && check->sumo[k - 1].high == pair.high)
            return CP_OK;
    pair.time_s = time_s;
    pair.collider = collider;
    pair.victim = victim;
    pair.type = strdup(type);
    if (pair.type == NULL)
        return cp_fail_memory(error, "collisions");
    cp_status status = append(&check->sumo, &check->sumo_count, pair, error);
    if (status != CP_OK)
        free(pair.type);
    return status;
}

static int compare_pairs(const void *left, const void *right)
{
    const cp_cross_check_pair *a = left, *b = right;
    if (a->low != b->low)
        return a->low < b->low ? -1 : 1;
    return a->high < b->high ? -1 : a->high > b->high;
}

void cp_cross_check_match(cp_cross_check *check)
{
    if (check->our_count > 0)
        qsort(check->ours, check->our_count, sizeof *check->ours, compare_pairs);
    for (size_t k = 0; k < check->sumo_count; k++) {
        const cp_cross_check_pair *ours = NULL;
        if (check->our_count > 0)
            ours = bsearch(&check->sumo[k], check->ours, check->our_count, sizeof *check->ours,
                           compare_pairs);
        check->sumo[k].found_as = ours != NULL ? ours->found_as : "no_contact";
    }
}

void cp_cross_check_destroy(cp_cross_check *check)
{
    for (size_t k = 0; k < check->sumo_count; k++)
        free(check->sumo[k].type);
    free(check->sumo);
    free(check->ours);
    *check = (cp_cross_check){0};
}
