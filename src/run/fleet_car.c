/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/fleet_car.h"

#include "crash/drawn_car.h"
#include "crash/validity.h"

#include <string.h>

void cp_fleet_begin(cp_fleet *fleet, size_t replication_number)
{
    fleet->cars = cp_rng_key_number(cp_rng_key_text(cp_rng_key_seed(fleet->study->seed), "fleet"),
                                    replication_number);
}

// The class drawn by the market's shares of the type; NULL when it has none.
static const char *draw_of_market(const cp_study *study, const char *sumo_type, double uniform_1)
{
    const char *drawn = NULL;
    double left_1 = uniform_1;
    for (size_t k = 0; k < study->market_count && left_1 >= 0.0; k++) {
        const cp_study_market *row = &study->market[k];
        if (strcmp(row->type, sumo_type) != 0 || row->share_1 <= 0.0)
            continue;
        drawn = row->vehicle_class;
        left_1 -= row->share_1;
    }
    return drawn;
}

static cp_status take_class(const cp_fleet *fleet, const char *name, const char *chosen_by,
                            cp_fleet_choice *choice, cp_error *error)
{
    *choice = (cp_fleet_choice){.model = cp_fleet_find(fleet, name), .chosen_by = chosen_by};
    return choice->model != NULL
               ? CP_OK
               : cp_fail(error, CP_RUN_FAILED, "the shipped model %s is missing", name);
}

static cp_status choose_in_fleet(const cp_fleet *fleet, const char *sumocfg_path,
                                 const char *sumo_type, const cp_sumo_type *type,
                                 const cp_vehicle_size *size, cp_rng_key car,
                                 cp_fleet_choice *choice, cp_error *error)
{
    cp_status status = cp_fleet_choose(fleet, sumocfg_path, sumo_type, type, choice, error);
    if (status != CP_OK || strcmp(choice->chosen_by, "study") == 0 ||
        strcmp(choice->chosen_by, "sumo_type") == 0)
        return status;
    double uniform_1 = cp_rng_uniform(cp_rng_key_text(car, "class"), 0);
    const char *name = draw_of_market(fleet->study, sumo_type, uniform_1);
    if (name != NULL)
        return take_class(fleet, name, "market", choice, error);
    name = cp_vehicle_draw_class(size, uniform_1, choice->reason);
    if (name != NULL)
        return take_class(fleet, name, "fleet", choice, error);
    choice->model = NULL;
    choice->chosen_by = "";
    return CP_OK;
}

cp_status cp_fleet_car(const cp_fleet *fleet, const char *sumocfg_path, const char *sumo_type,
                       const cp_sumo_type *type, const char *sumo_id, cp_fleet_choice *choice,
                       cp_vehicle_model *car, cp_error *error)
{
    cp_rng_key key = cp_rng_key_text(fleet->cars, sumo_id);
    const cp_vehicle_size size = {.vehicle_class = type->vehicle_class,
                                  .length_m = type->length_m,
                                  .width_m = type->width_m,
                                  .height_m = type->height_m,
                                  .mass_kg = type->mass_kg};
    bool has_fleet = fleet->study->has_fleet;
    cp_status status =
        has_fleet ? choose_in_fleet(fleet, sumocfg_path, sumo_type, type, &size, key, choice, error)
                  : cp_fleet_choose(fleet, sumocfg_path, sumo_type, type, choice, error);
    if (status != CP_OK || choice->model == NULL)
        return status;
    bool is_drawn = has_fleet && cp_vehicle_is_fleet_class(choice->model->name);
    bool is_heavy = choice->model->mass_kg > CP_HEAVY_FROM_KG;
    if (is_drawn || (is_heavy && strcmp(choice->chosen_by, "class_and_size") == 0))
        return cp_drawn_car(choice->model, is_drawn, &size, key, car, error);
    *car = *choice->model;
    return CP_OK;
}
