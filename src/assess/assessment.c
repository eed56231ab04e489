/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "assess/assessment.h"

#include "assess/collisions.h"
#include "assess/configurations.h"
#include "core/array.h"
#include "core/file.h"
#include "core/log.h"
#include "core/progress.h"
#include "crash/crash_simulation.h"
#include "crash/named_vehicle.h"
#include "crash/shipped_vehicle.h"
#include "exchange/sumo_places.h"
#include "store/stored_crash.h"

#include <stdlib.h>
#include <string.h>

// Kept of a recorded run around the report of a collision.
static const double BEFORE_S = 5.0, AFTER_S = 2.0;

static cp_status read_files(cp_assessment *self, cp_error *error)
{
    const cp_assessment_request *a = &self->request;
    if (a->configurations_path != NULL)
        return cp_configurations_csv_read(a->configurations_path, a->strict, &self->configurations,
                                          error);
    cp_status status = cp_sumo_collisions_read(a->collisions_path, &self->collisions, error);
    for (size_t k = 0; status == CP_OK && k < a->routes_count; k++)
        status = cp_vtypes_read(a->routes_path[k], &self->types, error);
    if (status == CP_OK && a->fcd_path == NULL)
        return cp_sumo_places_record(a->collisions_path, &self->collisions, &self->record, error);
    if (status == CP_OK)
        status = cp_sumo_fcd_read(a->fcd_path, &self->collisions, BEFORE_S, AFTER_S, &self->record,
                                  error);
    return status == CP_OK ? cp_sumo_places_add(&self->collisions, &self->record, error) : status;
}

// Another vehicle, unless the type has one: the name of a shipped one, or a path as seen from base
// (NULL: from here).
static cp_status add_vehicle(cp_study *study, const char *type, const char *model, const char *base,
                             cp_error *error)
{
    for (size_t k = 0; k < study->vehicle_count; k++)
        if (type != NULL && study->vehicles[k].type != NULL &&
            strcmp(study->vehicles[k].type, type) == 0)
            return CP_OK;
    bool is_path = model != NULL && cp_shipped_vehicle_is_path(model);
    if (model != NULL && cp_named_vehicle_check(model, error) != CP_OK)
        return base != NULL ? cp_error_prefix(error, "%s: ", base) : CP_BAD_INPUT;
    cp_study_vehicle *added = cp_array_add(study->vehicles, study->vehicle_count);
    if (added == NULL)
        return cp_fail_memory(error, "vehicles");
    *added = (cp_study_vehicle){.type = type != NULL ? strdup(type) : NULL};
    if (is_path)
        added->model_path = base != NULL ? cp_file_beside(base, model) : strdup(model);
    else if (model != NULL)
        added->model_name = strdup(model);
    bool complete = (type == NULL || added->type != NULL) &&
                    (model == NULL || added->model_path != NULL || added->model_name != NULL);
    return complete ? CP_OK : cp_fail_memory(error, "vehicles");
}

// The vehicles of one row; a file among them is read once, to see whether it is one.
static cp_status add_listed(cp_assessment *self, const cp_listed_configuration *row, cp_error *error)
{
    cp_study *study = &self->study;
    cp_vehicle_model model;
    cp_status status = CP_OK;
    for (int v = 0; status == CP_OK && v < 2; v++) {
        const char *name = row->vehicle[v];
        size_t before = study->vehicle_count;
        if (name == NULL)
            continue;
        status = add_vehicle(study, name, name, self->request.configurations_path, error);
        bool is_new = status == CP_OK && study->vehicle_count > before;
        if (!is_new || study->vehicles[before].model_path == NULL)
            continue;
        status = cp_vehicle_model_load(study->vehicles[before].model_path, &model, error);
        if (status != CP_OK) {
            free(study->vehicles[before].type);
            free(study->vehicles[before].model_path);
            study->vehicle_count = before;
        }
    }
    return status;
}

// Rows whose vehicles are none are left out, the first of them ends it where --strict is given.
static cp_status gather_listed(cp_assessment *self, cp_error *error)
{
    const cp_assessment_request *a = &self->request;
    cp_configuration_list *list = &self->configurations;
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < list->count; k++) {
        cp_error why = {0}, told = {0};
        size_t line = list->row[k].line, length = strlen(a->configurations_path);
        status = add_listed(self, &list->row[k], &why);
        if (status == CP_OK)
            continue;
        // What is wrong with a name is told with the list's own name in front.
        bool named = strncmp(why.text, a->configurations_path, length) == 0;
        cp_fail(&told, status, "%s:%zu%s%s", a->configurations_path, line, named ? "" : ": ",
                why.text + (named ? length : 0));
        if (status == CP_BAD_INPUT && !a->strict)
            status = cp_configuration_list_leave_out(list, k, told.text, error);
        else
            *error = told;
    }
    cp_configuration_list_close_up(list);
    if (status == CP_OK && list->count == 0 && list->bad_count > 0)
        status = cp_fail(error, CP_BAD_INPUT, "%s", list->bad[0]);
    return status;
}

static cp_status gather_vehicles(cp_assessment *self, cp_error *error)
{
    const cp_assessment_request *a = &self->request;
    cp_study *study = &self->study;
    cp_status status = add_vehicle(study, NULL, a->vehicle, NULL, error);
    for (size_t k = 0; status == CP_OK && k < a->type_count; k++) {
        const char *sign = strchr(a->type[k], '=');
        char *type = strndup(a->type[k], (size_t)(sign - a->type[k]));
        status = type != NULL ? add_vehicle(study, type, sign + 1, NULL, error)
                              : cp_fail_memory(error, "vehicles");
        free(type);
    }
    if (status == CP_OK)
        status = gather_listed(self, error);
    for (size_t k = 0; status == CP_OK && k < self->types.count; k++) {
        const cp_vtype *type = &self->types.type[k];
        if (type->model != NULL)
            status = add_vehicle(study, type->id, type->model, type->path, error);
    }
    return status == CP_OK ? cp_fleet_load(study, &self->fleet, error) : status;
}

// Rows that could not be read count as those that could not be assessed.
static cp_status assess_list(cp_assessment *self, cp_assessment_keep keep, cp_error *error)
{
    const cp_configuration_list *list = &self->configurations;
    for (size_t k = 0; k < list->bad_count; k++)
        cp_log_warning("%s; left out", list->bad[k]);
    cp_status status =
        cp_assess_configurations(list, self->request.configurations_path, &self->fleet, keep,
                                 self->request.strict, &self->results, &self->count, error);
    self->count.listed += list->bad_count;
    self->count.bad += list->bad_count;
    return status;
}

static cp_status assess(cp_assessment *self, cp_error *error)
{
    const cp_assessment_request *a = &self->request;
    cp_assessment_keep keep = a->db_path != NULL ? CP_KEEP_PULSES : CP_KEEP_NO_PULSES;
    cp_crash_options options = cp_crash_options_default();
    double started_s = cp_clock_s();
    cp_status status = cp_crash_library_begin(error);
    if (status != CP_OK)
        return status;
    self->results.crash_options = cp_crash_options_json(&options);
    if (self->results.crash_options == NULL)
        status = cp_fail_memory(error, "crash options");
    else if (a->configurations_path != NULL)
        status = assess_list(self, keep, error);
    else
        status = cp_assess_collisions(&self->collisions, a->collisions_path, &self->record,
                                      &self->types, &self->fleet, keep, a->strict, &self->results,
                                      &self->count, error);
    cp_crash_library_end();
    self->results.wall_time_s = cp_clock_s() - started_s;
    return status;
}

cp_status cp_assessment_make(const cp_assessment_request *request, cp_assessment *assessment,
                             cp_error *error)
{
    *assessment = (cp_assessment){.request = *request};
    cp_status status = read_files(assessment, error);
    if (status == CP_OK)
        status = gather_vehicles(assessment, error);
    return status == CP_OK ? assess(assessment, error) : status;
}

void cp_assessment_destroy(cp_assessment *self)
{
    cp_result_rows_destroy(&self->results);
    cp_fleet_destroy(&self->fleet);
    cp_study_destroy(&self->study);
    cp_configuration_list_destroy(&self->configurations);
    cp_vtypes_destroy(&self->types);
    cp_fcd_record_destroy(&self->record);
    cp_collision_list_destroy(&self->collisions);
}
