/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/function_host.h"

#include "control/acting.h"
#include "control/function_actions.h"
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

#define CAR_ALIGNMENT 16 /* of the function's memory */

_Static_assert((int)CRASHPULSE_REAR_END == (int)CP_TARGET_REAR_END &&
                   (int)CRASHPULSE_ONCOMING == (int)CP_TARGET_ONCOMING &&
                   (int)CRASHPULSE_CROSSING == (int)CP_TARGET_CROSSING &&
                   (int)CRASHPULSE_TURNING == (int)CP_TARGET_TURNING &&
                   (int)CRASHPULSE_CLASSES == (int)CP_TARGET_CLASSES,
               "classes of targets are the same on both sides");

typedef struct function_host {
    const crashpulse_function *function;
    const cp_library *library; /* NULL: one of ours */
    const char *name;
    const cp_traffic *traffic;
    cp_function_parameters parameters;
    void *self;
    cp_vehicle_table cars; /* a host_car of each, the function's memory behind it */
    cp_function_senses senses;
    double *counter; /* the function's own */
    cp_function_actions actions;
    fenv_t arithmetic; /* how numbers are rounded here */
    double grown_mb;   /* memory, during calls of a library */
} function_host;

/* One car. */
typedef struct host_car {
    function_host *host; /* NULL: the function has not seen it */
    cp_function_car does;
} host_car;

// Rows of cars lie one behind the other: all that is in them stands on even addresses.
static size_t aligned(size_t size)
{
    return (size + CAR_ALIGNMENT - 1) / CAR_ALIGNMENT * CAR_ALIGNMENT;
}

static void *memory_of(host_car *car)
{
    return (unsigned char *)car + aligned(sizeof *car);
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
        .brake_delay_s = host->actions.brake_delay_s,
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
    host->actions.senses = &host->senses;
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
    host->actions.traffic = host->traffic;
    host->actions.does = host->function->does;
    host->actions.jerk_m_s3 = parameter[CP_HOST_JERK_M_S3];
    host->actions.friction_m_s2 = parameter[CP_HOST_FRICTION_1] * CP_G0_M_S2;
    if (!(host->function->does & CRASHPULSE_DRIVER_BRAKES))
        host->actions.brake_delay_s = parameter[CP_HOST_LATENCY_S] + parameter[CP_HOST_DEAD_TIME_S];
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
        host->cars = cp_vehicle_table_create(
            aligned(sizeof(host_car)) + aligned(host->function->car_size), release_car);
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

// ---- steps ---------------------------------------------------------------------------------

// The function's step, and what of it can be wrong.
static cp_status ask(function_host *host, host_car *car, const cp_vehicle_motion *motion,
                     crashpulse_request *request, cp_error *error)
{
    char whom[160], wrong[256];
    double now_s = cp_traffic_time_s(host->traffic);
    *request = cp_function_request_none();
    crashpulse_view view = cp_function_view(&host->senses, motion);
    view.brake_m_s2 = cp_function_held_m_s2(&car->does, now_s);
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
        cp_function_look_back(&host->actions, motion, &car->does);
    status = ask(host, car, motion, &request, error);
    return status == CP_OK
               ? cp_function_carry_out(&host->actions, context, &car->does, motion, &request, error)
               : status;
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

size_t cp_function_host_counters(const void *state, const char **names, double *values, size_t room)
{
    const function_host *host = state;
    return cp_function_counts_list(&host->actions.counts, host->function, host->counter, names,
                                   values, room);
}
