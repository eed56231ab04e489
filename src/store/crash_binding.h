/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STORE_CRASH_BINDING_H
#define STORE_CRASH_BINDING_H

#include "crash/validity.h"
#include "store/crash_rows.h"
#include "store/store_sqlite.h"

/* What crash_vehicle and counterfactual_vehicle have in common; for the files of this folder. */

#define CP_CRASHES_MAX (1 << 14) /* per replication: room in the row id, below 2^53 */

/* Parameters 5 to 52: frontal, the columns from sumo_id to contact_side, validity, severity, mass
 * and place, number of driver errors, intrusion, what was drawn and evidence, of the vehicle of a
 * role. The text of validity is borrowed
 * until the statement has run. */
void cp_bind_crash_vehicle(cp_statement *statement, const cp_crash_row *crash, int role,
                           char validity[CP_VALIDITY_TEXT_SIZE]);

/* One row for every parameter set of the vehicle's ensemble; parameters 1 to key, who it is, are
 * bound already, and stay. */
CP_MUST_CHECK cp_status cp_write_members(cp_statement *statement, int key,
                                         const cp_crash_vehicle_row *vehicle, cp_error *error);

#endif
