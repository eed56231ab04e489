/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE // O_PATH
#include "run/confinement.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <stdint.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#define TRUNCATE (UINT64_C(1) << 14) /* LANDLOCK_ACCESS_FS_TRUNCATE, since version 3 */

// What is kept to the folders, and what of it is allowed there: files, neither folders nor links,
// devices or sockets.
#define WRITES                                                                                     \
    (LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_REMOVE_FILE | LANDLOCK_ACCESS_FS_MAKE_REG)
#define MAKES                                                                                      \
    (LANDLOCK_ACCESS_FS_REMOVE_DIR | LANDLOCK_ACCESS_FS_MAKE_DIR | LANDLOCK_ACCESS_FS_MAKE_SYM |   \
     LANDLOCK_ACCESS_FS_MAKE_SOCK | LANDLOCK_ACCESS_FS_MAKE_FIFO | LANDLOCK_ACCESS_FS_MAKE_BLOCK | \
     LANDLOCK_ACCESS_FS_MAKE_CHAR)

// ---- files ---------------------------------------------------------------------------------

// 0: the system has none.
static long landlock_version(void)
{
    long version = syscall(SYS_landlock_create_ruleset, NULL, 0, LANDLOCK_CREATE_RULESET_VERSION);
    return version > 0 ? version : 0;
}

bool cp_confinement_has_folders(void)
{
    return landlock_version() > 0;
}

static bool allow(int rules, const char *path, uint64_t what)
{
    int place = open(path, O_PATH | O_CLOEXEC);
    if (place < 0)
        return errno == ENOENT || errno == ENOTDIR;
    // Nothing is made in a file.
    struct stat status;
    if (fstat(place, &status) == 0 && !S_ISDIR(status.st_mode))
        what &= LANDLOCK_ACCESS_FS_WRITE_FILE | TRUNCATE;
    struct landlock_path_beneath_attr rule = {.allowed_access = what, .parent_fd = place};
    long failed = syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
    close(place);
    return failed == 0;
}

static bool keep_to_folders(const char *const *folders, size_t count)
{
    uint64_t truncate = landlock_version() >= 3 ? TRUNCATE : 0;
    struct landlock_ruleset_attr kept = {.handled_access_fs = WRITES | MAKES | truncate};
    int rules = (int)syscall(SYS_landlock_create_ruleset, &kept, sizeof kept, 0);
    if (rules < 0)
        return false;
    bool good = allow(rules, "/dev/null", WRITES | truncate);
    for (size_t k = 0; good && k < count; k++)
        good = allow(rules, folders[k], WRITES | truncate);
#ifdef CRASHPULSE_COVERAGE
    // What was counted is written there as the process ends.
    good =
        good && allow(rules, CRASHPULSE_COVERAGE, WRITES | LANDLOCK_ACCESS_FS_MAKE_DIR | truncate);
#endif
    good = good && syscall(SYS_landlock_restrict_self, rules, 0) == 0;
    int reason = errno;
    close(rules);
    errno = reason;
    return good;
}

// ---- connections ---------------------------------------------------------------------------

static bool refuse_sockets(void)
{
    struct sock_filter filter[] = {
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_socket, 0, 1),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EACCES),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
    };
    struct sock_fprog program = {.len = sizeof filter / sizeof *filter, .filter = filter};
    return prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program, 0, 0) == 0;
}

// ---- public --------------------------------------------------------------------------------

cp_status cp_confine(const char *const *folders, size_t count, cp_error *error)
{
    bool good = prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0;
    if (good && cp_confinement_has_folders())
        good = keep_to_folders(folders, count);
    if (good && !refuse_sockets() && errno != EINVAL && errno != ENOSYS) // a system without
        good = false;
    return good
               ? CP_OK
               : cp_fail(error, CP_IO_FAILED, "the worker cannot be confined: %s", strerror(errno));
}
