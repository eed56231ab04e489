/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/yaml_file.h"

#include "core/file.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

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

// ---- line of every key path ----------------------------------------------------------------

#define DEPTH_MAX 64
#define PATH_MAX_CHARACTERS 1024

// Where the walk over libyaml's events stands: a stack of open mappings and sequences.
typedef struct line_walk {
    cp_yaml_file *file;
    size_t capacity;
    int depth;
    struct {
        bool mapping;
        bool key_next;
        size_t index;
        char key[256];
        size_t prefix_length; /* of path, up to this collection */
    } level[DEPTH_MAX];
    char path[PATH_MAX_CHARACTERS];
} line_walk;

// Path of the value that begins now: the open collections' path and the present key or index.
static void extend_path(line_walk *walk)
{
    if (walk->depth == 0) {
        walk->path[0] = '\0';
        return;
    }
    size_t start = walk->level[walk->depth - 1].prefix_length;
    size_t room = PATH_MAX_CHARACTERS - start;
    if (walk->level[walk->depth - 1].mapping)
        snprintf(walk->path + start, room, "%s%s", start > 0 ? "." : "",
                 walk->level[walk->depth - 1].key);
    else
        snprintf(walk->path + start, room, "[%zu]", walk->level[walk->depth - 1].index);
}

static bool remember_line(line_walk *walk, size_t line, const char *scalar)
{
    cp_yaml_file *file = walk->file;
    if (file->line_count == walk->capacity) {
        size_t capacity = walk->capacity == 0 ? 64 : 2 * walk->capacity;
        cp_yaml_line *lines = realloc(file->lines, capacity * sizeof *lines);
        if (lines == NULL)
            return false;
        file->lines = lines;
        walk->capacity = capacity;
    }
    cp_yaml_line entry = {
        .path = strdup(walk->path), .scalar = scalar != NULL ? strdup(scalar) : NULL, .line = line};
    if (entry.path == NULL || (scalar != NULL && entry.scalar == NULL)) {
        free(entry.path);
        free(entry.scalar);
        return false;
    }
    file->lines[file->line_count++] = entry;
    return true;
}

// After a value: a mapping expects a key again, a sequence counts on.
static void value_done(line_walk *walk)
{
    if (walk->depth == 0)
        return;
    walk->level[walk->depth - 1].key_next = true;
    walk->level[walk->depth - 1].index++;
}

static bool take_event(line_walk *walk, const yaml_event_t *event)
{
    size_t line = event->start_mark.line + 1;
    bool at_key = walk->depth > 0 && walk->level[walk->depth - 1].mapping &&
                  walk->level[walk->depth - 1].key_next;
    switch (event->type) {
    case YAML_SCALAR_EVENT:
        if (at_key) {
            snprintf(walk->level[walk->depth - 1].key, sizeof walk->level[0].key, "%s",
                     (const char *)event->data.scalar.value);
            walk->level[walk->depth - 1].key_next = false;
            return true;
        }
        extend_path(walk);
        if (!remember_line(walk, line, (const char *)event->data.scalar.value))
            return false;
        value_done(walk);
        return true;
    case YAML_MAPPING_START_EVENT:
    case YAML_SEQUENCE_START_EVENT:
        extend_path(walk);
        if (walk->depth == DEPTH_MAX || !remember_line(walk, line, NULL))
            return false;
        walk->level[walk->depth].mapping = event->type == YAML_MAPPING_START_EVENT;
        walk->level[walk->depth].key_next = true;
        walk->level[walk->depth].index = 0;
        walk->level[walk->depth].prefix_length = strlen(walk->path);
        walk->depth++;
        return true;
    case YAML_MAPPING_END_EVENT:
    case YAML_SEQUENCE_END_EVENT:
        walk->depth--;
        value_done(walk);
        return true;
    default:
        return true;
    }
}

static bool walk_lines(cp_yaml_file *file, const char *content, size_t size)
{
    yaml_parser_t parser;
    if (!yaml_parser_initialize(&parser))
        return false;
    yaml_parser_set_input_string(&parser, (const unsigned char *)content, size);
    line_walk walk = {.file = file};
    bool ended = false, good = true;
    while (good && !ended) {
        yaml_event_t event;
        if (!yaml_parser_parse(&parser, &event)) {
            good = false;
            break;
        }
        good = take_event(&walk, &event);
        ended = event.type == YAML_STREAM_END_EVENT;
        yaml_event_delete(&event);
    }
    yaml_parser_delete(&parser);
    return good;
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
    walk_lines(file, content, size);
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
    if (status == CP_OK)
        status = load_structure(file, content, size, error);
    if (status == CP_OK && !walk_lines(file, content, size))
        status = cp_fail(error, CP_BAD_INPUT, "%s: is nested too deeply", name);
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
    for (size_t k = 0; k < file->line_count; k++) {
        free(file->lines[k].path);
        free(file->lines[k].scalar);
    }
    free(file->lines);
    free(file->path);
    *file = (cp_yaml_file){0};
}

size_t cp_yaml_line_of(const cp_yaml_file *file, const char *key_path)
{
    // The entry whose path is the longest beginning of key_path that ends at a path boundary.
    size_t best_length = 0, best_line = 1;
    for (size_t k = 0; k < file->line_count; k++) {
        size_t length = strlen(file->lines[k].path);
        char next = strncmp(file->lines[k].path, key_path, length) == 0 ? key_path[length] : 'x';
        if (length > best_length && (next == '\0' || next == '.' || next == '[')) {
            best_length = length;
            best_line = file->lines[k].line;
        }
    }
    return best_line;
}

cp_status cp_yaml_fail(const cp_yaml_file *file, cp_error *error, const char *key_path,
                       const char *format, ...)
{
    char message[2048];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return cp_fail(error, CP_BAD_INPUT, "%s:%zu: %s %s", file->path,
                   cp_yaml_line_of(file, key_path), key_path, message);
}

bool cp_parse_number(const char *text, double *value)
{
    char *end = NULL;
    errno = 0;
    double number = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(number) || errno == ERANGE)
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
