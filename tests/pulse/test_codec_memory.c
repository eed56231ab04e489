/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every request for memory of packing and unpacking refused in turn, those of zstd included. */
#include "pulse/pulse_codec.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

static long requests, refused_one; /* 0: none */

#ifndef __SANITIZE_ADDRESS__
extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t count, size_t size);

void *malloc(size_t size)
{
    return ++requests == refused_one ? NULL : __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    return ++requests == refused_one ? NULL : __libc_calloc(count, size);
}
#endif

static void make_pulse(cp_pulse *pulse)
{
    cp_error error = {0};
    assert_int_equal(cp_pulse_create(pulse, 400, 1e-3, &error), CP_OK);
    for (size_t k = 0; k < pulse->sample_count; k++) {
        pulse->channel[CP_CHANNEL_AX][k] = -200.0 * sin(0.02 * (double)k);
        pulse->channel[CP_CHANNEL_VX][k] = 15.0 * cos(0.01 * (double)k);
    }
}

static void packing_says_so(void **state)
{
    cp_pulse pulse;
    void *right = NULL, *blob = NULL;
    size_t right_size = 0, size = 0;
    cp_error error = {0};
    long served = 0;
    (void)state;
#ifdef __SANITIZE_ADDRESS__
    skip();
#endif
    make_pulse(&pulse);
    requests = 0;
    assert_int_equal(cp_pulse_encode(&pulse, &right, &right_size, &error), CP_OK);
    served = requests;
    assert_in_range(served, 4, 100);
    for (long k = 1; k <= served; k++) {
        error = (cp_error){0};
        requests = 0;
        refused_one = k;
        cp_status status = cp_pulse_encode(&pulse, &blob, &size, &error);
        refused_one = 0;
        if (status == CP_OK) { // did without
            assert_int_equal(size, right_size);
            assert_memory_equal(blob, right, size);
            free(blob);
            continue;
        }
        assert_int_equal(cp_status_exit_code(status), 1);
        assert_true(error.text[0] != '\0');
    }
    free(right);
    cp_pulse_destroy(&pulse);
}

static void unpacking_says_so(void **state)
{
    cp_pulse pulse, again;
    void *blob = NULL;
    size_t size = 0;
    cp_error error = {0};
    (void)state;
#ifdef __SANITIZE_ADDRESS__
    skip();
#endif
    make_pulse(&pulse);
    assert_int_equal(cp_pulse_encode(&pulse, &blob, &size, &error), CP_OK);
    requests = 0;
    assert_int_equal(cp_pulse_decode_blob(blob, size, &again, &error), CP_OK);
    cp_pulse_destroy(&again);
    long served = requests;
    assert_in_range(served, 3, 100);
    for (long k = 1; k <= served; k++) {
        error = (cp_error){0};
        requests = 0;
        refused_one = k;
        cp_status status = cp_pulse_decode_blob(blob, size, &again, &error);
        refused_one = 0;
        // Want of memory, not a damaged pulse.
        assert_int_equal(status, CP_NO_MEMORY);
        cp_pulse_destroy(&again);
    }
    free(blob);
    cp_pulse_destroy(&pulse);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(packing_says_so),
        cmocka_unit_test(unpacking_says_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
