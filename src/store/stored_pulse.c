/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/stored_pulse.h"

#include "store/pulse_columns.h"

cp_status cp_stored_pulse_read(cp_store *store, int64_t crash_id, const char *variant,
                               const char *role, cp_pulse *pulse, bool *there, cp_error *error)
{
    static const char AS_IT_HAPPENED[] =
        "SELECT " CP_PULSE_COLUMNS " FROM pulse WHERE crash_id = ?1 AND role = ?2";
    static const char TREATED[] =
        "SELECT " CP_PULSE_COLUMNS " FROM counterfactual_pulse WHERE crash_id = ?1 AND role = ?2 "
        "AND variant_id IN (SELECT id FROM variant WHERE name = ?3)";
    cp_statement s;
    int row = 0;
    *pulse = (cp_pulse){0};
    cp_status status = cp_statement_prepare(store, "reading a pulse",
                                            variant != NULL ? TREATED : AS_IT_HAPPENED, &s, error);
    cp_bind_integer(&s, 1, crash_id);
    cp_bind_text(&s, 2, role);
    if (variant != NULL)
        cp_bind_text(&s, 3, variant);
    if (status == CP_OK)
        status = cp_statement_row(&s, &row, error);
    *there = status == CP_OK && row;
    if (*there)
        status = cp_pulse_of_columns(&s, 0, pulse, error);
    cp_statement_finish(&s);
    return status;
}
