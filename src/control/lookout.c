/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/lookout.h"

#include <stdlib.h>
#include <string.h>

#define TURNING_RAD_S 0.1
#define OTHERWISE_LATER_S 0.5 /* driving otherwise, they may meet this much later */
#define STANDS_M_S 0.5
#define BRAKES_FROM_M_S2 1.0 /* a driver who brakes more than this has seen what is ahead */
#define BISECTIONS 40

static bool is_turning(const cp_moving_rectangle *moving)
{
    return fabs(moving->yaw_rate_rad_s) > TURNING_RAD_S;
}

cp_target_class cp_target_class_of(const cp_moving_rectangle *own,
                                   const cp_moving_rectangle *target)
{
    double apart_rad = fabs(cp_wrap_angle(target->rectangle.yaw_rad - own->rectangle.yaw_rad));
    if (apart_rad < M_PI / 4.0)
        return CP_TARGET_REAR_END;
    if (is_turning(own) || is_turning(target))
        return CP_TARGET_TURNING;
    return apart_rad > 0.75 * M_PI ? CP_TARGET_ONCOMING : CP_TARGET_CROSSING;
}

static void release_tracks(void *item)
{
    cp_tracks *tracks = item;
    free(tracks->track);
}

cp_lookout cp_lookout_create(const cp_lookout_settings *settings, const cp_traffic *traffic)
{
    return (cp_lookout){.settings = *settings,
                        .traffic = traffic,
                        .tracks = cp_vehicle_table_create(sizeof(cp_tracks), release_tracks)};
}

void cp_lookout_destroy(cp_lookout *lookout)
{
    cp_vehicle_table_destroy(&lookout->tracks);
    free(lookout->around);
    free(lookout->screens);
    free(lookout->outlines);
    cp_neighbourhood_clear(&lookout->neighbourhood);
    *lookout = (cp_lookout){0};
}

cp_status cp_lookout_step(cp_lookout *lookout, cp_error *error)
{
    size_t count;
    const cp_vehicle_motion *motions = cp_traffic_motions(lookout->traffic, &count);
    // Fronts lie at most one sensor range and a long vehicle apart when the target is in view.
    double cell_m = lookout->settings.sensor.range_m + 20.0;
    if (count > lookout->around_room) {
        size_t room = 2 * count;
        cp_rectangle *outlines = realloc(lookout->outlines, room * sizeof *outlines);
        if (outlines)
            lookout->outlines = outlines;
        const cp_rectangle **screens = realloc(lookout->screens, room * sizeof *screens);
        if (screens)
            lookout->screens = screens;
        const cp_vehicle_motion **around = realloc(lookout->around, room * sizeof *around);
        if (around)
            lookout->around = around;
        if (!outlines || !screens || !around)
            return cp_fail_memory(error, "lookout");
        lookout->around_room = room;
    }
    for (size_t k = 0; k < count; k++)
        lookout->outlines[k] = cp_moving_rectangle_of(&motions[k]).rectangle;
    cp_status status = cp_vehicle_table_prune(&lookout->tracks, lookout->traffic, error);
    return status == CP_OK
               ? cp_neighbourhood_fill(&lookout->neighbourhood, cell_m, motions, count, error)
               : status;
}

// ---- tracking ------------------------------------------------------------------------------

static void gather(void *context, const cp_vehicle_motion *motion)
{
    cp_lookout *lookout = context;
    size_t row = (size_t)(motion - lookout->neighbourhood.motions);
    lookout->around[lookout->around_count] = motion;
    lookout->screens[lookout->around_count++] = &lookout->outlines[row];
}

// Whether the two can meet within the horizon at all, at the speeds they have.
static bool is_within_reach(const cp_lookout *lookout, const cp_vehicle_motion *own,
                            const cp_vehicle_motion *other)
{
    double reach_m = lookout->settings.horizon_s * (own->after.speed_m_s + other->after.speed_m_s) +
                     own->after.length_m + other->after.length_m;
    return cp_front_distance_m2(own, other) <= reach_m * reach_m;
}

// Whether two can touch within a time at all.
static bool is_in_time(const cp_vehicle_motion *own, const cp_vehicle_motion *other,
                       double horizon_s)
{
    double reach_m = horizon_s * (own->after.speed_m_s + other->after.speed_m_s) +
                     own->after.length_m + other->after.length_m + own->after.width_m +
                     other->after.width_m;
    return cp_front_distance_m2(own, other) <= reach_m * reach_m;
}

// Whether the one behind in the same lane is no faster than the one ahead: most pairs in traffic,
// and they do not meet. For vehicles whose places are known.
static bool are_parting(const cp_vehicle_state *own, const cp_vehicle_state *other)
{
    if (own->lane != other->lane || cos(own->yaw_rad - other->yaw_rad) < 0.0)
        return false;
    bool is_ahead = own->lane_position_m > other->lane_position_m;
    const cp_vehicle_state *ahead = is_ahead ? own : other, *behind = is_ahead ? other : own;
    return ahead->lane_position_m - ahead->length_m > behind->lane_position_m &&
           ahead->speed_m_s >= behind->speed_m_s;
}

static bool is_detectable(const cp_lookout *lookout, uint32_t own, uint32_t target)
{
    double probability_1 = lookout->settings.detection_probability_1;
    if (probability_1 >= 1.0)
        return true;
    cp_rng_key key = cp_rng_key_text(lookout->settings.key, "detection");
    key = cp_rng_key_text(key, cp_traffic_vehicle_id(lookout->traffic, own));
    key = cp_rng_key_text(key, cp_traffic_vehicle_id(lookout->traffic, target));
    return cp_rng_uniform(key, 0) < probability_1;
}

static cp_status note_seen(cp_lookout *lookout, cp_tracks *tracks, uint32_t own, uint32_t target,
                           cp_error *error)
{
    for (size_t k = 0; k < tracks->count; k++) {
        if (tracks->track[k].vehicle == target) {
            tracks->track[k].is_seen = true;
            return CP_OK;
        }
    }
    if (tracks->count == tracks->room) {
        size_t room = tracks->room ? 2 * tracks->room : 8;
        cp_track *larger = realloc(tracks->track, room * sizeof *larger);
        if (!larger)
            return cp_fail_memory(error, "lookout");
        tracks->track = larger;
        tracks->room = room;
    }
    tracks->track[tracks->count++] =
        (cp_track){.vehicle = target,
                   .is_seen = true,
                   .is_detectable = is_detectable(lookout, own, target),
                   .seen_since_s = cp_traffic_time_s(lookout->traffic)};
    return CP_OK;
}

cp_status cp_lookout_track(cp_lookout *lookout, const cp_vehicle_motion *own, cp_error *error)
{
    uint32_t vehicle = own->after.vehicle;
    void *item;
    cp_status status = cp_vehicle_table_take(&lookout->tracks, vehicle, &item, error);
    if (status != CP_OK)
        return status;
    cp_tracks *tracks = item;
    for (size_t k = 0; k < tracks->count; k++)
        tracks->track[k].is_seen = false;

    // Who is near, and of those who matter, who is in view.
    lookout->around_count = 0;
    cp_neighbourhood_visit(&lookout->neighbourhood, own->after.front_x_m, own->after.front_y_m,
                           gather, lookout);
    const cp_rectangle *outline = &lookout->outlines[own - lookout->neighbourhood.motions];
    size_t screens = lookout->settings.has_occlusion ? lookout->around_count : 0;
    for (size_t k = 0; k < lookout->around_count && status == CP_OK; k++) {
        const cp_vehicle_motion *target = lookout->around[k];
        if (target != own && is_within_reach(lookout, own, target) &&
            cp_sensor_sees(&lookout->settings.sensor, outline, lookout->screens[k],
                           lookout->screens, screens))
            status = note_seen(lookout, tracks, vehicle, target->after.vehicle, error);
    }

    // Whoever is out of view is forgotten.
    size_t kept = 0;
    for (size_t k = 0; k < tracks->count; k++)
        if (tracks->track[k].is_seen)
            tracks->track[kept++] = tracks->track[k];
    tracks->count = kept;
    return status;
}

void cp_lookout_forget(cp_lookout *lookout, uint32_t vehicle)
{
    cp_tracks *tracks = cp_vehicle_table_find(&lookout->tracks, vehicle);
    if (tracks != NULL)
        tracks->count = 0;
}

cp_tracks cp_lookout_tracks_of(const cp_lookout *lookout, uint32_t vehicle)
{
    const cp_tracks *tracks = cp_vehicle_table_find(&lookout->tracks, vehicle);
    return tracks != NULL ? *tracks : (cp_tracks){0};
}

bool cp_lookout_is_known(const cp_lookout *lookout, const cp_track *track)
{
    return track->is_detectable && track->seen_since_s + lookout->settings.confirmation_s <=
                                       cp_traffic_time_s(lookout->traffic);
}

// ---- threats -------------------------------------------------------------------------------

static cp_mover straightened(cp_mover mover)
{
    if (mover.way == NULL)
        mover.now.yaw_rate_rad_s = 0.0;
    return mover;
}

// As if it had gained speed evenly from now, or braked: on the same path, as far in time_s as it
// comes then.
static cp_mover accelerating(cp_mover mover, double acceleration_m_s2, double time_s)
{
    double speed_m_s = cp_vec2_length(mover.now.velocity_m_s);
    if (!(speed_m_s > 0.0 && time_s > 0.0))
        return mover;
    double until_s =
        acceleration_m_s2 < 0.0 ? fmin(time_s, speed_m_s / -acceleration_m_s2) : time_s;
    double way_m = until_s * (speed_m_s + 0.5 * acceleration_m_s2 * until_s);
    double share_1 = way_m / (speed_m_s * time_s);
    mover.now.velocity_m_s = cp_vec2_scale(mover.now.velocity_m_s, share_1);
    mover.now.yaw_rate_rad_s *= share_1;
    return mover;
}

// As if it came to rest at the first place where it has to wait for others, of those where it can
// do so at ease: light_m is the way from the front at the end of the step to a red light.
static cp_mover waiting(cp_mover mover, double light_m, double time_s)
{
    double speed_m_s = cp_vec2_length(mover.now.velocity_m_s), nearest_m = INFINITY;
    size_t count = mover.way != NULL ? mover.way->wait_count : 0;
    for (size_t k = 0; k <= count; k++) {
        double rest_m = (k < count ? mover.way->wait_m[k] : light_m) - mover.begin_m;
        if (rest_m > 0.0 && speed_m_s * speed_m_s < 2.0 * rest_m * CP_LOOKOUT_EASY_BRAKING_M_S2)
            nearest_m = fmin(nearest_m, rest_m);
    }
    if (nearest_m == INFINITY)
        return mover;
    return accelerating(mover, -speed_m_s * speed_m_s / (2.0 * nearest_m), time_s);
}

/* Two vehicles at one moment. */
typedef struct encounter {
    cp_mover own;
    cp_mover target;
    const cp_lane_ahead *target_route; /* its way along its route; NULL: not known */
    double own_m_s2;                   /* accelerations along their headings */
    double target_m_s2;
    double own_light_m; /* way to the red light it comes to next; INFINITY without */
    double target_light_m;
    cp_target_class class;
    double ttc_s;
} encounter;

// On a way along a lane only junctions turn a vehicle: a road that bends is no turn.
static bool is_turning_now(const cp_mover *mover)
{
    return is_turning(&mover->now) && (mover->way == NULL || mover->way->is_inside);
}

// By the headings where they meet: in a bend those of now say little.
static cp_target_class class_of(const encounter *pair, double time_s)
{
    if (pair->own.way == NULL && pair->target.way == NULL)
        return cp_target_class_of(&pair->own.now, &pair->target.now);
    double own_rad = cp_mover_at(&pair->own, time_s).yaw_rad;
    double target_rad = cp_mover_at(&pair->target, time_s).yaw_rad;
    double apart_rad = fabs(cp_wrap_angle(target_rad - own_rad));
    if (apart_rad < M_PI / 4.0)
        return CP_TARGET_REAR_END;
    if (is_turning_now(&pair->own) || is_turning_now(&pair->target))
        return CP_TARGET_TURNING;
    return apart_rad > 0.75 * M_PI ? CP_TARGET_ONCOMING : CP_TARGET_CROSSING;
}

// Conditions 3 and 4: whether the contact takes the function, or the driver sees to it.
static bool takes_braking(const encounter *pair, double required_m_s2)
{
    double time_s = pair->ttc_s;
    double speed_m_s = cp_vec2_length(pair->own.now.velocity_m_s);
    double braking_m_s2 = pair->class != CP_TARGET_ONCOMING ? -pair->own_m_s2 : 0.0;
    if (pair->class == CP_TARGET_REAR_END) {
        double apart_rad =
            cp_mover_at(&pair->target, time_s).yaw_rad - cp_mover_at(&pair->own, time_s).yaw_rad;
        speed_m_s -= cp_vec2_length(pair->target.now.velocity_m_s) * cos(apart_rad);
        // Who stands, or all but, gets no slower.
        if (cp_vec2_length(pair->target.now.velocity_m_s) > STANDS_M_S)
            braking_m_s2 += pair->target_m_s2;
    }
    double twice_s = 2.0 * time_s; // v^2/(2 d) with d = v TTC
    // Who brakes at ease what can be met at ease has seen it, whether or not he brakes enough yet.
    bool sees_to_it =
        braking_m_s2 > BRAKES_FROM_M_S2 && speed_m_s < twice_s * CP_LOOKOUT_EASY_BRAKING_M_S2;
    return speed_m_s >= twice_s * required_m_s2 && speed_m_s > twice_s * braking_m_s2 &&
           !sees_to_it;
}

// Conditions 5 and 6.
static bool meet_otherwise(const encounter *pair, double later_s)
{
    const cp_mover *own = &pair->own, *target = &pair->target;
    bool may_straighten =
        pair->ttc_s > CP_LOOKOUT_TURN_HOLDS_S || is_turning(&own->now) || is_turning(&target->now);
    cp_mover own_straight = straightened(*own);
    cp_mover target_straight = straightened(*target);
    if (may_straighten && own->way == NULL &&
        cp_mover_ttc_s(&own_straight, target, later_s) == INFINITY)
        return false;
    if (may_straighten && target->way == NULL &&
        cp_mover_ttc_s(own, &target_straight, later_s) == INFINITY)
        return false;
    cp_mover on_route = *target;
    on_route.way = pair->target_route;
    if (target->way != NULL && pair->target_route != NULL &&
        cp_mover_ttc_s(own, &on_route, later_s) == INFINITY)
        return false;
    if (pair->class == CP_TARGET_REAR_END)
        return true;
    cp_mover own_waits = waiting(*own, pair->own_light_m, later_s);
    cp_mover target_waits = waiting(*target, pair->target_light_m, later_s);
    if (cp_mover_ttc_s(&own_waits, target, later_s) == INFINITY ||
        cp_mover_ttc_s(own, &target_waits, later_s) == INFINITY)
        return false;
    cp_mover other = accelerating(*target, pair->target_m_s2, pair->ttc_s);
    return cp_mover_ttc_s(own, &other, later_s) < INFINITY;
}

// Conditions 1 to 6 for two vehicles at one moment; class and TTC are set as far as they hold.
static bool is_threat(const cp_lookout_settings *settings, encounter *pair)
{
    pair->ttc_s = cp_mover_ttc_s(&pair->own, &pair->target, settings->ttc_s);
    if (!(pair->ttc_s < settings->ttc_s))
        return false;
    pair->class = class_of(pair, pair->ttc_s);
    return settings->has_class[pair->class] && takes_braking(pair, settings->required_m_s2) &&
           meet_otherwise(pair, settings->ttc_s + OTHERWISE_LATER_S);
}

/* A pair and the ways of both. */
typedef struct sight {
    const cp_vehicle_motion *own;
    const cp_vehicle_motion *target;
    const cp_lane_ahead *own_way;
    const cp_lane_ahead *target_way;
    const cp_lane_ahead *target_route;
    double light_m[2]; /* ways of own and target to red lights */
} sight;

static cp_status look_at_ways(const cp_lookout *lookout, sight *seen, cp_error *error)
{
    cp_road_view *view = lookout->settings.view;
    cp_status status = cp_road_view_way(view, seen->own, CP_WAY_ROUTE, &seen->own_way, error);
    if (status == CP_OK)
        status = cp_road_view_way(view, seen->target, CP_WAY_STRAIGHT, &seen->target_way, error);
    return status;
}

static encounter encounter_inside(const sight *seen, double fraction)
{
    return (encounter){.own = cp_mover_inside(seen->own, seen->own_way, fraction),
                       .target = cp_mover_inside(seen->target, seen->target_way, fraction),
                       .target_route = seen->target_route,
                       .own_m_s2 = seen->own->after.acceleration_m_s2,
                       .target_m_s2 = seen->target->after.acceleration_m_s2,
                       .own_light_m = seen->light_m[0],
                       .target_light_m = seen->light_m[1]};
}

static bool is_threat_inside(const cp_lookout_settings *settings, const sight *seen,
                             double fraction)
{
    encounter pair = encounter_inside(seen, fraction);
    return is_threat(settings, &pair);
}

// Fraction of the step at which it became a threat, which it is at the end: 0 if it was already at
// the beginning.
static double find_instant(const cp_lookout_settings *settings, const sight *seen)
{
    double before_1 = 0.0, after_1 = 1.0;
    if (!seen->own->was_present || !seen->target->was_present || cp_is_put_aside(seen->own) ||
        cp_is_put_aside(seen->target))
        return 1.0;
    if (is_threat_inside(settings, seen, 0.0))
        return 0.0;
    for (int k = 0; k < BISECTIONS; k++) {
        double middle_1 = 0.5 * (before_1 + after_1);
        if (is_threat_inside(settings, seen, middle_1))
            after_1 = middle_1;
        else
            before_1 = middle_1;
    }
    return after_1;
}

// Ways to red lights, of two who head apart.
static cp_status look_at_lights(const cp_lookout *lookout, sight *seen, cp_error *error)
{
    const cp_vehicle_motion *motions[2] = {seen->own, seen->target};
    cp_status status = CP_OK;
    for (int k = 0; k < 2 && status == CP_OK; k++) {
        cp_next_light light;
        status = cp_traffic_next_light(lookout->traffic, motions[k]->after.vehicle, &light, error);
        if (status == CP_OK && light.is_red)
            seen->light_m[k] = light.distance_m;
    }
    return status;
}

// Condition 8.
static bool goes_nowhere(const cp_vehicle_motion *motion, const cp_lane_ahead *way)
{
    return way == NULL && cp_turns_too_fast(motion);
}

// All conditions at the end of the step.
static cp_status judge(const cp_lookout *lookout, sight *seen, encounter *pair, bool *threatens,
                       cp_error *error)
{
    const cp_lookout_settings *settings = &lookout->settings;
    *threatens = false;
    seen->light_m[0] = seen->light_m[1] = INFINITY;
    if (!is_in_time(seen->own, seen->target, settings->ttc_s) ||
        (settings->view != NULL && are_parting(&seen->own->after, &seen->target->after)))
        return CP_OK;
    cp_status status = look_at_ways(lookout, seen, error);
    if (goes_nowhere(seen->own, seen->own_way) || goes_nowhere(seen->target, seen->target_way))
        return status;
    *pair = encounter_inside(seen, 1.0);
    if (status != CP_OK || !is_threat(settings, pair))
        return status;
    // Few come so far: where its signal says it goes, who has a red light, and whether the roads
    // meet.
    status =
        cp_road_view_way(settings->view, seen->target, CP_WAY_ROUTE, &seen->target_route, error);
    if (status == CP_OK && pair->class != CP_TARGET_REAR_END)
        status = look_at_lights(lookout, seen, error);
    pair->target_route = seen->target_route;
    pair->own_light_m = seen->light_m[0];
    pair->target_light_m = seen->light_m[1];
    if (status != CP_OK || !is_threat(settings, pair))
        return status;
    return cp_road_view_meet(settings->view, seen->own, &pair->own, seen->target, &pair->target,
                             pair->ttc_s, threatens, error);
}

cp_status cp_lookout_threat(const cp_lookout *lookout, const cp_vehicle_motion *own, bool *found,
                            cp_threat *threat, cp_error *error)
{
    const cp_lookout_settings *settings = &lookout->settings;
    const cp_tracks tracks = cp_lookout_tracks_of(lookout, own->after.vehicle);
    double now_s = cp_traffic_time_s(lookout->traffic);
    double step_s = cp_traffic_step_length_s(lookout->traffic);
    cp_status status = CP_OK;
    *found = false;
    for (size_t k = 0; status == CP_OK && k < tracks.count; k++) {
        const cp_track *track = &tracks.track[k];
        sight seen = {.own = own, .target = cp_traffic_motion_of(lookout->traffic, track->vehicle)};
        double known_s = track->seen_since_s + settings->confirmation_s;
        encounter pair;
        bool threatens = false;
        if (seen.target != NULL && cp_lookout_is_known(lookout, track))
            status = judge(lookout, &seen, &pair, &threatens, error);
        if (status != CP_OK || !threatens)
            continue;
        double inside_s = now_s - (1.0 - find_instant(settings, &seen)) * step_s;
        double instant_s = fmax(inside_s, known_s);
        if (*found && instant_s >= threat->instant_s)
            continue;
        *threat = (cp_threat){.vehicle = track->vehicle,
                              .class = pair.class,
                              .ttc_s = pair.ttc_s,
                              .instant_s = instant_s};
        *found = true;
    }
    return status;
}

cp_status cp_lookout_is_danger(const cp_lookout *lookout, const cp_vehicle_motion *own,
                               double horizon_s, bool *is_danger, cp_error *error)
{
    const cp_lookout_settings *settings = &lookout->settings;
    const cp_tracks tracks = cp_lookout_tracks_of(lookout, own->after.vehicle);
    cp_status status = CP_OK;
    *is_danger = false;
    for (size_t k = 0; status == CP_OK && !*is_danger && k < tracks.count; k++) {
        sight seen = {.own = own,
                      .target = cp_traffic_motion_of(lookout->traffic, tracks.track[k].vehicle)};
        if (seen.target == NULL || !tracks.track[k].is_detectable ||
            !is_in_time(own, seen.target, horizon_s) ||
            (settings->view != NULL && are_parting(&own->after, &seen.target->after)))
            continue;
        status = look_at_ways(lookout, &seen, error);
        encounter pair = encounter_inside(&seen, 1.0);
        pair.ttc_s = cp_mover_ttc_s(&pair.own, &pair.target, horizon_s);
        if (status == CP_OK && pair.ttc_s < INFINITY &&
            settings->has_class[class_of(&pair, pair.ttc_s)])
            status = cp_road_view_meet(settings->view, own, &pair.own, seen.target, &pair.target,
                                       pair.ttc_s, is_danger, error);
    }
    return status;
}
