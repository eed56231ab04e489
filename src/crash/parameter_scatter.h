/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_PARAMETER_SCATTER_H
#define CRASH_PARAMETER_SCATTER_H

#include "core/rng.h"
#include "crash/vehicle_model.h"

/* Cars of one make differ, and their parameters are known only so well: every parameter with a
 * scatter s > 0 in the vehicle file is normal about its value p with standard deviation s |p|,
 * independent of the others. A draw outside the parameter's bounds is drawn again (truncation), a
 * car whose parameters do not fit together is drawn again as a whole. The parameter sets of an
 * ensemble keep their ratio to the car's values.
 *
 * A draw is a function of (key, sample number, parameter name) only: samples may be drawn in any
 * order and on any thread, and giving another parameter scatter changes no draw of this one. */

/* Parameters with scatter. */
size_t cp_parameter_scatter_count(const cp_vehicle_model *model);

/* Car number sample about model. *redrawn (may be NULL) is how often the whole car was drawn again.
 * Errors: CP_BAD_INPUT when hundreds of cars in a row do not fit together, saying why the last did
 * not, or when a parameter's bounds hold next to nothing of its distribution. */
CP_MUST_CHECK cp_status cp_parameter_scatter_draw(const cp_vehicle_model *model, cp_rng_key key,
                                                  uint64_t sample, cp_vehicle_model *drawn,
                                                  size_t *redrawn, cp_error *error);

#endif
