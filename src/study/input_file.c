/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/input_file.h"

#include "core/array.h"
#include "core/file.h"
#include "core/xml_file.h"

#include <ctype.h>
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
    char **added = cp_array_add(*list, *count);
    if (added == NULL)
        return cp_fail_memory(error, text);
    *added = strdup(text);
    return *added != NULL ? CP_OK : cp_fail_memory(error, text);
}

// ---- inside --------------------------------------------------------------------------------

typedef struct search {
    cp_input_file *file;
    const cp_input_search *wanted;
} search;

static cp_status add_output(cp_input_file *file, size_t line, const char *element,
                            const char *attribute, const char *name, cp_error *error)
{
    cp_input_output *output = cp_array_add(file->outputs, file->output_count);
    if (output == NULL)
        return cp_fail_memory(error, name);
    char *what = malloc(strlen(element) + strlen(attribute) + sizeof "< >");
    if (what != NULL && element[0] != '\0')
        strcat(strcat(strcat(strcat(strcpy(what, "<"), element), " "), attribute), ">");
    else if (what != NULL)
        strcpy(what, attribute);
    *output = (cp_input_output){.line = line, .what = what, .name = strdup(name)};
    return what != NULL && output->name != NULL ? CP_OK : cp_fail_memory(error, name);
}

// Whether a text ends in a word: "x.file" in "file", "profile" not.
static bool ends_in(const char *text, const char *word)
{
    size_t length = strlen(text), of_word = strlen(word);
    if (length < of_word || strcmp(text + length - of_word, word) != 0)
        return false;
    return length == of_word || !isalpha((unsigned char)text[length - of_word - 1]);
}

// Elements whose file is read.
static bool reads_its_file(const char *element)
{
    static const char *const NAME[] = {"variableSpeedSign", "rerouter", "calibrator"};
    for (size_t k = 0; k < sizeof NAME / sizeof *NAME; k++)
        if (strcmp(element, NAME[k]) == 0)
            return true;
    return false;
}

// What of an element makes SUMO write.
static cp_status look_for_outputs(cp_input_file *file, const cp_xml_element *element,
                                  cp_error *error)
{
    static const char *const ATTRIBUTE[] = {"file", "output", "dest"};
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < sizeof ATTRIBUTE / sizeof *ATTRIBUTE; k++) {
        const char *name = cp_xml_attribute(element, ATTRIBUTE[k]);
        bool is_read = k == 0 && reads_its_file(element->name);
        if (name != NULL && name[0] != '\0' && !is_read)
            status = add_output(file, element->line, element->name, ATTRIBUTE[k], name, error);
    }
    const char *key = cp_xml_attribute(element, "key");
    const char *value = cp_xml_attribute(element, "value");
    if (status == CP_OK && key != NULL && value != NULL && value[0] != '\0' &&
        (ends_in(key, "file") || ends_in(key, "output")))
        status = add_output(file, element->line, "", key, value, error);
    // A kind of traffic light that writes a log of its own where SUMO was started.
    const char *type = cp_xml_attribute(element, "type");
    if (status == CP_OK && strcmp(element->name, "tlLogic") == 0 && type != NULL &&
        strcmp(type, "swarm") == 0)
        status = add_output(file, element->line, element->name, "type", "swarm", error);
    return status;
}

static cp_status look_at_element(void *context, const cp_xml_element *element, cp_error *error)
{
    const search *s = context;
    cp_input_file *file = s->file;
    const char *included = NULL;
    cp_status status = CP_OK;
    if (s->wanted->outputs)
        status = look_for_outputs(file, element, error);
    if (status != CP_OK)
        return status;
    if (strcmp(element->name, "include") == 0)
        included = cp_xml_attribute(element, "href");
    else if (reads_its_file(element->name))
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
    if (s->wanted->outputs && strchr(name, ':') != NULL) {
        cp_status status = add_output(s->file, 0, "", "document type or entity", name, error);
        if (status != CP_OK)
            return status;
    }
    return append(&s->file->includes, &s->file->include_count, name, error);
}

// Whether there is anything to find: a network of a whole city need not be parsed for that. Text of
// two bytes a character is, it cannot be searched.
static bool is_worth_parsing(const char *content, size_t size, const cp_input_search *wanted)
{
    static const char *const WORD[] = {"<include", "variableSpeedSign", "<rerouter", "<calibrator",
                                       "<!"};
    static const char *const OUTPUT_WORD[] = {"file", "output", "dest", "swarm", "&#"};
    if (memchr(content, '\0', size) != NULL)
        return true;
    for (size_t k = 0; k < sizeof WORD / sizeof *WORD; k++)
        if (strstr(content, WORD[k]) != NULL)
            return true;
    for (size_t k = 0; wanted->outputs && k < sizeof OUTPUT_WORD / sizeof *OUTPUT_WORD; k++)
        if (strstr(content, OUTPUT_WORD[k]) != NULL)
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

cp_status cp_input_file_read(const char *path, const cp_input_search *wanted, cp_input_file *file,
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
        if (wanted->hash)
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
        if (wanted->hash)
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
    for (size_t k = 0; k < file->output_count; k++) {
        free(file->outputs[k].what);
        free(file->outputs[k].name);
    }
    free(file->types);
    free(file->outputs);
    free(file->includes);
    free(file->values);
    *file = (cp_input_file){0};
}
