/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CLI_LOG_OPTIONS_H
#define CLI_LOG_OPTIONS_H

/* --quiet, --verbose and --log-format text|json, which stand anywhere on the command line, before a
 * lone "--": taken out of argv and put into the environment, where core/log.h finds them, as do the
 * workers. A wrong format ends the program with one message and exit code 2. */
void cp_log_options_take(int *argc, char **argv);

#endif
