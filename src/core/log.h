/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_LOG_H
#define CORE_LOG_H

#include <stdbool.h>

/* Messages for the person at the terminal: always stderr, one line each, so that stdout carries
 * results only. No colours.
 *
 * Two variables of the environment, which reach the workers too, say how: CRASHPULSE_LOG is quiet
 * (warnings and errors only), verbose (details too) or normal; CRASHPULSE_LOG_FORMAT is text or
 * json: an object a line, {"time": UTC, "level": "info", "message": "..."}. */
#define CP_LOG_VARIABLE "CRASHPULSE_LOG"
#define CP_LOG_FORMAT_VARIABLE "CRASHPULSE_LOG_FORMAT"

/* Whether info is wanted; progress is info. */
bool cp_log_is_quiet(void);
bool cp_log_is_json(void);

/* Only with verbose. */
void cp_log_detail(const char *format, ...) __attribute__((format(printf, 1, 2)));
void cp_log_info(const char *format, ...) __attribute__((format(printf, 1, 2)));
void cp_log_warning(const char *format, ...) __attribute__((format(printf, 1, 2)));
void cp_log_error(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* A line that another process of ours wrote as text, CP_LOG_PREFIX and all, as our own message. */
#define CP_LOG_PREFIX "crashpulse: "
void cp_log_pass_on(const char *line);

#endif
