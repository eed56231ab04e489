/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/error_log.h"

#include <stdlib.h>
#include <string.h>

// Slot at which the search for an error begins (multiplicative hashing; 2^64 / golden ratio).
static size_t first_slot(const cp_error_log *log, size_t control, uint32_t vehicle, uint32_t other)
{
    uint64_t key = ((uint64_t)vehicle << 32 | other) ^ (uint64_t)control << 58;
    key *= UINT64_C(0x9E3779B97F4A7C15);
    return (size_t)(key >> 32) & (log->slot_count - 1);
}

// The slot of an error: its own, or the empty one it belongs into.
static uint32_t *slot_of(const cp_error_log *log, size_t control, uint32_t vehicle, uint32_t other)
{
    size_t k = first_slot(log, control, vehicle, other);
    for (;; k = (k + 1) & (log->slot_count - 1)) {
        if (log->slots[k] == 0)
            return &log->slots[k];
        const cp_logged_error *found = &log->errors[log->slots[k] - 1];
        if (found->control == control && found->vehicle == vehicle && found->other == other)
            return &log->slots[k];
    }
}

// Fill the table anew, at most half full.
static cp_status index_errors(cp_error_log *log, cp_error *error)
{
    size_t wanted = 64;
    while (wanted < 2 * log->room)
        wanted *= 2;
    if (wanted != log->slot_count) {
        uint32_t *slots = realloc(log->slots, wanted * sizeof *slots);
        if (slots == NULL)
            return cp_fail_memory(error, "driver errors");
        log->slots = slots;
        log->slot_count = wanted;
    }
    memset(log->slots, 0, log->slot_count * sizeof *log->slots);
    for (size_t k = 0; k < log->count; k++) {
        const cp_logged_error *entry = &log->errors[k];
        *slot_of(log, entry->control, entry->vehicle, entry->other) = (uint32_t)k + 1;
    }
    return CP_OK;
}

static cp_status reserve(cp_error_log *log, cp_error *error)
{
    if (log->count < log->room)
        return CP_OK;
    size_t room = log->room == 0 ? 32 : 2 * log->room;
    cp_logged_error *errors = realloc(log->errors, room * sizeof *errors);
    if (errors == NULL)
        return cp_fail_memory(error, "driver errors");
    log->errors = errors;
    log->room = room;
    return index_errors(log, error);
}

cp_status cp_error_log_note(cp_error_log *log, size_t control, uint32_t vehicle, uint32_t other,
                            double now_s, double step_s, cp_error *error)
{
    cp_status status = reserve(log, error);
    if (status != CP_OK)
        return status;
    uint32_t *slot = slot_of(log, control, vehicle, other);
    if (*slot == 0) {
        log->errors[log->count] = (cp_logged_error){control, vehicle, other, now_s, now_s};
        *slot = (uint32_t)++log->count;
        return CP_OK;
    }
    // At work in the step before too: it goes on.
    cp_logged_error *entry = &log->errors[*slot - 1];
    if (now_s - entry->until_s > 1.5 * step_s)
        entry->since_s = now_s;
    entry->until_s = now_s;
    return CP_OK;
}

cp_status cp_error_log_tidy(cp_error_log *log, double now_s, cp_error *error)
{
    size_t kept = 0;
    if (now_s < log->tidy_at_s || log->count == 0)
        return CP_OK;
    log->tidy_at_s = now_s + CP_ERROR_MEMORY_S;
    for (size_t k = 0; k < log->count; k++)
        if (now_s - log->errors[k].until_s <= CP_ERROR_MEMORY_S)
            log->errors[kept++] = log->errors[k];
    log->count = kept;
    return index_errors(log, error);
}

void cp_error_log_destroy(cp_error_log *log)
{
    free(log->errors);
    free(log->slots);
    *log = (cp_error_log){0};
}
