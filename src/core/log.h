/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_LOG_H
#define CORE_LOG_H

/* Messages for the person at the terminal: always stderr, one line each, so that stdout carries
 * results only. */
void cp_log_info(const char *format, ...) __attribute__((format(printf, 1, 2)));
void cp_log_warning(const char *format, ...) __attribute__((format(printf, 1, 2)));
void cp_log_error(const char *format, ...) __attribute__((format(printf, 1, 2)));

#endif
