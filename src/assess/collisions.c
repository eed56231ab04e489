/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "assess/collisions.h"

#include "core/log.h"
#include "impact/confirmation.h"
#include "impact/footprint.h"
#include "impact/recorded_contact.h"
#include "run/contact_rows.h"
#include "run/crash_record.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* One collision of the list while it is looked at. */
typedef struct collision_view {
    const cp_listed_collision *listed;
    const char *list_path;
    const cp_fleet *fleet;
    const cp_fcd_record *record;
    double step_length_s;   /* of the record */
    double sumo_step_s;     /* SUMO's own, where it is told to be shorter */
    const char *type_id[2]; /* the list's, else the record's */
    cp_sumo_type type[2];
    cp_vehicle_state *state[2];
    double *time_s[2];
    cp_recorded_track track[2];
} collision_view;

// What a vehicle is, as the bridge would tell it, and so how large its rectangle. Models that types
// name are the fleet's already.
static cp_status describe_type(const collision_view *view, const cp_vtypes *types, int role,
                               cp_sumo_type *type, cp_error *error)
{
    const char *id = view->type_id[role];
    const cp_vtype *known = cp_vtypes_find(types, id);
    cp_fleet_choice choice;
    *type = cp_listed_standard_car();
    if (known != NULL) {
        snprintf(type->vehicle_class, sizeof type->vehicle_class, "%s", known->vehicle_class);
        type->length_m = known->length_m;
        type->width_m = known->width_m;
        type->height_m = known->height_m;
        type->mass_kg = known->mass_kg;
        return CP_OK;
    }
    cp_status status = cp_fleet_choose(view->fleet, "", id, type, &choice, error);
    if (status == CP_OK && strcmp(choice.chosen_by, "study") == 0) {
        type->length_m = choice.model->length_m;
        type->width_m = choice.model->width_m;
    }
    return status;
}

static cp_status make_track(collision_view *view, const cp_fcd_track *track, const cp_vtypes *types,
                            int role, cp_error *error)
{
    const char *listed_type = view->listed->type[role];
    view->type_id[role] = listed_type != NULL   ? listed_type
                          : track->type != NULL ? track->type
                                                : "";
    cp_status status = describe_type(view, types, role, &view->type[role], error);
    if (status != CP_OK)
        return status;
    view->state[role] = calloc(track->count + 1, sizeof **view->state);
    view->time_s[role] = calloc(track->count + 1, sizeof **view->time_s);
    if (view->state[role] == NULL || view->time_s[role] == NULL)
        return cp_fail_memory(error, "ways of vehicles");
    for (size_t k = 0; k < track->count; k++) {
        const cp_fcd_sample *sample = &track->sample[k];
        view->time_s[role][k] = sample->time_s;
        view->state[role][k] = (cp_vehicle_state){.vehicle = (uint32_t)role,
                                                  .lane = (uint32_t)sample->lane,
                                                  .front_x_m = sample->front_m.x,
                                                  .front_y_m = sample->front_m.y,
                                                  .yaw_rad = sample->yaw_rad,
                                                  .speed_m_s = sample->speed_m_s,
                                                  .lane_position_m = isnan(sample->lane_position_m)
                                                                         ? CP_LISTED_FAR_ALONG_M
                                                                         : sample->lane_position_m,
                                                  .length_m = view->type[role].length_m,
                                                  .width_m = view->type[role].width_m};
    }
    view->track[role] = (cp_recorded_track){view->state[role], view->time_s[role], track->count};
    return CP_OK;
}

/* How a way goes on back beyond its first state. */
typedef struct way_back {
    double turn_rad;  /* of the heading in a step */
    double drift_rad; /* of the front's way from the heading: the rear cuts the corner */
} way_back;

// As from the first report to the second, where there is one in the next step; else straight.
static way_back way_back_of(const collision_view *view, int v)
{
    const cp_recorded_track *track = &view->track[v];
    way_back back = {0.0, 0.0};
    if (track->count < 2 || track->time_s[1] - track->time_s[0] > 1.5 * view->step_length_s)
        return back;
    const cp_vehicle_state *first = &track->state[0], *second = &track->state[1];
    double x_m = second->front_x_m - first->front_x_m, y_m = second->front_y_m - first->front_y_m;
    back.turn_rad = cp_wrap_angle(second->yaw_rad - first->yaw_rad);
    if (hypot(x_m, y_m) > 0.1)
        back.drift_rad = cp_wrap_angle(atan2(y_m, x_m) - (first->yaw_rad + 0.5 * back.turn_rad));
    return back;
}

static cp_vehicle_state step_back(cp_vehicle_state state, way_back back, double step_length_s)
{
    double heading_rad = state.yaw_rad - 0.5 * back.turn_rad + back.drift_rad;
    cp_vec2 way_m = cp_vec2_scale(cp_vec2_heading(heading_rad), state.speed_m_s * step_length_s);
    state.front_x_m -= way_m.x;
    state.front_y_m -= way_m.y;
    state.yaw_rad = cp_wrap_angle(state.yaw_rad - back.turn_rad);
    return state;
}

// In front of a track, steps states back from its first one.
static cp_status extend_back(collision_view *view, int v, size_t steps, cp_error *error)
{
    size_t count = view->track[v].count;
    way_back back = way_back_of(view, v);
    cp_vehicle_state *state = calloc(count + steps, sizeof *state);
    double *time_s = calloc(count + steps, sizeof *time_s);
    if (state == NULL || time_s == NULL) {
        free(state);
        free(time_s);
        return cp_fail_memory(error, "ways of vehicles");
    }
    memcpy(&state[steps], view->state[v], count * sizeof *state);
    memcpy(&time_s[steps], view->time_s[v], count * sizeof *time_s);
    for (size_t k = steps; k > 0; k--) {
        state[k - 1] = step_back(state[k], back, view->step_length_s);
        time_s[k - 1] = time_s[k] - view->step_length_s;
    }
    free(view->state[v]);
    free(view->time_s[v]);
    view->state[v] = state;
    view->time_s[v] = time_s;
    view->track[v] = (cp_recorded_track){state, time_s, count + steps};
    return CP_OK;
}

// Back until the two are apart.
static cp_status lead_in(collision_view *view, cp_error *error)
{
    const double longest_s = 2.0;
    cp_vehicle_state state[2] = {view->state[0][0], view->state[1][0]};
    bool are_apart = false;
    size_t steps = 0;
    while (!are_apart && (double)steps * view->step_length_s < longest_s) {
        cp_rectangle rectangle[2];
        for (int v = 0; v < 2; v++) {
            state[v] = step_back(state[v], way_back_of(view, v), view->step_length_s);
            rectangle[v] = cp_vehicle_rectangle(&state[v]);
        }
        are_apart = cp_rectangle_separation(&rectangle[0], &rectangle[1]) > 0.0;
        steps++;
    }
    cp_status status = extend_back(view, 0, steps, error);
    return status == CP_OK ? extend_back(view, 1, steps, error) : status;
}

static cp_status add_crash(const collision_view *view, const cp_impact *impact,
                           cp_result_rows *results, cp_error *error)
{
    cp_impact_names names = {.sumocfg_path = view->list_path};
    for (int role = 0; role < 2; role++) {
        names.sumo_id[role] = view->listed->id[impact->vehicle[role]];
        names.sumo_type[role] = view->type_id[impact->vehicle[role]];
        names.type[role] = view->type[impact->vehicle[role]];
        // Numbers of lanes are those of the record here.
        if (impact->state[role].lane < view->record->lane_count)
            names.lane[role] = view->record->lanes[impact->state[role].lane];
    }
    cp_crash_row *row = cp_result_rows_add_crash(results);
    return row != NULL
               ? cp_crash_record_fill(impact, &names, view->fleet, CP_RECORD_ALL, row, error)
               : cp_fail_memory(error, "crash");
}

static cp_status add_contact(const collision_view *view, const cp_impact *impact,
                             cp_result_rows *results, cp_error *error)
{
    const char *const ids[2] = {view->listed->id[impact->vehicle[0]],
                                view->listed->id[impact->vehicle[1]]};
    return cp_contact_rows_add(results, impact, cp_contact_verdict_text(impact->verdict), ids,
                               error);
}

static cp_status add_report(const collision_view *view, const char *found_as, double gap_m,
                            cp_result_rows *results, cp_error *error)
{
    const cp_reported_collision report = {.time_s = view->listed->time_s + view->sumo_step_s,
                                          .collider = view->listed->id[0],
                                          .victim = view->listed->id[1],
                                          .type = view->listed->kind,
                                          .found_as = found_as,
                                          .gap_m = gap_m};
    return cp_contact_rows_add_report(results, &report, error);
}

// Carried through the step in which SUMO took them away, and that step is long: what turned before,
// or only touches after it, did something else in it.
static bool is_doubtful(const collision_view *view, const cp_recorded_contact *contact)
{
    const double straight_rad = 0.01;
    const double *yaw_rate_rad_s = contact->impact.yaw_rate_rad_s;
    return contact->is_found && contact->is_carried && contact->is_taken &&
           view->step_length_s > CP_FCD_COARSEST_PERIOD_S &&
           (fmax(fabs(yaw_rate_rad_s[0]), fabs(yaw_rate_rad_s[1])) * view->step_length_s >
                straight_rad ||
            contact->impact.time_s > view->listed->time_s + 1e-6);
}

// One of the two is not in the record.
static cp_status take_missing(const collision_view *view, int missing, bool strict,
                              cp_assessment_count *count, cp_error *error)
{
    const cp_listed_collision *listed = view->listed;
    cp_error reason = {0};
    cp_status status = cp_fail(
        &reason, CP_BAD_INPUT,
        "%s:%zu: '%s' is not in the record around %g s: whether it and '%s' touch is not known",
        view->list_path, listed->line, listed->id[missing], listed->time_s,
        listed->id[1 - missing]);
    if (strict) {
        *error = reason;
        return status;
    }
    count->bad++;
    cp_log_warning("%s", reason.text);
    return CP_OK;
}

// Both are in the record and have no contact: told why, and counted. How near the two came is not
// known when it is not known how they met.
static void tell_missed(const collision_view *view, cp_recorded_contact *contact,
                        cp_assessment_count *count)
{
    const cp_listed_collision *listed = view->listed;
    const char *one = listed->id[0], *other = listed->id[1];
    bool is_unknown = contact->is_taken && view->step_length_s > CP_FCD_COARSEST_PERIOD_S;
    count->unknown += is_unknown;
    count->no_contact += !is_unknown;
    if (is_unknown) {
        contact->gap_m = NAN;
        cp_log_warning("%s:%zu: SUMO took '%s' or '%s' away in the step of %g s in which they "
                       "collided: how they met is not known (write the record with "
                       "--collision.action warn, or in steps of %g s at most)",
                       view->list_path, listed->line, one, other, view->step_length_s,
                       CP_FCD_COARSEST_PERIOD_S);
    } else {
        cp_log_warning("%s:%zu: '%s' and '%s' do not touch, nearest %g m", view->list_path,
                       listed->line, one, other, contact->gap_m);
    }
}

static cp_status assess_one(collision_view *view, bool strict, cp_result_rows *results,
                            cp_assessment_count *count, cp_error *error)
{
    const cp_listed_collision *listed = view->listed;
    const char *const ids[2] = {listed->id[0], listed->id[1]};
    const cp_recorded_report report = {listed->time_s,
                                       {listed->speed_m_s[0], listed->speed_m_s[1]}};
    cp_recorded_contact contact;
    cp_status status =
        cp_recorded_contact_find(view->track, ids, view->step_length_s, &report, &contact, error);
    if (status != CP_OK)
        return status;
    bool is_missed = !contact.is_found || is_doubtful(view, &contact);
    // SUMO's files name a step by its beginning, its clock and we by its end.
    contact.impact.time_s += view->sumo_step_s;
    const char *found_as = "no_contact";
    int missing = view->track[0].count == 0 ? 0 : view->track[1].count == 0 ? 1 : -1;
    bool is_confirmed = contact.is_found && contact.impact.verdict == CP_CONTACT_CONFIRMED;
    if (missing >= 0) {
        status = take_missing(view, missing, strict, count, error);
    } else if (is_missed) {
        tell_missed(view, &contact, count);
    } else if (!is_confirmed) {
        count->filtered++;
        found_as = cp_contact_verdict_text(contact.impact.verdict);
        cp_log_info("%s:%zu: '%s' and '%s' are not counted: %s", view->list_path, listed->line,
                    ids[0], ids[1], found_as);
        status = add_contact(view, &contact.impact, results, error);
    } else {
        count->crashes++;
        count->carried += contact.is_carried;
        found_as = "crash";
        status = add_crash(view, &contact.impact, results, error);
    }
    return status == CP_OK ? add_report(view, found_as, contact.gap_m, results, error) : status;
}

static int compare_crashes(const void *one, const void *other)
{
    const cp_crash_row *a = one, *b = other;
    if (a->time_s != b->time_s)
        return a->time_s < b->time_s ? -1 : 1;
    int order = strcmp(a->vehicle[0].sumo_id, b->vehicle[0].sumo_id);
    return order != 0 ? order : strcmp(a->vehicle[1].sumo_id, b->vehicle[1].sumo_id);
}

static cp_status check_seen(const cp_collision_list *list, const char *list_path,
                            const cp_fcd_record *record, cp_error *error)
{
    for (size_t k = 0; k < list->count; k++)
        if (record->track[k][0].count > 0 && record->track[k][1].count > 0)
            return CP_OK;
    if (list->count == 0)
        return CP_OK;
    return cp_fail(
        error, CP_BAD_INPUT,
        "%s:%zu: '%s' and '%s' must be on the road around %g s in the record of the same "
        "run, found neither these nor any other pair of the list",
        list_path, list->collision[0].line, list->collision[0].id[0], list->collision[0].id[1],
        list->collision[0].time_s);
}

// Times are written with two or three digits: what is about the record's step is that.
static double sumo_step_of(const cp_collision_list *list, const cp_fcd_record *record)
{
    const double rounding_s = 0.011;
    return list->step_s < record->step_length_s - rounding_s ? list->step_s : record->step_length_s;
}

cp_status cp_assess_collisions(const cp_collision_list *list, const char *list_path,
                               cp_fcd_record *record, const cp_vtypes *types, const cp_fleet *fleet,
                               cp_assessment_keep keep, bool strict, cp_result_rows *results,
                               cp_assessment_count *count, cp_error *error)
{
    *count = (cp_assessment_count){.listed = list->count};
    if (list->with_themselves > 0)
        cp_log_warning("%s: %zu rows in which a vehicle collides with itself are passed over",
                       list_path, list->with_themselves);
    cp_status status = check_seen(list, list_path, record, error);
    for (size_t k = 0; status == CP_OK && k < list->count; k++) {
        collision_view view = {.listed = &list->collision[k],
                               .list_path = list_path,
                               .fleet = fleet,
                               .record = record,
                               .step_length_s = record->step_length_s,
                               .sumo_step_s = sumo_step_of(list, record)};
        for (int role = 0; status == CP_OK && role < 2; role++)
            status = make_track(&view, &record->track[k][role], types, role, error);
        if (status == CP_OK && record->of_places)
            status = lead_in(&view, error);
        if (status == CP_OK)
            status = assess_one(&view, strict, results, count, error);
        for (int role = 0; role < 2; role++) {
            free(view.state[role]);
            free(view.time_s[role]);
            cp_fcd_track_destroy(&record->track[k][role]);
        }
        if (keep == CP_KEEP_NO_PULSES)
            cp_listed_drop_pulses(results);
    }
    if (status == CP_OK && results->crash_count > 1)
        qsort(results->crash, results->crash_count, sizeof *results->crash, compare_crashes);
    results->simulated_s = record->simulated_s;
    results->vehicle_km = record->vehicle_km;
    results->vehicle_h = record->vehicle_h;
    results->departed = record->departed;
    return status;
}
