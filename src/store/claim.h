/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STORE_CLAIM_H
#define STORE_CLAIM_H

#include "store/store.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The table replication as a queue of work: who runs what. A claim is a replication with status
 * running and an attempt with outcome running that names its owner. */

/* A process as others can recognise it. */
typedef struct cp_owner {
    char host[256];
    int64_t pid;
    int64_t process_start; /* clock ticks since boot */
} cp_owner;

/* Replications that wait for a worker: planned, and failed in earlier runs. ids is the caller's to
 * free; in order of number, scenario, variant, so that a study half done is half done everywhere.
 */
CP_MUST_CHECK cp_status cp_claim_waiting(cp_store *store, int64_t **ids, size_t *count,
                                         cp_error *error);

/* Claim one replication whose configuration hash is as expected, in one transaction. *attempt is
 * the number of the attempt, 0 when somebody else has it or finished it. Errors: CP_BAD_INPUT for a
 * replication that is unknown or configured otherwise. */
CP_MUST_CHECK cp_status cp_claim_take(cp_store *store, int64_t replication_id,
                                      const char *configuration_hash, const cp_owner *owner,
                                      int *attempt, cp_error *error);

typedef enum cp_claim_end {
    CP_CLAIM_FAILED,      /* the replication failed */
    CP_CLAIM_LOST,        /* its owner died: planned again */
    CP_CLAIM_INTERRUPTED, /* its owner was told to stop: planned again */
} cp_claim_end;

/* End the claim that process pid of host holds on a replication, if it still holds it; message
 * (may be NULL) says why. *ended tells whether there was one. */
CP_MUST_CHECK cp_status cp_claim_end_of(cp_store *store, int64_t replication_id, const char *host,
                                        int64_t pid, cp_claim_end end, double wall_time_s,
                                        const char *message, bool *ended, cp_error *error);

/* A replication whose worker never got as far as a claim has failed: record it with an attempt of
 * its own. Nothing happens when it is done or running by now. */
CP_MUST_CHECK cp_status cp_claim_record_failure(cp_store *store, int64_t replication_id,
                                                const cp_owner *owner, double wall_time_s,
                                                const char *message, cp_error *error);

/* End every claim whose owner is_alive denies, as CP_CLAIM_LOST. *released counts them. */
CP_MUST_CHECK cp_status cp_claim_release_dead(cp_store *store,
                                              bool (*is_alive)(const cp_owner *owner),
                                              size_t *released, cp_error *error);

#endif
