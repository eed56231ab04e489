/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef REPORT_FIGURE_JSON_H
#define REPORT_FIGURE_JSON_H

#include "stats/bootstrap.h"

#include <jansson.h>

/* Single figures as JSON; NULL when memory is gone. */

/* {"status": "value", "low": x, "high": y}, null where it is open. */
json_t *cp_interval_json(cp_interval interval);

/* Digits enough to draw: to a ten-thousandth; null where it is not finite. */
json_t *cp_drawn_json(double value);

#endif
