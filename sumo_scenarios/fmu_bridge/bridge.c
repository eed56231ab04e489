/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "unit.h"

#include <crashpulse/function.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A function whose decisions a functional mock-up unit makes (README.md). Each car has an instance.
 * After every step its inputs are set, it makes a step of the same length, and its outputs are what
 * is requested for the coming one. Names are the interface: what a unit does not have is not told.
 */

#define OBJECTS 8
#define FAR_S 1e6 /* threat_ttc_s when there is none */

/* Inputs that are told, object ones for each of OBJECTS. */
enum { SPEED, ACCELERATION, YAW_RATE, COUNT, LANE_LEFT, CURVATURE, LIMIT, THREAT_TTC, INPUTS };
static const char *const INPUT[INPUTS] = {
    [SPEED] = "own_speed_m_s",         [ACCELERATION] = "own_acceleration_m_s2",
    [YAW_RATE] = "own_yaw_rate_rad_s", [COUNT] = "object_count",
    [LANE_LEFT] = "lane_left_m",       [CURVATURE] = "curvature_1_m",
    [LIMIT] = "speed_limit_m_s",       [THREAT_TTC] = "threat_ttc_s"};

enum { AHEAD, LEFT, HEADING, OBJECT_SPEED, OBJECT_ACCELERATION, LENGTH, WIDTH, PROPERTIES };
static const char *const PROPERTY[PROPERTIES] = {[AHEAD] = "ahead_m",
                                                 [LEFT] = "left_m",
                                                 [HEADING] = "heading_rad",
                                                 [OBJECT_SPEED] = "speed_m_s",
                                                 [OBJECT_ACCELERATION] = "acceleration_m_s2",
                                                 [LENGTH] = "length_m",
                                                 [WIDTH] = "width_m"};

enum { BRAKE, WARNING, OUTPUTS };
static const char *const OUTPUT[OUTPUTS] = {[BRAKE] = "brake_m_s2", [WARNING] = "warning_1"};

enum { RANGE_M, THREAT_WITHIN_S };
static const crashpulse_parameter PARAMETERS[] = {
    [RANGE_M] = {"sensor_range_m", 100.0, 1.0, 500.0, "the host's sensor, m (assumed)"},
    [THREAT_WITHIN_S] = {"threat_within_s", 3.0, 0.1, 10.0,
                         "threat_ttc_s tells of threats within this, s (assumed)"},
};

/* A parameter of the unit and its value. */
typedef struct setting {
    fmi_reference reference;
    double value;
} setting;

typedef struct bridge {
    fmu_unit unit;
    setting *setting;
    size_t setting_count;
    const fmu_variable *input[INPUTS];
    const fmu_variable *object[OBJECTS][PROPERTIES];
    const fmu_variable *output[OUTPUTS];
    char wrong[1024]; /* last message */
} bridge;

typedef struct car {
    fmi_component instance;
    bool is_warning, is_braking;
    double warned_s, since_s;
} car;

// ---- beginning and end ---------------------------------------------------------------------

static const char *fail(bridge *self, const char *what, const char *name)
{
    snprintf(self->wrong, sizeof self->wrong, "%s%s%s", what, name != NULL ? ": " : "",
             name != NULL ? name : "");
    return self->wrong;
}

static void find_variables(bridge *self)
{
    for (int k = 0; k < INPUTS; k++)
        self->input[k] = fmu_find(&self->unit, INPUT[k], "input");
    for (int k = 0; k < OUTPUTS; k++)
        self->output[k] = fmu_find(&self->unit, OUTPUT[k], "output");
    for (int object = 0; object < OBJECTS; object++) {
        for (int k = 0; k < PROPERTIES; k++) {
            char name[64];
            snprintf(name, sizeof name, "object%d_%s", object + 1, PROPERTY[k]);
            self->object[object][k] = fmu_find(&self->unit, name, "input");
        }
    }
}

// Keys of the study that are not the host's are the unit's parameters.
static const char *take_settings(bridge *self, const crashpulse_setup *setup)
{
    self->setting = calloc(setup->extra_count + 1, sizeof *self->setting);
    if (self->setting == NULL)
        return "out of memory";
    for (size_t k = 0; k < setup->extra_count; k++) {
        const crashpulse_extra *extra = &setup->extra[k];
        const fmu_variable *variable = fmu_find(&self->unit, extra->name, "parameter");
        if (variable == NULL)
            return fail(self, "the unit has no real parameter of this name", extra->name);
        if (isnan(extra->number))
            return fail(self, "must be a number", extra->name);
        self->setting[self->setting_count++] = (setting){variable->reference, extra->number};
    }
    return NULL;
}

// What is wrong is told until the next beginning; the process that was told ends soon.
static const char *create(const crashpulse_setup *setup, crashpulse_outlook *outlook, void **state)
{
    bridge *self = calloc(1, sizeof *self);
    if (self == NULL)
        return "out of memory";
    *state = self; // the host destroys it, whatever comes
    if (setup->data == NULL)
        return "names no unit: the study's key 'data' is an .fmu file, or a modelDescription.xml";
    const char *wrong = fmu_open(setup->data, &self->unit);
    if (wrong != NULL)
        return fail(self, setup->data, wrong);
    find_variables(self);
    if (self->output[BRAKE] == NULL && self->output[WARNING] == NULL)
        return "the unit has neither the output brake_m_s2 nor warning_1";
    outlook->ttc_s = setup->parameter[THREAT_WITHIN_S];
    outlook->horizon_s = fmax(outlook->horizon_s, outlook->ttc_s + 1.0);
    outlook->required_m_s2 = 0.0;
    return take_settings(self, setup);
}

static void destroy(void *state)
{
    bridge *self = state;
    fmu_close(&self->unit);
    free(self->setting);
    free(self);
}

static void leave(void *state, void *memory)
{
    bridge *self = state;
    car *own = memory;
    if (own->instance != NULL)
        fmu_destroy(&self->unit, own->instance);
    own->instance = NULL;
}

static bool begin(bridge *self, car *own, const crashpulse_view *view)
{
    own->instance = fmu_create(&self->unit, view->id);
    bool good = own->instance != NULL && fmu_begin(&self->unit, own->instance, view->time_s);
    for (size_t k = 0; good && k < self->setting_count; k++)
        good =
            fmu_set(&self->unit, own->instance, self->setting[k].reference, self->setting[k].value);
    return good && fmu_started(&self->unit, own->instance);
}

// ---- steps ---------------------------------------------------------------------------------

static int by_distance(const void *one, const void *other)
{
    const crashpulse_object *a = one, *b = other;
    double difference_m2 = (a->ahead_m * a->ahead_m + a->left_m * a->left_m) -
                           (b->ahead_m * b->ahead_m + b->left_m * b->left_m);
    return difference_m2 != 0.0 ? (difference_m2 > 0.0) - (difference_m2 < 0.0)
                                : (a->id > b->id) - (a->id < b->id);
}

// The nearest objects, near ones first; of those there are not, all is 0 but far ahead.
static bool tell_objects(const bridge *self, const car *own, const crashpulse_object *nearest,
                         size_t count)
{
    bool good = true;
    for (size_t object = 0; object < OBJECTS; object++) {
        const crashpulse_object *o = object < count ? &nearest[object] : NULL;
        const double value[PROPERTIES] = {[AHEAD] = o != NULL ? o->ahead_m : 1e6,
                                          [LEFT] = o != NULL ? o->left_m : 0.0,
                                          [HEADING] = o != NULL ? o->heading_rad : 0.0,
                                          [OBJECT_SPEED] = o != NULL ? o->speed_m_s : 0.0,
                                          [OBJECT_ACCELERATION] =
                                              o != NULL ? o->acceleration_m_s2 : 0.0,
                                          [LENGTH] = o != NULL ? o->length_m : 0.0,
                                          [WIDTH] = o != NULL ? o->width_m : 0.0};
        for (int k = 0; good && k < PROPERTIES; k++)
            if (self->object[object][k] != NULL)
                good = fmu_set(&self->unit, own->instance, self->object[object][k]->reference,
                               value[k]);
    }
    return good;
}

static bool tell_world(const bridge *self, const car *own, const crashpulse_view *view,
                       crashpulse_threat *threat, bool *is_threat)
{
    const crashpulse_object *known;
    crashpulse_object sorted[64];
    crashpulse_road road = {.speed_limit_m_s = INFINITY};
    size_t count = view->host->look(view, &known);
    count = count < sizeof sorted / sizeof *sorted ? count : sizeof sorted / sizeof *sorted;
    if (count > 0)
        memcpy(sorted, known, count * sizeof *sorted);
    qsort(sorted, count, sizeof *sorted, by_distance);
    *is_threat = view->host->threat(view, threat);
    bool is_road = (self->input[LANE_LEFT] || self->input[CURVATURE] || self->input[LIMIT]) &&
                   view->host->road(view, &road);
    const double value[INPUTS] = {
        [SPEED] = view->speed_m_s,
        [ACCELERATION] = view->acceleration_m_s2,
        [YAW_RATE] = view->yaw_rate_rad_s,
        [COUNT] = (double)count,
        [LANE_LEFT] = is_road ? road.lane_left_m : 0.0,
        [CURVATURE] = is_road ? road.point[0].curvature_1_m : 0.0,
        [LIMIT] = is_road && isfinite(road.speed_limit_m_s) ? road.speed_limit_m_s : 1e3,
        [THREAT_TTC] = *is_threat ? threat->ttc_s : FAR_S};
    bool good = tell_objects(self, own, sorted, count);
    for (int k = 0; good && k < INPUTS; k++)
        if (self->input[k] != NULL)
            good = fmu_set(&self->unit, own->instance, self->input[k]->reference, value[k]);
    return good;
}

// What the unit says, as a request. A number that is none is for the host to find.
static bool ask(const bridge *self, car *own, const crashpulse_view *view,
                crashpulse_request *request)
{
    double said[OUTPUTS] = {0.0, 0.0};
    for (int k = 0; k < OUTPUTS; k++)
        if (self->output[k] != NULL &&
            !fmu_get(&self->unit, own->instance, self->output[k]->reference, &said[k]))
            return false;
    bool brakes = !(said[BRAKE] <= 0.0), warns = said[WARNING] > 0.5;
    if (brakes && !own->is_braking)
        own->since_s = view->time_s;
    if (warns && !own->is_warning)
        own->warned_s = view->time_s;
    own->is_braking = brakes;
    own->is_warning = warns;
    if (brakes) {
        request->acceleration_m_s2 = -said[BRAKE];
        request->since_s = own->since_s;
    }
    if (warns)
        request->warned_s = own->warned_s;
    return true;
}

static const char *step(void *state, void *memory, const crashpulse_view *view,
                        crashpulse_request *request)
{
    bridge *self = state;
    car *own = memory;
    crashpulse_threat threat;
    bool is_threat = false;
    if (own->instance == NULL && !begin(self, own, view))
        return "the unit cannot be instantiated";
    if (!tell_world(self, own, view, &threat, &is_threat))
        return "the unit does not take an input";
    if (!fmu_step(&self->unit, own->instance, view->time_s, view->step_s))
        return "the unit does not make a step";
    if (!ask(self, own, view, request))
        return "the unit does not give an output";
    if (is_threat) {
        request->target = threat.id;
        request->target_ttc_s = threat.ttc_s;
    }
    return NULL;
}

static const crashpulse_function BRIDGE = {
    .abi = CRASHPULSE_FUNCTION_ABI,
    .does = CRASHPULSE_BRAKES | CRASHPULSE_WARNS | CRASHPULSE_ANY_PARAMETER,
    .what = "what a functional mock-up unit decides",
    .parameters = PARAMETERS,
    .parameter_count = sizeof PARAMETERS / sizeof *PARAMETERS,
    .car_size = sizeof(car),
    .create = create,
    .step = step,
    .leave = leave,
    .destroy = destroy,
};

const crashpulse_function *crashpulse_function_entry(void)
{
    return &BRIDGE;
}
