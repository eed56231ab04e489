/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/equipment.h"

#include <stdlib.h>
#include <string.h>

enum { UNKNOWN, WITHOUT, EQUIPPED };

static cp_status reserve(cp_equipment *equipment, uint32_t vehicle, cp_error *error)
{
    if (vehicle < equipment->numbers)
        return CP_OK;
    size_t numbers = 2 * ((size_t)vehicle + 1);
    unsigned char *known = realloc(equipment->known, numbers);
    if (!known)
        return cp_fail_memory(error, "equipment");
    memset(known + equipment->numbers, UNKNOWN, numbers - equipment->numbers);
    equipment->known = known;
    equipment->numbers = numbers;
    return CP_OK;
}

static double share_of_type(const cp_equipment *equipment, const char *type)
{
    for (size_t k = 0; k < equipment->share_count; k++)
        if (strcmp(equipment->shares[k].type, type) == 0)
            return equipment->shares[k].penetration_1;
    return equipment->penetration_1;
}

static bool may_have(const cp_equipment *equipment, const char *id)
{
    if (!equipment->only)
        return true;
    for (size_t k = 0; k < equipment->only_count; k++)
        if (strcmp(equipment->only[k], id) == 0)
            return true;
    return false;
}

cp_status cp_equipment_has(cp_equipment *equipment, const cp_traffic *traffic, uint32_t vehicle,
                           bool *has, cp_error *error)
{
    *has = false;
    cp_status status = reserve(equipment, vehicle, error);
    if (status != CP_OK)
        return status;
    if (equipment->known[vehicle] == UNKNOWN) {
        const char *id = cp_traffic_vehicle_id(traffic, vehicle);
        double share_1 = share_of_type(equipment, cp_traffic_vehicle_type(traffic, vehicle));
        cp_rng_key key = cp_rng_key_text(cp_rng_key_text(equipment->key, "equipment"), id);
        bool is_equipped = may_have(equipment, id) && cp_rng_uniform(key, 0) < share_1;
        equipment->known[vehicle] = is_equipped ? EQUIPPED : WITHOUT;
        equipment->equipped += is_equipped;
    }
    *has = equipment->known[vehicle] == EQUIPPED;
    return CP_OK;
}

cp_status cp_equipment_each(cp_equipment *equipment, const cp_traffic *traffic,
                            cp_equipped_visit visit, void *state, const void *context,
                            cp_error *error)
{
    size_t count;
    const cp_vehicle_motion *motions = cp_traffic_motions(traffic, &count);
    cp_status status = CP_OK;
    for (size_t k = 0; k < count && status == CP_OK; k++) {
        bool has = false;
        status = cp_equipment_has(equipment, traffic, motions[k].after.vehicle, &has, error);
        if (status == CP_OK && has)
            status = visit(state, context, &motions[k], error);
    }
    return status;
}

bool cp_equipment_is_any(const cp_equipment *equipment)
{
    if (equipment->penetration_1 > 0.0)
        return true;
    for (size_t k = 0; k < equipment->share_count; k++)
        if (equipment->shares[k].penetration_1 > 0.0)
            return true;
    return false;
}

void cp_equipment_destroy(cp_equipment *equipment)
{
    free(equipment->known);
    *equipment = (cp_equipment){0};
}
