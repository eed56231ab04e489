/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_YAML_KEYS_H
#define CORE_YAML_KEYS_H

#include "core/yaml_file.h"

/* Every key that a schema allows, for documentation. */

typedef struct cp_yaml_key {
    const char *path; /* "scenarios[].driver_errors[].model" */
    const char *kind; /* "text or number", "list", "list of texts", "mapping" */
    bool is_required; /* where the mapping it is in is given */
} cp_yaml_key;

/* Visit them in the order of the schema, a mapping before its keys; anything but CP_OK ends it. */
typedef cp_status (*cp_yaml_key_visit)(void *context, const cp_yaml_key *key, cp_error *error);
CP_MUST_CHECK cp_status cp_yaml_keys_visit(const cyaml_schema_value_t *schema,
                                           cp_yaml_key_visit visit, void *context, cp_error *error);

#endif
