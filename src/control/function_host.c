/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/function_host.h"

#include "control/acting.h"
#include "control/brake.h"
#include "control/function_parameters.h"
#include "control/function_request.h"
#include "control/function_view.h"
#include "control/lookout.h"
#include "core/units.h"

#include <fenv.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#define BEARS_OUT_S 2.0  /* a warning has come true within the TTC and this */
#define HARDER_M_S2 0.1  /* than at ease: rounding */
#define CAR_ALIGNMENT 16 /* of the function's memory */

_Static_assert((int)CRASHPULSE_REAR_END == (int)CP_TARGET_REAR_END &&
                   (int)CRASHPULSE_ONCOMING == (int)CP_TARGET_ONCOMING &&
                   (int)CRASHPULSE_CROSSING == (int)CP_TARGET_CROSSING &&
                   (int)CRASHPULSE_TURNING == (int)CP_TARGET_TURNING &&
                   (int)CRASHPULSE_CLASSES == (int)CP_TARGET_CLASSES,
               "classes of targets are the same on both sides");

/* What the host counts. */
typedef struct host_counts {
    size_t activations, of_class[CP_TARGET_CLASSES], for_nothing, activations_without_error;
    size_t warnings, warnings_without_error, warnings_borne_out;
    size_t interventions, limited;
    double braking_s;
} host_counts;

typedef struct function_host {
    const crashpulse_function *function;
    const cp_library *library; /* NULL: one of ours */
    const char *name;
    const cp_traffic *traffic;
    cp_function_parameters parameters;
    void *self;
    double brake_delay_s, friction_m_s2;
    cp_vehicle_table cars; /* a host_car of each, the function's memory behind it */
    cp_function_senses senses;
    double *counter; /* the function's own */
    host_counts counts;
    fenv_t arithmetic; /* how numbers are rounded here */
    double grown_mb;   /* memory, during calls of a library */
} function_host;

/* One car. */
typedef struct host_car {
    function_host *host; /* NULL: the function has not seen it */
    cp_braking braking;
    double requested_s;
    bool has_target, has_cause; /* of the braking */
    cp_target_class class_of;
    bool is_warned, is_steering;
    uint32_t warned_of;     /* in the last warning, */
    double until_s;         /* looked at until then, SUMO clock */
    double factor_1;        /* speed factor that is set; 0: none */
    double driver_factor_1; /* that the driver brought along */
} host_car;

static size_t memory_offset(void)
{
    return (sizeof(host_car) + CAR_ALIGNMENT - 1) / CAR_ALIGNMENT * CAR_ALIGNMENT;
}

static void *memory_of(host_car *car)
{
    return (unsigned char *)car + memory_offset();
}

// ---- calls ---------------------------------------------------------------------------------

static void enter(function_host *host, const char *whom, double time_s)
{
    if (host->library == NULL)
        return;
    cp_acting_enter(host->name, host->library->written, whom, time_s);
}

// A library may have changed how numbers are rounded.
static void leave(function_host *host)
{
    if (host->library == NULL)
        return;
    cp_acting_leave();
    fesetenv(&host->arithmetic);
}

static double memory_mb(const function_host *host)
{
    struct rusage usage;
    if (host->library == NULL || getrusage(RUSAGE_SELF, &usage) != 0)
        return 0.0;
    return (double)usage.ru_maxrss / 1024.0;
}

// Error of a call, told to whoever has forked this process as well.
static cp_status fail_call(const function_host *host, const char *whom, const char *what,
                           cp_error *error)
{
    cp_error full = {0};
    const char *library = host->library != NULL ? host->library->written : "built in";
    double time_s = cp_traffic_time_s(host->traffic);
    cp_status status =
        cp_fail(error, CP_RUN_FAILED, "%s: %s at %.3f s: %s", library, whom, time_s, what);
    if (cp_fail(&full, CP_RUN_FAILED, "%s: %s", host->name, error->text) == CP_RUN_FAILED)
        cp_acting_failed(full.text);
    return status;
}

static void release_car(void *item)
{
    host_car *car = item;
    if (car->host == NULL || car->host->function->leave == NULL)
        return;
    enter(car->host, "a car that leaves", cp_traffic_time_s(car->host->traffic));
    car->host->function->leave(car->host->self, memory_of(car));
    leave(car->host);
}

// ---- beginning and end ---------------------------------------------------------------------

static cp_lookout_settings lookout_settings(const function_host *host,
                                            const crashpulse_outlook *outlook,
                                            const cp_control_context *context)
{
    const double *parameter = host->parameters.host;
    cp_lookout_settings settings = {
        .sensor = {parameter[CP_HOST_RANGE_M],
                   cp_rad_from_deg(parameter[CP_HOST_FIELD_OF_VIEW_DEG]),
                   parameter[CP_HOST_LATENCY_S]},
        .confirmation_s = parameter[CP_HOST_CONFIRMATION_S],
        .detection_probability_1 = parameter[CP_HOST_DETECTION_PROBABILITY_1],
        .has_occlusion = parameter[CP_HOST_OCCLUSION_1] >= 0.5,
        .ttc_s = outlook->ttc_s,
        .required_m_s2 = outlook->required_m_s2,
        .horizon_s = outlook->horizon_s,
        .key = context->seed_key,
        .view = context->view,
    };
    for (size_t k = 0; k < CP_TARGET_CLASSES; k++)
        settings.has_class[k] = outlook->has_class[k];
    return settings;
}

static cp_status check_outlook(const crashpulse_outlook *outlook, char *text, size_t size)
{
    bool good = outlook->horizon_s > 0.0 && outlook->horizon_s <= 60.0 && outlook->ttc_s >= 0.0 &&
                outlook->ttc_s <= outlook->horizon_s && outlook->required_m_s2 >= 0.0 &&
                outlook->required_m_s2 <= 100.0;
    snprintf(text, size,
             "looks out for horizon_s %g (must be in ]0, 60]), ttc_s %g ([0, horizon_s]), "
             "required_m_s2 %g ([0, 100])",
             outlook->horizon_s, outlook->ttc_s, outlook->required_m_s2);
    return good ? CP_OK : CP_RUN_FAILED;
}

// Call the function's create, and see to what it looks out for.
static cp_status create_function(function_host *host, const cp_control_context *context,
                                 cp_error *error)
{
    char wrong[256];
    const char *said = NULL;
    crashpulse_outlook outlook = {.horizon_s = 6.0, .required_m_s2 = CP_LOOKOUT_EASY_BRAKING_M_S2};
    for (size_t k = 0; k < CP_TARGET_CLASSES; k++)
        outlook.has_class[k] = true;
    crashpulse_setup setup = {
        .parameter = host->parameters.own,
        .extra = host->parameters.extra,
        .extra_count = host->parameters.extra_count,
        .data = host->library != NULL ? host->library->data_path : NULL,
        .step_s = cp_traffic_step_length_s(host->traffic),
        .seed = context->seed_key.value,
        .brake_delay_s = host->brake_delay_s,
    };
    if (host->function->create != NULL) {
        enter(host, "create", NAN);
        said = host->function->create(&setup, &outlook, &host->self);
        leave(host);
    }
    if (said != NULL)
        return fail_call(host, "create", said, error);
    if (check_outlook(&outlook, wrong, sizeof wrong) != CP_OK)
        return fail_call(host, "create", wrong, error);
    cp_lookout_settings settings = lookout_settings(host, &outlook, context);
    host->senses = cp_function_senses_create(&settings, context);
    return CP_OK;
}

// Which function it is: ours, or that of a library that is loaded now.
static cp_status find_function(function_host *host, const cp_control_context *context,
                               cp_error *error)
{
    const double *parameter = host->parameters.host;
    host->function = context->settings->type->function;
    cp_status status = CP_OK;
    if (host->library != NULL)
        status = cp_library_load(host->library, &host->function, error);
    else if (host->function == NULL)
        return cp_fail(error, CP_BAD_INPUT, "names no library");
    if (status == CP_OK)
        status = cp_function_parameters_take(host->function, context->settings, &host->parameters,
                                             error);
    if (status != CP_OK) {
        cp_acting_failed(error->text);
        return status;
    }
    bool is_treatment = context->equipment != NULL && context->equipment->only != NULL;
    if (is_treatment && host->function->does & CRASHPULSE_ACTS_LONG_BEFORE)
        return fail_call(host, "create", "acts long before a crash: no treatment", error);
    if (host->library != NULL)
        status = cp_acting_limit(parameter[CP_HOST_STEP_LIMIT_S], error);
    host->friction_m_s2 = parameter[CP_HOST_FRICTION_1] * CP_G0_M_S2;
    if (!(host->function->does & CRASHPULSE_DRIVER_BRAKES))
        host->brake_delay_s = parameter[CP_HOST_LATENCY_S] + parameter[CP_HOST_DEAD_TIME_S];
    return status;
}

cp_status cp_function_host_create(const cp_control_context *context, void **state, cp_error *error)
{
    function_host *host = calloc(1, sizeof *host);
    if (host == NULL)
        return cp_fail_memory(error, "function");
    host->library = context->settings->library;
    host->name = cp_control_name(context->settings);
    host->traffic = context->traffic;
    fegetenv(&host->arithmetic);
    cp_status status = find_function(host, context, error);
    if (status == CP_OK) {
        host->cars =
            cp_vehicle_table_create(memory_offset() + host->function->car_size, release_car);
        host->counter = calloc(host->function->counter_count + 1, sizeof *host->counter);
        status = host->counter != NULL ? create_function(host, context, error)
                                       : cp_fail_memory(error, "function");
    }
    if (status == CP_OK)
        *state = host;
    else
        cp_function_host_destroy(host);
    return status;
}

void cp_function_host_destroy(void *state)
{
    function_host *host = state;
    cp_vehicle_table_destroy(&host->cars);
    if (host->function != NULL && host->function->destroy != NULL && host->self != NULL) {
        enter(host, "destroy", NAN);
        host->function->destroy(host->self);
        leave(host);
    }
    cp_function_senses_destroy(&host->senses);
    cp_function_parameters_destroy(&host->parameters);
    free(host->counter);
    free(host);
}

// ---- what it asks for ----------------------------------------------------------------------

// A warning goes on, or begins, and is counted by what it is for.
static cp_status warn(function_host *host, const cp_control_context *context, host_car *car,
                      uint32_t vehicle, const crashpulse_request *request, cp_error *error)
{
    bool is_new = request->warned_s != CRASHPULSE_NONE && !car->is_warned;
    car->is_warned = request->warned_s != CRASHPULSE_NONE;
    if (is_new) {
        double ttc_s = request->target_ttc_s != CRASHPULSE_NONE ? request->target_ttc_s : 0.0;
        host->counts.warnings++;
        host->counts.warnings_without_error +=
            request->target == CRASHPULSE_NOBODY ||
            !cp_controls_has_cause(context->controls, vehicle, request->target);
        car->warned_of = request->target;
        car->until_s = cp_traffic_time_s(host->traffic) + ttc_s + BEARS_OUT_S;
        if (!car->braking.is_requesting)
            car->braking = (cp_braking){0};
    }
    if (!car->is_warned)
        return CP_OK;
    return cp_acts_note(context->acts, vehicle, CP_ACT_WARNING, request->warned_s, error);
}

// Braking is asked for, for the first time after it was not.
static void begin_braking(function_host *host, const cp_control_context *context, host_car *car,
                          const cp_vehicle_motion *motion, const crashpulse_request *request)
{
    double now_s = cp_traffic_time_s(host->traffic);
    double since_s = request->since_s != CRASHPULSE_NONE ? request->since_s : now_s;
    cp_brake brake = {.start_s = since_s + host->brake_delay_s,
                      .jerk_m_s3 = host->parameters.host[CP_HOST_JERK_M_S3],
                      .deceleration_m_s2 = fmin(-request->acceleration_m_s2, host->friction_m_s2)};
    cp_braking_begin(&car->braking, &brake);
    car->requested_s = brake.start_s - host->brake_delay_s;
    car->has_target = request->target != CRASHPULSE_NOBODY;
    car->has_cause =
        car->has_target &&
        cp_controls_has_cause(context->controls, motion->after.vehicle, request->target);
    if (car->has_target)
        car->class_of = cp_function_class_of(&host->senses, motion, request->target);
}

static void count_activation(host_counts *counts, const host_car *car)
{
    counts->activations++;
    counts->activations_without_error += !car->has_cause;
    if (car->has_target)
        counts->of_class[car->class_of]++;
    else
        counts->for_nothing++;
}

static cp_status brake(function_host *host, const cp_control_context *context, host_car *car,
                       const cp_vehicle_motion *motion, const crashpulse_request *request,
                       cp_error *error)
{
    double asked_m_s2 = fmin(-request->acceleration_m_s2, host->friction_m_s2);
    double now_s = cp_traffic_time_s(host->traffic);
    cp_status status = CP_OK;
    if (!car->braking.is_requesting)
        begin_braking(host, context, car, motion, request);
    else if (asked_m_s2 != car->braking.brake.deceleration_m_s2)
        cp_braking_change(&car->braking, now_s, asked_m_s2);
    if (host->function->does & CRASHPULSE_BRAKES)
        status = cp_acts_note(context->acts, motion->after.vehicle, CP_ACT_REQUEST,
                              car->requested_s, error);
    if (status != CP_OK)
        return status;
    bool was_braking = car->braking.is_braking;
    status = cp_braking_command(&car->braking, host->traffic, motion, context->actuation, error);
    if (car->braking.is_braking) {
        host->counts.braking_s += cp_traffic_step_length_s(host->traffic);
        if (!was_braking)
            count_activation(&host->counts, car);
    }
    return status;
}

static cp_status accelerate(function_host *host, const cp_control_context *context, host_car *car,
                            const cp_vehicle_motion *motion, const crashpulse_request *request,
                            cp_error *error)
{
    if (request->acceleration_m_s2 < 0.0 && request->acceleration_m_s2 != CRASHPULSE_NONE)
        return brake(host, context, car, motion, request, error);
    car->braking.is_requesting = false;
    if (request->acceleration_m_s2 == CRASHPULSE_NONE)
        return CP_OK;
    double gain_m_s = request->acceleration_m_s2 * cp_traffic_step_length_s(host->traffic);
    return cp_actuation_request(context->actuation, motion->after.vehicle,
                                motion->after.speed_m_s + gain_m_s, 0.0, error);
}

static cp_status steer(function_host *host, const cp_control_context *context, host_car *car,
                       uint32_t vehicle, const crashpulse_request *request, cp_error *error)
{
    cp_lateral_overlays *overlays = cp_traffic_overlays(host->traffic);
    bool is_steered = request->is_back || request->steer_end_1 != CRASHPULSE_NONE;
    double now_s = cp_traffic_time_s(host->traffic);
    double since_s = request->steer_since_s != CRASHPULSE_NONE ? request->steer_since_s : now_s;
    cp_status status = CP_OK;
    if (is_steered)
        status = cp_acts_note(context->acts, vehicle, CP_ACT_STEERING, since_s, error);
    else if (request->announced_s != CRASHPULSE_NONE)
        status = cp_acts_note(context->acts, vehicle, CP_ACT_REQUEST, request->announced_s, error);
    host->counts.interventions += is_steered && !car->is_steering;
    car->is_steering = is_steered && !request->is_back;
    if (status != CP_OK || !is_steered)
        return status;
    if (request->is_back) {
        cp_lateral_overlay_end(overlays, vehicle);
        return CP_OK;
    }
    double mean_1 = request->steer_mean_1;
    if (mean_1 == CRASHPULSE_NONE)
        mean_1 = 0.5 * (cp_lateral_overlay_get(overlays, vehicle).slope_1 + request->steer_end_1);
    return cp_lateral_overlay_steer(overlays, vehicle, mean_1, request->steer_end_1, error);
}

// The speed factor is told to SUMO when it changes.
static cp_status limit(function_host *host, const cp_control_context *context, host_car *car,
                       uint32_t vehicle, const crashpulse_request *request, cp_error *error)
{
    const cp_traffic_source *commands = cp_traffic_commands(host->traffic);
    bool is_limit = request->speed_factor_1 != CRASHPULSE_NONE;
    double asked_1 = is_limit ? request->speed_factor_1 : car->driver_factor_1;
    cp_status status = CP_OK;
    if (!is_limit && car->factor_1 == 0.0)
        return CP_OK;
    if (car->driver_factor_1 == 0.0)
        status = commands->speed_factor(vehicle, &car->driver_factor_1, error);
    double factor_1 = fmin(asked_1, car->driver_factor_1);
    double set_1 = car->factor_1 != 0.0 ? car->factor_1 : car->driver_factor_1;
    if (status != CP_OK || factor_1 == set_1)
        return status;
    if (car->factor_1 == 0.0) {
        host->counts.limited++;
        status = cp_acts_note(context->acts, vehicle, CP_ACT_LIMITING,
                              cp_traffic_time_s(host->traffic), error);
    }
    car->factor_1 = factor_1;
    return status == CP_OK ? commands->set_speed_factor(vehicle, factor_1, error) : status;
}

static cp_status carry_out(function_host *host, const cp_control_context *context, host_car *car,
                           const cp_vehicle_motion *motion, const crashpulse_request *request,
                           cp_error *error)
{
    uint32_t vehicle = motion->after.vehicle, does = host->function->does;
    cp_status status = CP_OK;
    if (does & CRASHPULSE_WARNS)
        status = warn(host, context, car, vehicle, request, error);
    if (status == CP_OK && does & CRASHPULSE_STEERS)
        status = steer(host, context, car, vehicle, request, error);
    if (status == CP_OK && does & CRASHPULSE_LIMITS)
        status = limit(host, context, car, vehicle, request, error);
    return status == CP_OK ? accelerate(host, context, car, motion, request, error) : status;
}

// ---- steps ---------------------------------------------------------------------------------

// Whether two bodies touched in the step that has ended, looked at four times.
static bool have_touched(const cp_vehicle_motion *one, const cp_vehicle_motion *other)
{
    bool is_whole = one->was_present && other->was_present;
    for (double fraction = is_whole ? 0.25 : 1.0; fraction <= 1.0; fraction += 0.25) {
        cp_rectangle body = cp_moving_rectangle_inside(one, fraction).rectangle;
        cp_rectangle other_body = cp_moving_rectangle_inside(other, fraction).rectangle;
        if (cp_rectangle_separation(&body, &other_body) <= 0.0)
            return true;
    }
    return false;
}

// Whether what the car was warned of comes: the two touch, or one of the drivers brakes harder than
// at ease. The own car's braking counts as long as it is not for the warning.
static void look_back(function_host *host, const cp_vehicle_motion *motion, host_car *car)
{
    const double hard_m_s2 = CP_LOOKOUT_EASY_BRAKING_M_S2 + HARDER_M_S2;
    if (!(cp_traffic_time_s(host->traffic) <= car->until_s))
        return;
    const cp_vehicle_motion *target = car->warned_of != CRASHPULSE_NOBODY
                                          ? cp_traffic_motion_of(host->traffic, car->warned_of)
                                          : NULL;
    bool comes = !car->braking.is_braking && motion->after.acceleration_m_s2 < -hard_m_s2;
    if (target != NULL)
        comes |= target->after.acceleration_m_s2 < -hard_m_s2 || have_touched(motion, target);
    host->counts.warnings_borne_out += comes;
    if (comes || target == NULL)
        car->until_s = 0.0;
}

// Deceleration that the host holds for the function at the end of the step.
static double held_m_s2(const host_car *car, double now_s)
{
    return car->braking.is_requesting ? cp_brake_deceleration_m_s2(&car->braking.brake, now_s)
                                      : 0.0;
}

// The function's step, and what of it can be wrong.
static cp_status ask(function_host *host, host_car *car, const cp_vehicle_motion *motion,
                     crashpulse_request *request, cp_error *error)
{
    char whom[160], wrong[256];
    double now_s = cp_traffic_time_s(host->traffic);
    *request = cp_function_request_none();
    crashpulse_view view = cp_function_view(&host->senses, motion);
    view.brake_m_s2 = held_m_s2(car, now_s);
    view.counter = host->counter;
    if (host->library != NULL)
        snprintf(whom, sizeof whom, "vehicle '%s'", view.id);
    enter(host, whom, now_s);
    const char *said = host->function->step(host->self, memory_of(car), &view, request);
    leave(host);
    cp_status status = cp_function_senses_end(&host->senses, error);
    if (status != CP_OK)
        return status;
    if (said == NULL &&
        cp_function_request_check(request, host->function->does, wrong, sizeof wrong))
        return CP_OK;
    snprintf(whom, sizeof whom, "vehicle '%s'", view.id);
    return fail_call(host, whom, said != NULL ? said : wrong, error);
}

static cp_status step_equipped(void *state, const void *context, const cp_vehicle_motion *motion,
                               cp_error *error)
{
    function_host *host = state;
    crashpulse_request request;
    void *item;
    cp_status status = cp_vehicle_table_take(&host->cars, motion->after.vehicle, &item, error);
    if (status != CP_OK)
        return status;
    host_car *car = item;
    car->host = host;
    if (host->function->does & CRASHPULSE_WARNS)
        look_back(host, motion, car);
    status = ask(host, car, motion, &request, error);
    return status == CP_OK ? carry_out(host, context, car, motion, &request, error) : status;
}

// What a library's calls let the process grow by; what was free before is not seen.
static cp_status check_memory(function_host *host, double before_mb, cp_error *error)
{
    char wrong[128];
    double limit_mb = host->parameters.host[CP_HOST_MEMORY_LIMIT_MB];
    host->grown_mb += memory_mb(host) - before_mb;
    if (host->library == NULL || host->grown_mb <= limit_mb)
        return CP_OK;
    snprintf(wrong, sizeof wrong,
             "it leaks: memory has grown by more than %g MB in its calls (memory_limit_mb)",
             limit_mb);
    return fail_call(host, "all vehicles", wrong, error);
}

cp_status cp_function_host_step(void *state, const cp_control_context *context, cp_error *error)
{
    function_host *host = state;
    if (!cp_equipment_is_any(context->equipment))
        return CP_OK;
    double before_mb = memory_mb(host);
    cp_status status = cp_vehicle_table_prune(&host->cars, host->traffic, error);
    if (status == CP_OK)
        status = cp_equipment_each(context->equipment, host->traffic, step_equipped, host, context,
                                   error);
    return status == CP_OK ? check_memory(host, before_mb, error) : status;
}

// ---- counters ------------------------------------------------------------------------------

/* Where counters are put. */
typedef struct counter_list {
    const char **names;
    double *values;
    size_t count, room;
} counter_list;

static void put(counter_list *list, const char *name, double value)
{
    if (list->count == list->room)
        return;
    list->names[list->count] = name;
    list->values[list->count++] = value;
}

size_t cp_function_host_counters(const void *state, const char **names, double *values, size_t room)
{
    const function_host *host = state;
    const host_counts *counts = &host->counts;
    const uint32_t does = host->function->does;
    counter_list list = {.names = names, .values = values, .room = room};
    if (does & CRASHPULSE_BRAKES) {
        put(&list, "activations", (double)counts->activations);
        put(&list, "activations_rear_end", (double)counts->of_class[CP_TARGET_REAR_END]);
        put(&list, "activations_oncoming", (double)counts->of_class[CP_TARGET_ONCOMING]);
        put(&list, "activations_crossing", (double)counts->of_class[CP_TARGET_CROSSING]);
        put(&list, "activations_turning", (double)counts->of_class[CP_TARGET_TURNING]);
        put(&list, "activations_without_error", (double)counts->activations_without_error);
        put(&list, "activations_for_nothing", (double)counts->for_nothing);
    }
    if (does & (CRASHPULSE_BRAKES | CRASHPULSE_DRIVER_BRAKES))
        put(&list, "braking_s", counts->braking_s);
    if (does & CRASHPULSE_WARNS) {
        put(&list, "warnings", (double)counts->warnings);
        put(&list, "warnings_without_error", (double)counts->warnings_without_error);
        put(&list, "warnings_borne_out", (double)counts->warnings_borne_out);
    }
    if (does & CRASHPULSE_STEERS)
        put(&list, "interventions", (double)counts->interventions);
    if (does & CRASHPULSE_LIMITS)
        put(&list, "limited_vehicles", (double)counts->limited);
    for (size_t k = 0; k < host->function->counter_count; k++)
        put(&list, host->function->counter_names[k], host->counter[k]);
    return list.count;
}
