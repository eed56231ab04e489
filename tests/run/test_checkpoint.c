/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/checkpoint.h"

#include "run/branch_process.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>

#include <cmocka.h>

#include <dirent.h>
#include <errno.h>
#include <semaphore.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

/* What runs: a number that counts up, a file being read and a file being written. */
typedef struct world {
    int count;
    int aborts_at; /* on the way between a copy and a checkpoint; 0: nowhere */
    int fails_at;
    FILE *in;
    FILE *out;
    sem_t *looping; /* shared memory: posted by a branch that loops; may be NULL */
} world;

typedef enum deed {
    COUNT_UP,
    ABORT,
    LOOP,
    READ_AND_WRITE,
    FAIL,
    FAIL_IN_SILENCE,
    ANSWER_MUCH
} deed;

static void loop_forever(void)
{
    volatile int forever = 1;
    while (forever)
        continue;
}

static cp_status branch(void *context, size_t number, const void *request, size_t size, int answer,
                        cp_error *error)
{
    world *w = context;
    deed what = *(const deed *)request;
    assert_int_equal(size, sizeof what);
    if (what == ABORT && number == 1)
        abort();
    if (what == LOOP) {
        if (w->looping != NULL)
            sem_post(w->looping);
        loop_forever();
    }
    if (what == FAIL && number == 1)
        return cp_fail(error, CP_TRAFFIC_FAILED, "SUMO stopped: %040d", 7);
    if (what == FAIL_IN_SILENCE)
        return CP_RUN_FAILED;
    if (what == READ_AND_WRITE) {
        char line[32];
        if (fgets(line, sizeof line, w->in) == NULL || fputs("branch\n", w->out) < 0 ||
            fflush(w->out) != 0)
            return CP_IO_FAILED;
        return cp_branch_write(answer, line, strlen(line) + 1) ? CP_OK : CP_IO_FAILED;
    }
    if (what == ANSWER_MUCH) {
        char block[4096] = {7};
        for (int k = 0; k < 1000; k++)
            if (!cp_branch_write(answer, block, sizeof block))
                return CP_IO_FAILED;
        return CP_OK;
    }
    w->count += (int)number + 1;
    return cp_branch_write(answer, &w->count, sizeof w->count) ? CP_OK : CP_IO_FAILED;
}

// The count is the clock: what the original did between a copy and a checkpoint.
static cp_status advance(void *context, double time_s, cp_error *error)
{
    world *w = context;
    while (w->count < (int)time_s)
        w->count++;
    if (w->aborts_at != 0 && w->count == w->aborts_at)
        abort();
    return w->fails_at != 0 && w->count == w->fails_at
               ? cp_fail(error, CP_TRAFFIC_FAILED, "SUMO stopped at %d", w->count)
               : CP_OK;
}

static cp_checkpoints *create_every(world *w, size_t kept, size_t every, unsigned cpu_s)
{
    cp_checkpoint_options options = cp_checkpoint_options_default();
    cp_checkpoints *checkpoints = NULL;
    cp_error error = {0};
    options.kept = kept;
    options.every = every;
    options.advance = advance;
    options.cpu_s = cpu_s;
    options.branch = branch;
    options.context = w;
    assert_int_equal(cp_checkpoints_create(&options, &checkpoints, &error), CP_OK);
    return checkpoints;
}

static cp_checkpoints *create(world *w, size_t kept, unsigned cpu_s)
{
    return create_every(w, kept, 1, cpu_s);
}

static void take(cp_checkpoints *checkpoints, double time_s)
{
    cp_error error = {0};
    if (cp_checkpoints_take(checkpoints, time_s, false, NULL, &error) != CP_OK)
        fail_msg("%s", error.text);
}

static void goes_on_from_the_frozen_state(void **unused)
{
    (void)unused;
    world w = {.count = 10};
    cp_branch_end ends[3];
    deed what = COUNT_UP;
    cp_checkpoints *checkpoints = create(&w, 4, 10);
    take(checkpoints, 1.0);
    w.count = 20;
    take(checkpoints, 2.0);
    w.count = 30;
    // As often as asked, each branch from the same state.
    for (int again = 0; again < 2; again++) {
        assert_true(cp_checkpoints_branch(checkpoints, 1.0, &what, sizeof what, 3, ends));
        for (int k = 0; k < 3; k++) {
            assert_true(ends[k].answered);
            assert_int_equal(ends[k].answer_size, sizeof(int));
            assert_int_equal(*(const int *)ends[k].answer, 11 + k);
        }
    }
    assert_true(cp_checkpoints_branch(checkpoints, 2.0, &what, sizeof what, 1, ends));
    assert_int_equal(*(const int *)ends[0].answer, 21);
    assert_int_equal(w.count, 30);
    assert_false(cp_checkpoints_branch(checkpoints, 1.5, &what, sizeof what, 1, ends));
    cp_checkpoints_destroy(checkpoints);
}

static void the_oldest_makes_way(void **unused)
{
    (void)unused;
    world w = {0};
    double time_s = 0.0;
    cp_checkpoints *checkpoints = create(&w, 3, 10);
    assert_false(cp_checkpoints_find(checkpoints, 100.0, &time_s));
    for (int k = 0; k < 5; k++)
        take(checkpoints, 2.0 * k);
    assert_true(cp_checkpoints_find(checkpoints, 100.0, &time_s) && time_s == 8.0);
    assert_true(cp_checkpoints_find(checkpoints, 7.9, &time_s) && time_s == 6.0);
    assert_true(cp_checkpoints_find(checkpoints, 4.0, &time_s) && time_s == 4.0);
    assert_false(cp_checkpoints_find(checkpoints, 3.9, &time_s));
    cp_checkpoints_destroy(checkpoints);
}

static long own_children(void)
{
    char path[64], text[4096] = "";
    long count = 0;
    snprintf(path, sizeof path, "/proc/self/task/%d/children", (int)getpid());
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    if (fgets(text, sizeof text, file) != NULL)
        for (const char *at = text; *at != '\0'; at++)
            count += *at == ' ';
    fclose(file);
    return count;
}

// The last `kept` checkpoints, and no other, can be branched from, and twice.
static void assert_kept_are_reached(const world *w, cp_checkpoints *checkpoints, int kept)
{
    deed what = COUNT_UP;
    for (int back = 0; back < kept + 2; back++) {
        double time_s = 0.0;
        cp_branch_end ends[2];
        bool is_kept = back < kept && back < w->count;
        int then = w->count - back;
        assert_int_equal(cp_checkpoints_find(checkpoints, then + 0.5, &time_s), is_kept);
        if (!is_kept)
            continue;
        assert_true(time_s == then);
        assert_true(cp_checkpoints_branch(checkpoints, then, &what, sizeof what, 2, ends));
        for (int k = 0; k < 2; k++) {
            assert_true(ends[k].answered);
            assert_int_equal(*(const int *)ends[k].answer, then + 1 + k);
        }
    }
}

// Whatever the number of checkpoints for a copy: the same checkpoints, the same answers.
static void checkpoints_between_copies_are_reached(void **unused)
{
    (void)unused;
    for (size_t every = 1; every <= 7; every++) {
        world w = {0};
        cp_checkpoints *checkpoints = create_every(&w, 5, every, 10);
        for (w.count = 1; w.count <= 12; w.count++) {
            take(checkpoints, w.count);
            assert_true(own_children() <= 1 + (long)((5 + every - 2) / every));
            assert_kept_are_reached(&w, checkpoints, 5);
        }
        cp_checkpoints_destroy(checkpoints);
    }
}

// Copies in any order that the caller wishes: as few as serve the kept checkpoints.
static void a_copy_comes_when_it_is_wanted(void **unused)
{
    (void)unused;
    enum { KEPT = 3, EVERY = 4, TAKEN = 10 };
    for (unsigned wishes = 0; wishes < 1u << 5; wishes++) {
        world w = {0};
        cp_checkpoints *checkpoints = create_every(&w, KEPT, EVERY, 10);
        int copied_at[TAKEN + 1] = {0};
        for (w.count = 1; w.count <= TAKEN; w.count++) {
            cp_error error = {0};
            bool is_wanted = wishes >> w.count % 5 & 1, is_copied = false;
            assert_int_equal(
                cp_checkpoints_take(checkpoints, w.count, is_wanted, &is_copied, &error), CP_OK);
            copied_at[w.count] = is_copied;
            assert_true(is_copied || !is_wanted);
            assert_kept_are_reached(&w, checkpoints, KEPT);

            // Those of the kept checkpoints, and one before them if the oldest has none.
            int oldest = w.count > KEPT ? w.count - KEPT + 1 : 1, needed = !copied_at[oldest];
            for (int k = oldest; k <= w.count; k++)
                needed += copied_at[k];
            assert_int_equal(own_children(), needed);
        }
        cp_checkpoints_destroy(checkpoints);
    }
}

static void a_checkpoint_that_is_not_reached_says_why(void **unused)
{
    (void)unused;
    deed what = COUNT_UP;
    world w = {.aborts_at = 13, .fails_at = 17};
    cp_branch_end ends[2];
    cp_checkpoints *checkpoints = create_every(&w, 20, 20, 10);
    for (w.count = 1; w.count <= 20; w.count++)
        take(checkpoints, w.count);
    const struct {
        double time_s;
        const char *failure;
    } WAYS[] = {{13, "ended by signal 6 (Aborted)"},
                {17, "failed: SUMO stopped at 17"},
                {13, "ended by signal 6 (Aborted)"}};
    for (size_t way = 0; way < 3; way++) {
        assert_true(
            cp_checkpoints_branch(checkpoints, WAYS[way].time_s, &what, sizeof what, 2, ends));
        for (int k = 0; k < 2; k++) {
            assert_false(ends[k].answered);
            assert_string_equal(ends[k].failure, WAYS[way].failure);
        }
    }
    assert_true(cp_checkpoints_branch(checkpoints, 16, &what, sizeof what, 1, ends));
    assert_int_equal(*(const int *)ends[0].answer, 17);
    cp_checkpoints_destroy(checkpoints);
}

static void leave_files_alone(size_t every)
{
    char in_path[] = "/tmp/crashpulse-test-XXXXXX", out_path[] = "/tmp/crashpulse-test-XXXXXX";
    char line[32];
    world w = {.in = fdopen(mkstemp(in_path), "w"), .out = fdopen(mkstemp(out_path), "w")};
    assert_true(w.in != NULL && w.out != NULL);
    for (int k = 0; k < 9; k++)
        fprintf(w.in, "line %d\n", k);
    fclose(w.in);
    // Unbuffered: every line read moves the place in the file.
    w.in = fopen(in_path, "r");
    assert_non_null(w.in);
    setvbuf(w.in, NULL, _IONBF, 0);
    assert_non_null(fgets(line, sizeof line, w.in));
    fputs("kept in a buffer, ", w.out);

    cp_branch_end ends[2];
    deed what = READ_AND_WRITE;
    cp_checkpoints *checkpoints = create_every(&w, 2, every, 10);
    take(checkpoints, 1.0);
    take(checkpoints, 2.0); // at the same place
    assert_non_null(fgets(line, sizeof line, w.in));
    assert_true(cp_checkpoints_branch(checkpoints, 2.0, &what, sizeof what, 2, ends));
    assert_string_equal(ends[0].answer, "line 1\n");
    assert_string_equal(ends[1].answer, "line 1\n");
    assert_non_null(fgets(line, sizeof line, w.in));
    assert_string_equal(line, "line 2\n");
    cp_checkpoints_destroy(checkpoints);

    fputs("written once\n", w.out);
    fclose(w.out);
    fclose(w.in);
    w.out = fopen(out_path, "r");
    char text[128];
    assert_non_null(w.out);
    assert_non_null(fgets(text, sizeof text, w.out));
    assert_string_equal(text, "kept in a buffer, written once\n");
    assert_null(fgets(text, sizeof text, w.out));
    fclose(w.out);
    unlink(in_path);
    unlink(out_path);
}

static void a_branch_that_dies_harms_nobody(void **unused)
{
    (void)unused;
    world w = {.count = 1};
    cp_branch_end ends[3];
    deed what = ABORT;
    cp_checkpoints *checkpoints = create(&w, 2, 1);
    take(checkpoints, 1.0);
    assert_true(cp_checkpoints_branch(checkpoints, 1.0, &what, sizeof what, 3, ends));
    assert_true(ends[0].answered && !ends[1].answered && ends[2].answered);
    assert_non_null(strstr(ends[1].failure, "signal 6"));
    assert_int_equal(*(const int *)ends[2].answer, 4);

    what = LOOP;
    assert_true(cp_checkpoints_branch(checkpoints, 1.0, &what, sizeof what, 1, ends));
    assert_false(ends[0].answered);
    assert_string_equal(ends[0].failure, "out of processor time");

    // What it says of its failure is told of this branch and of no other.
    what = FAIL;
    assert_true(cp_checkpoints_branch(checkpoints, 1.0, &what, sizeof what, 3, ends));
    assert_true(ends[0].answered && !ends[1].answered && ends[2].answered);
    assert_string_equal(ends[1].failure, "failed: SUMO stopped: "
                                         "0000000000000000000000000000000000000007");
    what = FAIL_IN_SILENCE;
    assert_true(cp_checkpoints_branch(checkpoints, 1.0, &what, sizeof what, 1, ends));
    assert_string_equal(ends[0].failure, "failed");

    // More than a pipe holds.
    what = ANSWER_MUCH;
    assert_true(cp_checkpoints_branch(checkpoints, 1.0, &what, sizeof what, 1, ends));
    assert_true(ends[0].answered);
    assert_int_equal(ends[0].answer_size, 4096000);
    assert_int_equal(((const char *)ends[0].answer)[4096], 7);
    cp_checkpoints_destroy(checkpoints);
}

static int count_entries(const char *folder)
{
    int count = 0;
    DIR *listing = opendir(folder);
    assert_non_null(listing);
    while (readdir(listing) != NULL)
        count++;
    closedir(listing);
    return count;
}

static void files_of_the_original_are_left_alone(void **unused)
{
    (void)unused;
    leave_files_alone(1);
    leave_files_alone(2);
}

// The sanitizer keeps what was freed for a while.
#if defined(__SANITIZE_ADDRESS__)
#define PAGES_ALLOWED 8192
#else
#define PAGES_ALLOWED 64
#endif

static long resident_pages(void)
{
    long total = 0, resident = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    assert_non_null(file);
    assert_int_equal(fscanf(file, "%ld %ld", &total, &resident), 2);
    fclose(file);
    return resident;
}

static void assert_no_children(void)
{
    errno = 0;
    assert_int_equal(waitpid(-1, NULL, WNOHANG), -1);
    assert_int_equal(errno, ECHILD);
}

static void a_thousand_branches_leave_nothing(void **unused)
{
    (void)unused;
    world w = {0};
    deed what = COUNT_UP;
    int descriptors = count_entries("/proc/self/fd");
    long pages = 0;
    for (int round = 0; round < 2; round++) {
        cp_checkpoints *checkpoints = create_every(&w, 4, 2, 10);
        for (int k = 0; k < (round == 0 ? 10 : 100); k++) {
            cp_branch_end ends[10];
            w.count = k;
            take(checkpoints, k);
            assert_true(cp_checkpoints_branch(checkpoints, k, &what, sizeof what, 10, ends));
            assert_int_equal(*(const int *)ends[9].answer, k + 10);
        }
        cp_checkpoints_destroy(checkpoints);
        assert_no_children();
        assert_int_equal(count_entries("/proc/self/fd"), descriptors);
        if (round == 0)
            pages = resident_pages();
    }
    assert_true(resident_pages() - pages < PAGES_ALLOWED);
}

// A worker whose branch loops, ended by that signal: nothing of it stays. Its orphans come to us.
static void assert_all_end_by(int signal_number, size_t every)
{
    sem_t *looping =
        mmap(NULL, sizeof *looping, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_true(looping != MAP_FAILED);
    assert_int_equal(sem_init(looping, 1, 0), 0);
    pid_t worker = fork();
    if (worker == 0) {
        world w = {.looping = looping};
        deed what = LOOP;
        cp_branch_end end;
        cp_checkpoints *checkpoints = create_every(&w, 3, every, 300);
        take(checkpoints, 1.0);
        take(checkpoints, 2.0);
        cp_checkpoints_branch(checkpoints, 2.0, &what, sizeof what, 1, &end);
        _exit(0);
    }
    assert_int_equal(sem_wait(looping), 0);
    kill(worker, signal_number);

    // The worker, its two copies, or one and its guide (by the signal or for want of a worker), and
    // the branch.
    int wait_status, ended = 0;
    while (wait(&wait_status) > 0) {
        assert_true(WIFSIGNALED(wait_status) || WEXITSTATUS(wait_status) == 0);
        ended++;
    }
    assert_int_equal(errno, ECHILD);
    assert_int_equal(ended, 4);
    sem_destroy(looping);
    munmap(looping, sizeof *looping);
}

static void nothing_outlives_the_worker(void **unused)
{
    (void)unused;
    assert_int_equal(prctl(PR_SET_CHILD_SUBREAPER, 1), 0);
    for (size_t k = 0; k < 2; k++) {
        assert_all_end_by(SIGKILL, 1 + k);
        assert_all_end_by(SIGINT, 1 + k);
        assert_all_end_by(SIGTERM, 1 + k);
    }
    assert_int_equal(prctl(PR_SET_CHILD_SUBREAPER, 0), 0);
}

static void a_lost_checkpoint_is_told(void **unused)
{
    (void)unused;
    world w = {0};
    deed what = COUNT_UP;
    cp_branch_end end;
    cp_checkpoints *checkpoints = create(&w, 2, 10);
    take(checkpoints, 1.0);
    // Somebody (the kernel, out of memory) kills it.
    char path[64], text[64] = "";
    snprintf(path, sizeof path, "/proc/self/task/%d/children", (int)getpid());
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_non_null(fgets(text, sizeof text, file));
    fclose(file);
    assert_int_equal(kill((pid_t)strtol(text, NULL, 10), SIGKILL), 0);
    assert_false(cp_checkpoints_branch(checkpoints, 1.0, &what, sizeof what, 1, &end));
    double time_s;
    assert_false(cp_checkpoints_find(checkpoints, 9.0, &time_s));
    take(checkpoints, 2.0);
    assert_true(cp_checkpoints_branch(checkpoints, 2.0, &what, sizeof what, 1, &end));
    cp_checkpoints_destroy(checkpoints);
    assert_no_children();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(goes_on_from_the_frozen_state),
        cmocka_unit_test(the_oldest_makes_way),
        cmocka_unit_test(checkpoints_between_copies_are_reached),
        cmocka_unit_test(a_copy_comes_when_it_is_wanted),
        cmocka_unit_test(a_checkpoint_that_is_not_reached_says_why),
        cmocka_unit_test(files_of_the_original_are_left_alone),
        cmocka_unit_test(a_branch_that_dies_harms_nobody),
        cmocka_unit_test(a_thousand_branches_leave_nothing),
        cmocka_unit_test(nothing_outlives_the_worker),
        cmocka_unit_test(a_lost_checkpoint_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
