/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact/recorded_contact.h"

#include "impact/detector.h"
#include "impact/footprint.h"

#include <math.h>

typedef struct replay {
    cp_detector *detector;
    const char *const *ids;
    double step_length_s;
    const cp_recorded_report *report; /* NULL: none */
    bool is_over;                     /* the step of the report has been looked at, or is missing */
    cp_vehicle_motion motion[2];
    cp_recorded_contact *contact;
} replay;

static const char *id_of(const void *context, uint32_t vehicle)
{
    return ((const replay *)context)->ids[vehicle];
}

static cp_vehicle_motion motion_between(const cp_vehicle_state *before,
                                        const cp_vehicle_state *after, double step_length_s)
{
    return (cp_vehicle_motion){.before = *before,
                               .after = *after,
                               .yaw_rate_rad_s =
                                   cp_wrap_angle(after->yaw_rad - before->yaw_rad) / step_length_s,
                               .was_present = true};
}

// One step of both through the detector; a confirmed contact ends the search.
static cp_status look(replay *self, double time_s, cp_error *error)
{
    const cp_impact *impacts = NULL;
    size_t count = 0;
    cp_detector_scene scene = {.motions = self->motion,
                               .count = 2,
                               .step_length_s = self->step_length_s,
                               .time_s = time_s,
                               .vehicle_id = id_of,
                               .id_context = self};
    cp_status status = cp_detector_scan(self->detector, &scene, &impacts, &count, error);
    for (size_t k = 0; status == CP_OK && k < count; k++) {
        self->contact->is_found = true;
        self->contact->impact = impacts[k];
    }
    return status;
}

static bool is_confirmed(const cp_recorded_contact *contact)
{
    return contact->is_found && contact->impact.verdict == CP_CONTACT_CONFIRMED;
}

// On at the speed of the end, the way turning as the heading does.
static void carry_on(cp_vehicle_motion *motion, double step_length_s)
{
    cp_vehicle_state later = motion->after;
    double turn_rad = motion->yaw_rate_rad_s * step_length_s;
    double way_m = later.speed_m_s * step_length_s;
    cp_vec2 chord_m = {motion->after.front_x_m - motion->before.front_x_m,
                       motion->after.front_y_m - motion->before.front_y_m};
    double chord_length_m = cp_vec2_length(chord_m);
    chord_m = chord_length_m > 1e-3 ? cp_vec2_scale(chord_m, way_m / chord_length_m)
                                    : cp_vec2_scale(cp_vec2_heading(later.yaw_rad), way_m);
    chord_m = cp_vec2_rotate(chord_m, turn_rad);
    later.front_x_m += chord_m.x;
    later.front_y_m += chord_m.y;
    later.yaw_rad = cp_wrap_angle(later.yaw_rad + turn_rad);
    motion->before = motion->after;
    motion->after = later;
}

// Whether positions follow the mean of the speeds at both ends of a step (SUMO's ballistic update)
// rather than the speed at its end (Euler's, its default).
static bool is_ballistic(const cp_vehicle_motion *motion, double step_length_s)
{
    double way_m = hypot(motion->after.front_x_m - motion->before.front_x_m,
                         motion->after.front_y_m - motion->before.front_y_m);
    double end_m = motion->after.speed_m_s * step_length_s;
    double mean_m = 0.5 * (motion->before.speed_m_s + motion->after.speed_m_s) * step_length_s;
    double rounding_m = 0.02;
    return fabs(way_m - mean_m) < fabs(way_m - end_m) - rounding_m;
}

// Through the step in which SUMO took them away, whose speeds at the end it reported.
static void carry_through_report(replay *self, double step_length_s)
{
    bool ballistic = is_ballistic(&self->motion[0], step_length_s) ||
                     is_ballistic(&self->motion[1], step_length_s);
    for (int v = 0; v < 2; v++) {
        double reported_m_s = self->report->speed_m_s[v];
        cp_vehicle_state *after = &self->motion[v].after;
        double last_m_s = after->speed_m_s;
        if (isnan(reported_m_s))
            reported_m_s = last_m_s;
        after->speed_m_s = ballistic ? 0.5 * (last_m_s + reported_m_s) : reported_m_s;
        carry_on(&self->motion[v], step_length_s);
        self->motion[v].before.speed_m_s = last_m_s;
        self->motion[v].after.speed_m_s = reported_m_s;
    }
}

// Set down elsewhere along its way: SUMO's teleport. In the step of a report that is likely, and
// lanes that are longer than they look must do without a margin.
static bool was_put(const cp_vehicle_state *before, const cp_vehicle_state *after,
                    double step_length_s, bool is_likely)
{
    double margin_1 = is_likely ? 1.05 : 1.5;
    cp_vec2 chord_m = {after->front_x_m - before->front_x_m, after->front_y_m - before->front_y_m};
    double along_m = cp_vec2_dot(chord_m, cp_vec2_heading(before->yaw_rad));
    double fastest_m_s = fmax(fabs(before->speed_m_s), fabs(after->speed_m_s));
    double rounding_m = 0.5, lanes_m = 8.0;
    return along_m > margin_1 * fastest_m_s * step_length_s + rounding_m || along_m < -rounding_m ||
           cp_vec2_length(chord_m) > margin_1 * fastest_m_s * step_length_s + lanes_m;
}

// In the step of the report itself: one whose speed is not what SUMO reported has got another.
static bool has_other_speed(const replay *self, const cp_vehicle_state *now, int v, double time_s)
{
    const double rounding_m_s = 0.05, rounding_s = 0.006;
    return fabs(time_s - self->report->time_s) < rounding_s &&
           fabs(now->speed_m_s - self->report->speed_m_s[v]) > rounding_m_s;
}

// Index of the state of a track at that time, from *at on; false when it was away then.
static bool find(const cp_recorded_track *track, double time_s, double step_length_s, size_t *at)
{
    while (*at < track->count && track->time_s[*at] < time_s - 0.5 * step_length_s)
        (*at)++;
    return *at < track->count && track->time_s[*at] < time_s + 0.5 * step_length_s;
}

// Through the record, until one of the two is put elsewhere. *end_s: of the last step with both, in
// which they moved.
static cp_status look_through(replay *self, const cp_recorded_track track[2], bool *moved,
                              double *end_s, cp_error *error)
{
    size_t other = 0;
    bool were_there = false;
    cp_vehicle_state before[2];
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < track[0].count && !is_confirmed(self->contact); k++) {
        double time_s = track[0].time_s[k];
        bool follows = k > 0 && time_s - track[0].time_s[k - 1] < 1.5 * self->step_length_s;
        bool is_there = find(&track[1], time_s, self->step_length_s, &other);
        bool is_reported = self->report != NULL && !self->is_over &&
                           time_s > self->report->time_s - 0.5 * self->step_length_s;
        // Away in the step of the report, as one that is put back later.
        if (is_reported && *moved && (!is_there || !were_there || !follows))
            break;
        if (!is_there) {
            were_there = false;
            continue;
        }
        const cp_vehicle_state *now[2] = {&track[0].state[k], &track[1].state[other]};
        if (were_there && follows &&
            (was_put(&before[0], now[0], self->step_length_s, is_reported) ||
             was_put(&before[1], now[1], self->step_length_s, is_reported)))
            break;
        if (is_reported && *moved &&
            (has_other_speed(self, now[0], 0, time_s) || has_other_speed(self, now[1], 1, time_s)))
            break;
        self->is_over |= is_reported;
        cp_rectangle rectangle[2] = {cp_vehicle_rectangle(now[0]), cp_vehicle_rectangle(now[1])};
        self->contact->gap_m =
            fmin(self->contact->gap_m, cp_rectangle_separation(&rectangle[0], &rectangle[1]));
        if (were_there && follows) {
            for (int v = 0; v < 2; v++)
                self->motion[v] = motion_between(&before[v], now[v], self->step_length_s);
            status = look(self, time_s, error);
            *moved = true;
            *end_s = time_s;
        }
        before[0] = *now[0];
        before[1] = *now[1];
        were_there = true;
    }
    return status;
}

cp_status cp_recorded_contact_find(const cp_recorded_track track[2], const char *const ids[2],
                                   double step_length_s, const cp_recorded_report *report,
                                   cp_recorded_contact *contact, cp_error *error)
{
    *contact = (cp_recorded_contact){.gap_m = INFINITY};
    replay self = {
        .ids = ids, .step_length_s = step_length_s, .report = report, .contact = contact};
    bool moved = false;
    double end_s = 0.0;
    cp_status status = cp_detector_create(&self.detector, error);
    if (status == CP_OK)
        status = look_through(&self, track, &moved, &end_s, error);

    contact->is_taken = report != NULL && !self.is_over;

    // Nothing in the record: through the step of the report, then on as they moved last, speeds as
    // at its end.
    double steps = CP_RECORDED_CARRY_ON_S / step_length_s;
    bool by_report =
        contact->is_taken && fabs(report->time_s - end_s - step_length_s) < 0.5 * step_length_s;
    for (int k = 1; status == CP_OK && moved && !contact->is_found && k <= steps; k++) {
        if (k == 1 && by_report) {
            carry_through_report(&self, step_length_s);
        } else {
            carry_on(&self.motion[0], step_length_s);
            carry_on(&self.motion[1], step_length_s);
        }
        status = look(&self, end_s + k * step_length_s, error);
        contact->is_carried = contact->is_found;
    }
    cp_detector_destroy(self.detector);
    return status;
}
