/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/fleet.h"

#include "core/file.h"

#include <stdlib.h>
#include <string.h>

static cp_status load_one(const char *path, cp_vehicle_model *model, cp_vehicle_model_row *row,
                          cp_error *error)
{
    size_t size = 0;
    cp_status status = cp_vehicle_model_load(path, model, error);
    if (status == CP_OK)
        status = cp_file_read(path, &row->yaml, &size, error);
    if (status != CP_OK)
        return status;
    cp_hash_bytes(row->yaml, size, row->hash);
    row->name = strdup(model->name);
    return row->name != NULL ? CP_OK : cp_fail_memory(error, path);
}

cp_status cp_fleet_load(const cp_study *study, cp_fleet *fleet, cp_error *error)
{
    *fleet = (cp_fleet){.study = study,
                        .models = calloc(study->vehicle_count, sizeof *fleet->models),
                        .rows = calloc(study->vehicle_count, sizeof *fleet->rows)};
    cp_status status = CP_OK;
    if (fleet->models == NULL || fleet->rows == NULL)
        status = cp_fail_memory(error, "vehicle models");
    for (size_t k = 0; status == CP_OK && k < study->vehicle_count; k++) {
        fleet->count = k + 1;
        status = load_one(study->vehicles[k].model_path, &fleet->models[k], &fleet->rows[k], error);
    }
    if (status != CP_OK)
        cp_fleet_destroy(fleet);
    return status;
}

void cp_fleet_destroy(cp_fleet *fleet)
{
    for (size_t k = 0; k < fleet->count; k++) {
        free(fleet->rows[k].name);
        free(fleet->rows[k].yaml);
    }
    free(fleet->rows);
    free(fleet->models);
    *fleet = (cp_fleet){0};
}

const cp_vehicle_model *cp_fleet_model(const cp_fleet *fleet, const char *sumo_type)
{
    for (size_t k = 1; k < fleet->count; k++)
        if (strcmp(fleet->study->vehicles[k].type, sumo_type) == 0)
            return &fleet->models[k];
    return &fleet->models[0];
}
