/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef SQLEXT_FUNCTIONS_H
#define SQLEXT_FUNCTIONS_H

#include <sqlite3ext.h>

/* What the extension registers; each returns SQLite's result code. Functions of a pulse blob and
 * the aggregates are deterministic and innocuous: they see their arguments only. A blob that no
 * encoder wrote is an error of the statement. */

/* Every function has its name and the same behind "cp_"; the second is always ours. A short name
 * the connection already knows, for whatever function, stays what it is: a program that has a
 * median of its own keeps it, and SQLite refuses to replace a function while a statement is
 * running, which in R is the one that loads. */

#define CP_SQLEXT_PREFIX "cp_"

/* Whether the connection knows a function of this name and number of arguments. */
int cp_sqlext_has(sqlite3 *db, const char *name, int arguments);

/* olc, olc_status, delta_v, peak, cfc. */
int cp_sqlext_register_scalars(sqlite3 *db);
/* median, quantile (also as window functions), cliffs_delta, ks_distance. */
int cp_sqlext_register_aggregates(sqlite3 *db);
/* pulse_samples(crash_id, role) and pulse_samples(blob). */
int cp_sqlext_register_pulse_samples(sqlite3 *db);

#endif
