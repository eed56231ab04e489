/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/vehicle_table.h"

#include <stdlib.h>
#include <string.h>

cp_vehicle_table cp_vehicle_table_create(size_t item_size, void (*release)(void *item))
{
    return (cp_vehicle_table){.item_size = item_size, .release = release};
}

static void *item_of(const cp_vehicle_table *table, size_t row)
{
    return table->items + row * table->item_size;
}

void cp_vehicle_table_destroy(cp_vehicle_table *table)
{
    for (size_t row = 0; table->release != NULL && row < table->count; row++)
        table->release(item_of(table, row));
    free(table->items);
    free(table->vehicles);
    cp_recent_rows_destroy(&table->row_of);
    *table = (cp_vehicle_table){0};
}

static cp_status reserve(cp_vehicle_table *table, cp_error *error)
{
    if (table->count < table->capacity)
        return CP_OK;
    size_t capacity = table->capacity == 0 ? 64 : 2 * table->capacity;
    unsigned char *items = realloc(table->items, capacity * table->item_size);
    if (items != NULL)
        table->items = items;
    uint32_t *vehicles = realloc(table->vehicles, capacity * sizeof *vehicles);
    if (vehicles != NULL)
        table->vehicles = vehicles;
    if (items == NULL || vehicles == NULL)
        return cp_fail_memory(error, "what is kept of vehicles");
    table->capacity = capacity;
    return CP_OK;
}

cp_status cp_vehicle_table_take(cp_vehicle_table *table, uint32_t vehicle, void **item,
                                cp_error *error)
{
    *item = cp_vehicle_table_find(table, vehicle);
    if (*item != NULL)
        return CP_OK;
    cp_status status = reserve(table, error);
    if (status == CP_OK)
        status = cp_recent_rows_set(&table->row_of, vehicle, (uint32_t)table->count, error);
    if (status != CP_OK)
        return status;
    table->vehicles[table->count] = vehicle;
    *item = memset(item_of(table, table->count++), 0, table->item_size);
    return CP_OK;
}

void *cp_vehicle_table_find(const cp_vehicle_table *table, uint32_t vehicle)
{
    uint32_t row = cp_recent_rows_get(&table->row_of, vehicle);
    return row != CP_NO_ROW ? item_of(table, row) : NULL;
}

cp_status cp_vehicle_table_prune(cp_vehicle_table *table, const cp_traffic *traffic,
                                 cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t row = table->count; row-- > 0 && status == CP_OK;) {
        uint32_t vehicle = table->vehicles[row];
        if (cp_traffic_motion_of(traffic, vehicle) != NULL)
            continue;
        if (table->release != NULL)
            table->release(item_of(table, row));
        cp_recent_rows_clear(&table->row_of, vehicle);

        // The last one takes its place; all behind it are on the road.
        size_t last = --table->count;
        if (row == last)
            continue;
        memcpy(item_of(table, row), item_of(table, last), table->item_size);
        table->vehicles[row] = table->vehicles[last];
        status = cp_recent_rows_set(&table->row_of, table->vehicles[row], (uint32_t)row, error);
    }
    return status;
}
