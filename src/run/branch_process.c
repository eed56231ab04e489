/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/branch_process.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

bool cp_branch_follow(pid_t parent)
{
    // Handlers belong to the program we are a copy of.
    for (int number = 1; number < NSIG; number++)
        signal(number, SIG_DFL);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    struct rlimit no_core = {0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    return prctl(PR_SET_PDEATHSIG, SIGKILL) == 0 && getppid() == parent;
}

// A file that is only read, from the same place on, without moving the place of the others.
static bool reopen(int fd)
{
    char path[64];
    off_t place = lseek(fd, 0, SEEK_CUR);
    snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
    int anew = open(path, O_RDONLY | O_CLOEXEC);
    bool done =
        anew >= 0 && place >= 0 && lseek(anew, place, SEEK_SET) == place && dup2(anew, fd) == fd;
    if (anew >= 0)
        close(anew);
    return done;
}

static bool isolate_one(int fd, int nowhere)
{
    struct stat file;
    int flags = fcntl(fd, F_GETFL);
    if (flags < 0 || fstat(fd, &file) != 0)
        return errno == EBADF; // the directory being listed, closed meanwhile
    bool reads_only = (flags & O_ACCMODE) == O_RDONLY && !S_ISSOCK(file.st_mode);
    if (!reads_only)
        return dup2(nowhere, fd) == fd;
    return S_ISREG(file.st_mode) ? reopen(fd) : true;
}

/* An entry of a directory as the kernel gives it. */
typedef struct kernel_entry {
    uint64_t inode;
    int64_t offset;
    unsigned short length;
    unsigned char type;
    char name[];
} kernel_entry;

// The open descriptors by the kernel's own listing: opendir would allocate.
static bool isolate_listed(int listing, int keep, int also, int nowhere)
{
    _Alignas(kernel_entry) char entries[4096];
    long size;
    while ((size = syscall(SYS_getdents64, listing, entries, sizeof entries)) > 0) {
        for (long at = 0; at < size;) {
            const kernel_entry *entry = (const kernel_entry *)(entries + at);
            at += entry->length;
            if (entry->name[0] == '.')
                continue;
            int fd = (int)strtol(entry->name, NULL, 10);
            if (fd != keep && fd != also && fd != nowhere && fd != listing &&
                !isolate_one(fd, nowhere))
                return false;
        }
    }
    return size == 0;
}

bool cp_branch_isolate(int keep, int also)
{
    int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
    int listing = open("/proc/self/fd", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    bool done = nowhere >= 0 && listing >= 0 && isolate_listed(listing, keep, also, nowhere);
    if (listing >= 0)
        close(listing);
    if (nowhere >= 0)
        close(nowhere);
    return done;
}

bool cp_branch_limit(unsigned cpu_s, unsigned wall_s)
{
    struct rlimit limit = {cpu_s, cpu_s + 1};
    alarm(wall_s);
    return setrlimit(RLIMIT_CPU, &limit) == 0;
}

bool cp_branch_write(int fd, const void *bytes, size_t size)
{
    const char *next = bytes;
    while (size > 0) {
        ssize_t written = send(fd, next, size, MSG_NOSIGNAL);
        if (written < 0 && errno == ENOTSOCK)
            written = write(fd, next, size);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return false;
        next += written;
        size -= (size_t)written;
    }
    return true;
}

bool cp_branch_read(int fd, void *bytes, size_t size)
{
    char *next = bytes;
    while (size > 0) {
        ssize_t got = read(fd, next, size);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return false;
        next += got;
        size -= (size_t)got;
    }
    return true;
}
