/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE // posix_spawn_file_actions_addchdir_np
#include "core/scratch.h"

#include "core/file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

const char *cp_scratch_folder(void)
{
    const char *folder = getenv("TMPDIR");
    return folder != NULL && folder[0] != '\0' ? folder : "/tmp";
}

FILE *cp_scratch_file(void)
{
    char path[4096];
    if (snprintf(path, sizeof path, "%s/crashpulse-XXXXXX", cp_scratch_folder()) >=
        (int)sizeof path) {
        errno = ENAMETOOLONG;
        return NULL;
    }
    int descriptor = mkostemp(path, O_CLOEXEC);
    if (descriptor < 0)
        return NULL;
    unlink(path);
    FILE *file = fdopen(descriptor, "w+b");
    if (file == NULL)
        close(descriptor);
    return file;
}

cp_status cp_scratch_open(cp_scratch *scratch, cp_error *error)
{
    const char *folder = cp_scratch_folder();
    // Room behind it for the names of files.
    int length =
        snprintf(scratch->path, sizeof scratch->path - 256, "%s/crashpulse-XXXXXX", folder);
    bool fits = length > 0 && (size_t)length < sizeof scratch->path - 256;
    if (fits && mkdtemp(scratch->path) != NULL)
        return CP_OK;
    scratch->path[0] = '\0';
    return cp_fail(error, CP_IO_FAILED, "%s: no folder for temporary files can be made: %s", folder,
                   fits ? strerror(errno) : "path too long");
}

void cp_scratch_close(cp_scratch *scratch)
{
    DIR *folder = scratch->path[0] != '\0' ? opendir(scratch->path) : NULL;
    if (folder == NULL)
        return;
    for (struct dirent *entry; (entry = readdir(folder)) != NULL;)
        if (entry->d_name[0] != '.')
            unlinkat(dirfd(folder), entry->d_name, 0);
    closedir(folder);
    rmdir(scratch->path);
    scratch->path[0] = '\0';
}

static void join(const cp_scratch *scratch, const char *name, char path[4096 + 256])
{
    snprintf(path, 4096 + 256, "%s/%s", scratch->path, name);
}

cp_status cp_scratch_write(const cp_scratch *scratch, const char *name, const char *const part[],
                           size_t part_count, cp_error *error)
{
    char path[4096 + 256];
    join(scratch, name, path);
    FILE *file = fopen(path, "wbx");
    int bad = file == NULL;
    for (size_t k = 0; !bad && k < part_count; k++)
        bad = fputs(part[k], file) == EOF;
    if (file != NULL && fclose(file) != 0)
        bad = 1;
    return bad ? cp_fail(error, CP_IO_FAILED, "%s: cannot be written: %s", path, strerror(errno))
               : CP_OK;
}

cp_status cp_scratch_read(const cp_scratch *scratch, const char *name, char **content, size_t *size,
                          cp_error *error)
{
    char path[4096 + 256];
    join(scratch, name, path);
    cp_status status = cp_file_read(path, content, size, error);
    return status == CP_BAD_INPUT ? cp_fail(error, CP_RUN_FAILED, "%s was not written", name)
                                  : status;
}

static int spawn(const cp_scratch *scratch, const char *const word[], pid_t *pid)
{
    posix_spawn_file_actions_t actions;
    int failed = posix_spawn_file_actions_init(&actions);
    if (failed != 0)
        return failed;
    failed = posix_spawn_file_actions_addchdir_np(&actions, scratch->path);
    if (failed == 0)
        failed = posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    if (failed == 0)
        failed =
            posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    if (failed == 0) // posix_spawnp takes the words without changing them
        failed = posix_spawnp(pid, word[0], &actions, NULL, (char *const *)word, environ);
    posix_spawn_file_actions_destroy(&actions);
    return failed;
}

cp_status cp_scratch_run(const cp_scratch *scratch, const char *const word[], int *code,
                         cp_error *error)
{
    pid_t pid = 0;
    int ended = 0, failed = spawn(scratch, word, &pid);
    if (failed == 0) {
        while (waitpid(pid, &ended, 0) < 0 && errno == EINTR)
            continue;
        *code = WIFEXITED(ended) ? WEXITSTATUS(ended) : 128 + WTERMSIG(ended);
        return CP_OK;
    }
    return cp_fail(error, failed == ENOENT ? CP_BAD_INPUT : CP_RUN_FAILED,
                   "%s cannot be started: %s", word[0], strerror(failed));
}
