/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/background.h"

#include "run/simulation.h"

#include <jansson.h>
#include <math.h>
#include <string.h>

// ---- simulating ----------------------------------------------------------------------------

static cp_status add_contact(const cp_traffic *traffic, const cp_found_contact *found,
                             cp_background_rows *rows, cp_error *error)
{
    const cp_impact *impact = &found->impact;
    cp_background_contact_row *row = cp_background_rows_add_contact(rows);
    if (row == NULL)
        return cp_fail_memory(error, "background");
    *row = (cp_background_contact_row){.time_s = impact->time_s,
                                       .contact_m = impact->contact_m,
                                       .reason = cp_found_as_text(found->found_as),
                                       .crash_type = "",
                                       .closing_speed_m_s = NAN,
                                       .lateral_offset_m = NAN,
                                       .angle_rad = NAN};
    if (cp_found_is_crash(found)) {
        cp_vehicle_model model = cp_vehicle_model_default();
        cp_crash_description description = cp_impact_describe(impact, &model, &model);
        row->crash_type = cp_crash_type_text(impact->side[0], impact->side[1]);
        row->closing_speed_m_s = description.closing_speed_m_s;
        row->lateral_offset_m = description.lateral_offset_m;
        row->angle_rad = description.angle_rad;
    }
    for (int role = 0; role < 2; role++) {
        row->vehicle[role] = strdup(cp_traffic_vehicle_id(traffic, impact->vehicle[role]));
        if (row->vehicle[role] == NULL)
            return cp_fail_memory(error, "background");
    }
    return CP_OK;
}

static cp_status fill_rows(const cp_simulation *simulation, cp_background_rows *rows,
                           cp_error *error)
{
    cp_exposure counted = cp_simulation_counted(simulation, &rows->simulated_s);
    rows->vehicle_km = counted.vehicle_km;
    rows->vehicle_h = counted.vehicle_h;
    rows->departed = counted.departed;
    rows->sumo_version = strdup(cp_traffic_version(simulation->traffic));
    rows->sumo_command_line = strdup(cp_traffic_command_line(simulation->traffic));
    if (rows->sumo_version == NULL || rows->sumo_command_line == NULL)
        return cp_fail_memory(error, "background");
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < simulation->found_count; k++)
        status = add_contact(simulation->traffic, &simulation->found[k], rows, error);
    return status;
}

cp_status cp_background_run(const cp_background_options *options, cp_background_rows *rows,
                            cp_cross_check *check, cp_error *error)
{
    // Neither driver errors nor functions.
    cp_simulation_settings settings = {.sumo = options->sumo,
                                       .study_seed = options->seed,
                                       .seed = options->seed,
                                       .step_length_s = options->step_length_s,
                                       .warmup_s = options->warmup_s,
                                       .stay_s = options->stay_s};
    cp_simulation simulation = {0};
    rows->scenario = options->network;
    rows->seed = options->seed;
    rows->step_length_s = options->step_length_s;
    long long steps = llround(options->duration_s / options->step_length_s), done = 0;
    cp_status status = cp_simulation_begin(&settings, &simulation, error);
    while (status == CP_OK && done < steps &&
           (done == 0 || !cp_traffic_finished(simulation.traffic))) {
        status = cp_simulation_step(&simulation, error);
        done++;
    }
    if (status == CP_OK)
        status = fill_rows(&simulation, rows, error);
    if (status == CP_OK) {
        cp_cross_check_match(&simulation.check);
        *check = simulation.check;
        simulation.check = (cp_cross_check){0};
    }
    cp_simulation_end(&simulation);
    return status;
}

// ---- telling -------------------------------------------------------------------------------

// One more of a kind in a list of {key: word, key_2: word_2, count_key: number}.
static void count(json_t *list, const char *key, const char *word, const char *key_2,
                  const char *word_2, const char *count_key)
{
    size_t k;
    json_t *row;
    json_array_foreach(list, k, row)
    {
        bool is_same = strcmp(json_string_value(json_object_get(row, key)), word) == 0;
        if (key_2 != NULL)
            is_same &= strcmp(json_string_value(json_object_get(row, key_2)), word_2) == 0;
        if (!is_same)
            continue;
        json_int_t number = json_integer_value(json_object_get(row, count_key));
        json_object_set_new(row, count_key, json_integer(number + 1));
        return;
    }
    row = json_pack("{s:s, s:i}", key, word, count_key, 1);
    if (key_2 != NULL)
        json_object_set_new(row, key_2, json_string(word_2));
    json_array_append_new(list, row);
}

static json_t *crash_json(const cp_background_contact_row *contact)
{
    return json_pack("{s:f, s:f, s:f, s:s, s:f, s:s, s:s}", "time_s", contact->time_s, "x_m",
                     contact->contact_m.x, "y_m", contact->contact_m.y, "crash_type",
                     contact->crash_type, "closing_speed_m_s", contact->closing_speed_m_s,
                     "vehicle_1", contact->vehicle[0], "vehicle_2", contact->vehicle[1]);
}

cp_status cp_background_write_json(const cp_background_rows *rows, const cp_cross_check *check,
                                   const char *result_path, cp_error *error)
{
    json_t *contacts = json_array(), *crashes = json_array(), *reports = json_array();
    for (size_t k = 0; k < rows->contact_count; k++) {
        const cp_background_contact_row *contact = &rows->contact[k];
        count(contacts, "reason", contact->reason, "crash_type", contact->crash_type, "contacts");
        if (contact->crash_type[0] != '\0')
            json_array_append_new(crashes, crash_json(contact));
    }
    for (size_t k = 0; k < check->sumo_count; k++)
        count(reports, "found_as", cp_found_as_text(check->sumo[k].found_as), NULL, NULL,
              "collisions");
    json_t *result =
        json_pack("{s:s, s:I, s:f, s:f, s:f, s:f, s:I, s:o, s:o, s:o}", "network", rows->scenario,
                  "seed", (json_int_t)rows->seed, "step_length_s", rows->step_length_s,
                  "simulated_s", rows->simulated_s, "vehicle_km", rows->vehicle_km, "vehicle_h",
                  rows->vehicle_h, "departed", (json_int_t)rows->departed, "contacts", contacts,
                  "crashes", crashes, "sumo_collisions", reports);
    if (result == NULL)
        return cp_fail_memory(error, "background");
    int failed = json_dump_file(result, result_path, JSON_INDENT(2) | JSON_REAL_PRECISION(17));
    json_decref(result);
    return failed == 0 ? CP_OK : cp_fail(error, CP_IO_FAILED, "%s: cannot be written", result_path);
}
