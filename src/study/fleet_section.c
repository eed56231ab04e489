/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/fleet_section.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { KEY_PATH_SIZE = 64 };

#define MARKET_TEXT(key, member)                                                                   \
    CYAML_FIELD_STRING_PTR(key, CYAML_FLAG_POINTER, cp_market_entry, member, 1, CYAML_UNLIMITED)

static const cyaml_schema_field_t FIELDS[] = {MARKET_TEXT("type", type),
                                              MARKET_TEXT("class", vehicle_class),
                                              MARKET_TEXT("share_1", share_1), CYAML_FIELD_END};

const cyaml_schema_value_t CP_MARKET_ENTRY = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, cp_market_entry, FIELDS)};

static cp_status take_row(const cp_yaml_file *file, const cp_market_entry *entry, size_t k,
                          cp_study *study, cp_error *error)
{
    char path[KEY_PATH_SIZE];
    cp_study_market *row = &study->market[k];
    snprintf(path, sizeof path, "vehicles.market[%zu].type", k);
    for (size_t other = 0; other < k; other++)
        if (strcmp(study->market[other].type, entry->type) == 0 &&
            strcmp(study->market[other].vehicle_class, entry->vehicle_class) == 0)
            return cp_yaml_fail(file, error, path, "repeats '%s' with class '%s'", entry->type,
                                entry->vehicle_class);
    row->line = cp_yaml_line_of(file, path);
    row->type = strdup(entry->type);
    row->vehicle_class = strdup(entry->vehicle_class);
    study->market_count = k + 1;
    if (row->type == NULL || row->vehicle_class == NULL)
        return cp_fail_memory(error, path);
    snprintf(path, sizeof path, "vehicles.market[%zu].share_1", k);
    return cp_yaml_number(file, path, entry->share_1, 0.0, 1.0, &row->share_1, error);
}

// The shares of every type sum up to 1, but for the digits a file has.
static cp_status check_sums(const cp_yaml_file *file, const cp_study *study, cp_error *error)
{
    static const double ROUNDING_1 = 0.001;
    for (size_t k = 0; k < study->market_count; k++) {
        double sum_1 = 0.0;
        for (size_t other = 0; other < study->market_count; other++)
            if (strcmp(study->market[other].type, study->market[k].type) == 0)
                sum_1 += study->market[other].share_1;
        char path[KEY_PATH_SIZE];
        snprintf(path, sizeof path, "vehicles.market[%zu].share_1", k);
        if (fabs(sum_1 - 1.0) > ROUNDING_1)
            return cp_yaml_fail(file, error, path,
                                "must sum up to 1 with the other shares of type '%s', found %g",
                                study->market[k].type, sum_1);
    }
    return CP_OK;
}

cp_status cp_fleet_section_take(const cp_yaml_file *file, const char *fleet,
                                const cp_market_entry *entries, size_t count, cp_study *study,
                                cp_error *error)
{
    study->has_fleet = fleet != NULL;
    if (fleet != NULL && strcmp(fleet, "default") != 0)
        return cp_yaml_fail(file, error, "vehicles.fleet", "must be default, found '%s'", fleet);
    if (fleet == NULL && count > 0)
        return cp_yaml_fail(file, error, "vehicles.market", "needs vehicles.fleet: default");
    if (count == 0)
        return CP_OK;
    study->market = calloc(count, sizeof *study->market);
    if (study->market == NULL)
        return cp_fail_memory(error, "vehicles.market");
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < count; k++)
        status = take_row(file, &entries[k], k, study, error);
    return status == CP_OK ? check_sums(file, study, error) : status;
}
