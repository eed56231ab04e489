/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STORE_INSPECTION_H
#define STORE_INSPECTION_H

#include "store/store.h"

#include <stdint.h>

/* Whether a database is whole: SQLite's own check of the file, references between tables, what
 * must hold between rows, and every stored pulse unpacked. */

/* One thing looked at. */
typedef struct cp_inspection_result {
    const char *what; /* static: "file structure" */
    int64_t looked_at;
    int64_t wrong;
    char first[512]; /* of the wrong ones, in words; "" when all is well */
} cp_inspection_result;

#define CP_INSPECTION_RESULTS_MAX 32

typedef struct cp_inspection {
    cp_inspection_result result[CP_INSPECTION_RESULTS_MAX];
    int count;
    int64_t wrong; /* of all */
} cp_inspection;

/* Look at everything; what is wrong is in the inspection and no error. Errors: CP_BUSY,
 * CP_STORE_FAILED when it cannot be read at all, CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_inspection_run(cp_store *store, cp_inspection *inspection,
                                          cp_error *error);

#endif
