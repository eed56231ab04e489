/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/function_request.h"

#include <stdio.h>

#define CLOCK_MAX_S 1e9

crashpulse_request cp_function_request_none(void)
{
    return (crashpulse_request){
        .acceleration_m_s2 = CRASHPULSE_NONE,
        .since_s = CRASHPULSE_NONE,
        .steer_mean_1 = CRASHPULSE_NONE,
        .steer_end_1 = CRASHPULSE_NONE,
        .steer_since_s = CRASHPULSE_NONE,
        .announced_s = CRASHPULSE_NONE,
        .warned_s = CRASHPULSE_NONE,
        .speed_factor_1 = CRASHPULSE_NONE,
        .target = CRASHPULSE_NOBODY,
        .target_ttc_s = CRASHPULSE_NONE,
    };
}

/* A number of a request. */
typedef struct asked {
    const char *name;
    double value, smallest, largest;
    uint32_t needs; /* any of these */
} asked;

bool cp_function_request_check(const crashpulse_request *request, uint32_t does, char *wrong,
                               size_t size)
{
    const crashpulse_request *r = request;
    const uint32_t brakes = CRASHPULSE_BRAKES | CRASHPULSE_DRIVER_BRAKES;
    const uint32_t any = UINT32_MAX, steers = CRASHPULSE_STEERS;
    const bool is_braking = r->acceleration_m_s2 < 0.0;
    const asked all[] = {
        {"acceleration_m_s2", r->acceleration_m_s2, -20.0, 20.0,
         is_braking ? brakes : CRASHPULSE_DRIVES},
        {"since_s", r->since_s, -CLOCK_MAX_S, CLOCK_MAX_S, any},
        {"steer_mean_1", r->steer_mean_1, -1.0, 1.0, steers},
        {"steer_end_1", r->steer_end_1, -1.0, 1.0, steers},
        {"steer_since_s", r->steer_since_s, -CLOCK_MAX_S, CLOCK_MAX_S, steers},
        {"announced_s", r->announced_s, -CLOCK_MAX_S, CLOCK_MAX_S, steers},
        {"warned_s", r->warned_s, -CLOCK_MAX_S, CLOCK_MAX_S, CRASHPULSE_WARNS},
        {"speed_factor_1", r->speed_factor_1, 1e-3, 10.0, CRASHPULSE_LIMITS},
        {"target_ttc_s", r->target_ttc_s, 0.0, CLOCK_MAX_S, any},
    };
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        const asked *one = &all[k];
        if (one->value == CRASHPULSE_NONE)
            continue;
        if (!(one->value >= one->smallest && one->value <= one->largest)) {
            snprintf(wrong, size, "its request has %s %g; it must be a number in %g..%g", one->name,
                     one->value, one->smallest, one->largest);
            return false;
        }
        if (!(does & one->needs)) {
            snprintf(wrong, size, "its request has %s, which is not among what it does (%u)",
                     one->name, (unsigned)does);
            return false;
        }
    }
    if (!r->is_back || does & CRASHPULSE_STEERS)
        return true;
    snprintf(wrong, size, "its request has is_back, and it does not steer");
    return false;
}
