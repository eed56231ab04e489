/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_PARTICIPANTS_H
#define RUN_PARTICIPANTS_H

#include "control/control.h"
#include "impact/impact.h"
#include "store/participant_rows.h"

/* What the drivers of the two cars of a crash did wrong, and what their functions did, by the
 * controls after the step of the crash. had_crashed: who had crashed before and stands there; his
 * errors ended then. rows: zeroed before; the caller destroys. Error: CP_NO_MEMORY. In the worker
 * process only. */
CP_MUST_CHECK cp_status cp_participants_of(cp_controls *controls, const cp_impact *impact,
                                           const bool had_crashed[2], cp_participant_rows *rows,
                                           cp_error *error);

#endif
