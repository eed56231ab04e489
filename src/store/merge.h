/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STORE_MERGE_H
#define STORE_MERGE_H

#include "store/store.h"

#include <stddef.h>

/* Several databases of one study into one: what shards or machines have done, put together. */

typedef struct cp_merge_count {
    size_t taken;   /* finished replications that came from this database */
    size_t present; /* finished ones that were here already, with the same results */
} cp_merge_count;

/* Take over the finished replications of the database at path: rows of every table that names a
 * replication or a crash, attempts included, and backgrounds of networks, in one transaction; the
 * plan too when store is empty. Merging the same again changes nothing. Errors: CP_BAD_INPUT when
 * path is no database, is of another version, holds another study or another configuration of it
 * (named), or other results of a replication that is here too; CP_BUSY, CP_STORE_FAILED. */
CP_MUST_CHECK cp_status cp_merge(cp_store *store, const char *path, cp_merge_count *count,
                                 cp_error *error);

#endif
