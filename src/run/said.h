/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_SAID_H
#define RUN_SAID_H

#include <stdbool.h>

/* What workers have said already: all of them read the same files, and say the same of them. */

/* Zero-initialise, ask, destroy. */
typedef struct cp_said {
    void *lines; /* owned texts, a binary tree */
} cp_said;

/* True the first time a line is asked for; true too when memory is gone. */
bool cp_said_is_new(cp_said *said, const char *line);
void cp_said_destroy(cp_said *said);

#endif
