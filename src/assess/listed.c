/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "assess/listed.h"

#include "exchange/sumo_types.h"

#include <math.h>
#include <stdlib.h>

cp_sumo_type cp_listed_standard_car(void)
{
    return (cp_sumo_type){.vehicle_class = "passenger",
                          .length_m = CP_SUMO_CAR_LENGTH_M,
                          .width_m = CP_SUMO_CAR_WIDTH_M,
                          .height_m = CP_SUMO_CAR_HEIGHT_M,
                          .mass_kg = NAN};
}

void cp_listed_drop_pulses(cp_result_rows *results)
{
    if (results->crash_count == 0)
        return;
    for (int role = 0; role < 2; role++) {
        cp_crash_vehicle_row *vehicle = &results->crash[results->crash_count - 1].vehicle[role];
        free(vehicle->pulse);
        vehicle->pulse = NULL;
        vehicle->pulse_size = 0;
    }
}
