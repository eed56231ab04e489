/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STORE_PARTICIPANT_BINDING_H
#define STORE_PARTICIPANT_BINDING_H

#include "store/participant_rows.h"
#include "store/store_sqlite.h"

/* Writing driver errors and functions of crashes; for the files of this folder. */

/* Rows of one role; -1: not known. */
int cp_participant_error_count(const cp_participant_rows *rows, int role);

/* Zero-initialise, prepare, write, finish. */
typedef struct cp_participant_writer {
    cp_statement driver_error, function;
} cp_participant_writer;

/* is_treated: into the tables of counterfactual pairs. */
CP_MUST_CHECK cp_status cp_participant_writer_prepare(cp_participant_writer *writer,
                                                      cp_store *store, bool is_treated,
                                                      cp_error *error);
/* After the two vehicles. variant_id: of the treatment; NULL: not treated. */
CP_MUST_CHECK cp_status cp_participant_writer_write(cp_participant_writer *writer, int64_t crash_id,
                                                    const int64_t *variant_id,
                                                    const cp_participant_rows *rows,
                                                    cp_error *error);
void cp_participant_writer_finish(cp_participant_writer *writer);

#endif
