/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/yaml_keys.h"

#include <stdio.h>

typedef struct walk {
    cp_yaml_key_visit visit;
    void *context;
    cp_error *error;
} walk;

static bool is_list(const cyaml_schema_value_t *value)
{
    return value->type == CYAML_SEQUENCE || value->type == CYAML_SEQUENCE_FIXED;
}

static const char *kind_of(const cyaml_schema_value_t *value)
{
    if (is_list(value))
        return value->sequence.entry->type == CYAML_MAPPING ? "list of mappings" : "list";
    return value->type == CYAML_MAPPING || value->type == CYAML_IGNORE ? "mapping"
                                                                       : "text or number";
}

static cp_status visit_mapping(const walk *w, const char *prefix,
                               const cyaml_schema_value_t *mapping)
{
    cp_status status = CP_OK;
    for (const cyaml_schema_field_t *f = mapping->mapping.fields; status == CP_OK && f->key != NULL;
         f++) {
        char path[512];
        const cyaml_schema_value_t *value = &f->value, *inner = value;
        snprintf(path, sizeof path, "%s%s%s", prefix, prefix[0] != '\0' ? "." : "", f->key);
        cp_yaml_key key = {.path = path,
                           .kind = kind_of(value),
                           .is_required = !(value->flags & CYAML_FLAG_OPTIONAL)};
        status = w->visit(w->context, &key, w->error);
        if (is_list(value)) {
            inner = value->sequence.entry;
            snprintf(path, sizeof path, "%s%s%s[]", prefix, prefix[0] != '\0' ? "." : "", f->key);
        }
        if (status == CP_OK && inner->type == CYAML_MAPPING)
            status = visit_mapping(w, path, inner);
    }
    return status;
}

cp_status cp_yaml_keys_visit(const cyaml_schema_value_t *schema, cp_yaml_key_visit visit,
                             void *context, cp_error *error)
{
    const walk w = {.visit = visit, .context = context, .error = error};
    return schema->type == CYAML_MAPPING ? visit_mapping(&w, "", schema) : CP_OK;
}
