/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/args.h"
#include "cli/assessment.h"
#include "cli/commands.h"
#include "core/file.h"
#include "core/log.h"
#include "core/progress.h"
#include "core/units.h"
#include "crash/crash_simulation.h"
#include "crash/shipped_vehicle.h"
#include "crash/validity.h"
#include "exchange/sumo_places.h"
#include "run/owner.h"
#include "store/claim.h"
#include "store/stored_crash.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TYPES_MAX 256
#define FILES_MAX 16

// Kept of a recorded run around the report of a collision.
static const double BEFORE_S = 5.0, AFTER_S = 2.0;

typedef struct arguments {
    const char *collisions_path;
    const char *fcd_path;
    const char *configurations_path;
    const char *routes_path[FILES_MAX];
    size_t routes_count;
    const char *vehicle_path;
    const char *type[TYPES_MAX]; /* TYPE=VEHICLE */
    size_t type_count;
    const char *db_path;
    const char *name;
    bool strict;
    cp_format format;
} arguments;

enum {
    COLLISIONS = 'c',
    FCD = 'f',
    CONFIGURATIONS = 'l',
    ROUTES = 'r',
    VEHICLE = 'v',
    TYPE = 'T',
    DB = 'd',
    NAME = 'n',
    STRICT = 256
};

static const struct argp_option OPTIONS[] = {
    {"collisions", COLLISIONS, "FILE", 0, "SUMO's --collision-output of a finished run", 0},
    {"fcd", FCD, "FILE", 0,
     "its --fcd-output; write it with --precision 6. Without it the places that SUMO 1.24 and "
     "later "
     "write with each collision (colliderFront, ...) are used",
     0},
    {"routes", ROUTES, "FILE", 0,
     "its route or additional file with vTypes: class, length and width of the vehicles; may be "
     "repeated",
     0},
    {"configurations", CONFIGURATIONS, "FILE", 0, "a list of crash configurations, CSV", 0},
    {"vehicle", VEHICLE, "VEHICLE", 0, "what cars not named by --type crash as", 0},
    {"type", TYPE, "TYPE=VEHICLE", 0, "what a SUMO vehicle type crashes as; may be repeated", 0},
    {"db", DB, "FILE", 0, "store crashes and pulses in this new database", 0},
    {"name", NAME, "NAME", 0, "name of the study in the database (default: assessment)", 0},
    {"strict", STRICT, NULL, 0,
     "end at the first row that cannot be assessed; without it such rows are named and left out, "
     "and "
     "the exit code is 2 when the others are done",
     0},
    {0},
};

static void add_to(struct argp_state *state, const char *list[], size_t *count, size_t room,
                   const char *argument)
{
    if (*count == room)
        argp_error(state, "at most %zu of '%s' and the like", room, argument);
    list[(*count)++] = argument;
}

static void check(struct argp_state *state, const arguments *a)
{
    if ((a->collisions_path != NULL) == (a->configurations_path != NULL))
        argp_error(state, "either --collisions, or --configurations");
    if (a->configurations_path != NULL && a->fcd_path != NULL)
        argp_error(state, "--fcd belongs to --collisions");
    if (a->configurations_path != NULL && a->routes_count > 0)
        argp_error(state, "--routes belongs to --collisions");
}

static error_t parse(int key, char *argument, struct argp_state *state)
{
    arguments *a = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &a->format;
        return 0;
    case COLLISIONS:
        a->collisions_path = argument;
        return 0;
    case FCD:
        a->fcd_path = argument;
        return 0;
    case ROUTES:
        add_to(state, a->routes_path, &a->routes_count, FILES_MAX, argument);
        return 0;
    case CONFIGURATIONS:
        a->configurations_path = argument;
        return 0;
    case VEHICLE:
        a->vehicle_path = argument;
        return 0;
    case TYPE:
        if (strchr(argument, '=') == NULL || argument[0] == '=')
            argp_error(state, "--type must be TYPE=VEHICLE, found '%s'", argument);
        add_to(state, a->type, &a->type_count, TYPES_MAX, argument);
        return 0;
    case DB:
        a->db_path = argument;
        return 0;
    case NAME:
        a->name = argument;
        return 0;
    case STRICT:
        a->strict = true;
        return 0;
    case ARGP_KEY_ARG:
        argp_error(state, "no such argument: '%s'", argument);
        return 0;
    case ARGP_KEY_END:
        check(state, a);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child CHILDREN[] = {{&CP_ARGS_FORMAT, 0, NULL, 0}, {0}};

static const struct argp ARGP = {
    .options = OPTIONS,
    .parser = parse,
    .args_doc = "",
    .doc =
        "Put ready collisions through the path that those of a study take: poses, contact "
        "configuration, surrogate with both vehicle models, OLC and the other severities. No "
        "traffic is simulated."
        "\v"
        "Collisions of a SUMO run: the first contact is found between the steps of the record; "
        "where SUMO took the vehicles away before (collision.action teleport, its default "
        "minGap factor) they are carried on by their last motion; where one turned "
        "and steps are longer than 0.25 s how they met is not known, and told. Without --fcd their "
        "ways before the first "
        "report are at the speeds of then, turning as from the first report to the next if there "
        "is one: coarser in turns. Contacts that a study would "
        "not count are listed with their reason. time_s is SUMO's clock at the end of a step, as "
        "in a study; the files name a step by its beginning.\n\n"
        "A list of configurations has a first line of column names:\n"
        "  speed_a_km_h,speed_b_km_h,offset_mm,angle_deg, as of 'crash'; or poses\n"
        "  x_a_m,y_a_m,heading_a_deg,speed_a_km_h and the same of b, before contact,\n"
        "  with yaw_rate_a_deg_s,yaw_rate_b_deg_s if they turn; and in both kinds\n"
        "  id,vehicle_a,vehicle_b if there are names and vehicles.\n\n"
        "A vehicle is the name of a shipped one or a file. Without --type and --vehicle a type is "
        "what "
        "its vType in the --routes says, by class and size.\n\n"
        "Examples:\n"
        "  crashpulse assess --collisions coll.xml --fcd fcd.xml --routes r.rou.xml \\\n"
        "      --type van=my_van.yaml --db crashes.db\n"
        "  crashpulse assess --configurations cases.csv --vehicle mid_size --format csv\n",
    .children = CHILDREN,
};

// ---- what there is -------------------------------------------------------------------------

/* All of one assessment. */
typedef struct assessment {
    const arguments *arguments;
    cp_collision_list collisions;
    cp_fcd_record record;
    cp_vtypes types;
    cp_configuration_list configurations;
    cp_study study; /* names the vehicle files */
    cp_fleet fleet;
    cp_result_rows results;
    cp_assessment_count count;
} assessment;

static void destroy(assessment *self)
{
    cp_result_rows_destroy(&self->results);
    cp_fleet_destroy(&self->fleet);
    cp_study_destroy(&self->study);
    cp_configuration_list_destroy(&self->configurations);
    cp_vtypes_destroy(&self->types);
    cp_fcd_record_destroy(&self->record);
    cp_collision_list_destroy(&self->collisions);
}

static cp_status read_files(assessment *self, cp_error *error)
{
    const arguments *a = self->arguments;
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
    cp_shipped_vehicle shipped;
    for (size_t k = 0; k < study->vehicle_count; k++)
        if (type != NULL && study->vehicles[k].type != NULL &&
            strcmp(study->vehicles[k].type, type) == 0)
            return CP_OK;
    bool is_path = model != NULL && cp_shipped_vehicle_is_path(model);
    if (model != NULL && !is_path && !cp_shipped_vehicle_find(model, &shipped))
        return cp_fail(error, CP_BAD_INPUT,
                       "%s%sno vehicle '%s' is shipped; a name must be one of %s, a file has a '/' "
                       "or a '.' in it",
                       base != NULL ? base : "", base != NULL ? ": " : "", model,
                       cp_shipped_vehicle_names());
    cp_study_vehicle *larger =
        realloc(study->vehicles, (study->vehicle_count + 1) * sizeof *larger);
    if (larger == NULL)
        return cp_fail_memory(error, "vehicles");
    study->vehicles = larger;
    cp_study_vehicle *added = &study->vehicles[study->vehicle_count++];
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
static cp_status add_listed(assessment *self, const cp_listed_configuration *row, cp_error *error)
{
    cp_study *study = &self->study;
    cp_vehicle_model model;
    cp_status status = CP_OK;
    for (int v = 0; status == CP_OK && v < 2; v++) {
        const char *name = row->vehicle[v];
        size_t before = study->vehicle_count;
        if (name == NULL)
            continue;
        status = add_vehicle(study, name, name, self->arguments->configurations_path, error);
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
static cp_status gather_listed(assessment *self, cp_error *error)
{
    const arguments *a = self->arguments;
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

static cp_status gather_vehicles(assessment *self, cp_error *error)
{
    const arguments *a = self->arguments;
    cp_study *study = &self->study;
    cp_status status = add_vehicle(study, NULL, a->vehicle_path, NULL, error);
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
static cp_status assess_list(assessment *self, cp_assessment_keep keep, cp_error *error)
{
    const cp_configuration_list *list = &self->configurations;
    for (size_t k = 0; k < list->bad_count; k++)
        cp_log_warning("%s; left out", list->bad[k]);
    cp_status status =
        cp_assess_configurations(list, self->arguments->configurations_path, &self->fleet, keep,
                                 self->arguments->strict, &self->results, &self->count, error);
    self->count.listed += list->bad_count;
    self->count.bad += list->bad_count;
    return status;
}

static cp_status assess(assessment *self, cp_error *error)
{
    const arguments *a = self->arguments;
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

// ---- the database --------------------------------------------------------------------------

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
static cp_status files_text(const arguments *a, char **text, cp_error *error)
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
static cp_status gather_models(const assessment *self, assessment_texts *texts, json_t *hashes,
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
                           self->arguments->db_path, name);
        json_object_set_new(hashes, name, json_string(hash));
    }
    return CP_OK;
}

static cp_status fill_texts(const assessment *self, assessment_texts *texts, cp_error *error)
{
    json_t *hashes = json_object(), *types = json_object();
    cp_status status = gather_models(self, texts, hashes, error);
    if (status == CP_OK)
        status = files_text(self->arguments, &texts->files, error);
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
static cp_status write_rows(assessment *self, const cp_plan_rows *plan, cp_error *error)
{
    cp_store *store = NULL;
    cp_owner owner;
    int attempt = 0;
    const cp_replication_row *replication = &plan->replication[0];
    cp_status status = cp_store_open(self->arguments->db_path, CP_STORE_CREATE, &store, error);
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
        cp_log_info("%s: holds these crashes already", self->arguments->db_path);
    cp_store_finish(store);
    cp_store_close(store);
    return status;
}

// The assessment as a study of one scenario and one variant that has been run.
static cp_status store_results(assessment *self, cp_error *error)
{
    const arguments *a = self->arguments;
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

// ---- output --------------------------------------------------------------------------------

static const char *const COLUMN[] = {"crash",
                                     "time_s",
                                     "a",
                                     "b",
                                     "model_a",
                                     "model_b",
                                     "crash_type",
                                     "closing_speed_km_h",
                                     "offset_mm",
                                     "angle_deg",
                                     "overlap_1",
                                     "side_a",
                                     "side_b",
                                     "speed_a_km_h",
                                     "speed_b_km_h",
                                     "delta_v_a_km_h",
                                     "delta_v_b_km_h",
                                     "olc_a_g",
                                     "olc_b_g",
                                     "olc_status_a",
                                     "olc_status_b",
                                     "validity_a",
                                     "validity_b"};

static void add_row(cp_table *table, size_t number, const cp_crash_row *crash)
{
    const cp_crash_vehicle_row *v = crash->vehicle;
    const cp_crash_description *description = &crash->description;
    char text[CP_VALIDITY_TEXT_SIZE];
    cp_table_integer(table, (int64_t)number);
    cp_table_real(table, crash->time_s);
    for (int role = 0; role < 2; role++)
        cp_table_text(table, v[role].sumo_id);
    for (int role = 0; role < 2; role++)
        cp_table_text(table, v[role].vehicle_model);
    cp_table_text(table, cp_crash_type_text(v[0].side, v[1].side));
    cp_table_real(table, cp_km_h_from_m_s(description->closing_speed_m_s));
    cp_table_real(table, 1000.0 * description->lateral_offset_m);
    cp_table_real(table, cp_deg_from_rad(description->angle_rad));
    cp_table_real(table, description->overlap_1);
    for (int role = 0; role < 2; role++)
        cp_table_text(table, cp_contact_side_text(v[role].side));
    for (int role = 0; role < 2; role++)
        cp_table_real(table, cp_km_h_from_m_s(v[role].speed_m_s));
    for (int role = 0; role < 2; role++)
        cp_table_real(table, cp_km_h_from_m_s(v[role].severity.delta_v_m_s));
    for (int role = 0; role < 2; role++)
        cp_table_real(
            table, v[role].severity.olc.status == CP_OLC_VALUE ? v[role].severity.olc.olc_g : NAN);
    for (int role = 0; role < 2; role++)
        cp_table_text(table, cp_olc_status_text(v[role].severity.olc.status));
    for (int role = 0; role < 2; role++)
        cp_table_text(table, cp_validity_text(v[role].outside, text));
}

static cp_status print(const assessment *self, cp_error *error)
{
    cp_table table = {0};
    cp_table_begin(&table, COLUMN, sizeof COLUMN / sizeof *COLUMN);
    for (size_t k = 0; k < self->results.crash_count; k++)
        add_row(&table, k, &self->results.crash[k]);
    cp_status status = cp_table_print(&table, self->arguments->format, stdout, error);
    cp_table_destroy(&table);
    const cp_assessment_count *count = &self->count;
    cp_log_info("%zu listed: %zu crashes (%zu of them beyond the record), %zu not counted, %zu do "
                "not touch, of %zu it is not known, %zu left out",
                count->listed, count->crashes, count->carried, count->filtered, count->no_contact,
                count->unknown, count->bad);
    return status;
}

cp_status cmd_assess(int argc, char **argv, cp_error *error)
{
    arguments a = {.name = "assessment"};
    assessment self = {.arguments = &a};
    cp_args_parse(&ARGP, argc, argv, &a);
    cp_status status = read_files(&self, error);
    if (status == CP_OK)
        status = gather_vehicles(&self, error);
    if (status == CP_OK)
        status = assess(&self, error);
    if (status == CP_OK && a.db_path != NULL)
        status = store_results(&self, error);
    if (status == CP_OK)
        status = print(&self, error);
    if (status == CP_OK && self.count.bad > 0)
        status = cp_fail(error, CP_BAD_INPUT,
                         "%s: %zu of %zu rows could not be assessed (named above); the others are "
                         "done",
                         a.collisions_path != NULL ? a.collisions_path : a.configurations_path,
                         self.count.bad, self.count.listed);
    destroy(&self);
    return status;
}
