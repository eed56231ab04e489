/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_DRAWN_CAR_H
#define CRASH_DRAWN_CAR_H

#include "core/rng.h"
#include "crash/vehicle_choice.h"
#include "crash/vehicle_model.h"

/* One car of a vehicle class: what scatters in the class's file is drawn
 * (crash/parameter_scatter.h), and its outline is that of the vehicle it stands for: length    that
 * of the vehicle, where it is within 0.6 m of the class's, or the class claims no calibrated range
 * (the heavy ones), and the front leaves room for it mass      that of the vehicle, where it is
 * known and within the class's bounds yaw inertia  that of the class times the ratio of mass
 * (length^2 + width^2), as the regression of db/vehicles/fleet/README.md has it Width follows when
 * the outline is covered (cp_vehicle_model_cover). */

/* Draw the car of key about the class's model; scatters: false takes the class's own values.
 * Errors: those of cp_parameter_scatter_draw. */
CP_MUST_CHECK cp_status cp_drawn_car(const cp_vehicle_model *class_model, bool scatters,
                                     const cp_vehicle_size *size, cp_rng_key key,
                                     cp_vehicle_model *drawn, cp_error *error);

#define CP_DRAWN_CAR_TEXT_SIZE 8192

/* The parameters of a drawn car that are not its class's, as JSON: {"mass_kg":1652.25,...}, in 17
 * digits, which give the same bits back; "" when none differs. Returns text. */
const char *cp_drawn_car_text(const cp_vehicle_model *class_model, const cp_vehicle_model *drawn,
                              char text[CP_DRAWN_CAR_TEXT_SIZE]);

/* The class's model with the parameters of such a text, checked as a vehicle file is. Errors:
 * CP_BAD_INPUT with what stands there. */
CP_MUST_CHECK cp_status cp_drawn_car_read(const cp_vehicle_model *class_model, const char *text,
                                          cp_vehicle_model *drawn, cp_error *error);

#endif
