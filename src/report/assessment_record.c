/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/assessment_record.h"

#include "core/log.h"
#include "core/yaml_lines.h"
#include "store/assessment_items.h"

#include <string.h>

static const struct {
    const char *key, *title, *says;
} ITEM[CP_ASSESSMENT_ITEM_COUNT] = {
#define ITEM_OF(name, key, title, says) [name] = {key, title, says},
    CP_ASSESSMENT_ITEMS(ITEM_OF)
#undef ITEM_OF
};

// What the study file says of a key; NULL: nothing.
static const char *said(const cp_yaml_line *lines, size_t count, const char *key)
{
    static const char SECTION[] = "assessment.";
    for (size_t k = 0; k < count; k++) {
        const cp_yaml_line *line = &lines[k];
        if (strncmp(line->path, SECTION, sizeof SECTION - 1) == 0 &&
            strcmp(line->path + sizeof SECTION - 1, key) == 0)
            return line->scalar;
    }
    return NULL;
}

cp_status cp_assessment_record_json(const cp_study_data *data, json_t **items, cp_error *error)
{
    const json_t *study = json_array_get(json_object_get(data->about, "study"), 0);
    const char *yaml = json_string_value(json_object_get(study, "yaml"));
    cp_yaml_line *lines = NULL;
    size_t count = 0;
    cp_error failure = {0};
    *items = json_array();
    cp_status status = *items ? CP_OK : CP_NO_MEMORY;
    if (status == CP_OK && yaml)
        status = cp_yaml_lines_read("the stored study file", yaml, strlen(yaml), &lines, &count,
                                    &failure);
    if (status == CP_BAD_INPUT)
        cp_log_warning("%s: no assessment is read from it", failure.text);
    for (size_t k = 0; k < CP_ASSESSMENT_ITEM_COUNT && status != CP_NO_MEMORY; k++) {
        const char *text = status == CP_OK ? said(lines, count, ITEM[k].key) : NULL;
        json_t *item = json_pack("{s:s, s:s, s:s, s:s?}", "key", ITEM[k].key, "title",
                                 ITEM[k].title, "says", ITEM[k].says, "text", text);
        if (json_array_append_new(*items, item) != 0)
            status = CP_NO_MEMORY;
    }
    cp_yaml_lines_destroy(lines, count);
    if (status != CP_NO_MEMORY)
        return CP_OK;
    json_decref(*items);
    *items = NULL;
    return cp_fail_memory(error, "the assessment record");
}
