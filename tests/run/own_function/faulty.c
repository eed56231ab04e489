/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "api/crashpulse/function.h"

#include <stdlib.h>
#include <string.h>

/* A function with one fault, which FAULT names: compiled once for each. It behaves for a while, so
 * that the fault has a vehicle and a time. */

#define GOOD 0
#define SEGFAULT 1
#define ENDLESS 2
#define NOT_A_NUMBER 3
#define OTHER_ABI 4
#define LEAK 5
#define SAYS_SO 6
#define EXITS 7
#define STACK 8
#define UNASKED 9
#define ROUNDING 10

typedef struct car {
    unsigned steps;
} car;

#define GOOD_STEPS 40

// Deeper than any stack, which the compiler cannot know.
static size_t deeper(size_t depth)
{
    volatile size_t deepest = SIZE_MAX;
    volatile char here[4096];
    here[depth % sizeof here] = (char)depth;
    return depth == deepest ? 0 : deeper(depth + 1) + (size_t)here[0];
}

static const char *step(void *self, void *memory, const crashpulse_view *view,
                        crashpulse_request *request)
{
    car *own = memory;
    (void)self;
    if (own->steps++ < GOOD_STEPS)
        return NULL;
    volatile double zero = 0.0;
    volatile int *volatile nowhere = NULL;
    volatile unsigned turns = 0;
    switch (FAULT) {
    case SEGFAULT:
        *nowhere = 1;
        break;
    case ENDLESS:
        while (zero < 1.0)
            turns++;
        break;
    case NOT_A_NUMBER:
        request->acceleration_m_s2 = -zero / zero;
        break;
    case LEAK: {
        void *volatile lost = malloc(1 << 20);
        if (lost != NULL)
            memset(lost, 1, 1 << 20);
        break;
    }
    case SAYS_SO:
        return view->speed_m_s >= 0.0 ? "has no idea what to do" : NULL;
    case EXITS:
        exit(0);
    case STACK:
        return deeper(1) == 0 ? "stack" : NULL;
    case UNASKED:
        request->warned_s = view->time_s;
        break;
    default:
        break;
    }
    return NULL;
}

static const crashpulse_function FUNCTION = {
    .abi = FAULT == OTHER_ABI ? CRASHPULSE_FUNCTION_ABI + 1 : CRASHPULSE_FUNCTION_ABI,
    .does = CRASHPULSE_BRAKES,
    .what = "has a fault",
    .car_size = sizeof(car),
    .step = step,
};

// Faster sums, and wrong ones: what some compilers' fast modes do as a library is loaded.
#if FAULT == ROUNDING
#include <fenv.h>
__attribute__((constructor)) static void round_up(void)
{
    fesetround(FE_UPWARD);
}
#endif

const crashpulse_function *crashpulse_function_entry(void)
{
    return &FUNCTION;
}
