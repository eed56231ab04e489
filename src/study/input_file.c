/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/input_file.h"

#include "core/file.h"
#include "core/xml_file.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

// Cut XML comments out of text in place.
static void remove_comments(char *text)
{
    char *to = text;
    const char *from = text;
    while (*from != '\0') {
        if (strncmp(from, "<!--", 4) == 0) {
            const char *end = strstr(from + 4, "-->");
            from = end != NULL ? end + 3 : from + strlen(from);
        } else {
            *to++ = *from++;
        }
    }
    *to = '\0';
}

static cp_status append(char ***list, size_t *count, const char *text, cp_error *error)
{
    char **more = realloc(*list, (*count + 1) * sizeof *more);
    if (more == NULL)
        return cp_fail_memory(error, text);
    *list = more;
    more[*count] = strdup(text);
    if (more[*count] == NULL)
        return cp_fail_memory(error, text);
    ++*count;
    return CP_OK;
}

// ---- inside --------------------------------------------------------------------------------

typedef struct search {
    cp_input_file *file;
    const cp_input_wanted *wanted;
} search;

static cp_status look_at_element(void *context, const cp_xml_element *element, cp_error *error)
{
    static const char *const WITH_FILE[] = {"variableSpeedSign", "rerouter", "calibrator"};
    const search *s = context;
    cp_input_file *file = s->file;
    const char *included = NULL;
    if (strcmp(element->name, "include") == 0)
        included = cp_xml_attribute(element, "href");
    for (size_t k = 0; k < sizeof WITH_FILE / sizeof *WITH_FILE; k++)
        if (strcmp(element->name, WITH_FILE[k]) == 0)
            included = cp_xml_attribute(element, "file");
    if (included != NULL && included[0] != '\0')
        return append(&file->includes, &file->include_count, included, error);

    const char *key = cp_xml_attribute(element, "key");
    const char *value = cp_xml_attribute(element, "value");
    const char *id = cp_xml_attribute(element, "id");
    if (s->wanted->types && id != NULL &&
        (strcmp(element->name, "vType") == 0 || strcmp(element->name, "vTypeDistribution") == 0))
        return append(&file->types, &file->type_count, id, error);
    if (s->wanted->key != NULL && strcmp(element->name, "param") == 0 && key != NULL &&
        value != NULL && strcmp(key, s->wanted->key) == 0)
        return append(&file->values, &file->value_count, value, error);
    return CP_OK;
}

static cp_status look_at_entity(void *context, const char *name, cp_error *error)
{
    const search *s = context;
    return append(&s->file->includes, &s->file->include_count, name, error);
}

// Whether there is anything to find: a network of a whole city need not be parsed for that. Text of
// two bytes a character is, it cannot be searched.
static bool is_worth_parsing(const char *content, size_t size, const cp_input_wanted *wanted)
{
    static const char *const WORD[] = {"<include", "variableSpeedSign", "<rerouter", "<calibrator",
                                       "<!"};
    if (memchr(content, '\0', size) != NULL)
        return true;
    for (size_t k = 0; k < sizeof WORD / sizeof *WORD; k++)
        if (strstr(content, WORD[k]) != NULL)
            return true;
    return (wanted->key != NULL && strstr(content, wanted->key) != NULL) ||
           (wanted->types && strstr(content, "<vType") != NULL);
}

// The content of a compressed file, zero-terminated.
static cp_status inflate_file(const char *path, char **content, size_t *size, cp_error *error)
{
    gzFile in = gzopen(path, "rb");
    size_t room = 1 << 16;
    int got = 0;
    *size = 0;
    *content = malloc(room + 1);
    if (in == NULL || *content == NULL) {
        if (in != NULL)
            gzclose(in);
        return cp_fail_memory(error, path);
    }
    cp_status status = CP_OK;
    while (status == CP_OK && (got = gzread(in, *content + *size, (unsigned)(room - *size))) > 0) {
        *size += (size_t)got;
        if (*size < room)
            continue;
        char *more = realloc(*content, 2 * room + 1);
        if (more == NULL)
            status = cp_fail_memory(error, path);
        else {
            *content = more;
            room *= 2;
        }
    }
    (*content)[*size] = '\0';
    gzclose(in);
    return status;
}

static cp_status look_inside(search *s, const char *content, size_t size, cp_error *error)
{
    s->file->has_lights = strstr(content, "<tlLogic") != NULL;
    s->file->has_opposite = strstr(content, "<neigh") != NULL;
    static const cp_xml_visitor VISITOR = {look_at_element, NULL, NULL, look_at_entity};
    if (!is_worth_parsing(content, size, s->wanted))
        return CP_OK;
    cp_error of_file = {0};
    cp_status status = cp_xml_read_all(s->file->path, NULL, &VISITOR, s, &of_file);
    // What is no XML is for SUMO to complain of.
    if (status == CP_NO_MEMORY)
        *error = of_file;
    return status == CP_NO_MEMORY ? status : CP_OK;
}

// ---- public --------------------------------------------------------------------------------

static bool is_compressed(const char *content, size_t size)
{
    return size > 2 && (unsigned char)content[0] == 0x1f && (unsigned char)content[1] == 0x8b;
}

cp_status cp_input_file_read(const char *path, const cp_input_wanted *wanted, cp_input_file *file,
                             cp_error *error)
{
    char *content = NULL, *plain = NULL;
    size_t size = 0, plain_size = 0;
    search s = {.file = file, .wanted = wanted};
    *file = (cp_input_file){.path = path};
    cp_status status = cp_file_read(path, &content, &size, error);
    if (status != CP_OK)
        return status;
    if (is_compressed(content, size)) {
        cp_hash_bytes(content, size, file->hash);
        status = inflate_file(path, &plain, &plain_size, error);
        if (status == CP_OK)
            status = look_inside(&s, plain, plain_size, error);
    } else {
        // Bytes of zero are in no XML text of one byte a character: then all of it counts.
        bool is_text = memchr(content, '\0', size) == NULL;
        if (is_text) {
            remove_comments(content);
            size = strlen(content);
        }
        cp_hash_bytes(content, size, file->hash);
        status = look_inside(&s, content, size, error);
    }
    free(plain);
    free(content);
    return status;
}

void cp_input_file_destroy(cp_input_file *file)
{
    for (size_t k = 0; k < file->include_count; k++)
        free(file->includes[k]);
    for (size_t k = 0; k < file->value_count; k++)
        free(file->values[k]);
    for (size_t k = 0; k < file->type_count; k++)
        free(file->types[k]);
    free(file->types);
    free(file->includes);
    free(file->values);
    *file = (cp_input_file){0};
}
