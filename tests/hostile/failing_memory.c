/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Preloaded into a program: the k-th request for memory after main has begun is refused
 * (FAIL_AT=k), all others are served. FAIL_IN: only in the program of this name. COUNT_FILE: the
 * number of requests is written there at the end. What loaders and constructors of libraries ask
 * for before main is not counted: no code of ours has run by then. PATHS_FILE: who asks, a 64-bit
 * hash of the PATHS_DEPTH innermost calls that lead to each request, goes to the file of this name
 * and
 * ".<process id>". */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t count, size_t size);
extern void *__libc_realloc(void *memory, size_t size);
extern void *__libc_memalign(size_t alignment, size_t size);

void *memalign(size_t alignment, size_t size);

typedef int main_function(int argc, char **argv, char **environment);
typedef int start_function(main_function *main, int argc, char **argv, void (*init)(void),
                           void (*fini)(void), void (*rtld_fini)(void), void *stack_end);

static main_function *program_main;
static atomic_int main_has_begun;
static atomic_long requests;
static long fail_at = -1; /* -1: not read yet */

// ---- who asks ------------------------------------------------------------------------------

enum { CALLS_MAX = 32, CALLS_OF_OURS = 2, PATHS_AT_ONCE = 8192 };

static int paths_file = -1;
static int paths_depth;
static uint64_t path_of[PATHS_AT_ONCE];
static size_t paths_kept;
static atomic_flag paths_are_used = ATOMIC_FLAG_INIT;

static void write_paths(void)
{
    size_t size = paths_kept * sizeof *path_of;
    if (paths_file >= 0 && write(paths_file, path_of, size) != (ssize_t)size)
        _exit(99);
    paths_kept = 0;
}

// The addresses are the same within one process, which is all that is asked of them.
static void remember_path(void)
{
    void *call[CALLS_MAX];
    while (atomic_flag_test_and_set(&paths_are_used))
        continue;
    int count = backtrace(call, paths_depth + CALLS_OF_OURS);
    uint64_t hash = 14695981039346656037u; // FNV-1a
    for (int k = CALLS_OF_OURS; k < count; k++)
        hash = (hash ^ (uintptr_t)call[k]) * 1099511628211u;
    path_of[paths_kept++] = hash;
    if (paths_kept == PATHS_AT_ONCE)
        write_paths();
    atomic_flag_clear(&paths_are_used);
}

static void begin_paths(void)
{
    char name[4096];
    void *call[CALLS_MAX];
    const char *path = getenv("PATHS_FILE"), *in = getenv("FAIL_IN");
    if (path == NULL || (in != NULL && strcmp(in, program_invocation_short_name) != 0))
        return;
    const char *depth = getenv("PATHS_DEPTH");
    paths_depth = depth != NULL ? atoi(depth) : 0;
    if (paths_depth < 1 || paths_depth > CALLS_MAX - CALLS_OF_OURS)
        _exit(99);
    snprintf(name, sizeof name, "%s.%ld", path, (long)getpid());
    paths_file = open(name, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    backtrace(call, CALLS_MAX); // the first asks for memory itself
}

// ---- requests ------------------------------------------------------------------------------

static int refused(void)
{
    if (!atomic_load(&main_has_begun))
        return 0;
    long number = atomic_fetch_add(&requests, 1) + 1;
    if (paths_file >= 0)
        remember_path();
    if (fail_at < 0) {
        const char *at = getenv("FAIL_AT"), *in = getenv("FAIL_IN");
        int ours = in == NULL || strcmp(in, program_invocation_short_name) == 0;
        fail_at = at != NULL && ours ? strtol(at, NULL, 10) : 0;
    }
    if (number != fail_at)
        return 0;
    errno = ENOMEM;
    return 1;
}

void *malloc(size_t size)
{
    return refused() ? NULL : __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    return refused() ? NULL : __libc_calloc(count, size);
}

void *realloc(void *memory, size_t size)
{
    return refused() ? NULL : __libc_realloc(memory, size);
}

void *memalign(size_t alignment, size_t size)
{
    return refused() ? NULL : __libc_memalign(alignment, size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    return memalign(alignment, size);
}

int posix_memalign(void **memory, size_t alignment, size_t size)
{
    *memory = memalign(alignment, size);
    return *memory != NULL ? 0 : ENOMEM;
}

static int begin_main(int argc, char **argv, char **environment)
{
    begin_paths();
    atomic_store(&main_has_begun, 1);
    return program_main(argc, argv, environment);
}

// Where every program begins; the C library's own is behind it.
int __libc_start_main(main_function *main, int argc, char **argv, void (*init)(void),
                      void (*fini)(void), void (*rtld_fini)(void), void *stack_end);
int __libc_start_main(main_function *main, int argc, char **argv, void (*init)(void),
                      void (*fini)(void), void (*rtld_fini)(void), void *stack_end)
{
    start_function *start = NULL;
    *(void **)&start = dlsym(RTLD_NEXT, "__libc_start_main"); // as POSIX has it
    program_main = main;
    return start(begin_main, argc, argv, init, fini, rtld_fini, stack_end);
}

__attribute__((destructor)) static void write_count(void)
{
    write_paths();
    const char *path = getenv("COUNT_FILE");
    const char *in = getenv("FAIL_IN");
    if (path == NULL || (in != NULL && strcmp(in, program_invocation_short_name) != 0))
        return;
    char text[32];
    int length = snprintf(text, sizeof text, "%ld\n", atomic_load(&requests));
    int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (file >= 0 && write(file, text, (size_t)length) != length)
        _exit(99);
    if (file >= 0)
        close(file);
}
