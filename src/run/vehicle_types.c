/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/vehicle_types.h"

#include "core/log.h"
#include "store/counterfactual_rows.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// A type whose cars are drawn crashes as several models: their names, in alphabetical order.
static void add_model(json_t *type, const char *name)
{
    json_t *known = json_object_get(type, "model");
    char models[1024] = "", *end = models;
    const char *list = json_is_string(known) ? json_string_value(known) : "";
    bool is_placed = false;
    for (const char *at = list; *at != '\0';) {
        size_t length = strcspn(at, ",");
        int order = strncmp(name, at, length);
        order = order == 0 && name[length] != '\0' ? 1 : order;
        if (order == 0)
            return;
        if (!is_placed && order < 0)
            end += snprintf(end, sizeof models - (size_t)(end - models), "%s,", name);
        is_placed = is_placed || order < 0;
        end += snprintf(end, sizeof models - (size_t)(end - models), "%.*s,", (int)length, at);
        at += length + (at[length] == ',');
    }
    if (!is_placed)
        end += snprintf(end, sizeof models - (size_t)(end - models), "%s,", name);
    end[-1] = '\0';
    json_object_set_new(type, "model", json_string(models));
}

static void add_vehicle(json_t *types, const cp_crash_vehicle_row *vehicle)
{
    json_t *type = json_object_get(types, vehicle->sumo_type);
    if (type != NULL && vehicle->no_model_reason[0] == '\0')
        add_model(type, vehicle->vehicle_model);
    if (type != NULL)
        return;
    bool has_model = vehicle->no_model_reason[0] == '\0';
    if (!has_model)
        cp_log_warning(
            "crashes of vehicle type %s are kept without a severity: %s; this line of the "
            "study file gives them MODEL, a shipped one or a vehicle file: vehicles: "
            "{types: [{type: \"%s\", model: MODEL}]}",
            vehicle->sumo_type, vehicle->no_model_reason, vehicle->sumo_type);
    json_object_set_new(types, vehicle->sumo_type,
                        json_pack("{s:s?, s:s?, s:s?}", "model",
                                  has_model ? vehicle->vehicle_model : NULL, "chosen_by",
                                  has_model ? vehicle->chosen_by : NULL, "reason",
                                  has_model ? NULL : vehicle->no_model_reason));
}

static void add_crash(json_t *types, const cp_crash_row *crash)
{
    for (int role = 0; role < 2; role++)
        add_vehicle(types, &crash->vehicle[role]);
}

cp_status cp_vehicle_types_add(cp_result_rows *rows, cp_error *error)
{
    json_t *options = json_loads(rows->crash_options, 0, NULL);
    json_t *types = json_object();
    const cp_counterfactual_rows *pairs = rows->counterfactual;
    for (size_t k = 0; k < rows->crash_count; k++)
        add_crash(types, &rows->crash[k]);
    for (size_t k = 0; pairs != NULL && k < pairs->row_count; k++)
        if (pairs->row[k].has_crash)
            add_crash(types, &pairs->row[k].treated);
    json_object_set_new(options, "covers_outline", json_integer(1));
    json_object_set_new(options, "vehicle_types", types);
    char *text = json_dumps(options, JSON_COMPACT | JSON_SORT_KEYS | JSON_REAL_PRECISION(17));
    json_decref(options);
    if (text == NULL)
        return cp_fail_memory(error, "vehicle types");
    free(rows->crash_options);
    rows->crash_options = text;
    return CP_OK;
}
