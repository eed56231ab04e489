/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/assessment_section.h"

#include <stdio.h>
#include <string.h>

const cyaml_schema_field_t CP_ASSESSMENT_FIELDS[] = {
#define FIELD(name, key, title, says)                                                              \
    CYAML_FIELD_STRING_PTR(key, CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, cp_assessment_section,   \
                           text[name], 0, CYAML_UNLIMITED),
    CP_ASSESSMENT_ITEMS(FIELD)
#undef FIELD
        CYAML_FIELD_END};

static const char *const KEY[] = {
#define KEY_OF(name, key, title, says) [name] = key,
    CP_ASSESSMENT_ITEMS(KEY_OF)
#undef KEY_OF
};

cp_status cp_assessment_take(const cp_yaml_file *file, const cp_assessment_section *section,
                             bool said[CP_ASSESSMENT_ITEM_COUNT], cp_error *error)
{
    for (size_t k = 0; section != NULL && k < CP_ASSESSMENT_ITEM_COUNT; k++) {
        const char *text = section->text[k];
        char path[64];
        if (text == NULL)
            continue;
        snprintf(path, sizeof path, "assessment.%s", KEY[k]);
        if (text[strspn(text, " \t\r\n")] == '\0')
            return cp_yaml_fail(file, error, path, "must say something, or be left out, found '%s'",
                                text);
        if (strlen(text) > CP_ASSESSMENT_CHARACTERS_MAX)
            return cp_yaml_fail(file, error, path, "must have at most %d characters, found %zu",
                                CP_ASSESSMENT_CHARACTERS_MAX, strlen(text));
        said[k] = true;
    }
    return CP_OK;
}
