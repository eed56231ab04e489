/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/acts.h"

#include <math.h>

/* The last two acts of one car: one that begins in the very step of a crash may come after it. */
typedef struct acting_car {
    cp_act act[2]; /* the last one first */
} acting_car;

static const cp_act NO_ACT = {
    .since_s = {NAN, NAN, NAN, NAN, NAN},
    .last_s = -INFINITY,
    .speed_m_s = NAN,
    .deceleration_m_s2 = -INFINITY,
    .requested_at_s = {-INFINITY, -INFINITY},
};

cp_acts cp_acts_create(const cp_traffic *traffic)
{
    return (cp_acts){traffic, cp_vehicle_table_create(sizeof(acting_car), NULL)};
}

void cp_acts_destroy(cp_acts *acts)
{
    cp_vehicle_table_destroy(&acts->cars);
}

// Whether an act was noted in the last step but that of now, or now.
static bool goes_on(const cp_acts *acts, const cp_act *act)
{
    return cp_traffic_time_s(acts->traffic) - act->last_s <
           1.5 * cp_traffic_step_length_s(acts->traffic);
}

cp_status cp_acts_step(cp_acts *acts, cp_error *error)
{
    cp_status status = cp_vehicle_table_prune(&acts->cars, acts->traffic, error);
    for (size_t k = 0; status == CP_OK && k < acts->cars.count; k++) {
        uint32_t vehicle = acts->cars.vehicles[k];
        acting_car *car = cp_vehicle_table_find(&acts->cars, vehicle);
        const cp_vehicle_motion *motion = cp_traffic_motion_of(acts->traffic, vehicle);
        if (!isnan(car->act[0].since_s[CP_ACT_BRAKING]) && goes_on(acts, &car->act[0]))
            car->act[0].deceleration_m_s2 =
                fmax(car->act[0].deceleration_m_s2, -motion->after.acceleration_m_s2);
    }
    return status;
}

// The act that is going on, or a new one.
static cp_status take(cp_acts *acts, uint32_t vehicle, cp_act **act, cp_error *error)
{
    void *item;
    bool is_new = cp_vehicle_table_find(&acts->cars, vehicle) == NULL;
    cp_status status = cp_vehicle_table_take(&acts->cars, vehicle, &item, error);
    if (status != CP_OK)
        return status;
    acting_car *car = item;
    if (is_new)
        car->act[0] = car->act[1] = NO_ACT;
    if (!goes_on(acts, &car->act[0])) {
        double limiting_since_s = car->act[0].since_s[CP_ACT_LIMITING];
        car->act[1] = car->act[0];
        car->act[0] = NO_ACT;
        car->act[0].since_s[CP_ACT_LIMITING] = limiting_since_s;
    }
    *act = &car->act[0];
    return CP_OK;
}

cp_status cp_acts_note(cp_acts *acts, uint32_t vehicle, cp_act_kind kind, double since_s,
                       cp_error *error)
{
    cp_act *act;
    if (acts == NULL)
        return CP_OK;
    cp_status status = take(acts, vehicle, &act, error);
    if (status != CP_OK)
        return status;
    if (isnan(act->since_s[kind]))
        act->since_s[kind] = since_s;
    if (kind != CP_ACT_LIMITING)
        act->last_s = cp_traffic_time_s(acts->traffic);
    return CP_OK;
}

cp_status cp_acts_brake(cp_acts *acts, uint32_t vehicle, double since_s, double deceleration_m_s2,
                        cp_error *error)
{
    cp_act *act;
    if (acts == NULL)
        return CP_OK;
    cp_status status = take(acts, vehicle, &act, error);
    if (status != CP_OK)
        return status;
    double now_s = cp_traffic_time_s(acts->traffic);
    const cp_vehicle_motion *motion = cp_traffic_motion_of(acts->traffic, vehicle);
    if (isnan(act->since_s[CP_ACT_BRAKING])) {
        act->since_s[CP_ACT_BRAKING] = since_s;
        act->speed_m_s = motion != NULL ? motion->after.speed_m_s : NAN;
    }
    // Asked twice in a step: the harder one holds.
    if (act->requested_at_s[0] != now_s) {
        act->request_m_s2[1] = act->request_m_s2[0];
        act->requested_at_s[1] = act->requested_at_s[0];
        act->request_m_s2[0] = 0.0;
        act->requested_at_s[0] = now_s;
    }
    act->request_m_s2[0] = fmax(act->request_m_s2[0], deceleration_m_s2);
    act->last_s = now_s;
    return CP_OK;
}

// ---- asking --------------------------------------------------------------------------------

// Time from the beginning of a kind of act to the instant; NAN: it had not begun.
static double before_s(const cp_act *act, cp_act_kind kind, double instant_s)
{
    double since_s = act->since_s[kind];
    return since_s <= instant_s ? instant_s - since_s : NAN;
}

static bool has_begun(const cp_act *act, double instant_s)
{
    for (int kind = 0; kind < CP_ACT_KINDS; kind++)
        if (kind != CP_ACT_LIMITING && act->since_s[kind] <= instant_s)
            return true;
    return false;
}

static cp_act_state state_of(const cp_act_at *at)
{
    if (!isnan(at->released_s))
        return CP_ACT_RELEASED;
    if (!isnan(at->steering_s))
        return CP_ACT_STEERED;
    if (!isnan(at->braking_s))
        return CP_ACT_BRAKED;
    return isnan(at->requested_s) ? CP_ACT_WARNED : CP_ACT_REQUESTED;
}

// Commands of the step before the last hold in the last, within which the instant lies.
static double request_in_force(const cp_acts *acts, const cp_act *act)
{
    double step_s = cp_traffic_step_length_s(acts->traffic);
    double given_s = cp_traffic_time_s(acts->traffic) - step_s;
    for (int k = 0; k < 2; k++)
        if (fabs(act->requested_at_s[k] - given_s) < 0.5 * step_s)
            return act->request_m_s2[k];
    return NAN;
}

cp_act_at cp_acts_at(const cp_acts *acts, uint32_t vehicle, double instant_s, double speed_m_s)
{
    cp_act_at at = {CP_ACT_IDLE, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    const acting_car *car = cp_vehicle_table_find(&acts->cars, vehicle);
    if (car == NULL)
        return at;
    const cp_act *act = has_begun(&car->act[0], instant_s) ? &car->act[0] : &car->act[1];
    bool is_limited = car->act[0].since_s[CP_ACT_LIMITING] <= instant_s;
    double step_s = cp_traffic_step_length_s(acts->traffic);
    double end_s = act->last_s + step_s;
    if (!has_begun(act, instant_s) || instant_s - end_s > CP_ACTS_MEMORY_S) {
        at.state = is_limited ? CP_ACT_LIMITED : CP_ACT_IDLE;
        return at;
    }
    // What was noted at the end of the step before the instant, or of its own, is going on.
    if (cp_traffic_time_s(acts->traffic) - act->last_s > 1.5 * step_s)
        at.released_s = fmax(instant_s - end_s, 0.0);
    at.warned_s = before_s(act, CP_ACT_WARNING, instant_s);
    at.requested_s = before_s(act, CP_ACT_REQUEST, instant_s);
    at.braking_s = before_s(act, CP_ACT_BRAKING, instant_s);
    at.steering_s = before_s(act, CP_ACT_STEERING, instant_s);
    if (!isnan(at.braking_s)) {
        at.brake_request_m_s2 = request_in_force(acts, act);
        at.deceleration_m_s2 = act->deceleration_m_s2;
        at.speed_taken_off_m_s = act->speed_m_s - speed_m_s;
    }
    at.state = state_of(&at);
    return at;
}
