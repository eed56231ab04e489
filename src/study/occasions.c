/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/occasions.h"

#include "core/log.h"
#include "study/scenario_files.h"

#include <string.h>

static void tell(const cp_study_scenario *scenario, const char *model,
                 const cp_scenario_occasions *occasions)
{
    if (strcmp(model, "red_light") == 0 && !occasions->has_lights)
        cp_log_warning("scenario %s: red_light cannot act: the network has no traffic light",
                       scenario->name);
    if (strcmp(model, "risky_overtaking") == 0 && !occasions->has_opposite)
        cp_log_warning(
            "scenario %s: risky_overtaking cannot act: no lane of the network may overtake "
            "over the oncoming one (netconvert --opposites.guess)",
            scenario->name);
}

cp_status cp_study_tell_occasions(const cp_study *study, cp_error *error)
{
    cp_status status = CP_OK;
    cp_scenario_occasions occasions = {0};
    bool is_known = false;
    for (size_t k = 0; status == CP_OK && k < study->scenario_count; k++) {
        const cp_study_scenario *scenario = &study->scenarios[k];
        // Those of a sweep read the same files.
        is_known = is_known && cp_study_scenarios_start_alike(scenario - 1, scenario);
        if (scenario->driver_error_count == 0)
            continue;
        cp_scenario_inputs inputs = cp_study_scenario_inputs(scenario);
        if (!is_known)
            status = cp_scenario_occasions_find(&inputs, &occasions, error);
        is_known = true;
        for (size_t e = 0; status == CP_OK && e < scenario->driver_error_count; e++)
            tell(scenario, scenario->driver_errors[e].type->name, &occasions);
    }
    return status;
}
