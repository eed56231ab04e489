/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/checkpoint.h"

#include "run/branch_process.h"

#include <errno.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

/* Room for answers: address space only, until something is written there. */
#define ARENA_BYTES ((size_t)4 << 30)
#define ANSWER_ALIGNMENT 64

typedef struct frozen {
    pid_t pid;   /* 0: free */
    int channel; /* our end of its socket */
    double time_s;
} frozen;

struct cp_checkpoints {
    cp_checkpoint_options options;
    double *times;     /* of the last options.kept checkpoints, number n at n % options.kept */
    size_t taken;      /* so far */
    size_t since_copy; /* checkpoints since the last that was copied */
    frozen *slots;     /* copies */
    size_t slot_count; /* one more than the checkpoints that can be branched from */
    char *request;     /* options.request_max bytes, in a copy */
    cp_error *said;    /* shared with all copies: why the guide or branch at work fails */
    char *arena;       /* answers, one behind the other */
    size_t arena_used;
};

/* What goes before a request and before an answer. */
typedef struct request_head {
    double time_s; /* of the checkpoint */
    size_t branches;
    size_t size;
} request_head;

typedef struct answer_head {
    int wait_status;
    size_t size;
    char error[CP_BRANCH_FAILURE_SIZE]; /* "" unless it said why it fails */
} answer_head;

cp_checkpoint_options cp_checkpoint_options_default(void)
{
    return (cp_checkpoint_options){
        .kept = 20, .every = 1, .cpu_s = 120, .wall_s = 1200, .request_max = (size_t)64 << 10};
}

// ---- in a copy and its guides: forking branches --------------------------------------------

static _Noreturn void run_branch(const cp_checkpoints *self, pid_t parent, size_t number,
                                 size_t size, int answer)
{
    const cp_checkpoint_options *options = &self->options;
    if (!cp_branch_follow(parent) || !cp_branch_isolate(answer, -1) ||
        !cp_branch_limit(options->cpu_s, options->wall_s))
        _exit(1);
    _exit(options->branch(options->context, number, self->request, size, answer, self->said) ==
                  CP_OK
              ? 0
              : 1);
}

// Nobody has said anything yet; what was said is the last of a head's process.
static void forget_said(const cp_checkpoints *self)
{
    *self->said = (cp_error){0};
}

static void take_said(const cp_checkpoints *self, answer_head *head)
{
    snprintf(head->error, sizeof head->error, "%.*s", CP_BRANCH_FAILURE_SIZE - 1, self->said->text);
}

// Everything a branch says until it closes its end, behind the answers known already.
static size_t read_answer(const cp_checkpoints *self, int from)
{
    size_t size = 0, room = ARENA_BYTES - self->arena_used;
    while (size < room) {
        ssize_t got = read(from, self->arena + self->arena_used + size, room - size);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            break;
        size += (size_t)got;
    }
    return size;
}

static bool serve_branch(const cp_checkpoints *self, size_t number, size_t size, int channel)
{
    int ends[2];
    answer_head head = {.wait_status = -1};
    pid_t self_pid = getpid();
    if (pipe(ends) != 0)
        return false;
    forget_said(self);
    pid_t pid = fork();
    if (pid == 0)
        run_branch(self, self_pid, number, size, ends[1]);
    close(ends[1]);
    if (pid > 0) {
        head.size = read_answer(self, ends[0]);
        while (waitpid(pid, &head.wait_status, 0) < 0 && errno == EINTR)
            continue;
        take_said(self, &head);
    }
    close(ends[0]);
    return cp_branch_write(channel, &head, sizeof head) &&
           cp_branch_write(channel, self->arena + self->arena_used, head.size);
}

static bool serve_branches(const cp_checkpoints *self, const request_head *head, int channel)
{
    bool alive = true;
    for (size_t k = 0; alive && k < head->branches; k++)
        alive = serve_branch(self, k, head->size, channel);
    return alive;
}

// A guide's life: on to the checkpoint, tell that it is there, then serve.
static _Noreturn void guide(const cp_checkpoints *self, pid_t copy, const request_head *head,
                            int channel, int arrival)
{
    const cp_checkpoint_options *options = &self->options;
    char arrived = 1;
    if (!cp_branch_follow(copy) || !cp_branch_isolate(channel, arrival) ||
        !cp_branch_limit(options->cpu_s, options->wall_s) ||
        options->advance(options->context, head->time_s, self->said) != CP_OK ||
        !cp_branch_write(arrival, &arrived, 1))
        _exit(1);
    close(arrival);
    alarm(0); // each branch has its own
    _exit(serve_branches(self, head, channel) ? 0 : 1);
}

// By a guide. One that does not arrive has an answer for each branch that says so; what ends it
// later may have cut an answer short, and nothing can be said any more.
static bool serve_guided(const cp_checkpoints *self, const request_head *head, int channel)
{
    int ends[2];
    char arrived = 0;
    answer_head lost = {.wait_status = -1};
    pid_t self_pid = getpid();
    if (pipe(ends) != 0)
        return false;
    forget_said(self);
    pid_t pid = fork();
    if (pid == 0)
        guide(self, self_pid, head, channel, ends[1]);
    close(ends[1]);
    bool alive = cp_branch_read(ends[0], &arrived, 1);
    close(ends[0]);
    while (pid > 0 && waitpid(pid, &lost.wait_status, 0) < 0 && errno == EINTR)
        continue;
    if (alive)
        return lost.wait_status == 0;
    alive = true;
    take_said(self, &lost);
    for (size_t k = 0; alive && k < head->branches; k++)
        alive = cp_branch_write(channel, &lost, sizeof lost);
    return alive;
}

// A copy's life: tell that it is ready, then serve until nobody is left to ask.
static _Noreturn void be_frozen(const cp_checkpoints *self, pid_t worker, double time_s,
                                int channel)
{
    char ready = 1;
    request_head head;
    bool alive = cp_branch_follow(worker) && cp_branch_isolate(channel, -1) &&
                 cp_branch_write(channel, &ready, 1);
    while (alive && cp_branch_read(channel, &head, sizeof head) &&
           cp_branch_read(channel, self->request, head.size))
        alive = head.time_s == time_s ? serve_branches(self, &head, channel)
                                      : serve_guided(self, &head, channel);
    _exit(0);
}

// ---- in the worker -------------------------------------------------------------------------

static void end_frozen(frozen *slot)
{
    if (slot->pid == 0)
        return;
    kill(slot->pid, SIGKILL);
    while (waitpid(slot->pid, NULL, 0) < 0 && errno == EINTR)
        continue;
    close(slot->channel);
    *slot = (frozen){0};
}

void cp_checkpoints_destroy(cp_checkpoints *self)
{
    if (self == NULL)
        return;
    for (size_t k = 0; self->slots != NULL && k < self->slot_count; k++)
        end_frozen(&self->slots[k]);
    if (self->arena != NULL)
        munmap(self->arena, ARENA_BYTES);
    if (self->said != NULL)
        munmap(self->said, sizeof *self->said);
    free(self->request);
    free(self->slots);
    free(self->times);
    free(self);
}

cp_status cp_checkpoints_create(const cp_checkpoint_options *options, cp_checkpoints **checkpoints,
                                cp_error *error)
{
    *checkpoints = NULL;
    cp_checkpoints *self = calloc(1, sizeof *self);
    if (self == NULL)
        return cp_fail_memory(error, "checkpoints");
    self->options = *options;
    self->slot_count = options->kept + 1;
    self->slots = calloc(self->slot_count, sizeof *self->slots);
    self->times = calloc(options->kept, sizeof *self->times);
    self->request = calloc(1, options->request_max);
    void *arena = mmap(NULL, ARENA_BYTES, PROT_READ | PROT_WRITE,
                       MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    self->arena = arena != MAP_FAILED ? arena : NULL;
    void *said =
        mmap(NULL, sizeof *self->said, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    self->said = said != MAP_FAILED ? said : NULL;
    if (self->slots == NULL || self->times == NULL || self->request == NULL ||
        self->arena == NULL || self->said == NULL) {
        cp_checkpoints_destroy(self);
        return cp_fail_memory(error, "checkpoints");
    }
    *checkpoints = self;
    return CP_OK;
}

// The youngest copy that is not younger; NULL when there is none.
static frozen *copy_before(const cp_checkpoints *self, double time_s)
{
    frozen *found = NULL;
    for (size_t k = 0; k < self->slot_count; k++) {
        frozen *slot = &self->slots[k];
        if (slot->pid != 0 && slot->time_s <= time_s &&
            (found == NULL || slot->time_s > found->time_s))
            found = slot;
    }
    return found;
}

// Copies older than one that serves the oldest checkpoint as well. Those that stay are of
// checkpoints that can be branched from, and one before them if the oldest of these has none.
static void end_needless(cp_checkpoints *self)
{
    size_t kept = self->options.kept, known = self->taken < kept ? self->taken : kept;
    const frozen *needed = copy_before(self, self->times[(self->taken - known) % kept]);
    for (size_t k = 0; needed != NULL && k < self->slot_count; k++)
        if (self->slots[k].time_s < needed->time_s)
            end_frozen(&self->slots[k]);
}

static frozen *free_slot(cp_checkpoints *self)
{
    size_t k = 0;
    while (self->slots[k].pid != 0)
        k++; // one is free: end_needless leaves as many copies as checkpoints at most
    return &self->slots[k];
}

static cp_status freeze(cp_checkpoints *self, double time_s, cp_error *error)
{
    int ends[2];
    char ready = 0;
    frozen *slot = free_slot(self);
    pid_t worker = getpid();
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
        return cp_fail(error, CP_RUN_FAILED, "checkpoint at %.2f s: %s", time_s, strerror(errno));
    pid_t pid = fork();
    if (pid == 0)
        be_frozen(self, worker, time_s, ends[1]);
    int failed = pid < 0 ? errno : 0;
    close(ends[1]);
    if (failed == 0) {
        // Until it has its own places in the files, ours must not move.
        *slot = (frozen){.pid = pid, .channel = ends[0], .time_s = time_s};
        if (cp_branch_read(ends[0], &ready, 1))
            return CP_OK;
        end_frozen(slot);
        return cp_fail(error, CP_RUN_FAILED, "checkpoint at %.2f s: could not be cut off", time_s);
    }
    close(ends[0]);
    return cp_fail(error, CP_RUN_FAILED, "checkpoint at %.2f s: %s", time_s, strerror(failed));
}

cp_status cp_checkpoints_take(cp_checkpoints *self, double time_s, bool is_wanted, bool *is_copied,
                              cp_error *error)
{
    bool is_due = is_wanted || self->taken == 0 || self->since_copy + 1 >= self->options.every;
    if (is_copied != NULL)
        *is_copied = is_due;
    self->times[self->taken++ % self->options.kept] = time_s;
    self->since_copy = is_due ? 0 : self->since_copy + 1;
    cp_status status = is_due ? freeze(self, time_s, error) : CP_OK;
    end_needless(self);
    return status;
}

bool cp_checkpoints_find(const cp_checkpoints *self, double latest_s, double *time_s)
{
    size_t known = self->taken < self->options.kept ? self->taken : self->options.kept;
    for (size_t k = 1; k <= known; k++) {
        double found_s = self->times[(self->taken - k) % self->options.kept];
        if (found_s > latest_s)
            continue;
        *time_s = found_s;
        return copy_before(self, found_s) != NULL;
    }
    return false;
}

static void explain(const answer_head *head, cp_branch_end *end)
{
    int wait_status = head->wait_status;
    if (wait_status == -1)
        snprintf(end->failure, sizeof end->failure, "could not be started");
    else if (WIFSIGNALED(wait_status) && WTERMSIG(wait_status) == SIGALRM)
        snprintf(end->failure, sizeof end->failure, "out of time");
    else if (WIFSIGNALED(wait_status) && WTERMSIG(wait_status) == SIGXCPU)
        snprintf(end->failure, sizeof end->failure, "out of processor time");
    else if (WIFSIGNALED(wait_status))
        snprintf(end->failure, sizeof end->failure, "ended by signal %d (%s)",
                 WTERMSIG(wait_status), strsignal(WTERMSIG(wait_status)));
    else if (WEXITSTATUS(wait_status) != 0)
        snprintf(end->failure, sizeof end->failure, "failed%s%.*s",
                 head->error[0] != '\0' ? ": " : "", CP_BRANCH_FAILURE_SIZE - 9, head->error);
}

static bool take_answer(cp_checkpoints *self, int channel, cp_branch_end *end)
{
    answer_head head;
    *end = (cp_branch_end){0};
    if (!cp_branch_read(channel, &head, sizeof head) ||
        head.size > ARENA_BYTES - self->arena_used ||
        !cp_branch_read(channel, self->arena + self->arena_used, head.size))
        return false;
    explain(&head, end);
    end->answered = end->failure[0] == '\0';
    end->answer = self->arena + self->arena_used;
    end->answer_size = head.size;
    self->arena_used +=
        (head.size + ANSWER_ALIGNMENT - 1) / ANSWER_ALIGNMENT * (size_t)ANSWER_ALIGNMENT;
    return true;
}

bool cp_checkpoints_branch(cp_checkpoints *self, double time_s, const void *request, size_t size,
                           size_t count, cp_branch_end *ends)
{
    double found_s;
    if (!cp_checkpoints_find(self, time_s, &found_s) || found_s != time_s ||
        size > self->options.request_max)
        return false;
    frozen *slot = copy_before(self, time_s);
    request_head head = {.time_s = time_s, .branches = count, .size = size};
    bool alive = cp_branch_write(slot->channel, &head, sizeof head) &&
                 cp_branch_write(slot->channel, request, size);
    for (size_t k = 0; alive && k < count; k++)
        alive = take_answer(self, slot->channel, &ends[k]);
    if (!alive)
        end_frozen(slot);
    return alive;
}
