/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_NAMED_VEHICLE_H
#define CRASH_NAMED_VEHICLE_H

#include "crash/vehicle_model.h"

/* The vehicle that a user names, in every command alike: the name of a shipped one, or, with a '/'
 * or a '.' in it, the path of a vehicle file as seen from the file base (NULL: from the working
 * folder). Errors: CP_BAD_INPUT, for an unknown name with the names there are and the nearest. */
CP_MUST_CHECK cp_status cp_named_vehicle_load(const char *base, const char *text,
                                              cp_vehicle_model *model, cp_error *error);

/* CP_BAD_INPUT for a name that is neither shipped nor a path. */
CP_MUST_CHECK cp_status cp_named_vehicle_check(const char *text, cp_error *error);

#endif
