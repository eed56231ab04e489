/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "assess/configurations.h"

#include "core/log.h"
#include "impact/confirmation.h"
#include "impact/recorded_contact.h"
#include "run/crash_record.h"

#include <math.h>
#include <stdio.h>

// Two cars on their ways from where they are given: a record of one step, carried on to contact.
static cp_status contact_of_poses(const cp_listed_configuration *row,
                                  const cp_vehicle_model *const models[2],
                                  cp_recorded_contact *contact, cp_error *error)
{
    const double step_s = 0.01;
    const char *const ids[2] = {"a", "b"};
    cp_vehicle_state state[2][2];
    double time_s[2] = {-step_s, 0.0};
    cp_recorded_track track[2];
    for (int v = 0; v < 2; v++) {
        // The centre of gravity on its arc, back by a step; the front before it.
        for (int k = 0; k < 2; k++) {
            double turned_rad = row->yaw_rate_rad_s[v] * time_s[k];
            double yaw_rad = cp_wrap_angle(row->pose[v].yaw_rad + turned_rad);
            double way_m = row->speed_m_s[v] * time_s[k];
            cp_vec2 cog_m = cp_vec2_add(
                row->pose[v].position_m,
                cp_vec2_scale(cp_vec2_heading(row->pose[v].yaw_rad + 0.5 * turned_rad), way_m));
            cp_vec2 front_m = cp_vec2_add(
                cog_m, cp_vec2_scale(cp_vec2_heading(yaw_rad), models[v]->cg_to_front_m));
            state[v][k] = (cp_vehicle_state){.vehicle = (uint32_t)v,
                                             .front_x_m = front_m.x,
                                             .front_y_m = front_m.y,
                                             .yaw_rad = yaw_rad,
                                             .speed_m_s = row->speed_m_s[v],
                                             .lane_position_m = CP_LISTED_FAR_ALONG_M,
                                             .length_m = models[v]->length_m,
                                             .width_m = models[v]->width_m};
        }
        track[v] = (cp_recorded_track){state[v], time_s, 2};
    }
    return cp_recorded_contact_find(track, ids, step_s, NULL, contact, error);
}

static cp_status facts_of_poses(const cp_listed_configuration *row, const char *list_path,
                                const cp_vehicle_model *models[2], cp_crash_facts *facts,
                                bool *swapped, cp_error *error)
{
    cp_recorded_contact contact;
    cp_status status = contact_of_poses(row, models, &contact, error);
    if (status != CP_OK)
        return status;
    if (contact.gap_m < 0.0)
        return cp_fail(
            error, CP_BAD_INPUT,
            "%s:%zu: x_b_m, y_b_m must leave the cars apart, found them %.3g m into each "
            "other",
            list_path, row->line, -contact.gap_m);
    if (!contact.is_found)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s:%zu: the two must meet within %g s, found them passing", list_path,
                       row->line, CP_RECORDED_CARRY_ON_S);
    *swapped = contact.impact.vehicle[0] == 1;
    const cp_vehicle_model *by_role[2] = {models[*swapped], models[!*swapped]};
    *facts = (cp_crash_facts){
        .time_s = contact.impact.time_s,
        .contact_m = contact.impact.contact_m,
        .configuration = cp_impact_configuration(&contact.impact, by_role[0], by_role[1]),
        .description = cp_impact_describe(&contact.impact, by_role[0], by_role[1])};
    return CP_OK;
}

static cp_status facts_of_description(const cp_listed_configuration *row, const char *list_path,
                                      const cp_vehicle_model *models[2], cp_crash_facts *facts,
                                      bool *swapped, cp_error *error)
{
    cp_crash_configuration *configuration = &facts->configuration;
    *facts = (cp_crash_facts){0};
    cp_status status = cp_crash_configuration_from_description(
        models[0], models[1], NULL, row->speed_m_s[0], row->speed_m_s[1], row->offset_m,
        row->angle_rad, &facts->configuration, error);
    if (status != CP_OK) {
        cp_error_prefix(error, "%s:%zu: ", list_path, row->line);
        return status;
    }
    facts->contact_m = cp_crash_contact_point(models[0], models[1], configuration);
    *swapped = configuration->side[0] != CP_SIDE_FRONT && configuration->side[1] == CP_SIDE_FRONT;
    if (*swapped) {
        cp_body_state first = configuration->vehicle[0];
        cp_contact_side first_side = configuration->side[0];
        configuration->vehicle[0] = configuration->vehicle[1];
        configuration->side[0] = configuration->side[1];
        configuration->vehicle[1] = first;
        configuration->side[1] = first_side;
    }
    facts->description =
        cp_crash_describe(models[*swapped], models[!*swapped], configuration, facts->contact_m);
    return CP_OK;
}

// Whether the two really strike each other, by the rule that contacts of a study are confirmed by;
// what does not is told.
static bool is_struck(const cp_listed_configuration *row, const char *list_path,
                      const cp_crash_facts *facts, const cp_vehicle_model *by_role[2])
{
    cp_touching_body body[2];
    cp_touch touch = {facts->contact_m,
                      {facts->configuration.side[0], facts->configuration.side[1]}};
    for (int role = 0; role < 2; role++) {
        const cp_body_state *state = &facts->configuration.vehicle[role];
        const cp_vehicle_model *model = by_role[role];
        cp_vec2 to_front_m = cp_vec2_scale(cp_vec2_heading(state->yaw_rad), model->cg_to_front_m);
        cp_vec2 to_centre_m = cp_vec2_scale(cp_vec2_heading(state->yaw_rad),
                                            model->cg_to_front_m - 0.5 * model->length_m);
        body[role] =
            (cp_touching_body){.rectangle = {cp_vec2_add(state->cog_m, to_centre_m), state->yaw_rad,
                                             model->length_m, model->width_m},
                               .front_velocity_m_s = cp_point_velocity(
                                   state->velocity_m_s, state->yaw_rate_rad_s, to_front_m),
                               .yaw_rate_rad_s = state->yaw_rate_rad_s};
    }
    if (cp_contact_is_crash(body, &touch))
        return true;
    cp_log_warning("%s:%zu: '%s' is a graze: the front edges meet over %.2f m, and the cars do not "
                   "go %g m into each other",
                   list_path, row->line, row->id, fmax(cp_front_edges_overlap_m(body), 0.0),
                   CP_CONFIRMATION_DEPTH_M);
    return false;
}

// The vehicle that a row names, else the default.
static cp_status choose_listed(const cp_listed_configuration *row, int v, const char *list_path,
                               const cp_fleet *fleet, cp_fleet_choice *choice, cp_error *error)
{
    const cp_sumo_type any = cp_listed_standard_car();
    if (row->vehicle[v] == NULL && fleet->models[0].name[0] == '\0')
        return cp_fail(
            error, CP_BAD_INPUT,
            "%s:%zu: vehicle_%c must name a vehicle where there is no default (--vehicle)",
            list_path, row->line, "ab"[v]);
    return cp_fleet_choose(fleet, list_path, row->vehicle[v] != NULL ? row->vehicle[v] : "", &any,
                           choice, error);
}

static cp_status assess_row(const cp_configuration_list *list, size_t number, const char *list_path,
                            const cp_fleet *fleet, cp_result_rows *results,
                            cp_assessment_count *count, cp_error *error)
{
    const cp_listed_configuration *row = &list->row[number];
    const char *type[2];
    const cp_vehicle_model *models[2];
    cp_fleet_choice choice[2];
    cp_status status = CP_OK;
    bool swapped = false;
    cp_crash_facts facts;
    char id[2][512];
    for (int v = 0; v < 2; v++) {
        type[v] = row->vehicle[v] != NULL ? row->vehicle[v] : "default";
        if (status == CP_OK)
            status = choose_listed(row, v, list_path, fleet, &choice[v], error);
        snprintf(id[v], sizeof id[v], "%.500s.%c", row->id, "ab"[v]);
    }
    if (status != CP_OK)
        return status;
    models[0] = choice[0].model;
    models[1] = choice[1].model;
    status = list->has_poses
                 ? facts_of_poses(row, list_path, models, &facts, &swapped, error)
                 : facts_of_description(row, list_path, models, &facts, &swapped, error);
    if (status != CP_OK)
        return status;

    // Role a is a car whose front is struck: the list's b where only its front is.
    const cp_stand_in cars[2] = {{choice[swapped], *models[swapped], ""},
                                 {choice[!swapped], *models[!swapped], ""}};
    cp_impact_names names = {.sumo_id = {id[swapped], id[!swapped]},
                             .sumo_type = {type[swapped], type[!swapped]}};
    for (int role = 0; role < 2; role++) {
        facts.length_m[role] = cars[role].model.length_m;
        facts.width_m[role] = cars[role].model.width_m;
    }
    const cp_vehicle_model *by_role[2] = {&cars[0].model, &cars[1].model};
    if (!is_struck(row, list_path, &facts, by_role)) {
        count->filtered++;
        return CP_OK;
    }
    cp_crash_row *crash = cp_result_rows_add_crash(results);
    return crash != NULL ? cp_crash_record_facts(&facts, &names, cars, CP_RECORD_ALL, crash, error)
                         : cp_fail_memory(error, "crash");
}

cp_status cp_assess_configurations(const cp_configuration_list *list, const char *list_path,
                                   const cp_fleet *fleet, cp_assessment_keep keep, bool strict,
                                   cp_result_rows *results, cp_assessment_count *count,
                                   cp_error *error)
{
    cp_error first = {0};
    *count = (cp_assessment_count){.listed = list->count};
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < list->count; k++) {
        cp_error reason = {0};
        size_t before = results->crash_count;
        status = assess_row(list, k, list_path, fleet, results, count, &reason);
        if (keep == CP_KEEP_NO_PULSES)
            cp_listed_drop_pulses(results);
        if (status == CP_OK)
            continue;
        if (count->bad == 0)
            first = reason;
        if (strict || status != CP_BAD_INPUT || results->crash_count != before) {
            *error = reason;
            continue;
        }
        status = CP_OK;
        if (++count->bad < list->count)
            cp_log_warning("%s; left out", reason.text);
    }
    count->crashes = results->crash_count;
    // Not one is right: the first says why.
    if (status == CP_OK && count->bad == list->count) {
        *error = first;
        return CP_BAD_INPUT;
    }
    return status;
}
