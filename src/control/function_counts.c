/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/function_counts.h"

/* Where counters are put. */
typedef struct counter_list {
    const char **names;
    double *values;
    size_t count, room;
} counter_list;

static void put(counter_list *list, const char *name, double value)
{
    if (list->count == list->room)
        return;
    list->names[list->count] = name;
    list->values[list->count++] = value;
}

size_t cp_function_counts_list(const cp_function_counts *counts,
                               const crashpulse_function *function, const double *counter,
                               const char **names, double *values, size_t room)
{
    const uint32_t does = function->does;
    counter_list list = {.names = names, .values = values, .room = room};
    if (does & CRASHPULSE_BRAKES) {
        put(&list, "activations", (double)counts->activations);
        put(&list, "activations_rear_end", (double)counts->of_class[CRASHPULSE_REAR_END]);
        put(&list, "activations_oncoming", (double)counts->of_class[CRASHPULSE_ONCOMING]);
        put(&list, "activations_crossing", (double)counts->of_class[CRASHPULSE_CROSSING]);
        put(&list, "activations_turning", (double)counts->of_class[CRASHPULSE_TURNING]);
        put(&list, "activations_without_error", (double)counts->activations_without_error);
        put(&list, "activations_for_nothing", (double)counts->for_nothing);
    }
    if (does & (CRASHPULSE_BRAKES | CRASHPULSE_DRIVER_BRAKES))
        put(&list, "braking_s", counts->braking_s);
    if (does & CRASHPULSE_WARNS) {
        put(&list, "warnings", (double)counts->warnings);
        put(&list, "warnings_without_error", (double)counts->warnings_without_error);
        put(&list, "warnings_borne_out", (double)counts->warnings_borne_out);
    }
    if (does & CRASHPULSE_STEERS)
        put(&list, "interventions", (double)counts->interventions);
    if (does & CRASHPULSE_LIMITS)
        put(&list, "limited_vehicles", (double)counts->limited);
    for (size_t k = 0; k < function->counter_count; k++)
        put(&list, function->counter_names[k], counter[k]);
    return list.count;
}
