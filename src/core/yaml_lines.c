/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/yaml_lines.h"

#include "core/array.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

#define DEPTH_MAX 64
#define PATH_MAX_CHARACTERS 1024
#define LINES_MAX 100000
#define NO_ANCHOR SIZE_MAX

// What an anchor marks: the lines from first on, whose paths begin with that of the first.
typedef struct anchor {
    char *name;
    size_t first, count;
    bool is_open; /* its collection has not ended */
} anchor;

// An open mapping or sequence.
typedef struct collection {
    bool mapping;
    bool key_next;
    size_t index;
    char key[256];
    size_t prefix_length; /* of path, up to this collection */
    size_t anchor;        /* that marks it, or NO_ANCHOR */
} collection;

// Where the walk over libyaml's events stands.
typedef struct line_walk {
    const char *name;
    cp_yaml_line *lines;
    size_t line_count;
    cp_error *error;
    anchor *anchors;
    size_t anchor_count;
    size_t documents;
    int depth;
    collection level[DEPTH_MAX];
    char path[PATH_MAX_CHARACTERS];
} line_walk;

static cp_status fail_at(const line_walk *walk, size_t line, const char *what, const char *name)
{
    return cp_fail(walk->error, CP_BAD_INPUT, "%s:%zu: %s%s", walk->name, line, what, name);
}

// Path of the value that begins now: the open collections' path and the present key or index.
static void extend_path(line_walk *walk)
{
    if (walk->depth == 0) {
        walk->path[0] = '\0';
        return;
    }
    const collection *inner = &walk->level[walk->depth - 1];
    size_t start = inner->prefix_length;
    size_t room = PATH_MAX_CHARACTERS - start;
    if (inner->mapping)
        snprintf(walk->path + start, room, "%s%s", start > 0 ? "." : "", inner->key);
    else
        snprintf(walk->path + start, room, "[%zu]", inner->index);
}

static cp_status remember_line(line_walk *walk, const char *path, size_t line, const char *scalar)
{
    if (walk->line_count == LINES_MAX)
        return fail_at(walk, line, "the file holds more than 100,000 values, aliases written out",
                       "");
    cp_yaml_line *entry = cp_array_add(walk->lines, walk->line_count);
    if (entry == NULL)
        return cp_fail_memory(walk->error, walk->name);
    *entry = (cp_yaml_line){
        .path = strdup(path), .scalar = scalar != NULL ? strdup(scalar) : NULL, .line = line};
    bool complete = entry->path != NULL && (scalar == NULL || entry->scalar != NULL);
    return complete ? CP_OK : cp_fail_memory(walk->error, walk->name);
}

// After a value: a mapping expects a key again, a sequence counts on.
static void value_done(line_walk *walk)
{
    if (walk->depth == 0)
        return;
    walk->level[walk->depth - 1].key_next = true;
    walk->level[walk->depth - 1].index++;
}

// ---- anchors and aliases -------------------------------------------------------------------

// The value listed next is marked by name (NULL: by none). *index: of its anchor.
static cp_status begin_anchor(line_walk *walk, const yaml_char_t *name, size_t *index)
{
    *index = NO_ANCHOR;
    if (name == NULL)
        return CP_OK;
    anchor *added = cp_array_add(walk->anchors, walk->anchor_count);
    if (added == NULL)
        return cp_fail_memory(walk->error, walk->name);
    *added =
        (anchor){.name = strdup((const char *)name), .first = walk->line_count, .is_open = true};
    if (added->name == NULL)
        return cp_fail_memory(walk->error, walk->name);
    *index = walk->anchor_count - 1;
    return CP_OK;
}

static void end_anchor(line_walk *walk, size_t index)
{
    if (index == NO_ANCHOR)
        return;
    walk->anchors[index].count = walk->line_count - walk->anchors[index].first;
    walk->anchors[index].is_open = false;
}

// List what the alias stands for, the last anchor of that name, under the alias's own path.
static cp_status take_alias(line_walk *walk, const char *name, size_t line)
{
    size_t k = walk->anchor_count;
    while (k > 0 && strcmp(walk->anchors[k - 1].name, name) != 0)
        k--;
    if (k == 0)
        return fail_at(walk, line, "there is no anchor before the alias *", name);
    const anchor *meant = &walk->anchors[k - 1];
    if (meant->is_open)
        return fail_at(walk, line, "an alias must not stand inside what it stands for: *", name);
    extend_path(walk);
    size_t prefix = strlen(walk->lines[meant->first].path);
    for (size_t i = meant->first; i < meant->first + meant->count; i++) {
        char path[2 * PATH_MAX_CHARACTERS];
        snprintf(path, sizeof path, "%s%s", walk->path, walk->lines[i].path + prefix);
        cp_status status = remember_line(walk, path, walk->lines[i].line, walk->lines[i].scalar);
        if (status != CP_OK)
            return status;
    }
    value_done(walk);
    return CP_OK;
}

// ---- events --------------------------------------------------------------------------------

// Escape sequences of a terminal, and zero bytes, which end a text for all who read it. Ends of
// lines are no such thing.
static bool holds_control(const yaml_event_t *event)
{
    const char *text = (const char *)event->data.scalar.value;
    size_t length = event->data.scalar.length;
    for (size_t k = 0; k < length; k++) {
        unsigned char c = (unsigned char)text[k];
        bool c1 = c == 0xc2 && (unsigned char)text[k + 1] < 0xa0;
        if ((c < 0x20 && c != '\n' && c != '\t') || c == 0x7f || c1)
            return true;
    }
    return false;
}

static cp_status take_key(line_walk *walk, const yaml_event_t *event, size_t line)
{
    collection *inner = &walk->level[walk->depth - 1];
    const char *key = (const char *)event->data.scalar.value;
    if (holds_control(event))
        return fail_at(walk, line, "a key must not hold control characters", "");
    if (strcmp(key, "<<") == 0)
        return fail_at(walk, line,
                       "merge keys (<<) are not read; write the keys out, or give the "
                       "whole mapping by an alias",
                       "");
    snprintf(inner->key, sizeof inner->key, "%s", key);
    inner->key_next = false;
    return CP_OK;
}

static cp_status take_scalar(line_walk *walk, const yaml_event_t *event, size_t line)
{
    size_t marked = NO_ANCHOR;
    extend_path(walk);
    if (holds_control(event))
        return fail_at(walk, line, "must not hold control characters: ", walk->path);
    cp_status status = begin_anchor(walk, event->data.scalar.anchor, &marked);
    if (status == CP_OK)
        status = remember_line(walk, walk->path, line, (const char *)event->data.scalar.value);
    end_anchor(walk, marked);
    value_done(walk);
    return status;
}

static cp_status begin_collection(line_walk *walk, const yaml_event_t *event, size_t line)
{
    bool mapping = event->type == YAML_MAPPING_START_EVENT;
    size_t marked = NO_ANCHOR;
    if (walk->depth == DEPTH_MAX)
        return fail_at(walk, line, "is nested too deeply", "");
    extend_path(walk);
    cp_status status = begin_anchor(
        walk, mapping ? event->data.mapping_start.anchor : event->data.sequence_start.anchor,
        &marked);
    if (status == CP_OK)
        status = remember_line(walk, walk->path, line, NULL);
    walk->level[walk->depth++] = (collection){.mapping = mapping,
                                              .key_next = true,
                                              .prefix_length = strlen(walk->path),
                                              .anchor = marked};
    return status;
}

static cp_status take_event(line_walk *walk, const yaml_event_t *event)
{
    size_t line = event->start_mark.line + 1;
    bool at_key = walk->depth > 0 && walk->level[walk->depth - 1].mapping &&
                  walk->level[walk->depth - 1].key_next;
    switch (event->type) {
    case YAML_DOCUMENT_START_EVENT:
        if (walk->documents++ > 0)
            return fail_at(walk, line, "a second document begins; only one a file is read", "");
        return CP_OK;
    case YAML_ALIAS_EVENT:
        if (at_key)
            return fail_at(walk, line, "an alias must not stand in place of a key: *",
                           (const char *)event->data.alias.anchor);
        return take_alias(walk, (const char *)event->data.alias.anchor, line);
    case YAML_SCALAR_EVENT:
        return at_key ? take_key(walk, event, line) : take_scalar(walk, event, line);
    case YAML_MAPPING_START_EVENT:
    case YAML_SEQUENCE_START_EVENT:
        return begin_collection(walk, event, line);
    case YAML_MAPPING_END_EVENT:
    case YAML_SEQUENCE_END_EVENT:
        end_anchor(walk, walk->level[--walk->depth].anchor);
        value_done(walk);
        return CP_OK;
    default:
        return CP_OK;
    }
}

cp_status cp_yaml_lines_read(const char *name, const char *content, size_t size,
                             cp_yaml_line **lines, size_t *count, cp_error *error)
{
    yaml_parser_t parser;
    *lines = NULL;
    *count = 0;
    if (!yaml_parser_initialize(&parser))
        return cp_fail_memory(error, name);
    yaml_parser_set_input_string(&parser, (const unsigned char *)content, size);
    line_walk walk = {.name = name, .error = error};
    cp_status status = CP_OK;
    bool ended = false;
    while (status == CP_OK && !ended) {
        yaml_event_t event;
        if (!yaml_parser_parse(&parser, &event)) {
            if (parser.error == YAML_MEMORY_ERROR)
                status = cp_fail_memory(error, name);
            break;
        }
        status = take_event(&walk, &event);
        ended = event.type == YAML_STREAM_END_EVENT;
        yaml_event_delete(&event);
    }
    yaml_parser_delete(&parser);
    for (size_t k = 0; k < walk.anchor_count; k++)
        free(walk.anchors[k].name);
    free(walk.anchors);
    *lines = walk.lines;
    *count = walk.line_count;
    return status;
}

void cp_yaml_lines_destroy(cp_yaml_line *lines, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        free(lines[k].path);
        free(lines[k].scalar);
    }
    free(lines);
}
