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
    for (size_t k = 0; status == CP_OK && k < self->configurations.count; k++)
        for (int v = 0; status == CP_OK && v < 2; v++) {
            const char *model = self->configurations.row[k].vehicle[v];
            if (model != NULL)
                status = add_vehicle(study, model, model, a->configurations_path, error);
        }
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
