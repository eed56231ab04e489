/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_DRIVER_ERROR_ONCOMING_REACTION_H
#define CONTROL_DRIVER_ERROR_ONCOMING_REACTION_H

#include "control/actuation.h"
#include "control/neighbourhood.h"
#include "control/road_view.h"
#include "core/rng.h"
#include "traffic/traffic.h"

/* What a driver does about a car that has left its lane towards him: SUMO's drivers do not see it
 * there. He notices it when the time to collision falls below a threshold, brakes after his
 * reaction time, and lets go when the danger has been over for a while. He does not steer. */

typedef struct cp_oncoming_reaction_settings {
    double notice_ttc_s;    /* looks no further ahead than this */
    double reaction_mean_s; /* normal, cut off at 0.5 and 3 s; drawn once per driver */
    double reaction_sd_s;
    double deceleration_m_s2;
    double jerk_m_s3;
} cp_oncoming_reaction_settings;

/* All drivers who are reacting; few at a time. Zero-initialise, destroy. */
typedef struct cp_oncoming_reaction {
    struct cp_reacting_driver *drivers;
    size_t count;
    size_t capacity;
    size_t reactions; /* so far */
} cp_oncoming_reaction;

void cp_oncoming_reaction_destroy(cp_oncoming_reaction *reaction);

/* A car is off its lane: whoever is on a collision course with it notices. neighbourhood covers at
 * least two speeds times notice_ttc_s. view: the road, NULL where nobody
 * knows it. seed_key: of the driver error, drivers are drawn by id. */
CP_MUST_CHECK cp_status cp_oncoming_reaction_notice(cp_oncoming_reaction *reaction,
                                                    const cp_oncoming_reaction_settings *settings,
                                                    const cp_traffic *traffic,
                                                    const cp_neighbourhood *neighbourhood,
                                                    cp_road_view *view, uint32_t drifting,
                                                    cp_rng_key seed_key, cp_error *error);

/* Ask for the brakes of those who react, for the coming step. */
CP_MUST_CHECK cp_status cp_oncoming_reaction_step(cp_oncoming_reaction *reaction,
                                                  const cp_oncoming_reaction_settings *settings,
                                                  const cp_traffic *traffic,
                                                  cp_actuation *actuation, cp_error *error);

#endif
