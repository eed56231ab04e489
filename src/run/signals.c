/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/signals.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <string.h>
#include <sys/signalfd.h>
#include <unistd.h>

// Longest sleep at a time.
#define LONGEST_MS 3.6e6

cp_status cp_signals_begin(cp_signals *signals, cp_error *error)
{
    sigset_t mask;
    sigemptyset(&mask);
    sigaddset(&mask, SIGCHLD);
    sigaddset(&mask, SIGINT);
    sigaddset(&mask, SIGTERM);
    if (sigprocmask(SIG_BLOCK, &mask, &signals->old_mask) == 0) {
        signals->descriptor = signalfd(-1, &mask, SFD_CLOEXEC);
        if (signals->descriptor >= 0)
            return CP_OK;
        sigprocmask(SIG_SETMASK, &signals->old_mask, NULL);
    }
    return cp_fail(error, CP_IO_FAILED, "signals: %s", strerror(errno));
}

void cp_signals_end(cp_signals *signals)
{
    if (signals->descriptor < 0)
        return;
    close(signals->descriptor);
    sigprocmask(SIG_SETMASK, &signals->old_mask, NULL);
    signals->descriptor = -1;
}

cp_status cp_signals_wait(cp_signals *signals, double longest_s, bool *interrupted, cp_error *error)
{
    struct signalfd_siginfo info;
    struct pollfd ready = {.fd = signals->descriptor, .events = POLLIN};
    int found = poll(&ready, 1, (int)fmin(ceil(1e3 * longest_s), LONGEST_MS));
    if (found == 0 || (found < 0 && errno == EINTR))
        return CP_OK;
    ssize_t length = read(signals->descriptor, &info, sizeof info);
    if (length < 0 && errno == EINTR)
        return CP_OK;
    if (length != sizeof info)
        return cp_fail(error, CP_IO_FAILED, "signals: %s", strerror(errno));
    if (info.ssi_signo != SIGCHLD)
        *interrupted = true;
    return CP_OK;
}
