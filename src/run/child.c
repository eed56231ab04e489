/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/child.h"

#include "core/installation.h"
#include "core/log.h"
#include "core/progress.h"
#include "core/scratch.h"
#include "run/child_environment.h"
#include "run/worker.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#define TAIL_BYTES 1500 /* of stderr kept as the reason of a failure */
#define WORKER_NAME "crashpulse-worker"

extern char **environ;

// ---- starting ------------------------------------------------------------------------------

// Its descriptors: nothing from stdout, stderr to the file, the report pipe at its known number.
static int set_descriptors(posix_spawn_file_actions_t *actions, const cp_child *child, int report)
{
    int failed = posix_spawn_file_actions_addopen(actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    if (failed == 0)
        failed = posix_spawn_file_actions_addopen(actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    if (failed == 0)
        failed = posix_spawn_file_actions_adddup2(actions, fileno(child->messages), STDERR_FILENO);
    if (failed == 0)
        failed = posix_spawn_file_actions_adddup2(actions, report, CP_WORKER_REPORT_FD);
    return failed;
}

// Its signals: none blocked, none ignored, a process group of its own.
static int set_attributes(posix_spawnattr_t *attributes)
{
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    int failed = posix_spawnattr_setflags(
        attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    if (failed == 0)
        failed = posix_spawnattr_setsigmask(attributes, &none);
    if (failed == 0)
        failed = posix_spawnattr_setsigdefault(attributes, &all);
    if (failed == 0)
        failed = posix_spawnattr_setpgroup(attributes, 0);
    return failed;
}

static int spawn(const char *program, const char *const *arguments, cp_child *child, int report)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    char **environment = cp_child_environment(environ);
    int failed = environment != NULL ? posix_spawn_file_actions_init(&actions) : ENOMEM;
    if (failed != 0) {
        cp_child_environment_free(environment);
        return failed;
    }
    failed = posix_spawnattr_init(&attributes);
    if (failed == 0) {
        failed = set_descriptors(&actions, child, report);
        if (failed == 0)
            failed = set_attributes(&attributes);
        if (failed == 0) // posix_spawn takes the words without changing them
            failed = posix_spawn(&child->pid, program, &actions, &attributes,
                                 (char *const *)arguments, environment);
        posix_spawnattr_destroy(&attributes);
    }
    posix_spawn_file_actions_destroy(&actions);
    cp_child_environment_free(environment);
    return failed;
}

cp_status cp_child_find_worker(const char *given, char *path, size_t size, cp_error *error)
{
    cp_status status = CP_OK;
    if (given != NULL)
        snprintf(path, size, "%s", given);
    else
        status = cp_installation_find(CP_INSTALLED_WORKER, WORKER_NAME, path, size, error);
    if (status == CP_OK && access(path, X_OK) != 0)
        return cp_fail(error, CP_IO_FAILED,
                       "%s: %s; the worker comes with crashpulse: install it again, or build all "
                       "of it",
                       path, strerror(errno));
    return status;
}

// With --verbose: what is started.
static void tell_start(const char *const *arguments, pid_t pid)
{
    char words[2048] = "";
    for (size_t k = 0, used = 0; arguments[k] != NULL && used < sizeof words; k++)
        used += (size_t)snprintf(words + used, sizeof words - used, "%s%s", k > 0 ? " " : "",
                                 arguments[k]);
    cp_log_detail("process %ld starts: %s", (long)pid, words);
}

cp_status cp_child_start(const char *program, const char *const *arguments, cp_child *child,
                         cp_error *error)
{
    int ends[2] = {-1, -1};
    *child = (cp_child){.report = -1, .started_s = cp_clock_s()};
    child->messages = cp_scratch_file();
    int failed = child->messages == NULL || pipe(ends) != 0 ? errno : 0;
    if (failed == 0) {
        // None of ours reaches the other children.
        child->report = ends[0];
        fcntl(ends[0], F_SETFD, FD_CLOEXEC);
        fcntl(ends[1], F_SETFD, FD_CLOEXEC);
        fcntl(fileno(child->messages), F_SETFD, FD_CLOEXEC);
        failed = spawn(program, arguments, child, ends[1]);
        close(ends[1]);
    }
    if (failed == 0) {
        tell_start(arguments, child->pid);
        return CP_OK;
    }
    bool has_file = child->messages != NULL;
    if (has_file)
        fclose(child->messages);
    if (child->report >= 0)
        close(child->report);
    *child = (cp_child){0};
    if (!has_file)
        return cp_fail(error, CP_IO_FAILED,
                       "%s: no temporary file can be made: %s (TMPDIR names another folder)",
                       cp_scratch_folder(), strerror(failed));
    return cp_fail(error, CP_IO_FAILED, "%s: cannot be started: %s", program, strerror(failed));
}

// ---- collecting ----------------------------------------------------------------------------

static void pass_on_log(FILE *messages, cp_said *said)
{
    char line[8192];
    rewind(messages);
    while (fgets(line, sizeof line, messages) != NULL)
        if (strncmp(line, CP_LOG_PREFIX, strlen(CP_LOG_PREFIX)) == 0 &&
            (said == NULL || cp_said_is_new(said, line)))
            cp_log_pass_on(line);
}

static void append(char reason[CP_CHILD_REASON_SIZE], const char *text)
{
    size_t used = strlen(reason);
    snprintf(reason + used, CP_CHILD_REASON_SIZE - used, "%s", text);
}

// The last lines of stderr, whole ones.
static void append_tail(FILE *messages, char reason[CP_CHILD_REASON_SIZE])
{
    char tail[TAIL_BYTES + 1];
    fseek(messages, 0, SEEK_END);
    long size = ftell(messages);
    long from = size > TAIL_BYTES ? size - TAIL_BYTES : 0;
    fseek(messages, from, SEEK_SET);
    size_t length = fread(tail, 1, TAIL_BYTES, messages);
    while (length > 0 && (tail[length - 1] == '\n' || tail[length - 1] == ' '))
        length--;
    tail[length] = '\0';
    const char *begin = tail;
    if (from > 0 && strchr(tail, '\n') != NULL)
        begin = strchr(tail, '\n') + 1;
    if (*begin != '\0') {
        append(reason, "; last words: ");
        append(reason, begin);
    }
}

static void explain(cp_child *child, int wait_status, char reason[CP_CHILD_REASON_SIZE])
{
    // The pipe is short and its writer is gone: one read has it all.
    ssize_t length = read(child->report, reason, CP_CHILD_REASON_SIZE / 2);
    reason[length > 0 ? length : 0] = '\0';
    if (WIFSIGNALED(wait_status)) {
        char text[128];
        int number = WTERMSIG(wait_status);
        snprintf(text, sizeof text, "%sended by signal %d (%s)", length > 0 ? "; " : "", number,
                 strsignal(number));
        append(reason, text);
        append_tail(child->messages, reason);
    } else if (length <= 0) {
        char text[64];
        snprintf(text, sizeof text, "ended without a message (exit code %d)",
                 WEXITSTATUS(wait_status));
        append(reason, text);
        append_tail(child->messages, reason);
    }
}

void cp_child_collect(cp_child *child, int wait_status, cp_child_end *end)
{
    int code = WIFEXITED(wait_status) ? WEXITSTATUS(wait_status) : -1;
    // SUMO may end the process before the work is done: that is a failure, whatever it says.
    end->exit_code = code == CP_WORKER_EXIT_DONE ? 0 : code == 0 ? 1 : code;
    end->wall_time_s = cp_clock_s() - child->started_s;
    end->reason[0] = '\0';
    pass_on_log(child->messages, child->said);
    cp_log_detail("process %ld ended after %.2f s, exit code %d", (long)child->pid,
                  end->wall_time_s, code);
    if (end->exit_code != 0 && end->exit_code != CP_WORKER_EXIT_ELSEWHERE)
        explain(child, wait_status, end->reason);
    fclose(child->messages);
    close(child->report);
    *child = (cp_child){0};
}

void cp_child_kill(cp_child *child, const char *why, cp_child_end *end)
{
    int wait_status = 0;
    // It may have ended by itself just now: then it is not killed, and its own end counts. Its
    // group goes with it, forked branches of the simulation included.
    kill(-child->pid, SIGKILL);
    while (waitpid(child->pid, &wait_status, 0) < 0 && errno == EINTR)
        continue;
    cp_child_collect(child, wait_status, end);
    if (why == NULL || end->exit_code >= 0)
        return;
    char reason[CP_CHILD_REASON_SIZE];
    snprintf(reason, sizeof reason, "%.200s: %.3500s", why, end->reason);
    snprintf(end->reason, sizeof end->reason, "%s", reason);
}

void cp_child_wait(cp_child *child, double limit_s, cp_child_end *end)
{
    // A descriptor of the process is readable once it has ended.
    struct pollfd ended = {.fd = (int)syscall(SYS_pidfd_open, child->pid, 0), .events = POLLIN};
    bool is_over = ended.fd < 0; // a kernel without: wait however long it takes
    while (!is_over) {
        double left_s = child->started_s + limit_s - cp_clock_s();
        if (left_s <= 0.0)
            break;
        int found = poll(&ended, 1, (int)fmin(ceil(1e3 * left_s), 3.6e6));
        is_over = found > 0 || (found < 0 && errno != EINTR);
    }
    if (ended.fd >= 0)
        close(ended.fd);
    if (!is_over) {
        char why[64];
        snprintf(why, sizeof why, "no end after %.6g s", limit_s);
        cp_child_kill(child, why, end);
        return;
    }
    int wait_status = 0;
    while (waitpid(child->pid, &wait_status, 0) < 0 && errno == EINTR)
        continue;
    cp_child_collect(child, wait_status, end);
}
