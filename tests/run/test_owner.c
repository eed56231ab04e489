/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/owner.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static void this_process_lives(void **state)
{
    (void)state;
    cp_owner self;
    cp_error error = {0};
    assert_int_equal(cp_owner_self(&self, &error), CP_OK);
    assert_int_equal(self.pid, getpid());
    assert_true(self.process_start > 0);
    assert_true(cp_owner_is_alive(&self));
}

static void a_pid_used_again_is_another_process(void **state)
{
    (void)state;
    cp_owner self;
    cp_error error = {0};
    assert_int_equal(cp_owner_self(&self, &error), CP_OK);
    self.process_start--;
    assert_false(cp_owner_is_alive(&self));
}

static void the_dead_are_dead_also_as_zombies(void **state)
{
    (void)state;
    cp_owner child;
    cp_error error = {0};
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    pid_t pid = fork();
    if (pid == 0) {
        int failed = cp_owner_self(&child, &error) != CP_OK ||
                     write(ends[1], &child, sizeof child) != (ssize_t)sizeof child;
        _exit(failed);
    }
    assert_int_equal(read(ends[0], &child, sizeof child), sizeof child);
    siginfo_t info;
    assert_int_equal(waitid(P_PID, (id_t)pid, &info, WEXITED | WNOWAIT), 0);
    assert_false(cp_owner_is_alive(&child));
    assert_int_equal(waitpid(pid, NULL, 0), pid);
    assert_false(cp_owner_is_alive(&child));
    close(ends[0]);
    close(ends[1]);
}

static void other_hosts_cannot_be_asked(void **state)
{
    (void)state;
    cp_owner other = {.host = "a host that is not this one", .pid = 1, .process_start = 1};
    assert_true(cp_owner_is_alive(&other));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(this_process_lives),
        cmocka_unit_test(a_pid_used_again_is_another_process),
        cmocka_unit_test(the_dead_are_dead_also_as_zombies),
        cmocka_unit_test(other_hosts_cannot_be_asked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
