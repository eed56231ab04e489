/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/progress.h"

#include "core/log.h"

#include <stdio.h>
#include <time.h>
#include <unistd.h>

double cp_clock_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void cp_progress_begin(cp_progress *progress, const char *label, size_t total)
{
    *progress = (cp_progress){.label = label,
                              .total = total,
                              .started_s = cp_clock_s(),
                              .terminal = isatty(STDERR_FILENO) != 0 && !cp_log_is_json() &&
                                          !cp_log_is_quiet(),
                              .last_tenth = -1};
    cp_progress_update(progress, 0, NULL);
}

static void format_time_left(const cp_progress *progress, char *text, size_t size)
{
    double elapsed_s = cp_clock_s() - progress->started_s;
    if (progress->done == 0 || progress->done >= progress->total) {
        snprintf(text, size, "%.0f s", elapsed_s);
        return;
    }
    double left_s = elapsed_s * (double)(progress->total - progress->done) / (double)progress->done;
    snprintf(text, size, "%d:%02d left", (int)(left_s / 60.0), (int)left_s % 60);
}

void cp_progress_update(cp_progress *progress, size_t done, const char *detail)
{
    progress->done = done;
    if (progress->total == 0 || cp_log_is_quiet())
        return;
    int tenth = (int)(10 * done / progress->total);
    if (!progress->terminal && tenth == progress->last_tenth)
        return;
    progress->last_tenth = tenth;

    char time_left[32];
    format_time_left(progress, time_left, sizeof time_left);
    if (cp_log_is_json()) {
        cp_log_info("%s %zu/%zu  %s  %s", progress->label, done, progress->total, time_left,
                    detail != NULL ? detail : "");
    } else if (progress->terminal) {
        char bar[31] = "..............................";
        for (size_t k = 0; k < 30 * done / progress->total; k++)
            bar[k] = '#';
        fprintf(stderr, "\r%s [%s] %zu/%zu  %s  %s\033[K", progress->label, bar, done,
                progress->total, time_left, detail != NULL ? detail : "");
    } else {
        fprintf(stderr, "%s %zu/%zu  %s  %s\n", progress->label, done, progress->total, time_left,
                detail != NULL ? detail : "");
    }
    fflush(stderr);
}

void cp_progress_end(cp_progress *progress)
{
    if (progress->terminal)
        fprintf(stderr, "\n");
}
