/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_VEHICLE_SCHEMA_H
#define CRASH_VEHICLE_SCHEMA_H

#include "core/yaml_file.h"

/* The keys of a vehicle file as libcyaml reads it; what they mean: db/vehicles/README.md. */
extern const cyaml_schema_value_t CP_VEHICLE_SCHEMA;

#endif
