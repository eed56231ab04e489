/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/driver_error/ignored_foes.h"

#include "core/recent_rows.h"

#include <stdlib.h>
#include <string.h>

typedef struct foe {
    uint32_t vehicle;
    unsigned reasons; /* bits of cp_ignore_reason */
} foe;

/* One driver and those he ignores. */
typedef struct ego {
    uint32_t vehicle;
    foe *foes; /* in the order they came */
    size_t count, capacity;
    bool has_changed;
} ego;

struct cp_ignored_foes {
    ego *egos; /* only those who ignore somebody, or did until now */
    size_t count, capacity;
    cp_recent_rows row_of; /* by vehicle number: row in egos */
};

cp_status cp_ignored_foes_create(cp_ignored_foes **ignored, cp_error *error)
{
    *ignored = calloc(1, sizeof **ignored);
    return *ignored != NULL ? CP_OK : cp_fail_memory(error, "ignored vehicles");
}

void cp_ignored_foes_destroy(cp_ignored_foes *ignored)
{
    if (ignored == NULL)
        return;
    for (size_t k = 0; k < ignored->count; k++)
        free(ignored->egos[k].foes);
    free(ignored->egos);
    cp_recent_rows_destroy(&ignored->row_of);
    free(ignored);
}

static ego *find_ego(const cp_ignored_foes *ignored, uint32_t vehicle)
{
    uint32_t row = cp_recent_rows_get(&ignored->row_of, vehicle);
    return row != CP_NO_ROW ? &ignored->egos[row] : NULL;
}

static cp_status add_ego(cp_ignored_foes *ignored, uint32_t vehicle, ego **added, cp_error *error)
{
    if (ignored->count == ignored->capacity) {
        size_t capacity = ignored->capacity == 0 ? 16 : 2 * ignored->capacity;
        ego *egos = realloc(ignored->egos, capacity * sizeof *egos);
        if (egos == NULL)
            return cp_fail_memory(error, "ignored vehicles");
        ignored->egos = egos;
        ignored->capacity = capacity;
    }
    cp_status status =
        cp_recent_rows_set(&ignored->row_of, vehicle, (uint32_t)ignored->count, error);
    if (status != CP_OK)
        return status;
    *added = &ignored->egos[ignored->count++];
    **added = (ego){.vehicle = vehicle};
    return CP_OK;
}

static foe *find_foe(const ego *own, uint32_t vehicle)
{
    for (size_t k = 0; k < own->count; k++)
        if (own->foes[k].vehicle == vehicle)
            return &own->foes[k];
    return NULL;
}

cp_status cp_ignored_foes_add(cp_ignored_foes *ignored, uint32_t ego_vehicle, uint32_t foe_vehicle,
                              cp_ignore_reason reason, cp_error *error)
{
    ego *own = find_ego(ignored, ego_vehicle);
    if (own == NULL) {
        cp_status status = add_ego(ignored, ego_vehicle, &own, error);
        if (status != CP_OK)
            return status;
    }
    foe *known = find_foe(own, foe_vehicle);
    if (known != NULL) {
        known->reasons |= (unsigned)reason;
        return CP_OK;
    }
    if (own->count == own->capacity) {
        size_t capacity = own->capacity == 0 ? 8 : 2 * own->capacity;
        foe *foes = realloc(own->foes, capacity * sizeof *foes);
        if (foes == NULL)
            return cp_fail_memory(error, "ignored vehicles");
        own->foes = foes;
        own->capacity = capacity;
    }
    own->foes[own->count++] = (foe){foe_vehicle, (unsigned)reason};
    own->has_changed = true;
    return CP_OK;
}

static void remove_foe(ego *own, size_t place)
{
    memmove(&own->foes[place], &own->foes[place + 1], (own->count - place - 1) * sizeof *own->foes);
    own->count--;
}

void cp_ignored_foes_take_back(cp_ignored_foes *ignored, uint32_t ego_vehicle, uint32_t foe_vehicle,
                               cp_ignore_reason reason)
{
    ego *own = find_ego(ignored, ego_vehicle);
    foe *known = own != NULL ? find_foe(own, foe_vehicle) : NULL;
    if (known == NULL)
        return;
    known->reasons &= ~(unsigned)reason;
    if (known->reasons != 0)
        return;
    remove_foe(own, (size_t)(known - own->foes));
    own->has_changed = true;
}

void cp_ignored_foes_heed(cp_ignored_foes *ignored, uint32_t foe_vehicle, cp_ignore_reason reason)
{
    for (size_t k = 0; k < ignored->count; k++)
        cp_ignored_foes_take_back(ignored, ignored->egos[k].vehicle, foe_vehicle, reason);
}

// All foes of one driver, ids separated by blanks.
static cp_status send_one(const ego *own, const cp_traffic *traffic, cp_error *error)
{
    size_t size = 1;
    for (size_t k = 0; k < own->count; k++)
        size += strlen(cp_traffic_vehicle_id(traffic, own->foes[k].vehicle)) + 1;
    char *text = malloc(size);
    if (text == NULL)
        return cp_fail_memory(error, "ignored vehicles");
    char *end = text;
    *end = '\0';
    for (size_t k = 0; k < own->count; k++) {
        if (k > 0)
            *end++ = ' ';
        end = stpcpy(end, cp_traffic_vehicle_id(traffic, own->foes[k].vehicle));
    }
    cp_status status = cp_traffic_commands(traffic)->set_parameter(
        own->vehicle, "junctionModel.ignoreIDs", text, error);
    free(text);
    return status;
}

// Foes that have gone are forgotten; that alone is no news for SUMO.
static void forget_gone(ego *own, const cp_traffic *traffic)
{
    size_t kept = 0;
    for (size_t k = 0; k < own->count; k++)
        if (cp_traffic_motion_of(traffic, own->foes[k].vehicle) != NULL)
            own->foes[kept++] = own->foes[k];
    own->count = kept;
}

static cp_status remove_ego(cp_ignored_foes *ignored, size_t row, cp_error *error)
{
    ego *own = &ignored->egos[row];
    free(own->foes);
    cp_recent_rows_clear(&ignored->row_of, own->vehicle);
    ignored->count--;
    if (row == ignored->count)
        return CP_OK;
    *own = ignored->egos[ignored->count];
    return cp_recent_rows_set(&ignored->row_of, own->vehicle, (uint32_t)row, error);
}

cp_status cp_ignored_foes_send(cp_ignored_foes *ignored, const cp_traffic *traffic, cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t row = 0; row < ignored->count && status == CP_OK;) {
        ego *own = &ignored->egos[row];
        bool is_gone = cp_traffic_motion_of(traffic, own->vehicle) == NULL;
        forget_gone(own, traffic);
        if (!is_gone && own->has_changed)
            status = send_one(own, traffic, error);
        own->has_changed = false;
        if (!is_gone && own->count > 0)
            row++;
        else if (status == CP_OK)
            status = remove_ego(ignored, row, error);
    }
    return status;
}

void cp_ignored_foes_visit(const cp_ignored_foes *ignored, uint32_t ego_vehicle,
                           cp_ignore_reason reason, void (*visit)(void *context, uint32_t foe),
                           void *context)
{
    const ego *own = find_ego(ignored, ego_vehicle);
    for (size_t k = 0; own != NULL && k < own->count; k++)
        if ((own->foes[k].reasons & (unsigned)reason) != 0)
            visit(context, own->foes[k].vehicle);
}
