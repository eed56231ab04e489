/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/parallel.h"

#include "crash/crash_simulation.h"

#include <pthread.h>

// One thread's share: every stride-th index from first on.
typedef struct share {
    cp_parallel_job job;
    void *context;
    size_t count;
    size_t first;
    size_t stride;
    cp_status status; /* of the job that ended it */
} share;

static void run_share(share *work)
{
    for (size_t k = work->first; work->status == CP_OK && k < work->count; k += work->stride)
        work->status = work->job(work->context, k);
}

static void *run_share_in_thread(void *context)
{
    cp_error error = {0};
    if (cp_crash_thread_begin(&error) != CP_OK)
        return context;
    run_share(context);
    cp_crash_thread_end();
    return NULL;
}

cp_status cp_parallel_simulate(size_t count, int threads, cp_parallel_job job, void *context,
                               cp_error *error)
{
    enum { THREADS_MAX = 64 };
    if (threads < 1 || threads > THREADS_MAX)
        return cp_fail(error, CP_BAD_INPUT, "threads must be between 1 and %d, found %d",
                       THREADS_MAX, threads);
    share shares[THREADS_MAX];
    pthread_t handles[THREADS_MAX];
    for (int t = 0; t < threads; t++)
        shares[t] = (share){job, context, count, (size_t)t, (size_t)threads, CP_OK};

    // This thread takes the first share itself.
    int started = 1, failed = 0;
    while (started < threads && !failed) {
        failed = pthread_create(&handles[started], NULL, run_share_in_thread, &shares[started]);
        started += !failed;
    }
    if (!failed)
        run_share(&shares[0]);
    for (int t = 1; t < started; t++) {
        void *trouble = NULL;
        pthread_join(handles[t], &trouble);
        failed |= trouble != NULL;
    }
    if (failed)
        return cp_fail(error, CP_RUN_FAILED, "could not run %d simulation threads", threads);
    for (int t = 0; t < threads; t++)
        if (shares[t].status != CP_OK)
            return cp_fail_memory(error, "crash simulation");
    return CP_OK;
}
