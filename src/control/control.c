/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control.h"

#include "control/control_types.h"
#include "control/driver_error/ignored_foes.h"
#include "control/road_view.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define COUNTERS_MAX 40

typedef struct active_control {
    double uncounted[COUNTERS_MAX]; /* its counters when the warm-up ended */
    cp_control_settings settings;
    cp_control_context context;
    cp_equipment equipment;
    cp_acts acts; /* of a function */
    void *state;
} active_control;

/* At once, of one replication or branch. Their contexts are pointed at and must stay in place. */
#define CP_CONTROLS_MAX 64

struct cp_controls {
    active_control active[CP_CONTROLS_MAX];
    size_t count; /* created so far */
    const cp_traffic *traffic;
    cp_actuation actuation;
    cp_error_log errors;
    char *only[2]; /* of a treatment: the ids of its two vehicles */
    cp_ignored_foes *ignored;
    cp_road_view *view;
};

const cp_control_type *cp_control_type_find(cp_control_kind kind, const char *name)
{
    for (size_t k = 0; k < CP_CONTROL_TYPE_COUNT; k++)
        if (CP_CONTROL_TYPE[k]->kind == kind && strcmp(CP_CONTROL_TYPE[k]->name, name) == 0)
            return CP_CONTROL_TYPE[k];
    return NULL;
}

cp_control_settings cp_control_settings_default(const cp_control_type *type)
{
    cp_control_settings settings = {.type = type};
    for (size_t k = 0; k < type->parameter_count; k++)
        settings.parameter[k] = type->parameters[k].standard;
    return settings;
}

const char *cp_control_name(const cp_control_settings *settings)
{
    return settings->library != NULL ? settings->library->name : settings->type->name;
}

static cp_status check_ranges(const cp_control_settings *settings, cp_error *error)
{
    const cp_control_type *type = settings->type;
    for (size_t k = 0; k < type->parameter_count; k++) {
        const cp_control_parameter *row = &type->parameters[k];
        double value = settings->parameter[k];
        if (!(value >= row->smallest && value <= row->largest))
            return cp_fail(error, CP_BAD_INPUT, "%s: %s must be in %g..%g, found %g", type->name,
                           row->name, row->smallest, row->largest, value);
    }
    return CP_OK;
}

static cp_status create_one(cp_controls *controls, active_control *active,
                            const cp_control_settings *settings, cp_rng_key replication_key,
                            cp_error *error)
{
    cp_status status = check_ranges(settings, error);
    if (status != CP_OK)
        return status;
    bool is_function = settings->type->kind == CP_CONTROL_FUNCTION;
    active->settings = *settings;
    active->equipment = (cp_equipment){
        .key = replication_key,
        .penetration_1 = is_function ? settings->parameter[0] : 0.0,
        .shares = settings->shares,
        .share_count = settings->share_count,
        .only = is_function && controls->only[0] ? (const char *const *)controls->only : NULL,
        .only_count = 2,
    };
    active->acts = cp_acts_create(controls->traffic);
    active->context = (cp_control_context){
        .traffic = controls->traffic,
        .settings = &active->settings,
        .ignored = controls->ignored,
        .view = controls->view,
        .controls = controls,
        .seed_key = cp_rng_key_text(replication_key, cp_control_name(settings)),
        .parameter = active->settings.parameter,
        .equipment = &active->equipment,
        .actuation = &controls->actuation,
        .acts = is_function ? &active->acts : NULL,
    };
    status = settings->type->create(&active->context, &active->state, error);
    if (status != CP_OK && is_function)
        cp_error_prefix(error, "%s: ", cp_control_name(settings));
    return status;
}

static cp_status create_all(const cp_control_settings *settings, size_t count, uint64_t study_seed,
                            uint64_t replication_seed, cp_controls *controls, cp_error *error)
{
    if (controls->count + count > CP_CONTROLS_MAX)
        return cp_fail(error, CP_BAD_INPUT, "more than %d driver errors and functions at once",
                       CP_CONTROLS_MAX);
    cp_rng_key key = cp_rng_key_number(cp_rng_key_seed(study_seed), replication_seed);
    for (size_t k = 0; k < count; k++) {
        active_control *active = &controls->active[controls->count];
        cp_status status = create_one(controls, active, &settings[k], key, error);
        if (status != CP_OK)
            return status;
        controls->count++;
    }
    return CP_OK;
}

cp_status cp_controls_create(const cp_control_settings *settings, size_t count, uint64_t study_seed,
                             uint64_t replication_seed, const cp_traffic *traffic,
                             cp_controls **controls, cp_error *error)
{
    *controls = NULL;
    cp_controls *created = calloc(1, sizeof *created);
    if (!created)
        return cp_fail_memory(error, "controls");
    created->traffic = traffic;
    cp_status status = cp_ignored_foes_create(&created->ignored, error);
    if (status == CP_OK)
        status = cp_road_view_create(traffic, &created->view, error);
    if (status == CP_OK)
        status = create_all(settings, count, study_seed, replication_seed, created, error);
    if (status != CP_OK) {
        cp_controls_destroy(created);
        return status;
    }
    *controls = created;
    return CP_OK;
}

cp_status cp_controls_add_treatment(cp_controls *controls, const cp_control_settings *settings,
                                    size_t count, uint64_t study_seed, uint64_t replication_seed,
                                    const char *const ids[2], cp_error *error)
{
    for (int k = 0; k < 2; k++) {
        free(controls->only[k]);
        if (!(controls->only[k] = strdup(ids[k])))
            return cp_fail_memory(error, "controls");
    }
    return create_all(settings, count, study_seed, replication_seed, controls, error);
}

void cp_controls_destroy(cp_controls *controls)
{
    if (!controls)
        return;
    for (size_t k = 0; k < controls->count; k++) {
        controls->active[k].settings.type->destroy(controls->active[k].state);
        cp_equipment_destroy(&controls->active[k].equipment);
        cp_acts_destroy(&controls->active[k].acts);
    }
    cp_actuation_destroy(&controls->actuation);
    cp_error_log_destroy(&controls->errors);
    free(controls->only[0]);
    free(controls->only[1]);
    cp_ignored_foes_destroy(controls->ignored);
    cp_road_view_destroy(controls->view);
    free(controls);
}

/* Errors of one control being noted. */
typedef struct noting {
    cp_controls *controls;
    size_t control;
} noting;

static cp_status note_error(void *context, uint32_t vehicle, uint32_t other, cp_error *error)
{
    const noting *now = context;
    const cp_traffic *traffic = now->controls->traffic;
    return cp_error_log_note(&now->controls->errors, now->control, vehicle, other,
                             cp_traffic_time_s(traffic), cp_traffic_step_length_s(traffic), error);
}

// Everybody whom a control makes err now, for controls that keep no list of them.
static cp_status ask_everybody(const cp_controls *controls, const active_control *active,
                               noting *now, cp_error *error)
{
    size_t count;
    const cp_vehicle_motion *motions = cp_traffic_motions(controls->traffic, &count);
    cp_status status = CP_OK;
    for (size_t k = 0; k < count && status == CP_OK; k++)
        if (active->settings.type->is_at_fault(active->state, motions[k].after.vehicle))
            status = note_error(now, motions[k].after.vehicle, CP_EVERYBODY, error);
    return status;
}

// The errors at work after the step that has just been made.
static cp_status note_errors(cp_controls *controls, cp_error *error)
{
    cp_status status =
        cp_error_log_tidy(&controls->errors, cp_traffic_time_s(controls->traffic), error);
    for (size_t k = 0; k < controls->count && status == CP_OK; k++) {
        const active_control *active = &controls->active[k];
        const cp_control_type *type = active->settings.type;
        noting now = {controls, k};
        if (type->kind == CP_CONTROL_DRIVER_ERROR && type->visit_errors)
            status = type->visit_errors(active->state, note_error, &now, error);
        else if (type->kind == CP_CONTROL_DRIVER_ERROR && type->is_at_fault)
            status = ask_everybody(controls, active, &now, error);
    }
    return status;
}

static cp_status step_one(cp_controls *controls, active_control *active, cp_error *error)
{
    const cp_control_type *type = active->settings.type;
    bool is_function = type->kind == CP_CONTROL_FUNCTION;
    cp_status status = is_function ? cp_acts_step(&active->acts, error) : CP_OK;
    controls->actuation.acts = active->context.acts;
    if (status == CP_OK)
        status = type->step(active->state, &active->context, error);
    if (status != CP_OK)
        cp_error_prefix(error, "%s: ", cp_control_name(&active->settings));
    return status;
}

cp_status cp_controls_step(cp_controls *controls, cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t k = 0; k < controls->count && status == CP_OK; k++)
        status = step_one(controls, &controls->active[k], error);
    if (status == CP_OK)
        status = note_errors(controls, error);
    if (status == CP_OK)
        status = cp_ignored_foes_send(controls->ignored, controls->traffic, error);
    if (status != CP_OK)
        return status;
    return cp_actuation_apply(&controls->actuation, controls->traffic, error);
}

double cp_controls_brake_request_m_s2(const cp_controls *controls, uint32_t vehicle)
{
    return cp_actuation_deceleration_m_s2(&controls->actuation, vehicle);
}

static bool is_at_fault(const cp_controls *controls, uint32_t vehicle)
{
    for (size_t k = 0; k < controls->count; k++) {
        const active_control *active = &controls->active[k];
        const cp_control_type *type = active->settings.type;
        if (type->is_at_fault && type->is_at_fault(active->state, vehicle))
            return true;
    }
    return false;
}

bool cp_controls_is_at_fault(void *context, uint32_t vehicle)
{
    return is_at_fault(context, vehicle);
}

bool cp_controls_has_cause(const cp_controls *controls, uint32_t own, uint32_t target)
{
    return is_at_fault(controls, own) || is_at_fault(controls, target) ||
           cp_traffic_is_held(controls->traffic, target);
}

bool cp_controls_errs_alone(const cp_controls *controls, uint32_t vehicle)
{
    for (size_t k = 0; k < controls->count; k++) {
        const active_control *active = &controls->active[k];
        const cp_control_type *type = active->settings.type;
        if (type->is_at_fault && !type->error_since_s && type->is_at_fault(active->state, vehicle))
            return true;
    }
    return false;
}

double cp_controls_error_since_s(const cp_controls *controls, uint32_t vehicle, uint32_t other)
{
    double since_s = INFINITY;
    for (size_t k = 0; k < controls->count; k++) {
        const active_control *active = &controls->active[k];
        const cp_control_type *type = active->settings.type;
        if (type->error_since_s)
            since_s = fmin(since_s, type->error_since_s(active->state, vehicle, other));
    }
    return since_s;
}

// ---- how a crash came about ----------------------------------------------------------------

static size_t count_kind(const cp_controls *controls, cp_control_kind kind)
{
    size_t count = 0;
    for (size_t k = 0; k < controls->count; k++)
        count += controls->active[k].settings.type->kind == kind;
    return count;
}

size_t cp_controls_driver_error_count(const cp_controls *controls)
{
    return count_kind(controls, CP_CONTROL_DRIVER_ERROR);
}

size_t cp_controls_function_count(const cp_controls *controls)
{
    return count_kind(controls, CP_CONTROL_FUNCTION);
}

// Index of the number-th control of a kind.
static size_t index_of(const cp_controls *controls, cp_control_kind kind, size_t number)
{
    size_t k = 0;
    while (controls->active[k].settings.type->kind != kind || number-- > 0)
        k++;
    return k;
}

bool cp_controls_error_at(const cp_controls *controls, size_t number, uint32_t vehicle,
                          uint32_t opponent, double instant_s, cp_error_at *at)
{
    size_t control = index_of(controls, CP_CONTROL_DRIVER_ERROR, number);
    const cp_logged_error *found = NULL;
    for (size_t k = 0; k < controls->errors.count; k++) {
        const cp_logged_error *entry = &controls->errors.errors[k];
        if (entry->control != control || entry->vehicle != vehicle ||
            instant_s - entry->until_s > CP_ERROR_MEMORY_S)
            continue;
        // Towards him or everybody before towards another, later before earlier.
        bool is_his = entry->other == CP_EVERYBODY || entry->other == opponent;
        bool was_his = found && (found->other == CP_EVERYBODY || found->other == opponent);
        if (!found || is_his > was_his ||
            (is_his == was_his &&
             (entry->until_s > found->until_s ||
              (entry->until_s == found->until_s && entry->since_s < found->since_s))))
            found = entry;
    }
    if (!found)
        return false;
    *at = (cp_error_at){
        .name = cp_control_name(&controls->active[control].settings),
        .towards = found->other == CP_EVERYBODY ? CP_TOWARDS_EVERYBODY
                   : found->other == opponent   ? CP_TOWARDS_OPPONENT
                                                : CP_TOWARDS_ANOTHER,
        .began_s = fmax(instant_s - found->since_s, 0.0),
        .ended_s = fmax(instant_s - found->until_s, 0.0),
    };
    at->is_cause = at->towards != CP_TOWARDS_ANOTHER && at->ended_s <= CP_CAUSE_WINDOW_S;
    return true;
}

cp_status cp_controls_function_at(cp_controls *controls, size_t number, uint32_t vehicle,
                                  double instant_s, double speed_m_s, cp_function_at *at,
                                  cp_error *error)
{
    active_control *active = &controls->active[index_of(controls, CP_CONTROL_FUNCTION, number)];
    *at = (cp_function_at){.name = cp_control_name(&active->settings),
                           .act = cp_acts_at(&active->acts, vehicle, instant_s, speed_m_s)};
    return cp_equipment_has(&active->equipment, controls->traffic, vehicle, &at->is_equipped,
                            error);
}

// ---- counters ------------------------------------------------------------------------------

// Counters of one control under "name.counter"; false when memory is gone.
static bool add_counters(json_t *object, const active_control *active)
{
    const cp_control_type *type = active->settings.type;
    if (type->kind == CP_CONTROL_FUNCTION) {
        char key[128];
        snprintf(key, sizeof key, "%s.equipped_vehicles", cp_control_name(&active->settings));
        if (json_object_set_new(object, key, json_real((double)active->equipment.equipped)) != 0)
            return false;
    }
    if (!type->counters)
        return true;
    const char *names[COUNTERS_MAX];
    double values[COUNTERS_MAX];
    size_t count = type->counters(active->state, names, values, COUNTERS_MAX);
    for (size_t k = 0; k < count; k++) {
        char key[128];
        snprintf(key, sizeof key, "%s.%s", cp_control_name(&active->settings), names[k]);
        if (json_object_set_new(object, key, json_real(values[k] - active->uncounted[k])) != 0)
            return false;
    }
    return true;
}

void cp_controls_count_from_now(cp_controls *controls)
{
    for (size_t k = 0; k < controls->count; k++) {
        active_control *active = &controls->active[k];
        const char *names[COUNTERS_MAX];
        if (active->settings.type->counters != NULL)
            active->settings.type->counters(active->state, names, active->uncounted, COUNTERS_MAX);
    }
}

cp_status cp_controls_counters_json(const cp_controls *controls, char **json, cp_error *error)
{
    *json = NULL;
    json_t *object = json_object();
    bool is_complete = object != NULL;
    for (size_t k = 0; k < controls->count && is_complete; k++)
        is_complete = add_counters(object, &controls->active[k]);
    if (is_complete)
        *json = json_dumps(object, JSON_COMPACT | JSON_SORT_KEYS | JSON_REAL_PRECISION(15));
    json_decref(object);
    return *json ? CP_OK : cp_fail_memory(error, "counters");
}
