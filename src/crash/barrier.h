/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_BARRIER_H
#define CRASH_BARRIER_H

#include "crash/contact.h"
#include "crash/crash_configuration.h"

/* Outline of the barrier at a pose (middle of its face, x axis its depth direction). */
cp_outline cp_barrier_outline(const cp_barrier *barrier, cp_pose pose);

/* Ranges of width, depth, corner radius, pivot. Errors: CP_BAD_INPUT naming the field. */
CP_MUST_CHECK cp_status cp_barrier_validate(const cp_barrier *barrier, cp_error *error);

#endif
