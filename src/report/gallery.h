/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef REPORT_GALLERY_H
#define REPORT_GALLERY_H

#include "analysis/study_data.h"

/* Single crashes, simulated again from the database. */

/* The gallery: of every variant the frontally struck vehicle with the highest OLC, and the one in
 * the middle, both inside validity where there are such; at most CP_GALLERY_MAX crashes. An array
 * of {"variant", "scenario", "crash_id", "why", "match", "run"}: run as in animations, crash_id as
 * text (a script has no 64-bit numbers), match says whether the pulses are the stored ones. A crash
 * that cannot be simulated again is listed with "failed": why. Errors: those of the store,
 * CP_NO_MEMORY. */
#define CP_GALLERY_MAX 8
CP_MUST_CHECK cp_status cp_gallery_json(cp_store *store, const cp_study_data *data,
                                        json_t **gallery, cp_error *error);

#endif
