/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_HISTORY_H
#define RUN_HISTORY_H

#include "store/result_rows.h"
#include "traffic/traffic.h"

/* The last seconds of every vehicle on the road, so that what came before a crash can be told when
 * it has happened. */
typedef struct cp_history cp_history;

/* length_s: how far back; > 0. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_history_create(double length_s, double step_length_s,
                                          cp_history **history, cp_error *error);
void cp_history_destroy(cp_history *history); /* NULL is fine */

/* Keep the states after the traffic's last step; what is too old makes way. */
CP_MUST_CHECK cp_status cp_history_keep(cp_history *history, const cp_traffic *traffic,
                                        cp_error *error);

/* The samples of two vehicles that lie before time_s, at most the history's length before it, one
 * after another for each (row.role is its index). The caller frees; NULL and 0 when there are none.
 */
CP_MUST_CHECK cp_status cp_history_of(const cp_history *history, const uint32_t vehicle[2],
                                      double time_s, cp_history_row **rows, size_t *count,
                                      cp_error *error);

#endif
