/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/participant_rows.h"

#include <stdlib.h>

void cp_participant_rows_destroy(cp_participant_rows *rows)
{
    free(rows->error);
    free(rows->function);
    *rows = (cp_participant_rows){0};
}

cp_status cp_participant_rows_copy(const cp_participant_rows *from, bool swapped,
                                   cp_participant_rows *rows, cp_error *error)
{
    *rows = (cp_participant_rows){.is_known = from->is_known};
    rows->error = calloc(from->error_count + 1, sizeof *rows->error);
    rows->function = calloc(from->function_count + 1, sizeof *rows->function);
    if (rows->error == NULL || rows->function == NULL) {
        cp_participant_rows_destroy(rows);
        return cp_fail_memory(error, "driver errors and functions of a crash");
    }
    for (int role = 0; role < 2; role++) {
        int from_role = swapped ? 1 - role : role;
        for (size_t k = 0; k < from->error_count; k++)
            if (from->error[k].role == from_role) {
                rows->error[rows->error_count] = from->error[k];
                rows->error[rows->error_count++].role = role;
            }
        for (size_t k = 0; k < from->function_count; k++)
            if (from->function[k].role == from_role) {
                rows->function[rows->function_count] = from->function[k];
                rows->function[rows->function_count++].role = role;
            }
    }
    return CP_OK;
}
