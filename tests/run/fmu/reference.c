/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "api/crashpulse/function.h"

#include "rule.h"

/* The unit's rule as a function: what the bridge has to come to. */

enum { TTC_S, RANGE_M };
static const crashpulse_parameter PARAMETERS[] = {
    [TTC_S] = {"ttc_s", 1.0, 0.0, 10.0, "as the unit's"},
    [RANGE_M] = {"sensor_range_m", 100.0, 1.0, 500.0, "as the bridge's"},
};

typedef struct car {
    rule_state state;
    bool is_braking;
    double since_s;
} car;

static const char *create(const crashpulse_setup *setup, crashpulse_outlook *outlook, void **self)
{
    outlook->ttc_s = 3.0;
    outlook->required_m_s2 = 0.0;
    *self = (void *)setup->parameter;
    return NULL;
}

static const char *step(void *self, void *memory, const crashpulse_view *view,
                        crashpulse_request *request)
{
    const double *parameter = self;
    const crashpulse_object *object, *nearest = NULL;
    crashpulse_threat threat;
    car *own = memory;
    double nearest_m2 = INFINITY;
    size_t count = view->host->look(view, &object);
    for (size_t k = 0; k < count; k++) {
        double m2 = object[k].ahead_m * object[k].ahead_m + object[k].left_m * object[k].left_m;
        if (m2 < nearest_m2 || (m2 == nearest_m2 && object[k].id < nearest->id)) {
            nearest = &object[k];
            nearest_m2 = m2;
        }
    }
    double brake_m_s2 =
        rule_brake_m_s2(&own->state, parameter[TTC_S], view->step_s, view->speed_m_s,
                        nearest ? nearest->ahead_m : 1e6, nearest ? nearest->left_m : 0.0,
                        nearest ? nearest->heading_rad : 0.0, nearest ? nearest->speed_m_s : 0.0);
    if (brake_m_s2 > 0.0 && !own->is_braking)
        own->since_s = view->time_s;
    own->is_braking = brake_m_s2 > 0.0;
    if (own->is_braking) {
        request->acceleration_m_s2 = -brake_m_s2;
        request->since_s = own->since_s;
    }
    if (view->host->threat(view, &threat)) {
        request->target = threat.id;
        request->target_ttc_s = threat.ttc_s;
    }
    return NULL;
}

static const crashpulse_function REFERENCE = {
    .abi = CRASHPULSE_FUNCTION_ABI,
    .does = CRASHPULSE_BRAKES | CRASHPULSE_WARNS,
    .what = "the rule of the unit",
    .parameters = PARAMETERS,
    .parameter_count = sizeof PARAMETERS / sizeof *PARAMETERS,
    .car_size = sizeof(car),
    .create = create,
    .step = step,
};

const crashpulse_function *crashpulse_function_entry(void)
{
    return &REFERENCE;
}
