/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/log.h"

#include "core/safe_text.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void write_line(const char *label, const char *format, va_list arguments)
{
    // One write a message, so that those of several processes do not mix. What names of files and
    // databases bring along does not act on the terminal, and no line of theirs looks like ours.
    char text[8192], safe[8192], line[16384];
    vsnprintf(text, sizeof text, format, arguments);
    cp_text_for_terminal(text, "\n\t", safe, sizeof safe);
    size_t used = (size_t)snprintf(line, sizeof line, "crashpulse: %s", label);
    for (const char *c = safe; *c != '\0' && used + 8 < sizeof line; c++) {
        line[used++] = *c;
        if (*c == '\n') {
            memcpy(line + used, "    ", 4);
            used += 4;
        }
    }
    line[used] = '\0';
    fprintf(stderr, "%s\n", line);
}

void cp_log_info(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    write_line("", format, arguments);
    va_end(arguments);
}

void cp_log_warning(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    write_line("warning: ", format, arguments);
    va_end(arguments);
}

void cp_log_error(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    write_line("error: ", format, arguments);
    va_end(arguments);
}
