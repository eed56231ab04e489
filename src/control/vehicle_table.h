/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_VEHICLE_TABLE_H
#define CONTROL_VEHICLE_TABLE_H

#include "core/recent_rows.h"
#include "traffic/traffic.h"

/* What a control keeps of each vehicle while it is on the road; of one that has left it nothing is
 * kept, so that hours of traffic take no more memory than what drives at once. Begin with
 * cp_vehicle_table_create, prune once a step, destroy. */
typedef struct cp_vehicle_table {
    size_t item_size;
    void (*release)(void *item); /* frees what an item owns; NULL: nothing */
    cp_recent_rows row_of;       /* by vehicle number */
    unsigned char *items;
    uint32_t *vehicles; /* by row */
    size_t count;
    size_t capacity;
} cp_vehicle_table;

cp_vehicle_table cp_vehicle_table_create(size_t item_size, void (*release)(void *item));
void cp_vehicle_table_destroy(cp_vehicle_table *table);

/* The item of a vehicle, all zero bytes when it is taken for the first time. Valid until the next
 * take or prune. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_vehicle_table_take(cp_vehicle_table *table, uint32_t vehicle,
                                              void **item, cp_error *error);
/* The item of a vehicle, NULL when there is none. */
void *cp_vehicle_table_find(const cp_vehicle_table *table, uint32_t vehicle);
/* Drop the items of all vehicles that are not on the road. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_vehicle_table_prune(cp_vehicle_table *table, const cp_traffic *traffic,
                                               cp_error *error);

#endif
