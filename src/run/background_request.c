/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/background_request.h"

#include "core/file.h"
#include "run/child.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#define PATH_SIZE 4096

static cp_status run_worker(const cp_background_request *request, const char *result_path,
                            cp_error *error)
{
    char worker[PATH_SIZE], seed[32], step_length[32], duration[32], parent[32];
    cp_child child;
    cp_child_end end;
    int wait_status = 0;
    cp_status status = cp_child_find_worker(request->worker_path, worker, sizeof worker, error);
    if (status != CP_OK)
        return status;
    snprintf(seed, sizeof seed, "%" PRIu64, request->seed);
    snprintf(step_length, sizeof step_length, "%.17g", request->step_length_s);
    snprintf(duration, sizeof duration, "%.17g", request->duration_s);
    snprintf(parent, sizeof parent, "%ld", (long)getpid());
    const char *arguments[20] = {"crashpulse-worker", "--parent",   parent,  "--background",
                                 result_path,         "--seed",     seed,    "--step-length",
                                 step_length,         "--duration", duration};
    size_t count = 11;
    arguments[count++] = request->scenario != NULL ? "--study" : "--sumocfg";
    arguments[count++] = request->path;
    if (request->scenario != NULL) {
        arguments[count++] = "--scenario";
        arguments[count++] = request->scenario;
    }
    arguments[count] = NULL;
    status = cp_child_start(worker, arguments, &child, error);
    if (status != CP_OK)
        return status;
    while (waitpid(child.pid, &wait_status, 0) < 0 && errno == EINTR)
        continue;
    cp_child_collect(&child, wait_status, &end);
    if (end.exit_code == 0)
        return CP_OK;
    return cp_fail(error, end.exit_code == 2 ? CP_BAD_INPUT : CP_RUN_FAILED, "%s", end.reason);
}

cp_status cp_background_request_run(const cp_background_request *request, char **json,
                                    cp_error *error)
{
    const char *folder = getenv("TMPDIR");
    char path[PATH_SIZE];
    size_t size = 0;
    *json = NULL;
    snprintf(path, sizeof path, "%s/crashpulse-background-XXXXXX", folder ? folder : "/tmp");
    int file = mkstemp(path);
    if (file < 0)
        return cp_fail(error, CP_IO_FAILED, "%s: cannot be created", path);
    close(file);
    cp_status status = run_worker(request, path, error);
    if (status == CP_OK)
        status = cp_file_read(path, json, &size, error);
    unlink(path);
    return status;
}
