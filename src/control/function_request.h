/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_FUNCTION_REQUEST_H
#define CONTROL_FUNCTION_REQUEST_H

#include "api/crashpulse/function.h"

/* A request that asks for nothing. */
crashpulse_request cp_function_request_none(void);

/* Whether all it asks for is finite, in range and among what the function does (CRASHPULSE_BRAKES
 * ...); else false, and the first fault in wrong. */
bool cp_function_request_check(const crashpulse_request *request, uint32_t does, char *wrong,
                               size_t size);

#endif
