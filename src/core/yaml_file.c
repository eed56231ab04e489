/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/yaml_file.h"

#include "core/file.h"
#include "core/yaml_lines.h"
#include "core/yaml_structure.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- libcyaml's messages -------------------------------------------------------------------

// What libcyaml logs while loading: its first error and the place nearest to it.
typedef struct cyaml_report {
    char message[512];
    size_t line;
} cyaml_report;

static void collect_message(cyaml_log_t level, void *context, const char *format, va_list arguments)
{
    cyaml_report *report = context;
    (void)level;
    char text[512];
    vsnprintf(text, sizeof text, format, arguments);
    text[strcspn(text, "\n")] = '\0';

    // The first message tells the cause, the first backtrace line with a position the place.
    const char *position = strstr(text, "line: ");
    if (position != NULL && report->line == 0)
        report->line = strtoul(position + 6, NULL, 10);
    const char *cause = strncmp(text, "Load: ", 6) == 0 ? text + 6 : text;
    if (report->message[0] == '\0')
        snprintf(report->message, sizeof report->message, "%s", cause);
}

// ---- public --------------------------------------------------------------------------------

// Last component of a key path: "b" of "a[0].b".
static const char *last_key(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot != NULL ? dot + 1 : path;
}

// libcyaml names the place of the last value it took; the key it complains of stands at or behind
// it: the first of that name, for a key seen before the last.
static size_t line_of_complaint(const cp_yaml_file *file, const cyaml_report *report)
{
    static const char UNEXPECTED[] = "Unexpected key: ";
    static const char SEEN[] = "Mapping field already seen: ";
    bool seen = strncmp(report->message, SEEN, sizeof SEEN - 1) == 0;
    bool unexpected = strncmp(report->message, UNEXPECTED, sizeof UNEXPECTED - 1) == 0;
    size_t line = report->line > 0 ? report->line : 1;
    if (!seen && !unexpected)
        return line;
    const char *key = report->message + (seen ? sizeof SEEN : sizeof UNEXPECTED) - 1;
    size_t found = 0;
    for (size_t k = 0; k < file->line_count; k++) {
        size_t here = file->lines[k].line;
        if (here >= line && strcmp(last_key(file->lines[k].path), key) == 0 &&
            (found == 0 || (seen ? here > found : here < found)))
            found = here;
    }
    return found > 0 ? found : line;
}

// libyaml has no word for its own lack of memory: libcyaml passes on that it has none.
static bool lacked_memory(cyaml_err_t outcome, const cyaml_report *report)
{
    return outcome == CYAML_ERR_OOM || outcome == CYAML_ERR_LIBYAML_PARSER_INIT ||
           outcome == CYAML_ERR_LIBYAML_EVENT_INIT ||
           (outcome == CYAML_ERR_LIBYAML_PARSER && strstr(report->message, "(null)") != NULL);
}

static cp_status load_structure(cp_yaml_file *file, const char *content, size_t size,
                                cp_error *error)
{
    cyaml_report report = {0};
    cyaml_config_t config = {.log_fn = collect_message,
                             .log_ctx = &report,
                             .log_level = CYAML_LOG_ERROR,
                             .mem_fn = cyaml_mem,
                             .flags = CYAML_CFG_DEFAULT};
    cyaml_err_t outcome =
        cyaml_load_data((const uint8_t *)content, size, &config, file->schema, &file->data, NULL);
    if (outcome == CYAML_OK && file->data != NULL)
        return CP_OK;
    if (outcome == CYAML_OK)
        return cp_fail(error, CP_BAD_INPUT, "%s: the file is empty", file->path);
    if (lacked_memory(outcome, &report))
        return cp_fail_memory(error, file->path);
    return cp_fail(error, CP_BAD_INPUT, "%s:%zu: %s", file->path, line_of_complaint(file, &report),
                   report.message[0] != '\0' ? report.message : cyaml_strerror(outcome));
}

cp_status cp_yaml_parse(const char *name, const char *content, size_t size,
                        const cyaml_schema_value_t *schema, cp_yaml_file *file, cp_error *error)
{
    *file = (cp_yaml_file){.schema = schema, .path = strdup(name)};
    cp_status status = CP_OK;
    if (file->path == NULL)
        status = cp_fail_memory(error, name);
    // Before libcyaml's pass: its complaints find their line here, and what it takes without a word
    // (a second document, aliases of aliases without end) is refused.
    if (status == CP_OK)
        status = cp_file_check_text(name, content, size, error);
    if (status == CP_OK)
        status = cp_yaml_lines_read(name, content, size, &file->lines, &file->line_count, error);
    if (status == CP_OK)
        status = cp_yaml_structure_check(file, error);
    if (status == CP_OK)
        status = load_structure(file, content, size, error);
    if (status != CP_OK)
        cp_yaml_close(file);
    return status;
}

cp_status cp_yaml_load(const char *path, const cyaml_schema_value_t *schema, cp_yaml_file *file,
                       cp_error *error)
{
    char *content = NULL;
    size_t size = 0;
    *file = (cp_yaml_file){0};
    cp_status status = cp_file_read(path, &content, &size, error);
    if (status == CP_OK)
        status = cp_yaml_parse(path, content, size, schema, file, error);
    free(content);
    return status;
}

void cp_yaml_close(cp_yaml_file *file)
{
    cyaml_config_t config = {.mem_fn = cyaml_mem, .log_level = CYAML_LOG_ERROR};
    if (file->data != NULL)
        cyaml_free(&config, file->schema, file->data, 0);
    cp_yaml_lines_destroy(file->lines, file->line_count);
    free(file->path);
    *file = (cp_yaml_file){0};
}

bool cp_parse_number(const char *text, double *value)
{
    char *end = NULL;
    errno = 0;
    double number = strtod(text, &end);
    // strtod takes hexadecimal numbers too; nobody means them.
    if (end == text || *end != '\0' || !isfinite(number) || errno == ERANGE ||
        strpbrk(text, "xX") != NULL)
        return false;
    *value = number;
    return true;
}

cp_status cp_yaml_number(const cp_yaml_file *file, const char *key_path, const char *text,
                         double smallest, double largest, double *value, cp_error *error)
{
    if (text == NULL)
        return CP_OK;
    double number = 0.0;
    if (!cp_parse_number(text, &number))
        return cp_yaml_fail(file, error, key_path, "must be a number from %g to %g, found '%s'",
                            smallest, largest, text);
    if (number < smallest || number > largest)
        return cp_yaml_fail(file, error, key_path, "must be between %g and %g, found %s", smallest,
                            largest, text);
    *value = number;
    return CP_OK;
}
