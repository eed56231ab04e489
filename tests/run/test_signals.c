/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/signals.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <sys/wait.h>
#include <unistd.h>

// SIGCHLD wakes, SIGINT and SIGTERM interrupt, and nobody dies of them.
static void signals_come_as_data(void **state)
{
    (void)state;
    cp_error error = {0};
    cp_signals signals = CP_SIGNALS_NONE;
    assert_int_equal(cp_signals_begin(&signals, &error), CP_OK);
    bool interrupted = false;
    pid_t child = fork();
    if (child == 0)
        _exit(0);
    assert_int_equal(cp_signals_wait(&signals, 3600.0, &interrupted, &error), CP_OK);
    assert_false(interrupted);
    assert_int_equal(waitpid(child, NULL, WNOHANG), child);
    for (int k = 0; k < 2; k++) {
        interrupted = false;
        assert_int_equal(kill(getpid(), k == 0 ? SIGINT : SIGTERM), 0);
        assert_int_equal(cp_signals_wait(&signals, 3600.0, &interrupted, &error), CP_OK);
        assert_true(interrupted);
    }
    // Nothing more is there; what has been told stays told.
    assert_int_equal(cp_signals_wait(&signals, 0.0, &interrupted, &error), CP_OK);
    assert_true(interrupted);
    cp_signals_end(&signals);
    assert_int_equal(signals.descriptor, -1);
    cp_signals_end(&signals);
}

static void the_mask_is_given_back(void **state)
{
    (void)state;
    cp_error error = {0};
    sigset_t before, during, after;
    cp_signals signals = CP_SIGNALS_NONE;
    assert_int_equal(sigprocmask(SIG_BLOCK, NULL, &before), 0);
    assert_int_equal(cp_signals_begin(&signals, &error), CP_OK);
    assert_int_equal(sigprocmask(SIG_BLOCK, NULL, &during), 0);
    cp_signals_end(&signals);
    assert_int_equal(sigprocmask(SIG_BLOCK, NULL, &after), 0);
    assert_true(sigismember(&during, SIGINT) == 1 && sigismember(&during, SIGCHLD) == 1);
    assert_int_equal(sigismember(&after, SIGINT), sigismember(&before, SIGINT));
    assert_int_equal(sigismember(&after, SIGTERM), sigismember(&before, SIGTERM));
    assert_int_equal(sigismember(&after, SIGCHLD), sigismember(&before, SIGCHLD));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(signals_come_as_data),
        cmocka_unit_test(the_mask_is_given_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
