/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_SHARD_H
#define RUN_SHARD_H

#include "store/plan_rows.h"

/* Shares of a study that several runs have between them. What is planned is dealt out in turn:
 * shards are alike in scenarios and variants, unless their numbers divide each other, and in number
 * of replications always. */
typedef struct cp_shard {
    size_t number; /* 1 ... shards */
    size_t shards; /* 0: there is one, and everything is its own */
} cp_shard;

/* Whether a place in the plan, from 0, is its own. */
bool cp_shard_has(const cp_shard *shard, size_t place);

/* Of the ids of waiting replications keep its own, in their order. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_shard_keep(const cp_shard *shard, const cp_plan_rows *plan,
                                      int64_t *waiting, size_t *count, cp_error *error);

#endif
