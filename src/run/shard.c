/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/shard.h"

#include <stdlib.h>

bool cp_shard_has(const cp_shard *shard, size_t place)
{
    return shard->shards == 0 || place % shard->shards == shard->number - 1;
}

static int by_id(const void *one, const void *other)
{
    int64_t a = *(const int64_t *)one, b = *(const int64_t *)other;
    return (a > b) - (a < b);
}

cp_status cp_shard_keep(const cp_shard *shard, const cp_plan_rows *plan, int64_t *waiting,
                        size_t *count, cp_error *error)
{
    int64_t *ours = malloc((plan->replication_count + 1) * sizeof *ours);
    if (ours == NULL)
        return cp_fail_memory(error, "shard");
    size_t own = 0, kept = 0;
    for (size_t k = 0; k < plan->replication_count; k++)
        if (cp_shard_has(shard, k))
            ours[own++] = plan->replication[k].id;
    qsort(ours, own, sizeof *ours, by_id);
    for (size_t k = 0; k < *count; k++)
        if (bsearch(&waiting[k], ours, own, sizeof *ours, by_id) != NULL)
            waiting[kept++] = waiting[k];
    *count = kept;
    free(ours);
    return CP_OK;
}
