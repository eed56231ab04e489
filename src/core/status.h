/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_STATUS_H
#define CORE_STATUS_H

/* Every way a function of crashpulse can fail. X(name, process exit code, text).
 * Exit codes are a contract with users: 0 success, 1 failed run, 2 bad input. */
#define CP_STATUSES(X)                                                                             \
    X(CP_OK, 0, "success")                                                                         \
    X(CP_BAD_INPUT, 2, "bad input")                                                                \
    X(CP_NO_MEMORY, 1, "out of memory")                                                            \
    X(CP_IO_FAILED, 1, "input/output failed")                                                      \
    X(CP_TRAFFIC_FAILED, 1, "traffic simulation failed")                                           \
    X(CP_CRASH_FAILED, 1, "crash simulation failed")                                               \
    X(CP_STORE_FAILED, 1, "database failed")                                                       \
    X(CP_BUSY, 1, "database in use")                                                               \
    X(CP_RUN_FAILED, 1, "run failed")                                                              \
    X(CP_INTERRUPTED, 1, "interrupted")

typedef enum cp_status {
#define CP_STATUS_NAME(name, exit_code, text) name,
    CP_STATUSES(CP_STATUS_NAME)
#undef CP_STATUS_NAME
} cp_status;

/* A result that must not be ignored. */
#define CP_MUST_CHECK __attribute__((warn_unused_result))

#ifdef __cplusplus
extern "C" {
#endif

/* Static text of a status, e.g. "bad input". */
const char *cp_status_text(cp_status status);

/* Process exit code of a status: 0, 1 or 2. */
int cp_status_exit_code(cp_status status);

#ifdef __cplusplus
}
#endif

#endif
