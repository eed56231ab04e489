/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/crash_rows.h"

#include <stdlib.h>

void cp_crash_row_destroy(cp_crash_row *crash)
{
    for (int v = 0; v < 2; v++) {
        free(crash->vehicle[v].sumo_id);
        free(crash->vehicle[v].sumo_type);
        free(crash->vehicle[v].vehicle_model);
        free(crash->vehicle[v].drawn);
        free(crash->vehicle[v].lane);
        free(crash->vehicle[v].edge);
        free(crash->vehicle[v].junction);
        free(crash->vehicle[v].pulse);
    }
    cp_participant_rows_destroy(&crash->participants);
    free(crash->history);
    *crash = (cp_crash_row){0};
}
