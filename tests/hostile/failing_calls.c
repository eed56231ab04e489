/* SPDX-License-Identifier: GPL-3.0-or-later */
// clang-format off
/* Preloaded into a program: the k-th call of one kind goes wrong. Kinds: of SQLite's files open,
 * read, write, full, sync, truncate, lock, map, delete; of the system rename, fsync, spawn, pipe,
 * fork, temp.
 *
 * FAULT_KIND, FAULT_AT=k  which call; of the program FAULT_IN only
 * FAULT_DO                error (default), error_on (this one and all after it), signal N (to the
 *                         process itself), parent N (to its parent), cut (SIGKILL to the process
 *                         group: the power is gone). A write goes wrong after half of it
 * FAULT_COUNT             file: a line "program kind calls" for every kind is added at the end
 * FAULT_DISK              folder: what of the databases is safe on the disk: the files as they were
 *                         at their last sync, for every program
 * FAULT_CLOCK=k:s         from the k-th look at the clock of the day on it is s seconds later */
// clang-format on
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sqlite3.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#define KINDS(X)                                                                                   \
    X(open)                                                                                        \
    X(read)                                                                                        \
    X(write)                                                                                       \
    X(full)                                                                                        \
    X(sync)                                                                                        \
    X(truncate)                                                                                    \
    X(lock) X(map) X(delete) X(rename) X(fsync) X(spawn) X(pipe) X(fork) X(temp) X(clock)
enum kind {
#define KIND_NAME(name) KIND_##name,
    KINDS(KIND_NAME)
#undef KIND_NAME
        KIND_COUNT
};
static const char *const NAME[KIND_COUNT] = {
#define KIND_TEXT(name) #name,
    KINDS(KIND_TEXT)
#undef KIND_TEXT
};

static atomic_long calls[KIND_COUNT];
static enum kind chosen = KIND_COUNT;
static long at;
static const char *what = "error";
static long clock_at, clock_jump_s;

// ---- whether -------------------------------------------------------------------------------

// Whether this call of a kind is to fail; signals and the cut happen here.
static bool fails(enum kind kind)
{
    long number = atomic_fetch_add(&calls[kind], 1) + 1;
    if (kind != chosen || number < at)
        return false;
    if (strcmp(what, "error_on") == 0)
        return true;
    if (number > at)
        return false;
    if (strncmp(what, "signal ", 7) == 0)
        raise(atoi(what + 7));
    else if (strncmp(what, "parent ", 7) == 0)
        kill(getppid(), atoi(what + 7));
    else if (strcmp(what, "cut") == 0) {
        // A worker has a group of its own: who started it goes first.
        if (strcmp(program_invocation_short_name, "crashpulse-worker") == 0)
            kill(getppid(), SIGKILL);
        kill(0, SIGKILL);
    } else
        return true;
    return false;
}

// ---- SQLite's files ------------------------------------------------------------------------

typedef struct failing_file {
    sqlite3_file base; /* first */
    char path[4096];   /* "": temporary */
    bool deleted_at_close;
    sqlite3_file real; /* the system's, longer than this; last */
} failing_file;

static sqlite3_vfs *system_vfs;

static failing_file *ours(sqlite3_file *file)
{
    return (failing_file *)file;
}

static sqlite3_file *real(sqlite3_file *file)
{
    return &ours(file)->real;
}

static const char *disk_folder(void)
{
    return getenv("FAULT_DISK");
}

static void disk_path(const char *path, char *safe, size_t size)
{
    const char *name = strrchr(path, '/');
    snprintf(safe, size, "%s/%s", disk_folder(), name != NULL ? name + 1 : path);
}

// The file as it is now is what a power cut leaves.
static void keep_on_disk(const char *path)
{
    char safe[8192], half[8300], buffer[65536];
    if (disk_folder() == NULL || path[0] == '\0')
        return;
    disk_path(path, safe, sizeof safe);
    snprintf(half, sizeof half, "%s.%ld.half", safe, (long)getpid());
    int from = open(path, O_RDONLY | O_CLOEXEC),
        to = open(half, O_WRONLY | O_CREAT | O_TRUNC, 0644);
    ssize_t size = from < 0 || to < 0 ? -1 : 1;
    while (size > 0 && (size = read(from, buffer, sizeof buffer)) > 0)
        if (write(to, buffer, (size_t)size) != size)
            size = -1;
    close(from);
    close(to);
    int (*rename_)(const char *, const char *) = NULL;
    *(void **)&rename_ = dlsym(RTLD_NEXT, "rename");
    if (size < 0 || rename_(half, safe) != 0)
        _exit(99);
}

static int file_close(sqlite3_file *file)
{
    return real(file)->pMethods->xClose(real(file));
}

static int file_read(sqlite3_file *file, void *to, int size, sqlite3_int64 place)
{
    if (fails(KIND_read))
        return SQLITE_IOERR_READ;
    return real(file)->pMethods->xRead(real(file), to, size, place);
}

static int file_write(sqlite3_file *file, const void *from, int size, sqlite3_int64 place)
{
    bool failed = fails(KIND_write), full = fails(KIND_full);
    if (failed || full) {
        real(file)->pMethods->xWrite(real(file), from, size / 2, place);
        return full ? SQLITE_FULL : SQLITE_IOERR_WRITE;
    }
    return real(file)->pMethods->xWrite(real(file), from, size, place);
}

static int file_truncate(sqlite3_file *file, sqlite3_int64 size)
{
    if (fails(KIND_truncate))
        return SQLITE_IOERR_TRUNCATE;
    return real(file)->pMethods->xTruncate(real(file), size);
}

static int file_sync(sqlite3_file *file, int flags)
{
    if (fails(KIND_sync))
        return SQLITE_IOERR_FSYNC;
    int result = real(file)->pMethods->xSync(real(file), flags);
    if (result == SQLITE_OK)
        keep_on_disk(ours(file)->path);
    return result;
}

static int file_size(sqlite3_file *file, sqlite3_int64 *size)
{
    return real(file)->pMethods->xFileSize(real(file), size);
}

static int file_lock(sqlite3_file *file, int level)
{
    if (fails(KIND_lock))
        return SQLITE_IOERR_LOCK;
    return real(file)->pMethods->xLock(real(file), level);
}

static int file_unlock(sqlite3_file *file, int level)
{
    return real(file)->pMethods->xUnlock(real(file), level);
}

static int file_check(sqlite3_file *file, int *reserved)
{
    return real(file)->pMethods->xCheckReservedLock(real(file), reserved);
}

static int file_control(sqlite3_file *file, int operation, void *argument)
{
    return real(file)->pMethods->xFileControl(real(file), operation, argument);
}

static int file_sector(sqlite3_file *file)
{
    return real(file)->pMethods->xSectorSize(real(file));
}

// Nothing is promised of writes that a power cut tears.
static int file_traits(sqlite3_file *file)
{
    return real(file)->pMethods->xDeviceCharacteristics(real(file)) &
           ~(SQLITE_IOCAP_POWERSAFE_OVERWRITE | SQLITE_IOCAP_SAFE_APPEND | SQLITE_IOCAP_ATOMIC);
}

static int file_map(sqlite3_file *file, int page, int size, int extend, void volatile **memory)
{
    if (fails(KIND_map))
        return SQLITE_IOERR_SHMMAP;
    return real(file)->pMethods->xShmMap(real(file), page, size, extend, memory);
}

static int file_map_lock(sqlite3_file *file, int offset, int count, int flags)
{
    if ((flags & SQLITE_SHM_LOCK) != 0 && fails(KIND_lock))
        return SQLITE_IOERR_SHMLOCK;
    return real(file)->pMethods->xShmLock(real(file), offset, count, flags);
}

static void file_barrier(sqlite3_file *file)
{
    real(file)->pMethods->xShmBarrier(real(file));
}

static int file_unmap(sqlite3_file *file, int deletes)
{
    return real(file)->pMethods->xShmUnmap(real(file), deletes);
}

static const sqlite3_io_methods METHODS = {.iVersion = 2, // nothing is read through a map
                                           .xClose = file_close,
                                           .xRead = file_read,
                                           .xWrite = file_write,
                                           .xTruncate = file_truncate,
                                           .xSync = file_sync,
                                           .xFileSize = file_size,
                                           .xLock = file_lock,
                                           .xUnlock = file_unlock,
                                           .xCheckReservedLock = file_check,
                                           .xFileControl = file_control,
                                           .xSectorSize = file_sector,
                                           .xDeviceCharacteristics = file_traits,
                                           .xShmMap = file_map,
                                           .xShmLock = file_map_lock,
                                           .xShmBarrier = file_barrier,
                                           .xShmUnmap = file_unmap};

static int vfs_open(sqlite3_vfs *vfs, const char *name, sqlite3_file *file, int flags, int *taken)
{
    (void)vfs;
    file->pMethods = NULL;
    if (fails(KIND_open)) {
        errno = EMFILE;
        return SQLITE_CANTOPEN;
    }
    ours(file)->path[0] = '\0';
    if (name != NULL)
        snprintf(ours(file)->path, sizeof ours(file)->path, "%s", name);
    int result = system_vfs->xOpen(system_vfs, name, real(file), flags, taken);
    if (real(file)->pMethods != NULL)
        file->pMethods = &METHODS;
    return result;
}

static int vfs_delete(sqlite3_vfs *vfs, const char *name, int sync_folder)
{
    char safe[8192];
    (void)vfs;
    if (fails(KIND_delete))
        return SQLITE_IOERR_DELETE;
    int result = system_vfs->xDelete(system_vfs, name, sync_folder);
    if (result == SQLITE_OK && sync_folder && disk_folder() != NULL) {
        disk_path(name, safe, sizeof safe);
        unlink(safe);
    }
    return result;
}

// ---- the system ----------------------------------------------------------------------------

#define NEXT(name)                                                                                 \
    static __typeof__(name) *next = NULL;                                                          \
    if (next == NULL)                                                                              \
    *(void **)&next = dlsym(RTLD_NEXT, #name)

int rename(const char *from, const char *to)
{
    NEXT(rename);
    if (!fails(KIND_rename))
        return next(from, to);
    errno = EIO;
    return -1;
}

int fsync(int descriptor)
{
    NEXT(fsync);
    if (!fails(KIND_fsync))
        return next(descriptor);
    errno = EIO;
    return -1;
}

int fdatasync(int descriptor)
{
    NEXT(fdatasync);
    if (!fails(KIND_fsync))
        return next(descriptor);
    errno = EIO;
    return -1;
}

int posix_spawn(pid_t *pid, const char *path, const posix_spawn_file_actions_t *actions,
                const posix_spawnattr_t *attributes, char *const words[], char *const environment[])
{
    NEXT(posix_spawn);
    return fails(KIND_spawn) ? EAGAIN : next(pid, path, actions, attributes, words, environment);
}

int posix_spawnp(pid_t *pid, const char *file, const posix_spawn_file_actions_t *actions,
                 const posix_spawnattr_t *attributes, char *const words[],
                 char *const environment[])
{
    NEXT(posix_spawnp);
    return fails(KIND_spawn) ? EAGAIN : next(pid, file, actions, attributes, words, environment);
}

int pipe(int ends[2])
{
    NEXT(pipe);
    if (!fails(KIND_pipe))
        return next(ends);
    errno = EMFILE;
    return -1;
}

pid_t fork(void)
{
    NEXT(fork);
    if (!fails(KIND_fork))
        return next();
    errno = EAGAIN;
    return -1;
}

int mkostemp(char *path, int flags)
{
    NEXT(mkostemp);
    if (!fails(KIND_temp))
        return next(path, flags);
    errno = ENOSPC;
    return -1;
}

char *mkdtemp(char *path)
{
    NEXT(mkdtemp);
    if (!fails(KIND_temp))
        return next(path);
    errno = ENOSPC;
    return NULL;
}

// ---- the clock -----------------------------------------------------------------------------

static long jump_s(void)
{
    long number = atomic_fetch_add(&calls[KIND_clock], 1) + 1;
    return clock_at > 0 && number >= clock_at ? clock_jump_s : 0;
}

int clock_gettime(clockid_t clock, struct timespec *now)
{
    NEXT(clock_gettime);
    int result = next(clock, now);
    if (result == 0 && clock == CLOCK_REALTIME)
        now->tv_sec += jump_s();
    return result;
}

int gettimeofday(struct timeval *restrict now, void *restrict zone)
{
    NEXT(gettimeofday);
    int result = next(now, zone);
    now->tv_sec += jump_s();
    return result;
}

time_t time(time_t *now)
{
    struct timespec found;
    clock_gettime(CLOCK_REALTIME, &found);
    if (now != NULL)
        *now = found.tv_sec;
    return found.tv_sec;
}

// ---- begin and end -------------------------------------------------------------------------

static bool is_program(const char *names)
{
    return names == NULL || strcmp(names, program_invocation_short_name) == 0;
}

__attribute__((constructor)) static void begin(void)
{
    static sqlite3_vfs vfs;
    const char *kind = getenv("FAULT_KIND"), *number = getenv("FAULT_AT");
    const char *clock = getenv("FAULT_CLOCK");
    if (strncmp(program_invocation_short_name, "crashpulse", 10) != 0)
        return;
    if (is_program(getenv("FAULT_IN"))) {
        for (int k = 0; kind != NULL && number != NULL && k < KIND_COUNT; k++)
            if (strcmp(kind, NAME[k]) == 0)
                chosen = (enum kind)k;
        at = number != NULL ? atol(number) : 0;
        what = getenv("FAULT_DO") != NULL ? getenv("FAULT_DO") : what;
    }
    if (clock != NULL && sscanf(clock, "%ld:%ld", &clock_at, &clock_jump_s) != 2)
        _exit(99);
    system_vfs = sqlite3_vfs_find(NULL);
    if (system_vfs == NULL)
        _exit(99);
    vfs = *system_vfs;
    vfs.zName = "failing";
    vfs.pNext = NULL;
    vfs.szOsFile = (int)(sizeof(failing_file) - sizeof(sqlite3_file)) + system_vfs->szOsFile;
    vfs.xOpen = vfs_open;
    vfs.xDelete = vfs_delete;
    if (sqlite3_vfs_register(&vfs, 1) != SQLITE_OK)
        _exit(99);
}

__attribute__((destructor)) static void count(void)
{
    const char *path = getenv("FAULT_COUNT");
    char text[1024];
    size_t used = 0;
    if (path == NULL || strncmp(program_invocation_short_name, "crashpulse", 10) != 0)
        return;
    for (int k = 0; k < KIND_COUNT; k++)
        used += (size_t)snprintf(text + used, sizeof text - used, "%s %s %ld\n",
                                 program_invocation_short_name, NAME[k], atomic_load(&calls[k]));
    int file = open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (file >= 0 && write(file, text, used) != (ssize_t)used)
        _exit(99);
    if (file >= 0)
        close(file);
}
