/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/grouping.h"

#include <stdlib.h>
#include <string.h>

static cp_status find_scenario(const cp_study_data *data, const char *name, size_t *index,
                               cp_error *error)
{
    *index = CP_SLICE_ALL;
    if (!name)
        return CP_OK;
    char names[512] = "";
    size_t used = 0;
    for (size_t k = 0; k < data->scenario_count; k++) {
        if (strcmp(name, data->scenario[k].name) == 0) {
            *index = k;
            return CP_OK;
        }
        int more = used < sizeof names ? snprintf(names + used, sizeof names - used, "%s%s",
                                                  k ? ", " : "", data->scenario[k].name)
                                       : 0;
        used += more > 0 ? (size_t)more : 0;
    }
    return cp_fail(error, CP_BAD_INPUT, "there is no scenario '%s'; the study has: %s", name,
                   names);
}

static cp_status make_room(cp_grouping *g, size_t slices, size_t vehicles, cp_error *error)
{
    g->slice = calloc(slices + 1, sizeof *g->slice);
    g->name = calloc(slices + 1, sizeof *g->name);
    g->chosen = calloc(slices * vehicles + 1, sizeof *g->chosen);
    return g->slice && g->name && g->chosen ? CP_OK : cp_fail_memory(error, "groups");
}

// A slice for each scenario: exposure is the scenario's own.
static void group_by_scenario(const cp_study_data *data, size_t scenario, const char *where,
                              cp_grouping *g)
{
    for (size_t s = 0; s < data->scenario_count; s++) {
        if (scenario != CP_SLICE_ALL && scenario != s)
            continue;
        g->slice[g->count] = (cp_slice){s, CP_SLICE_ALL, where ? g->choice.chosen : NULL};
        g->name[g->count++] = data->scenario[s].name;
    }
}

static void group_by_value(const cp_study_data *data, size_t scenario, cp_grouping *g)
{
    for (size_t v = 0; v < g->choice.value_count; v++) {
        unsigned char *chosen = g->chosen + v * data->vehicle_count;
        for (size_t k = 0; k < data->vehicle_count; k++)
            chosen[k] = g->choice.group[k] == v;
        g->slice[g->count] = (cp_slice){scenario, CP_SLICE_ALL, chosen};
        g->name[g->count++] = g->choice.value[v];
    }
}

cp_status cp_grouping_create(cp_store *store, const cp_study_data *data, const char *scenario,
                             const char *by, const char *where, cp_grouping *grouping,
                             cp_error *error)
{
    *grouping = (cp_grouping){0};
    size_t only;
    bool by_scenario = by && strcmp(by, "scenario") == 0;
    cp_status status = find_scenario(data, scenario, &only, error);
    if (status == CP_OK && (where || (by && !by_scenario)))
        status =
            cp_study_choose(store, data, where, by_scenario ? NULL : by, &grouping->choice, error);
    size_t slices = by_scenario ? data->scenario_count : by ? grouping->choice.value_count : 1;
    if (status == CP_OK)
        status = make_room(grouping, slices, by && !by_scenario ? data->vehicle_count : 0, error);
    if (status != CP_OK) {
        cp_grouping_destroy(grouping);
        return status;
    }

    if (by_scenario) {
        group_by_scenario(data, only, where, grouping);
    } else if (by) {
        group_by_value(data, only, grouping);
    } else {
        grouping->slice[0] = (cp_slice){only, CP_SLICE_ALL, where ? grouping->choice.chosen : NULL};
        grouping->name[grouping->count++] = "";
    }
    if (grouping->count == 0) {
        cp_grouping_destroy(grouping);
        return cp_fail(error, CP_BAD_INPUT,
                       "no crash fits --where, so there are no groups of --by");
    }
    return CP_OK;
}

void cp_grouping_destroy(cp_grouping *grouping)
{
    cp_study_choice_destroy(&grouping->choice);
    free(grouping->slice);
    free(grouping->name);
    free(grouping->chosen);
    *grouping = (cp_grouping){0};
}
