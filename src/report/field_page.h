/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef REPORT_FIELD_PAGE_H
#define REPORT_FIELD_PAGE_H

#include "core/error.h"

#include <jansson.h>

/* Add to the data of a page what reports/page/field.js lays under the study's delta-v: "field":
 * {"name", "bias", "x": [km/h …], "curves": {"all": {"n", "share": […]}, "front-front": …}}, the
 * weighted distribution functions of the field inside the program (NASS-CDS) at whole km/h, without
 * rebound. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_field_page_add(json_t *page, cp_error *error);

#endif
