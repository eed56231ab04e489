/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/background_request.h"

#include "core/file.h"
#include "core/scratch.h"
#include "run/child.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define PATH_SIZE 4096

static cp_status run_worker(const cp_background_request *request, const char *result_path,
                            cp_error *error)
{
    char worker[PATH_SIZE], result[PATH_SIZE + 32], parent[32];
    char seed[64], step_length[64], duration[64];
    cp_child child;
    cp_child_end end;
    cp_status status = cp_child_find_worker(request->worker_path, worker, sizeof worker, error);
    if (status != CP_OK)
        return status;
    snprintf(parent, sizeof parent, "%ld", (long)getpid());
    snprintf(result, sizeof result, "--background=%s", result_path);
    const char *arguments[20] = {"crashpulse-worker", "--parent", parent, result};
    size_t count = 4;

    // What a study has of its own is left to it.
    if (request->seed != NULL) {
        snprintf(seed, sizeof seed, "--seed=%" PRIu64, *request->seed);
        arguments[count++] = seed;
    }
    if (!isnan(request->duration_s)) {
        snprintf(duration, sizeof duration, "--duration=%.17g", request->duration_s);
        arguments[count++] = duration;
    }
    if (request->scenario == NULL) {
        snprintf(step_length, sizeof step_length, "--step-length=%.17g", request->step_length_s);
        arguments[count++] = step_length;
    }
    arguments[count++] = request->scenario != NULL ? "--study" : "--sumocfg";
    arguments[count++] = request->path;
    if (request->scenario != NULL) {
        arguments[count++] = "--scenario";
        arguments[count++] = request->scenario;
    }
    if (request->db_path != NULL) {
        arguments[count++] = "--db";
        arguments[count++] = request->db_path;
    }
    if (request->free_outputs)
        arguments[count++] = "--allow-sumo-outputs";
    arguments[count] = NULL;
    status = cp_child_start(worker, arguments, &child, error);
    if (status != CP_OK)
        return status;
    cp_child_wait(&child, request->time_limit_s > 0.0 ? request->time_limit_s : INFINITY, &end);
    if (end.exit_code == 0)
        return CP_OK;
    return cp_fail(error, end.exit_code == 2 ? CP_BAD_INPUT : CP_RUN_FAILED, "%s", end.reason);
}

cp_status cp_background_request_run(const cp_background_request *request, char **json,
                                    cp_error *error)
{
    char path[PATH_SIZE];
    size_t size = 0;
    *json = NULL;
    snprintf(path, sizeof path, "%s/crashpulse-background-XXXXXX", cp_scratch_folder());
    int file = mkstemp(path);
    if (file < 0)
        return cp_fail(error, CP_IO_FAILED,
                       "%s: cannot be created: %s (TMPDIR names another folder)", path,
                       strerror(errno));
    close(file);
    cp_status status = run_worker(request, path, error);
    if (status == CP_OK)
        status = cp_file_read(path, json, &size, error);
    unlink(path);
    return status;
}
