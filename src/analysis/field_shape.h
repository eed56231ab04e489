/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_FIELD_SHAPE_H
#define ANALYSIS_FIELD_SHAPE_H

#include "analysis/field_units.h"

/* A variant's units beside the field; weight: of each unit; NULL: none, what is weighted is
 * NAN then. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_field_shape_of(const cp_field_source *source,
                                          const cp_field_units *units, const double *weight,
                                          cp_field_shape *shape, cp_error *error);

#endif
