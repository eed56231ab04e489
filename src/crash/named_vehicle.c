/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/named_vehicle.h"

#include "core/file.h"
#include "core/nearest.h"
#include "crash/shipped_vehicle.h"

#include <stdlib.h>
#include <string.h>

#define NAMES_MAX 64

cp_status cp_named_vehicle_check(const char *text, cp_error *error)
{
    cp_shipped_vehicle shipped;
    const char *names[NAMES_MAX];
    char meant[CP_NEAREST_TEXT_SIZE];
    size_t count = 0;
    if (cp_shipped_vehicle_is_path(text) || cp_shipped_vehicle_find(text, &shipped))
        return CP_OK;
    for (; count < CP_SHIPPED_VEHICLE_COUNT && count < NAMES_MAX; count++)
        names[count] = cp_shipped_vehicle_at(count).name;
    return cp_fail(error, CP_BAD_INPUT,
                   "no vehicle '%s' is shipped; a name must be one of %s, a file has a '/' or a "
                   "'.' in it (./%s)%s",
                   text, cp_shipped_vehicle_names(), text,
                   cp_nearest_text(text, names, count, meant));
}

cp_status cp_named_vehicle_load(const char *base, const char *text, cp_vehicle_model *model,
                                cp_error *error)
{
    cp_shipped_vehicle shipped;
    cp_status status = cp_named_vehicle_check(text, error);
    if (status != CP_OK)
        return status;
    if (cp_shipped_vehicle_find(text, &shipped))
        return cp_vehicle_model_parse(shipped.name, shipped.yaml, shipped.size, model, error);
    char *path = base != NULL ? cp_file_beside(base, text) : strdup(text);
    status = path != NULL ? cp_vehicle_model_load(path, model, error) : cp_fail_memory(error, text);
    free(path);
    return status;
}
