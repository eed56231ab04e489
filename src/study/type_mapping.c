/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/type_mapping.h"

#include "study/scenario_files.h"

#include <jansson.h>
#include <stdio.h>
#include <string.h>

static const char *const OF_SUMO[] = {"DEFAULT_VEHTYPE",  "DEFAULT_BIKETYPE",
                                      "DEFAULT_PEDTYPE",  "DEFAULT_TAXITYPE",
                                      "DEFAULT_RAILTYPE", "DEFAULT_CONTAINERTYPE"};

static cp_status gather_types(const cp_study *study, json_t *types, cp_error *error)
{
    cp_status status = types != NULL ? CP_OK : cp_fail_memory(error, "vehicle types");
    for (size_t k = 0; status == CP_OK && k < sizeof OF_SUMO / sizeof *OF_SUMO; k++)
        if (json_object_set_new(types, OF_SUMO[k], json_true()) != 0)
            status = cp_fail_memory(error, "vehicle types");
    for (size_t k = 0; status == CP_OK && k < study->scenario_count; k++) {
        // Those of a sweep read the same files.
        if (k > 0 && cp_study_scenarios_start_alike(&study->scenarios[k - 1], &study->scenarios[k]))
            continue;
        cp_scenario_inputs inputs = cp_study_scenario_inputs(&study->scenarios[k]);
        status = cp_scenario_types_add(&inputs, types, error);
    }
    return status;
}

// The first of them that fit, SUMO's own left out.
static void list_types(json_t *types, char *text, size_t size)
{
    const char *id;
    json_t *value;
    size_t used = 0;
    text[0] = '\0';
    json_object_foreach(types, id, value)
    {
        if (strncmp(id, "DEFAULT_", 8) == 0)
            continue;
        if (used + strlen(id) + 8 > size) {
            snprintf(text + used, size - used, ", ...");
            return;
        }
        used += (size_t)snprintf(text + used, size - used, "%s%s", used > 0 ? ", " : "", id);
    }
    if (used == 0)
        snprintf(text, size, "none");
}

static cp_status check_type(const cp_study *study, json_t *types, const char *type, size_t line,
                            const char *list, size_t index, cp_error *error)
{
    char known[400];
    if (json_object_get(types, type) != NULL)
        return CP_OK;
    list_types(types, known, sizeof known);
    return cp_fail(error, CP_BAD_INPUT,
                   "%s:%zu: vehicles.%s[%zu].type must be a vehicle type of a scenario, found "
                   "'%s'; there are %s",
                   study->path, line, list, index, type, known);
}

cp_status cp_study_check_types(const cp_study *study, cp_error *error)
{
    // The first is the default.
    if (study->vehicle_count < 2 && study->market_count == 0)
        return CP_OK;
    json_t *types = json_object();
    cp_status status = gather_types(study, types, error);
    for (size_t k = 1; status == CP_OK && k < study->vehicle_count; k++)
        status = check_type(study, types, study->vehicles[k].type, study->vehicles[k].line, "types",
                            k - 1, error);
    for (size_t k = 0; status == CP_OK && k < study->market_count; k++)
        status = check_type(study, types, study->market[k].type, study->market[k].line, "market", k,
                            error);
    json_decref(types);
    return status;
}
