/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/function_host.h"

#include "core/geometry.h"
#include "core/units.h"
#include "traffic/lateral_overlay.h"

#include <stdlib.h>

/* Emergency lane keeping against drifting into oncoming traffic. It watches cars that drift off
 * their path (traffic/lateral_overlay.h). When the side that drifts is about to cross the edge of
 * its lane while a known oncoming vehicle is about to pass, it takes over the steering after
 * latency and dead time and leads the car back to its path, along a cubic as short as its lateral
 * acceleration allows; then the driver, alert again, has the steering back. It does not brake. */

enum {
    PENETRATION_1,
    LINE_CROSSING_S,
    ONCOMING_S,
    LATERAL_ACCELERATION_M_S2,
    DEAD_TIME_S,
    SPEED_MIN_M_S,
    SPEED_MAX_M_S,
    RANGE_M,
    FIELD_OF_VIEW_DEG,
    LATENCY_S,
    CONFIRMATION_S,
    DETECTION_PROBABILITY_1,
    OCCLUSION_1
};

static const cp_control_parameter PARAMETERS[] = {
    [PENETRATION_1] = CP_CONTROL_PENETRATION,
    [LINE_CROSSING_S] = {"line_crossing_s", 0.3, -2.0, 5.0,
                         "acts when the drifting side crosses the edge of its lane within this, s; "
                         "below 0: has crossed it that long ago (assumed)"},
    [ONCOMING_S] = {"oncoming_s", 6.0, 0.1, 30.0,
                    "and a known oncoming vehicle is abreast within this at the speeds of now, s "
                    "(assumed)"},
    [LATERAL_ACCELERATION_M_S2] = {"lateral_acceleration_m_s2", 3.0, 0.5, 9.0,
                                   "largest lateral acceleration on the way back, m/s^2 (assumed; "
                                   "UN Regulation 79 allows 3)"},
    [DEAD_TIME_S] = {"dead_time_s", 0.1, 0.0, 2.0, "from request to steering, s (assumed)"},
    [SPEED_MIN_M_S] = {"speed_min_m_s", 16.0, 0.0, 100.0,
                       "does not act below this own speed, m/s (assumed; Euro NCAP tests at 20)"},
    [SPEED_MAX_M_S] = {"speed_max_m_s", 50.0, 0.0, 200.0,
                       "does not act above this own speed, m/s (assumed)"},
    [RANGE_M] = {"sensor_range_m", 200.0, 1.0, 500.0, "how far the sensor sees, m (assumed)"},
    [FIELD_OF_VIEW_DEG] = {"sensor_field_of_view_deg", 60.0, 1.0, 360.0,
                           "whole opening angle of the sensor, degrees (assumed)"},
    [LATENCY_S] = {"sensor_latency_s", 0.1, 0.0, 2.0, "age of what the sensor tells, s (assumed)"},
    [CONFIRMATION_S] = {"sensor_confirmation_s", 0.2, 0.0, 5.0,
                        "a target is known after this long in view without a break, s (assumed)"},
    [DETECTION_PROBABILITY_1] = {"sensor_detection_probability_1", 1.0, 0.0, 1.0,
                                 "chance that one particular target is ever detected, drawn once "
                                 "per pair of vehicles (assumed)"},
    [OCCLUSION_1] = {"sensor_occlusion_1", 1.0, 0.0, 1.0,
                     "1: other vehicles hide what is behind them; 0: nothing hides anything"},
};

typedef enum phase { WATCHING, REQUESTING, STEERING } phase;

/* The function in one car. */
typedef struct elk_car {
    phase phase;
    double steer_from_s;  /* clock */
    double return_left_m; /* way until back on the path */
} elk_car;

typedef struct elk {
    const double *parameter;
} elk;

static const char *create(const crashpulse_setup *setup, crashpulse_outlook *outlook, void **state)
{
    elk *created = calloc(1, sizeof *created);
    if (!created)
        return "out of memory";
    created->parameter = setup->parameter;
    outlook->horizon_s = setup->parameter[ONCOMING_S];
    *state = created;
    return NULL;
}

// Time until the drifting side crosses the edge of its lane, negative since when; INFINITY when the
// car does not drift outwards. The path is taken to be the middle of the lane.
static double line_crossing_s(const crashpulse_view *view)
{
    double outwards_m_s = view->drift_1 * view->speed_m_s;
    if (outwards_m_s == 0.0 || outwards_m_s * view->drift_m < 0.0)
        return INFINITY;
    double margin_m = 0.5 * (view->host->lane_width_m(view) - view->width_m);
    return (margin_m - fabs(view->drift_m)) / fabs(outwards_m_s);
}

// Whether the drift leads to the side on which a known oncoming vehicle is about to pass.
static bool is_oncoming(const elk *self, const crashpulse_view *view,
                        const crashpulse_object *objects, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        const crashpulse_object *other = &objects[k];
        double closing_m_s = view->speed_m_s + other->speed_m_s;
        if (fabs(other->heading_rad) > 0.75 * CP_PI && other->ahead_m > 0.0 &&
            other->left_m * view->drift_1 > 0.0 &&
            other->ahead_m < closing_m_s * self->parameter[ONCOMING_S])
            return true;
    }
    return false;
}

// The shortest way back that keeps within the lateral acceleration. Of the cubic with offset y and
// slope k over the length l the second derivative is largest at one of its ends: |6 y / l^2 + 4 k /
// l| or |6 y / l^2 + 2 k / l|, times v^2.
static double return_way_m(cp_lateral_overlay overlay, double speed_m_s, double limit_m_s2)
{
    double way_m = fmax(speed_m_s, 1.0) * 0.2;
    for (; way_m < 1000.0; way_m *= 1.02) {
        double base_1_m = 6.0 * overlay.offset_m / (way_m * way_m);
        double at_start_1_m = fabs(base_1_m + 4.0 * overlay.slope_1 / way_m);
        double at_end_1_m = fabs(base_1_m + 2.0 * overlay.slope_1 / way_m);
        if (fmax(at_start_1_m, at_end_1_m) * speed_m_s * speed_m_s <= limit_m_s2)
            break;
    }
    return way_m;
}

static void watch(const elk *self, elk_car *car, const crashpulse_view *view)
{
    const double *parameter = self->parameter;
    const crashpulse_object *objects;
    size_t count = view->host->look(view, &objects);
    double crossing_s = line_crossing_s(view);
    if (view->speed_m_s < parameter[SPEED_MIN_M_S] || view->speed_m_s > parameter[SPEED_MAX_M_S] ||
        !(crossing_s < parameter[LINE_CROSSING_S]) || !is_oncoming(self, view, objects, count))
        return;
    // It falls by a second each second: the threshold was crossed inside the step.
    double back_s = fmin(parameter[LINE_CROSSING_S] - crossing_s, view->step_s);
    car->phase = REQUESTING;
    car->steer_from_s = view->time_s - back_s + parameter[LATENCY_S] + parameter[DEAD_TIME_S];
}

static void steer(const elk *self, elk_car *car, const crashpulse_view *view,
                  crashpulse_request *request)
{
    cp_lateral_overlay now = {view->drift_m, view->drift_1};
    request->steer_since_s = car->steer_from_s;
    if (car->phase == REQUESTING) {
        car->phase = STEERING;
        car->return_left_m =
            return_way_m(now, view->speed_m_s, self->parameter[LATERAL_ACCELERATION_M_S2]);
    }
    if (car->return_left_m <= 0.0) {
        request->is_back = true;
        car->phase = WATCHING;
        return;
    }
    double way_m = view->speed_m_s * view->step_s;
    cp_lateral_overlay_return(now, car->return_left_m, way_m, &request->steer_mean_1,
                              &request->steer_end_1);
    car->return_left_m -= way_m;
}

static const char *step(void *state, void *item, const crashpulse_view *view,
                        crashpulse_request *request)
{
    const elk *self = state;
    elk_car *car = item;
    // Nobody is looked for while the car does not drift.
    if (car->phase == WATCHING && view->drift_1 != 0.0)
        watch(self, car, view);
    if (car->phase == WATCHING)
        return NULL;
    if (car->steer_from_s < view->time_s + view->step_s)
        steer(self, car, view, request);
    else // instant of the request
        request->announced_s =
            car->steer_from_s - self->parameter[LATENCY_S] - self->parameter[DEAD_TIME_S];
    return NULL;
}

static const crashpulse_function ELK = {
    .abi = CRASHPULSE_FUNCTION_ABI,
    .does = CRASHPULSE_STEERS,
    .what = "emergency lane keeping against drifting into oncoming traffic",
    .parameters = PARAMETERS,
    .parameter_count = sizeof PARAMETERS / sizeof *PARAMETERS,
    .car_size = sizeof(elk_car),
    .create = create,
    .step = step,
    .destroy = free,
};

CP_FUNCTION_TYPE(CP_CONTROL_ELK, "elk", ELK, PARAMETERS,
                 "emergency lane keeping against drifting into oncoming traffic", false)
