/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/contact_rows.h"

#include <math.h>
#include <string.h>

cp_status cp_contact_rows_add(cp_result_rows *results, const cp_impact *impact, const char *verdict,
                              const char *const ids[2], cp_error *error)
{
    cp_contact_row *row = cp_result_rows_add_contact(results);
    if (row == NULL)
        return cp_fail_memory(error, "contact");
    row->time_s = impact->time_s;
    row->contact_m = impact->contact_m;
    row->verdict = verdict;
    for (int role = 0; role < 2; role++) {
        row->vehicle[role] = strdup(ids[role]);
        if (row->vehicle[role] == NULL)
            return cp_fail_memory(error, "contact");
    }
    return CP_OK;
}

cp_status cp_contact_rows_add_report(cp_result_rows *results, const cp_reported_collision *report,
                                     cp_error *error)
{
    cp_sumo_collision_row *row = cp_result_rows_add_sumo_collision(results);
    if (row == NULL)
        return cp_fail_memory(error, "collision of SUMO");
    row->time_s = report->time_s;
    row->collider = strdup(report->collider);
    row->victim = strdup(report->victim);
    row->type = strdup(report->type);
    row->found_as = report->found_as;
    row->gap_m = isfinite(report->gap_m) ? report->gap_m : NAN;
    return row->collider != NULL && row->victim != NULL && row->type != NULL
               ? CP_OK
               : cp_fail_memory(error, "collision of SUMO");
}
