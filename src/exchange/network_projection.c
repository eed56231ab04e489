/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/network_projection.h"

#include "core/units.h"
#include "core/xml_file.h"
#include "core/yaml_file.h"

#include <math.h>
#include <proj.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct cp_network_projection {
    PJ_CONTEXT *context;
    PJ *plane; // from longitude and latitude, rad
    cp_vec2 offset_m;
};

typedef struct reading {
    char definition[512];
    cp_vec2 offset_m;
    bool found;
} reading;

static cp_status take_location(void *context, const cp_xml_element *element, cp_error *error)
{
    reading *self = context;
    const char *offset = NULL, *definition = NULL;
    char text[2][64];
    if (strcmp(element->name, "location") != 0 || self->found)
        return CP_OK;
    cp_status status = cp_xml_text(element, "netOffset", &offset, error);
    if (status == CP_OK)
        status = cp_xml_text(element, "projParameter", &definition, error);
    if (status != CP_OK)
        return status;
    if (sscanf(offset, "%63[^,],%63s", text[0], text[1]) != 2 ||
        !cp_parse_number(text[0], &self->offset_m.x) ||
        !cp_parse_number(text[1], &self->offset_m.y))
        return cp_fail(error, CP_BAD_INPUT, "%s:%zu: netOffset must be two numbers, found '%s'",
                       element->path, element->line, offset);
    if (strlen(definition) >= sizeof self->definition)
        return cp_fail(error, CP_BAD_INPUT, "%s:%zu: projParameter is too long", element->path,
                       element->line);
    snprintf(self->definition, sizeof self->definition, "%s", definition);
    self->found = true;
    return CP_OK;
}

cp_status cp_network_projection_read(const char *path, cp_network_projection **projection,
                                     cp_error *error)
{
    reading self = {0};
    *projection = NULL;
    cp_status status = cp_xml_read(path, "net", take_location, &self, error);
    if (status != CP_OK)
        return status;
    // SUMO's words for none: "!"; "-" is a plain scaling that says nothing of a place.
    if (!self.found || strchr("!-.", self.definition[0]) != NULL)
        return CP_OK;
    // No files of grids, no steps: only what the definition itself says.
    static const char *const OUTSIDE[] = {"grids", "+init", "pipeline", "+step", "+file"};
    bool plain = self.definition[0] == '+';
    for (size_t k = 0; k < sizeof OUTSIDE / sizeof *OUTSIDE; k++)
        plain &= strstr(self.definition, OUTSIDE[k]) == NULL;
    if (!plain)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s: projParameter must be one projection that needs no files, found '%s'",
                       path, self.definition);
    cp_network_projection *made = calloc(1, sizeof *made);
    if (made == NULL)
        return cp_fail_memory(error, path);
    made->offset_m = self.offset_m;
    made->context = proj_context_create();
    if (made->context != NULL) {
        proj_log_level(made->context, PJ_LOG_NONE);
        proj_context_set_enable_network(made->context, 0);
        made->plane = proj_create(made->context, self.definition);
    }
    if (made->plane == NULL || !proj_angular_input(made->plane, PJ_FWD)) {
        cp_network_projection_destroy(made);
        return cp_fail(error, CP_BAD_INPUT, "%s: projParameter is not understood by PROJ: '%s'",
                       path, self.definition);
    }
    *projection = made;
    return CP_OK;
}

void cp_network_projection_destroy(cp_network_projection *projection)
{
    if (projection == NULL)
        return;
    proj_destroy(projection->plane);
    proj_context_destroy(projection->context);
    free(projection);
}

cp_status cp_network_projection_degrees(const cp_network_projection *projection, cp_vec2 place_m,
                                        cp_vec2 *degrees, cp_error *error)
{
    PJ_COORD plane = proj_coord(place_m.x - projection->offset_m.x,
                                place_m.y - projection->offset_m.y, 0.0, 0.0);
    PJ_COORD earth = proj_trans(projection->plane, PJ_INV, plane);
    *degrees = (cp_vec2){cp_deg_from_rad(earth.lp.lam), cp_deg_from_rad(earth.lp.phi)};
    if (isfinite(degrees->x) && isfinite(degrees->y))
        return CP_OK;
    return cp_fail(error, CP_BAD_INPUT,
                   "the network's projection has no place for x = %g m, y = %g m", place_m.x,
                   place_m.y);
}
