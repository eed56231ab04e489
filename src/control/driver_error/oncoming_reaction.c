/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/driver_error/oncoming_reaction.h"

#include "control/brake.h"
#include "core/units.h"

#include <stdlib.h>

/* Nobody brakes on after the danger has been over for so long. */
#define CALM_S 1.0

/* One driver from noticing to letting go. */
typedef struct cp_reacting_driver {
    uint32_t vehicle;
    uint32_t drifting;        /* what he watches */
    double brake_start_s;     /* clock */
    double commanded_until_s; /* speed loss up to here has been commanded */
    double danger_seen_s;     /* last time there was a collision course */
} cp_reacting_driver;

void cp_oncoming_reaction_destroy(cp_oncoming_reaction *reaction)
{
    free(reaction->drivers);
    *reaction = (cp_oncoming_reaction){0};
}

/* A look for those who come towards a drifting car. */
typedef struct look {
    cp_oncoming_reaction *reaction;
    const cp_oncoming_reaction_settings *settings;
    const cp_traffic *traffic;
    const cp_vehicle_motion *drifting;
    cp_road_view *view;
    cp_rng_key seed_key;
    cp_status status;
    cp_error *error;
} look;

static cp_reacting_driver *find(const cp_oncoming_reaction *reaction, uint32_t vehicle,
                                uint32_t drifting)
{
    for (size_t k = 0; k < reaction->count; k++)
        if (reaction->drivers[k].vehicle == vehicle && reaction->drivers[k].drifting == drifting)
            return &reaction->drivers[k];
    return NULL;
}

static cp_status add(look *looking, uint32_t vehicle, double noticed_s)
{
    cp_oncoming_reaction *reaction = looking->reaction;
    if (reaction->count == reaction->capacity) {
        size_t capacity = reaction->capacity == 0 ? 16 : 2 * reaction->capacity;
        cp_reacting_driver *drivers = realloc(reaction->drivers, capacity * sizeof *drivers);
        if (drivers == NULL)
            return cp_fail_memory(looking->error, "reacting drivers");
        reaction->drivers = drivers;
        reaction->capacity = capacity;
    }
    const char *id = cp_traffic_vehicle_id(looking->traffic, vehicle);
    cp_rng_key key = cp_rng_key_text(cp_rng_key_text(looking->seed_key, "reaction"), id);
    const cp_oncoming_reaction_settings *settings = looking->settings;
    double reaction_s = settings->reaction_mean_s + settings->reaction_sd_s * cp_rng_normal(key, 0);
    double start_s = noticed_s + fmin(fmax(reaction_s, 0.5), 3.0);
    reaction->drivers[reaction->count++] =
        (cp_reacting_driver){.vehicle = vehicle,
                             .drifting = looking->drifting->after.vehicle,
                             .brake_start_s = start_s,
                             .commanded_until_s = start_s,
                             .danger_seen_s = noticed_s};
    reaction->reactions++;
    return CP_OK;
}

static void look_at(void *context, const cp_vehicle_motion *motion)
{
    look *looking = context;
    const cp_vehicle_state *drifting = &looking->drifting->after;
    double across_rad = fabs(cp_wrap_angle(motion->after.yaw_rad - drifting->yaw_rad));
    if (looking->status != CP_OK || motion->after.vehicle == drifting->vehicle ||
        across_rad < 0.5 * CP_PI)
        return;
    double horizon_s = looking->settings->notice_ttc_s, time_s;
    looking->status = cp_road_view_ttc_s(looking->view, motion, looking->drifting, horizon_s,
                                         &time_s, looking->error);
    if (looking->status != CP_OK || !(time_s < horizon_s))
        return;

    // It falls by a second each second: the threshold was crossed inside the step.
    double now_s = cp_traffic_time_s(looking->traffic);
    cp_reacting_driver *known = find(looking->reaction, motion->after.vehicle, drifting->vehicle);
    if (known != NULL)
        known->danger_seen_s = now_s;
    else
        looking->status =
            add(looking, motion->after.vehicle,
                now_s - fmin(horizon_s - time_s, cp_traffic_step_length_s(looking->traffic)));
}

cp_status cp_oncoming_reaction_notice(cp_oncoming_reaction *reaction,
                                      const cp_oncoming_reaction_settings *settings,
                                      const cp_traffic *traffic,
                                      const cp_neighbourhood *neighbourhood, cp_road_view *view,
                                      uint32_t drifting, cp_rng_key seed_key, cp_error *error)
{
    const cp_vehicle_motion *motion = cp_traffic_motion_of(traffic, drifting);
    if (motion == NULL)
        return CP_OK;
    look looking = {reaction, settings, traffic, motion, view, seed_key, CP_OK, error};
    cp_neighbourhood_visit(neighbourhood, motion->after.front_x_m, motion->after.front_y_m, look_at,
                           &looking);
    return looking.status;
}

// Take away what the profile asks for until the end of the coming step.
static cp_status brake(cp_reacting_driver *driver, const cp_oncoming_reaction_settings *settings,
                       const cp_traffic *traffic, const cp_vehicle_motion *motion,
                       cp_actuation *actuation, cp_error *error)
{
    double end_s = cp_traffic_time_s(traffic) + cp_traffic_step_length_s(traffic);
    cp_brake profile = {driver->brake_start_s, settings->jerk_m_s3, settings->deceleration_m_s2,
                        0.0};
    double loss_m_s = cp_brake_speed_loss_m_s(&profile, end_s) -
                      cp_brake_speed_loss_m_s(&profile, driver->commanded_until_s);
    if (loss_m_s <= 0.0)
        return CP_OK;
    driver->commanded_until_s = end_s;
    return cp_actuation_request(actuation, driver->vehicle,
                                fmax(motion->after.speed_m_s - loss_m_s, 0.0), 0.0, error);
}

cp_status cp_oncoming_reaction_step(cp_oncoming_reaction *reaction,
                                    const cp_oncoming_reaction_settings *settings,
                                    const cp_traffic *traffic, cp_actuation *actuation,
                                    cp_error *error)
{
    double now_s = cp_traffic_time_s(traffic);
    cp_status status = CP_OK;
    size_t kept = 0;
    for (size_t k = 0; k < reaction->count; k++) {
        cp_reacting_driver driver = reaction->drivers[k];
        const cp_vehicle_motion *motion = cp_traffic_motion_of(traffic, driver.vehicle);
        if (motion == NULL)
            continue; // gone
        bool is_over = now_s - driver.danger_seen_s > CALM_S && now_s >= driver.brake_start_s;
        if (is_over)
            continue;
        if (status == CP_OK)
            status = brake(&driver, settings, traffic, motion, actuation, error);
        reaction->drivers[kept++] = driver;
    }
    reaction->count = kept;
    return status;
}
