/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BUILDERS_CRASH_LIBRARY_H
#define BUILDERS_CRASH_LIBRARY_H

#include "crash/crash_simulation.h"

/* Group fixtures of tests that simulate crashes:
 * cmocka_run_group_tests(tests, crash_library_begin, crash_library_end). */

static inline int crash_library_begin(void **state)
{
    (void)state;
    cp_error error = {0};
    return cp_crash_library_begin(&error) == CP_OK ? 0 : -1;
}

static inline int crash_library_end(void **state)
{
    (void)state;
    cp_crash_library_end();
    return 0;
}

#endif
