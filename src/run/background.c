/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/background.h"

#include "run/simulation.h"

#include <jansson.h>
#include <math.h>
#include <string.h>

static const char *type_of(const cp_found_contact *found)
{
    if (!cp_found_is_crash(found))
        return "";
    return cp_crash_type_text(found->impact.side[0], found->impact.side[1]);
}

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

static json_t *crash_json(const cp_found_contact *found)
{
    cp_vehicle_model model = cp_vehicle_model_default();
    cp_crash_description description = cp_impact_describe(&found->impact, &model, &model);
    return json_pack("{s:f, s:f, s:f, s:s, s:f, s:s, s:s}", "time_s", found->impact.time_s, "x_m",
                     found->impact.contact_m.x, "y_m", found->impact.contact_m.y, "crash_type",
                     type_of(found), "closing_speed_m_s", description.closing_speed_m_s,
                     "vehicle_1", sumo_bridge_vehicle_id(found->impact.vehicle[0]), "vehicle_2",
                     sumo_bridge_vehicle_id(found->impact.vehicle[1]));
}

static cp_status write_result(const cp_background_options *options, cp_simulation *simulation,
                              double simulated_s, const char *result_path, cp_error *error)
{
    json_t *contacts = json_array(), *crashes = json_array(), *reports = json_array();
    for (size_t k = 0; k < simulation->found_count; k++) {
        const cp_found_contact *found = &simulation->found[k];
        count(contacts, "reason", found->found_as, "crash_type", type_of(found), "contacts");
        if (cp_found_is_crash(found))
            json_array_append_new(crashes, crash_json(found));
    }
    cp_cross_check_match(&simulation->check);
    for (size_t k = 0; k < simulation->check.sumo_count; k++)
        count(reports, "found_as", simulation->check.sumo[k].found_as, NULL, NULL, "collisions");

    cp_exposure exposure = cp_traffic_exposure(simulation->traffic);
    json_t *result = json_pack(
        "{s:s, s:I, s:f, s:f, s:f, s:I, s:o, s:o, s:o}", "network", options->network, "seed",
        (json_int_t)options->seed, "step_length_s", options->step_length_s, "simulated_s",
        simulated_s, "vehicle_km", exposure.vehicle_km, "departed", (json_int_t)exposure.departed,
        "contacts", contacts, "crashes", crashes, "sumo_collisions", reports);
    if (result == NULL)
        return cp_fail_memory(error, "background");
    int failed = json_dump_file(result, result_path, JSON_INDENT(2) | JSON_REAL_PRECISION(17));
    json_decref(result);
    return failed == 0 ? CP_OK : cp_fail(error, CP_IO_FAILED, "%s: cannot be written", result_path);
}

cp_status cp_background_run(const cp_background_options *options, const char *result_path,
                            cp_error *error)
{
    // A study of one scenario without errors and one variant without functions.
    cp_study_scenario scenario = *options->scenario;
    scenario.driver_errors = NULL;
    scenario.driver_error_count = 0;
    cp_study_variant variant = {0};
    cp_study study = {.seed = options->seed, .step_length_s = options->step_length_s};
    cp_simulation simulation = {0};
    long long steps = llround(options->duration_s / options->step_length_s), done = 0;
    cp_status status =
        cp_simulation_begin(&study, &scenario, &variant, options->seed, &simulation, error);
    while (status == CP_OK && done < steps &&
           (done == 0 || !cp_traffic_finished(simulation.traffic))) {
        status = cp_simulation_step(&simulation, error);
        done++;
    }
    if (status == CP_OK)
        status = write_result(options, &simulation, (double)done * options->step_length_s,
                              result_path, error);
    cp_simulation_end(&simulation);
    return status;
}
