/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/log.h"

#include "core/safe_text.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

// ---- how -----------------------------------------------------------------------------------

typedef enum level { DETAIL, INFO, WARNING, FAILURE } level;

static const char *const LABEL[] = {[WARNING] = "warning: ", [FAILURE] = "error: "};

static bool is_set(const char *variable, const char *value)
{
    const char *found = getenv(variable);
    return found != NULL && strcmp(found, value) == 0;
}

bool cp_log_is_quiet(void)
{
    return is_set(CP_LOG_VARIABLE, "quiet");
}

bool cp_log_is_json(void)
{
    return is_set(CP_LOG_FORMAT_VARIABLE, "json");
}

static bool is_wanted(level of)
{
    return of == DETAIL ? is_set(CP_LOG_VARIABLE, "verbose") : of != INFO || !cp_log_is_quiet();
}

// ---- writing -------------------------------------------------------------------------------

// A JSON string: text for a terminal is UTF-8 without control characters but line ends and tabs.
static size_t write_json_string(const char *text, char *to, size_t size)
{
    size_t used = 0;
    to[used++] = '"';
    for (; *text != '\0' && used + 4 < size; text++) {
        char c = *text;
        if (strchr("\"\\\n\t", c) != NULL)
            to[used++] = '\\';
        if (c == '\n')
            c = 'n';
        if (c == '\t')
            c = 't';
        to[used++] = c;
    }
    to[used++] = '"';
    to[used] = '\0';
    return used;
}

static void write_json(level of, const char *safe)
{
    static const char *const NAME[] = {
        [DETAIL] = "detail", [INFO] = "info", [WARNING] = "warning", [FAILURE] = "error"};
    char line[16600], when[32] = "";
    time_t now = time(NULL);
    struct tm utc;
    if (gmtime_r(&now, &utc) != NULL)
        strftime(when, sizeof when, "%Y-%m-%dT%H:%M:%SZ", &utc);
    size_t used = (size_t)snprintf(
        line, sizeof line, "{\"time\": \"%s\", \"level\": \"%s\", \"message\": ", when, NAME[of]);
    used += write_json_string(safe, line + used, sizeof line - used - 2);
    snprintf(line + used, sizeof line - used, "}");
    fprintf(stderr, "%s\n", line);
}

static void write_text(level of, const char *safe)
{
    char line[16384];
    size_t used =
        (size_t)snprintf(line, sizeof line, CP_LOG_PREFIX "%s", LABEL[of] != NULL ? LABEL[of] : "");
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

static void write_message(level of, const char *format, va_list arguments)
{
    // One write a message, so that those of several processes do not mix. What names of files and
    // databases bring along does not act on the terminal, and no line of theirs looks like ours.
    char text[8192], safe[8192];
    if (!is_wanted(of))
        return;
    vsnprintf(text, sizeof text, format, arguments);
    cp_text_for_terminal(text, "\n\t", safe, sizeof safe);
    if (cp_log_is_json())
        write_json(of, safe);
    else
        write_text(of, safe);
}

void cp_log_detail(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    write_message(DETAIL, format, arguments);
    va_end(arguments);
}

void cp_log_info(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    write_message(INFO, format, arguments);
    va_end(arguments);
}

void cp_log_warning(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    write_message(WARNING, format, arguments);
    va_end(arguments);
}

void cp_log_error(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    write_message(FAILURE, format, arguments);
    va_end(arguments);
}

static void write_as(level of, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void write_as(level of, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    write_message(of, format, arguments);
    va_end(arguments);
}

void cp_log_pass_on(const char *line)
{
    const char *text = line + strlen(CP_LOG_PREFIX);
    level of = INFO;
    for (level k = WARNING; k <= FAILURE; k++)
        if (strncmp(text, LABEL[k], strlen(LABEL[k])) == 0) {
            of = k;
            text += strlen(LABEL[k]);
        }
    write_as(of, "%.*s", (int)strcspn(text, "\n"), text);
}
