/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/fleet.h"

#include "core/file.h"
#include "crash/named_vehicle.h"
#include "crash/shipped_vehicle.h"
#include "study/scenario_files.h"

#include <stdlib.h>
#include <string.h>

// ---- loading -------------------------------------------------------------------------------

// The file's text becomes the row's; it is freed with it.
static cp_status take_yaml(const char *name, char *yaml, size_t size, cp_vehicle_model *model,
                           cp_vehicle_model_row *row, cp_error *error)
{
    row->yaml = yaml;
    if (yaml == NULL)
        return cp_fail_memory(error, name);
    cp_status status = cp_vehicle_model_parse(name, yaml, size, model, error);
    if (status != CP_OK)
        return status;
    cp_hash_bytes(yaml, size, row->hash);
    row->name = strdup(model->name);
    return row->name != NULL ? CP_OK : cp_fail_memory(error, name);
}

static cp_status load_file(const char *path, cp_vehicle_model *model, cp_vehicle_model_row *row,
                           cp_error *error)
{
    char *yaml = NULL;
    size_t size = 0;
    cp_status status = cp_file_read(path, &yaml, &size, error);
    return status == CP_OK ? take_yaml(path, yaml, size, model, row, error) : status;
}

static cp_status load_shipped(const cp_shipped_vehicle *shipped, cp_vehicle_model *model,
                              cp_vehicle_model_row *row, cp_error *error)
{
    return take_yaml(shipped->name, strdup(shipped->yaml), shipped->size, model, row, error);
}

// A vehicle of the study file: the name of a shipped one, or a path.
static cp_status load_named(const cp_study *study, const cp_study_vehicle *vehicle,
                            cp_vehicle_model *model, cp_vehicle_model_row *row, cp_error *error)
{
    cp_shipped_vehicle shipped;
    if (vehicle->model_path != NULL)
        return load_file(vehicle->model_path, model, row, error);
    if (cp_shipped_vehicle_find(vehicle->model_name, &shipped))
        return load_shipped(&shipped, model, row, error);
    cp_status status = cp_named_vehicle_check(vehicle->model_name, error);
    return status == CP_OK
               ? status
               : cp_error_prefix(error, "%s:%zu: vehicles: ", study->path, vehicle->line);
}

// Room for one more.
static cp_status make_room(cp_fleet *fleet, cp_error *error)
{
    size_t room = fleet->count + 1;
    cp_vehicle_model *models = realloc(fleet->models, room * sizeof *models);
    if (models != NULL)
        fleet->models = models;
    cp_vehicle_model_row *rows = realloc(fleet->rows, room * sizeof *rows);
    if (rows != NULL)
        fleet->rows = rows;
    char **paths = realloc(fleet->paths, room * sizeof *paths);
    if (paths != NULL)
        fleet->paths = paths;
    if (models == NULL || rows == NULL || paths == NULL)
        return cp_fail_memory(error, "vehicle models");
    fleet->models[fleet->count] = (cp_vehicle_model){0};
    fleet->rows[fleet->count] = (cp_vehicle_model_row){0};
    fleet->paths[fleet->count] = NULL;
    fleet->count++;
    return CP_OK;
}

static size_t find_name(const cp_fleet *fleet, const char *name)
{
    size_t k = 0;
    while (k < fleet->count && strcmp(fleet->models[k].name, name) != 0)
        k++;
    return k;
}

static size_t find_path(const cp_fleet *fleet, const char *path)
{
    size_t k = 0;
    while (k < fleet->count &&
           (fleet->paths == NULL || fleet->paths[k] == NULL || strcmp(fleet->paths[k], path) != 0))
        k++;
    return k;
}

// What one vehicle type of a scenario names, when it is a file not met before.
static cp_status load_of_type(const char *name, const char *in_file, void *context, cp_error *error)
{
    cp_fleet *fleet = context;
    cp_shipped_vehicle shipped;
    if (!cp_shipped_vehicle_is_path(name)) {
        if (find_name(fleet, name) < fleet->count || cp_shipped_vehicle_find(name, &shipped))
            return CP_OK;
        return cp_fail(error, CP_BAD_INPUT,
                       "%s: a vehicle type names the model '%s', which is neither of the study nor "
                       "shipped (%s); a file has a '/' or a '.' in it",
                       in_file, name, cp_shipped_vehicle_names());
    }
    char *path = cp_file_beside(in_file, name);
    if (path == NULL)
        return cp_fail_memory(error, name);
    if (find_path(fleet, path) < fleet->count) {
        free(path);
        return CP_OK;
    }
    cp_status status = make_room(fleet, error);
    if (status != CP_OK) {
        free(path);
        return status;
    }
    size_t k = fleet->count - 1;
    fleet->paths[k] = path;
    status = load_file(path, &fleet->models[k], &fleet->rows[k], error);
    if (status != CP_OK)
        cp_error_prefix(error, "a vehicle type of %s names %s: ", in_file, name);
    return status;
}

static cp_status load_of_scenarios(cp_fleet *fleet, cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < fleet->study->scenario_count; k++) {
        const cp_scenario_inputs inputs = cp_study_scenario_inputs(&fleet->study->scenarios[k]);
        status = cp_scenario_models(&inputs, load_of_type, fleet, error);
    }
    return status;
}

// The shipped ones whose names the study has not taken, for types that choose them.
static cp_status load_rest(cp_fleet *fleet, cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t s = 0; status == CP_OK && s < CP_SHIPPED_VEHICLE_COUNT; s++) {
        cp_shipped_vehicle shipped = cp_shipped_vehicle_at(s);
        if (find_name(fleet, shipped.name) < fleet->count)
            continue;
        status = make_room(fleet, error);
        if (status == CP_OK)
            status = load_shipped(&shipped, &fleet->models[fleet->count - 1],
                                  &fleet->rows[fleet->count - 1], error);
    }
    return status;
}

// A row for the database to name where there is no model.
static cp_status add_none(cp_fleet *fleet, cp_error *error)
{
    static const char YAML[] = "# A vehicle without a model of the surrogate: its crashes are kept "
                               "without a severity.\n";
    cp_status status = make_room(fleet, error);
    if (status != CP_OK)
        return status;
    cp_vehicle_model_row *row = &fleet->rows[fleet->count - 1];
    row->name = strdup(CP_NO_VEHICLE_MODEL);
    row->yaml = strdup(YAML);
    cp_hash_bytes(YAML, sizeof YAML - 1, row->hash);
    return row->name != NULL && row->yaml != NULL ? CP_OK : cp_fail_memory(error, "vehicles");
}

cp_status cp_fleet_check_market(const cp_study *study, cp_error *error)
{
    for (size_t k = 0; k < study->market_count; k++)
        if (!cp_vehicle_is_fleet_class(study->market[k].vehicle_class))
            return cp_fail(error, CP_BAD_INPUT,
                           "%s:%zu: vehicles.market[%zu].class must be a vehicle class of the "
                           "fleet, found '%s'; there are %s",
                           study->path, study->market[k].line, k, study->market[k].vehicle_class,
                           cp_vehicle_fleet_classes());
    return CP_OK;
}

cp_status cp_fleet_load(const cp_study *study, cp_fleet *fleet, cp_error *error)
{
    *fleet = (cp_fleet){.study = study};
    cp_status status = cp_fleet_check_market(study, error);
    for (size_t k = 0; status == CP_OK && k < study->vehicle_count; k++) {
        const cp_study_vehicle *vehicle = &study->vehicles[k];
        status = make_room(fleet, error);
        if (status == CP_OK && (vehicle->model_path != NULL || vehicle->model_name != NULL))
            status = load_named(study, vehicle, &fleet->models[k], &fleet->rows[k], error);
    }
    if (status == CP_OK)
        status = load_of_scenarios(fleet, error);
    if (status == CP_OK)
        status = load_rest(fleet, error);
    if (status == CP_OK)
        status = add_none(fleet, error);
    if (status != CP_OK)
        cp_fleet_destroy(fleet);
    return status;
}

void cp_fleet_destroy(cp_fleet *fleet)
{
    for (size_t k = 0; k < fleet->count; k++) {
        free(fleet->rows[k].name);
        free(fleet->rows[k].yaml);
        free(fleet->paths[k]);
    }
    free(fleet->paths);
    free(fleet->rows);
    free(fleet->models);
    *fleet = (cp_fleet){0};
}

// ---- choosing ------------------------------------------------------------------------------

const cp_vehicle_model *cp_fleet_find(const cp_fleet *fleet, const char *name)
{
    size_t k = find_name(fleet, name);
    return k < fleet->count ? &fleet->models[k] : NULL;
}

static cp_status choose_named(const cp_fleet *fleet, const char *sumocfg_path,
                              const char *sumo_type, const char *name, cp_fleet_choice *choice,
                              cp_error *error)
{
    size_t k = fleet->count;
    if (cp_shipped_vehicle_is_path(name)) {
        char *path = cp_file_beside(sumocfg_path, name);
        if (path == NULL)
            return cp_fail_memory(error, name);
        k = find_path(fleet, path);
        free(path);
    } else {
        k = find_name(fleet, name);
    }
    if (k == fleet->count)
        return cp_fail(
            error, CP_BAD_INPUT,
            "%s: vehicle type '%s' names the model '%s', which is no model of the study, "
            "no shipped one (%s) and no file found in the route and additional files "
            "(uncompressed) that the configuration names",
            sumocfg_path, sumo_type, name, cp_shipped_vehicle_names());
    choice->model = &fleet->models[k];
    choice->chosen_by = "sumo_type";
    return CP_OK;
}

cp_status cp_fleet_choose(const cp_fleet *fleet, const char *sumocfg_path, const char *sumo_type,
                          const cp_sumo_type *type, cp_fleet_choice *choice, cp_error *error)
{
    *choice = (cp_fleet_choice){.chosen_by = ""};
    for (size_t k = 1; k < fleet->study->vehicle_count; k++) {
        if (strcmp(fleet->study->vehicles[k].type, sumo_type) != 0)
            continue;
        choice->model = &fleet->models[k];
        choice->chosen_by = "study";
        return CP_OK;
    }
    if (type->model[0] != '\0')
        return choose_named(fleet, sumocfg_path, sumo_type, type->model, choice, error);

    // The study's default is for cars: what the table holds for a van or for nothing is none.
    cp_vehicle_size size = {.vehicle_class = type->vehicle_class,
                            .length_m = type->length_m,
                            .width_m = type->width_m,
                            .height_m = type->height_m,
                            .mass_kg = type->mass_kg};
    bool is_car = false;
    const char *name = cp_vehicle_choose(&size, &is_car, choice->reason);
    if (name == NULL)
        return CP_OK;
    bool standard = is_car && fleet->models[0].name[0] != '\0';
    size_t k = standard ? 0 : find_name(fleet, name);
    if (k == fleet->count)
        return cp_fail(error, CP_RUN_FAILED, "the shipped model %s is missing", name);
    choice->model = &fleet->models[k];
    choice->chosen_by = standard ? "study_default" : "class_and_size";
    return CP_OK;
}
