/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/study_parts.h"

#include <stdlib.h>
#include <string.h>

// ---- controls ------------------------------------------------------------------------------

static bool copy_shares(const cp_control_settings *from, cp_control_settings *to)
{
    to->shares = NULL;
    to->share_count = 0;
    if (from->share_count == 0)
        return true;
    to->shares = calloc(from->share_count, sizeof *to->shares);
    if (to->shares == NULL)
        return false;
    for (size_t k = 0; k < from->share_count; k++) {
        to->shares[k] = (cp_equipment_share){.type = strdup(from->shares[k].type),
                                             .penetration_1 = from->shares[k].penetration_1};
        to->share_count++;
        if (to->shares[k].type == NULL)
            return false;
    }
    return true;
}

static bool copy_controls(const cp_control_settings *from, size_t count, cp_control_settings **to,
                          size_t *copied)
{
    if (count == 0)
        return true;
    *to = calloc(count, sizeof **to);
    for (size_t k = 0; *to != NULL && k < count; k++) {
        (*to)[k] = from[k];
        (*to)[k].library = NULL;
        (*copied)++;
        if (!copy_shares(&from[k], &(*to)[k]))
            return false;
        if (from[k].library != NULL && !((*to)[k].library = cp_library_copy(from[k].library)))
            return false;
    }
    return *to != NULL;
}

static void destroy_controls(cp_control_settings *settings, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        for (size_t share = 0; share < settings[k].share_count; share++)
            free(settings[k].shares[share].type);
        free(settings[k].shares);
        cp_library_destroy(settings[k].library);
    }
    free(settings);
}

// ---- texts ---------------------------------------------------------------------------------

static bool copy_words(const cp_study_scenario *from, cp_study_scenario *to)
{
    if (from->sumo_option_count == 0)
        return true;
    to->sumo_options = calloc(from->sumo_option_count, sizeof *to->sumo_options);
    for (size_t k = 0; to->sumo_options != NULL && k < from->sumo_option_count; k++) {
        to->sumo_options[k] = strdup(from->sumo_options[k]);
        to->sumo_option_count++;
        if (to->sumo_options[k] == NULL)
            return false;
    }
    return to->sumo_options != NULL;
}

static void destroy_swept(cp_study_swept *swept, size_t count)
{
    for (size_t k = 0; k < count; k++)
        free(swept[k].parameter);
    free(swept);
}

// ---- public --------------------------------------------------------------------------------

cp_status cp_study_scenario_copy(const cp_study_scenario *scenario, cp_study_scenario *copy,
                                 cp_error *error)
{
    *copy = (cp_study_scenario){.name = strdup(scenario->name),
                                .base = strdup(scenario->base),
                                .sumocfg = strdup(scenario->sumocfg),
                                .sumocfg_path = strdup(scenario->sumocfg_path)};
    bool good = copy->name != NULL && copy->base != NULL && copy->sumocfg != NULL &&
                copy->sumocfg_path != NULL && copy_words(scenario, copy) &&
                copy_controls(scenario->driver_errors, scenario->driver_error_count,
                              &copy->driver_errors, &copy->driver_error_count);
    return good ? CP_OK : cp_fail_memory(error, scenario->name);
}

cp_status cp_study_variant_copy(const cp_study_variant *variant, cp_study_variant *copy,
                                cp_error *error)
{
    *copy = (cp_study_variant){.name = strdup(variant->name),
                               .base = strdup(variant->base),
                               .is_baseline = variant->is_baseline};
    bool good = copy->name != NULL && copy->base != NULL &&
                copy_controls(variant->functions, variant->function_count, &copy->functions,
                              &copy->function_count);
    return good ? CP_OK : cp_fail_memory(error, variant->name);
}

void cp_study_scenario_destroy(cp_study_scenario *scenario)
{
    for (size_t word = 0; word < scenario->sumo_option_count; word++)
        free(scenario->sumo_options[word]);
    free(scenario->sumo_options);
    destroy_controls(scenario->driver_errors, scenario->driver_error_count);
    destroy_swept(scenario->swept, scenario->swept_count);
    free(scenario->sumocfg_path);
    free(scenario->sumocfg);
    free(scenario->base);
    free(scenario->name);
}

void cp_study_variant_destroy(cp_study_variant *variant)
{
    destroy_controls(variant->functions, variant->function_count);
    destroy_swept(variant->swept, variant->swept_count);
    free(variant->base);
    free(variant->name);
}
