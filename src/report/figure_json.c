/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/figure_json.h"

#include "analysis/query_json.h"

#include <math.h>

json_t *cp_interval_json(cp_interval interval)
{
    return json_pack("{s:s, s:o, s:o}", "status", cp_interval_status_text(interval.status), "low",
                     cp_number_json(interval.low), "high", cp_number_json(interval.high));
}

json_t *cp_drawn_json(double value)
{
    return cp_number_json(round(value * 1e4) / 1e4);
}
