/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "assess/assessment_store.h"

#include "core/log.h"
#include "run/owner.h"
#include "store/claim.h"

#include <stdlib.h>
#include <string.h>

static cp_status add_hash(json_t *files, const char *path, cp_error *error)
{
    char hash[CP_HASH_TEXT_SIZE];
    if (path == NULL)
        return CP_OK;
    cp_status status = cp_hash_file(path, hash, error);
    if (status == CP_OK)
        json_object_set_new(files, path, json_string(hash));
    return status;
}

// {file: SHA-256}
static cp_status files_text(const cp_assessment_request *a, char **text, cp_error *error)
{
    json_t *files = json_object();
    cp_status status = add_hash(files, a->collisions_path, error);
    if (status == CP_OK)
        status = add_hash(files, a->fcd_path, error);
    if (status == CP_OK)
        status = add_hash(files, a->configurations_path, error);
    for (size_t k = 0; status == CP_OK && k < a->routes_count; k++)
        status = add_hash(files, a->routes_path[k], error);
    *text = status == CP_OK ? json_dumps(files, JSON_COMPACT) : NULL;
    json_decref(files);
    return status == CP_OK && *text == NULL ? cp_fail_memory(error, "files") : status;
}

/* The same as texts of the database; borrowed names stay those of the fleet and the arguments. */
typedef struct assessment_texts {
    cp_vehicle_model_row *models; /* each once */
    size_t model_count;
    char *files;    /* {file: SHA-256} */
    char *vehicles; /* {"default": model, "types": {type: model}} */
    char *all;      /* both, and {model: SHA-256}: what the outcome depends on */
} assessment_texts;

static void destroy_texts(assessment_texts *texts)
{
    free(texts->models);
    free(texts->files);
    free(texts->vehicles);
    free(texts->all);
}

// Each model once, as rows and as {name: hash}.
static cp_status gather_models(const cp_assessment *self, assessment_texts *texts, json_t *hashes,
                               cp_error *error)
{
    const cp_fleet *fleet = &self->fleet;
    texts->models = calloc(fleet->count, sizeof *texts->models);
    if (texts->models == NULL)
        return cp_fail_memory(error, "vehicles");
    for (size_t k = 0; k < fleet->count; k++) {
        const char *name = fleet->rows[k].name, *hash = fleet->rows[k].hash;
        if (name == NULL) // no default
            continue;
        const char *known = json_string_value(json_object_get(hashes, name));
        if (known == NULL)
            texts->models[texts->model_count++] = fleet->rows[k];
        else if (strcmp(known, hash) != 0)
            return cp_fail(error, CP_BAD_INPUT,
                           "%s: the name '%s' belongs to another vehicle file too",
                           self->request.db_path, name);
        json_object_set_new(hashes, name, json_string(hash));
    }
    return CP_OK;
}

static cp_status fill_texts(const cp_assessment *self, assessment_texts *texts, cp_error *error)
{
    json_t *hashes = json_object(), *types = json_object();
    cp_status status = gather_models(self, texts, hashes, error);
    if (status == CP_OK)
        status = files_text(&self->request, &texts->files, error);
    for (size_t k = 1; status == CP_OK && k < self->study.vehicle_count; k++)
        json_object_set_new(types, self->study.vehicles[k].type,
                            json_string(self->fleet.rows[k].name));
    if (status == CP_OK) {
        json_t *vehicles =
            json_pack("{s:s?, s:O}", "default", self->fleet.rows[0].name, "types", types);
        json_t *all = json_pack("{s:s, s:O, s:O}", "files", texts->files, "vehicles", vehicles,
                                "models", hashes);
        texts->vehicles = json_dumps(vehicles, JSON_COMPACT | JSON_SORT_KEYS);
        texts->all = json_dumps(all, JSON_COMPACT | JSON_SORT_KEYS);
        json_decref(all);
        json_decref(vehicles);
        if (texts->vehicles == NULL || texts->all == NULL)
            status = cp_fail_memory(error, "assessment");
    }
    json_decref(types);
    json_decref(hashes);
    return status;
}

// A plan of the one replication there is, claimed and committed at once.
static cp_status write_rows(cp_assessment *self, const cp_plan_rows *plan, cp_error *error)
{
    cp_store *store = NULL;
    cp_owner owner;
    int attempt = 0;
    const cp_replication_row *replication = &plan->replication[0];
    cp_status status = cp_store_open(self->request.db_path, CP_STORE_CREATE, &store, error);
    if (status == CP_OK)
        status = cp_plan_rows_write(store, plan, error);
    if (status == CP_OK)
        status = cp_owner_self(&owner, error);
    if (status == CP_OK)
        status = cp_claim_take(store, replication->id, replication->configuration_hash, &owner,
                               &attempt, error);
    self->results.replication_id = replication->id;
    self->results.attempt = attempt;
    if (status == CP_OK && attempt > 0)
        status = cp_result_rows_commit(store, &self->results, error);
    else if (status == CP_OK)
        cp_log_info("%s: holds these crashes already", self->request.db_path);
    cp_store_finish(store);
    cp_store_close(store);
    return status;
}

cp_status cp_assessment_store(cp_assessment *self, cp_error *error)
{
    const cp_assessment_request *a = &self->request;
    assessment_texts texts = {0};
    char none[] = "[]", recorded[] = "recorded", collisions[] = "collisions",
         configurations[] = "configurations";
    cp_status status = fill_texts(self, &texts, error);
    cp_scenario_row scenario = {
        .name = a->collisions_path ? collisions : configurations,
        .sumocfg = (char *)(a->collisions_path ? a->collisions_path : a->configurations_path),
        .sumo_options = none,
        .files = texts.files,
        .driver_errors = none};
    cp_variant_row variant = {.name = recorded, .is_baseline = true, .functions = none};
    cp_replication_row replication = {.id = cp_replication_row_id(scenario.name, recorded, "", 0)};
    cp_plan_rows plan = {.study = {.name = (char *)a->name,
                                   .design = "assessment",
                                   .replications = 1,
                                   .duration_s = self->record.simulated_s,
                                   .step_length_s = self->record.step_length_s,
                                   .vehicles = texts.vehicles,
                                   .yaml = texts.all},
                         .scenario = &scenario,
                         .scenario_count = 1,
                         .variant = &variant,
                         .variant_count = 1,
                         .vehicle_model = texts.models,
                         .vehicle_model_count = texts.model_count,
                         .replication = &replication,
                         .replication_count = 1};
    if (status == CP_OK) {
        cp_hash_bytes(texts.all, strlen(texts.all), plan.study.hash);
        memcpy(replication.configuration_hash, plan.study.hash, CP_HASH_TEXT_SIZE);
        status = write_rows(self, &plan, error);
    }
    destroy_texts(&texts);
    return status;
}
