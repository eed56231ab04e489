/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/cross_check.h"

#include <math.h>
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
                                     cp_found_as found_as, double time_s, cp_error *error)
{
    cp_cross_check_pair pair = make_pair(vehicle_1, vehicle_2);
    pair.time_s = time_s;
    pair.found_as = found_as;
    return append(&check->ours, &check->our_count, pair, error);
}

cp_status cp_cross_check_add_report(cp_cross_check *check, uint32_t collider, uint32_t victim,
                                    const char *type, double time_s, double gap_m, cp_error *error)
{
    // Repetitions follow soon: look from the end.
    cp_cross_check_pair pair = make_pair(collider, victim);
    for (size_t k = check->sumo_count; k > 0; k--)
        if (check->sumo[k - 1].low == pair.low && check->sumo[k - 1].high == pair.high) {
            check->sumo[k - 1].gap_m = fmin(check->sumo[k - 1].gap_m, gap_m);
            return CP_OK;
        }
    pair.time_s = time_s;
    pair.gap_m = gap_m;
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

// Of our contacts of one pair, [from, ...) in the sorted list: the crash, else the nearest in time.
static cp_found_as best_of(const cp_cross_check *check, size_t from,
                           const cp_cross_check_pair *report)
{
    const cp_cross_check_pair *best = &check->ours[from];
    for (size_t k = from; k < check->our_count && compare_pairs(&check->ours[k], report) == 0;
         k++) {
        if (check->ours[k].found_as == CP_FOUND_CRASH)
            return check->ours[k].found_as;
        if (fabs(check->ours[k].time_s - report->time_s) < fabs(best->time_s - report->time_s))
            best = &check->ours[k];
    }
    return best->found_as;
}

// First of our contacts that does not come before the pair.
static size_t lower_bound(const cp_cross_check *check, const cp_cross_check_pair *pair)
{
    size_t low = 0, high = check->our_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (compare_pairs(&check->ours[middle], pair) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

void cp_cross_check_match(cp_cross_check *check)
{
    if (check->our_count > 0)
        qsort(check->ours, check->our_count, sizeof *check->ours, compare_pairs);
    for (size_t k = 0; k < check->sumo_count; k++) {
        cp_cross_check_pair *report = &check->sumo[k];
        size_t from = lower_bound(check, report);
        bool is_ours = from < check->our_count && compare_pairs(&check->ours[from], report) == 0;
        report->found_as = is_ours ? best_of(check, from, report) : CP_FOUND_NO_CONTACT;
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
