/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/error.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const struct {
    int exit_code;
    const char *text;
} STATUS_TABLE[] = {
#define CP_STATUS_ROW(name, exit_code, text) [name] = {exit_code, text},
    CP_STATUSES(CP_STATUS_ROW)
#undef CP_STATUS_ROW
};

const char *cp_status_text(cp_status status)
{
    return STATUS_TABLE[status].text;
}

int cp_status_exit_code(cp_status status)
{
    return STATUS_TABLE[status].exit_code;
}

cp_status cp_fail(cp_error *error, cp_status status, const char *format, ...)
{
    if (error == NULL)
        return status;
    error->status = status;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error->text, sizeof error->text, format, arguments);
    va_end(arguments);
    return status;
}

cp_status cp_error_prefix(cp_error *error, const char *format, ...)
{
    char prefix[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(prefix, sizeof prefix, format, arguments);
    va_end(arguments);

    // Shift the message right by the prefix; what no longer fits is cut at the end.
    size_t prefix_length = strlen(prefix);
    size_t room = sizeof error->text - 1 - prefix_length;
    size_t kept = strnlen(error->text, room);
    memmove(error->text + prefix_length, error->text, kept);
    memcpy(error->text, prefix, prefix_length);
    error->text[prefix_length + kept] = '\0';
    return error->status;
}

cp_status cp_fail_memory(cp_error *error, const char *what)
{
    return cp_fail(error, CP_NO_MEMORY, "out of memory: %s", what);
}
