/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/acting.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#define NAME_SIZE 64
#define LIBRARY_SIZE 200
#define WHOM_SIZE 128
#define TEXT_SIZE 600
#define STACK_BYTES 65536 /* for handlers: a stack that has run over cannot hold them */
#define LOOKS 4           /* at a call, within its limit */

/* Shared by all forks. */
typedef struct acting_note {
    volatile sig_atomic_t is_acting;
    volatile uint64_t call; /* number of the call */
    volatile int64_t time_ms;
    volatile bool has_time;
    char name[NAME_SIZE];
    char library[LIBRARY_SIZE];
    char whom[WHOM_SIZE];
    char failure[TEXT_SIZE];
} acting_note;

/* Of this process. */
typedef struct acting_watch {
    acting_note *note;
    int report_fd;
    timer_t timer;
    pid_t timer_of;     /* the process that has it: forks have none */
    uint64_t looked_at; /* call at the last look, */
    unsigned looks;     /* and how often it has been the same */
    char told[TEXT_SIZE];
} acting_watch;

static _Thread_local acting_watch watch;

// ---- texts, with nothing but what a signal handler may call --------------------------------

static size_t add(char *text, size_t used, const char *more)
{
    while (*more != '\0' && used + 1 < TEXT_SIZE)
        text[used++] = *more++;
    text[used] = '\0';
    return used;
}

static size_t add_number(char *text, size_t used, uint64_t number, unsigned digits)
{
    char reversed[24];
    unsigned count = 0;
    for (; count < sizeof reversed && (number > 0 || count < digits); number /= 10)
        reversed[count++] = (char)('0' + number % 10);
    while (count > 0 && used + 1 < TEXT_SIZE)
        text[used++] = reversed[--count];
    text[used] = '\0';
    return used;
}

// "my_aeb: ./my_aeb.so: vehicle 'b' at 12.350 s: "
static size_t add_who(char *text, const acting_note *note)
{
    size_t used = add(text, 0, note->name);
    used = add(text, add(text, used, ": "), note->library);
    used = add(text, add(text, used, ": "), note->whom);
    if (note->has_time && note->time_ms >= 0) {
        uint64_t time_ms = (uint64_t)note->time_ms;
        used = add_number(text, add(text, used, " at "), time_ms / 1000, 1);
        used = add_number(text, add(text, used, "."), time_ms % 1000, 3);
        used = add(text, used, " s");
    }
    return add(text, used, ": ");
}

// What has happened: to whoever listens, and into the note.
static void tell(const char *what)
{
    char text[TEXT_SIZE];
    acting_note *note = watch.note;
    size_t length = add(text, add_who(text, note), what);
    memcpy(note->failure, text, length + 1);
    note->is_acting = 0;
    if (write(watch.report_fd, text, length) < 0 && errno == EBADF) {
        text[length] = '\n';
        length = (size_t)write(STDERR_FILENO, text, length + 1);
    }
}

// ---- what ends a process -------------------------------------------------------------------

// Back at its default by now: what raised it does so again, or, of abort, the process ends anyway.
static void on_fatal(int number)
{
    int kept = errno;
    if (watch.note != NULL && watch.note->is_acting)
        tell("crashed");
    errno = kept;
    if (number == SIGABRT)
        raise(number);
}

static void on_exit_within(void)
{
    if (watch.note != NULL && watch.note->is_acting)
        tell("ended the process by exit");
}

// The same call as at the looks before: it takes too long.
static void on_look(int number)
{
    (void)number;
    acting_note *note = watch.note;
    int kept = errno;
    bool is_same = note->is_acting && note->call == watch.looked_at;
    watch.looks = is_same ? watch.looks + 1 : 0;
    watch.looked_at = note->call;
    if (watch.looks >= LOOKS) {
        tell("does not come back (step_limit_s)");
        _exit(1);
    }
    errno = kept;
}

static bool set_handlers(void)
{
    static const int FATAL[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS};
    stack_t stack = {.ss_size = STACK_BYTES};
    stack.ss_sp =
        mmap(NULL, STACK_BYTES, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (stack.ss_sp == MAP_FAILED || sigaltstack(&stack, NULL) != 0)
        return false;
    struct sigaction fatal = {.sa_flags = SA_ONSTACK | (int)SA_RESETHAND};
    fatal.sa_handler = on_fatal;
    sigemptyset(&fatal.sa_mask);
    for (size_t k = 0; k < sizeof FATAL / sizeof *FATAL; k++)
        if (sigaction(FATAL[k], &fatal, NULL) != 0)
            return false;
    return true;
}

// ---- public --------------------------------------------------------------------------------

cp_status cp_acting_watch(int report_fd, cp_error *error)
{
    if (watch.note != NULL)
        return CP_OK;
    void *shared =
        mmap(NULL, sizeof(acting_note), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED || !set_handlers() || atexit(on_exit_within) != 0)
        return cp_fail_memory(error, "watch over libraries");
    watch.note = shared;
    watch.report_fd = fcntl(report_fd, F_GETFD) != -1 ? report_fd : STDERR_FILENO;
    return CP_OK;
}

cp_status cp_acting_limit(double limit_s, cp_error *error)
{
    if (watch.note == NULL)
        return CP_OK;
    // A branch is a copy whose handlers are gone and whose timers never were.
    struct sigaction look = {.sa_flags = SA_RESTART | SA_ONSTACK};
    struct sigevent event = {.sigev_notify = SIGEV_SIGNAL, .sigev_signo = SIGRTMIN + 3};
    look.sa_handler = on_look;
    sigemptyset(&look.sa_mask);
    double between_s = limit_s / LOOKS;
    struct itimerspec times = {.it_value.tv_sec = (time_t)between_s};
    times.it_value.tv_nsec = (long)(1e9 * (between_s - floor(between_s)));
    times.it_interval = times.it_value;
    bool good = set_handlers() && sigaction(event.sigev_signo, &look, NULL) == 0;
    if (good && watch.timer_of != getpid())
        good = timer_create(CLOCK_MONOTONIC, &event, &watch.timer) == 0;
    if (good)
        watch.timer_of = getpid();
    good = good && timer_settime(watch.timer, 0, &times, NULL) == 0;
    return good ? CP_OK
                : cp_fail(error, CP_RUN_FAILED, "watch over libraries: %s", strerror(errno));
}

void cp_acting_enter(const char *name, const char *library, const char *whom, double time_s)
{
    acting_note *note = watch.note;
    if (note == NULL)
        return;
    snprintf(note->name, NAME_SIZE, "%s", name);
    snprintf(note->library, LIBRARY_SIZE, "%s", library);
    snprintf(note->whom, WHOM_SIZE, "%s", whom);
    note->has_time = isfinite(time_s);
    note->time_ms = isfinite(time_s) ? llround(1e3 * time_s) : 0;
    note->call++;
    note->is_acting = 1;
}

void cp_acting_leave(void)
{
    if (watch.note != NULL)
        watch.note->is_acting = 0;
}

void cp_acting_failed(const char *text)
{
    if (watch.note != NULL)
        snprintf(watch.note->failure, TEXT_SIZE, "%s", text);
}

const char *cp_acting_told(void)
{
    acting_note *note = watch.note;
    if (note == NULL)
        return NULL;
    // Nobody but a fork that is gone can be at work now.
    if (note->is_acting)
        add(note->failure, add_who(note->failure, note), "ended its process");
    note->is_acting = 0;
    if (note->failure[0] == '\0')
        return NULL;
    memcpy(watch.told, note->failure, TEXT_SIZE);
    note->failure[0] = '\0';
    return watch.told;
}
