/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/study.h"

#include "study/sumo_configuration.h"

#include <stdlib.h>
#include <string.h>

static const char *const DESIGN_TEXT[] = {
#define CP_STUDY_DESIGN_TEXT(name, text) [name] = text,
    CP_STUDY_DESIGNS(CP_STUDY_DESIGN_TEXT)
#undef CP_STUDY_DESIGN_TEXT
};
#define DESIGN_COUNT (sizeof DESIGN_TEXT / sizeof DESIGN_TEXT[0])

const char *cp_study_design_text(cp_study_design design)
{
    return DESIGN_TEXT[design];
}

bool cp_study_design_find(const char *text, cp_study_design *design)
{
    for (size_t k = 0; k < DESIGN_COUNT; k++)
        if (strcmp(text, DESIGN_TEXT[k]) == 0) {
            *design = (cp_study_design)k;
            return true;
        }
    return false;
}

void cp_study_destroy(cp_study *study)
{
    for (size_t k = 0; k < study->scenario_count; k++)
        cp_study_scenario_destroy(&study->scenarios[k]);
    for (size_t k = 0; k < study->variant_count; k++)
        cp_study_variant_destroy(&study->variants[k]);
    for (size_t k = 0; k < study->vehicle_count; k++) {
        free(study->vehicles[k].type);
        free(study->vehicles[k].model_path);
        free(study->vehicles[k].model_name);
    }
    for (size_t k = 0; k < study->market_count; k++) {
        free(study->market[k].type);
        free(study->market[k].vehicle_class);
    }
    free(study->scenarios);
    free(study->variants);
    free(study->vehicles);
    free(study->market);
    free(study->question);
    free(study->name);
    free(study->content);
    free(study->path);
    *study = (cp_study){0};
}

size_t cp_study_baseline(const cp_study *study)
{
    size_t k = 0;
    while (k + 1 < study->variant_count && !study->variants[k].is_baseline)
        k++;
    return k;
}

bool cp_study_scenarios_start_alike(const cp_study_scenario *one, const cp_study_scenario *other)
{
    bool alike = strcmp(one->sumocfg_path, other->sumocfg_path) == 0 &&
                 one->sumo_option_count == other->sumo_option_count;
    for (size_t k = 0; alike && k < one->sumo_option_count; k++)
        alike = strcmp(one->sumo_options[k], other->sumo_options[k]) == 0;
    return alike;
}

cp_scenario_inputs cp_study_scenario_inputs(const cp_study_scenario *scenario)
{
    return (cp_scenario_inputs){.sumocfg_path = scenario->sumocfg_path,
                                .words = scenario->sumo_options,
                                .word_count = scenario->sumo_option_count};
}

cp_status cp_study_tell_options(const cp_study *study, cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < study->scenario_count; k++) {
        const cp_study_scenario *scenario = &study->scenarios[k];
        cp_sumo_configuration configuration = {0};
        size_t first = 0;
        while (!cp_study_scenarios_start_alike(&study->scenarios[first], scenario))
            first++;
        if (first < k)
            continue;
        status = cp_sumo_configuration_read(scenario->sumocfg_path, scenario->sumo_options,
                                            scenario->sumo_option_count, &configuration, error);
        if (status == CP_OK)
            cp_sumo_configuration_tell(&configuration);
        cp_sumo_configuration_destroy(&configuration);
    }
    return status;
}

const cp_study_scenario *cp_study_find_scenario(const cp_study *study, const char *name)
{
    for (size_t k = 0; k < study->scenario_count; k++)
        if (strcmp(study->scenarios[k].name, name) == 0)
            return &study->scenarios[k];
    return NULL;
}
