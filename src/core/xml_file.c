/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/xml_file.h"

#include "core/file.h"

#include <errno.h>
#include <expat.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

typedef struct reader {
    XML_Parser parser;
    const char *path;
    const char *root;
    size_t depth;
    const cp_xml_visitor *visitor;
    void *context;
    cp_status status; /* of what was visited last */
    cp_error *error;
} reader;

// What a visit came to; anything but CP_OK is the last.
static void visited(reader *self, cp_status status)
{
    self->status = status;
    if (status != CP_OK)
        XML_StopParser(self->parser, XML_FALSE);
}

static void XMLCALL begin_element(void *user, const XML_Char *name, const XML_Char **attribute)
{
    reader *self = user;
    cp_xml_element element = {.path = self->path,
                              .line = (size_t)XML_GetCurrentLineNumber(self->parser),
                              .name = name,
                              .attribute = (const char *const *)attribute};
    if (self->status != CP_OK)
        return;
    if (self->depth++ == 0 && self->root != NULL && strcmp(name, self->root) != 0)
        visited(self, cp_fail(self->error, CP_BAD_INPUT, "%s:%zu: must be <%s>, found <%s>",
                              self->path, element.line, self->root, name));
    else if (self->visitor->begin != NULL)
        visited(self, self->visitor->begin(self->context, &element, self->error));
}

static void XMLCALL end_element(void *user, const XML_Char *name)
{
    reader *self = user;
    self->depth--;
    if (self->status == CP_OK && self->visitor->end != NULL)
        visited(self, self->visitor->end(self->context, name, self->error));
}

static void XMLCALL take_text(void *user, const XML_Char *text, int size)
{
    reader *self = user;
    if (self->status == CP_OK && self->visitor->text != NULL)
        visited(self, self->visitor->text(self->context, text, (size_t)size, self->error));
}

static void XMLCALL declare_entity(void *user, const XML_Char *name, int is_parameter,
                                   const XML_Char *value, int size, const XML_Char *base,
                                   const XML_Char *system, const XML_Char *public,
                                   const XML_Char *notation)
{
    reader *self = user;
    (void)name, (void)is_parameter, (void)value, (void)size, (void)base, (void)public;
    (void)notation;
    if (system != NULL && self->status == CP_OK && self->visitor->outside != NULL)
        visited(self, self->visitor->outside(self->context, system, self->error));
}

static void XMLCALL begin_doctype(void *user, const XML_Char *name, const XML_Char *system,
                                  const XML_Char *public, int has_internal_subset)
{
    (void)has_internal_subset;
    declare_entity(user, name, 0, NULL, 0, NULL, system, public, NULL);
}

// gzread reads what is not compressed as it is.
static cp_status parse(reader *self, gzFile file, cp_error *error)
{
    enum { CHUNK = 1 << 16 };
    int is_last = 0;
    while (!is_last) {
        void *buffer = XML_GetBuffer(self->parser, CHUNK);
        if (buffer == NULL)
            return cp_fail_memory(error, self->path);
        int size = gzread(file, buffer, CHUNK);
        int broken = 0;
        const char *reason = gzerror(file, &broken);
        if (broken == Z_MEM_ERROR)
            return cp_fail_memory(error, self->path);
        // A compressed file cut off in the middle ends without its checksum (Z_BUF_ERROR).
        if (size < 0 || broken < 0)
            return cp_fail(error, CP_BAD_INPUT, "%s: cannot be read: %s", self->path,
                           broken == Z_ERRNO ? strerror(errno) : reason);
        is_last = size < CHUNK;
        enum XML_Status parsed = XML_ParseBuffer(self->parser, size, is_last);
        if (self->status != CP_OK)
            return self->status;
        if (parsed == XML_STATUS_ERROR && XML_GetErrorCode(self->parser) == XML_ERROR_NO_MEMORY)
            return cp_fail_memory(error, self->path);
        if (parsed == XML_STATUS_ERROR)
            return cp_fail(error, CP_BAD_INPUT, "%s:%lu: is not XML: %s", self->path,
                           (unsigned long)XML_GetCurrentLineNumber(self->parser),
                           XML_ErrorString(XML_GetErrorCode(self->parser)));
    }
    return CP_OK;
}

cp_status cp_xml_read_all(const char *path, const char *root, const cp_xml_visitor *visitor,
                          void *context, cp_error *error)
{
    // gzip's reader takes a descriptor over; what has no end is refused before.
    FILE *checked = NULL;
    cp_status status = cp_file_open(path, &checked, error);
    if (status != CP_OK)
        return status;
    int descriptor = dup(fileno(checked));
    fclose(checked);
    gzFile file = descriptor >= 0 ? gzdopen(descriptor, "rb") : NULL;
    if (file == NULL) {
        if (descriptor >= 0)
            close(descriptor);
        return cp_fail_memory(error, path);
    }
    reader self = {.parser = XML_ParserCreate(NULL),
                   .path = path,
                   .root = root,
                   .visitor = visitor,
                   .context = context,
                   .error = error};
    if (self.parser == NULL) {
        status = cp_fail_memory(error, path);
    } else {
        XML_SetUserData(self.parser, &self);
        XML_SetElementHandler(self.parser, begin_element, end_element);
        XML_SetCharacterDataHandler(self.parser, take_text);
        XML_SetEntityDeclHandler(self.parser, declare_entity);
        XML_SetStartDoctypeDeclHandler(self.parser, begin_doctype);
        status = parse(&self, file, error);
        XML_ParserFree(self.parser);
    }
    gzclose(file);
    return status;
}

cp_status cp_xml_read(const char *path, const char *root, cp_xml_visit visit, void *context,
                      cp_error *error)
{
    const cp_xml_visitor visitor = {.begin = visit};
    return cp_xml_read_all(path, root, &visitor, context, error);
}

const char *cp_xml_attribute(const cp_xml_element *element, const char *name)
{
    for (size_t k = 0; element->attribute[k] != NULL; k += 2)
        if (strcmp(element->attribute[k], name) == 0)
            return element->attribute[k + 1];
    return NULL;
}

cp_status cp_xml_text(const cp_xml_element *element, const char *name, const char **text,
                      cp_error *error)
{
    *text = cp_xml_attribute(element, name);
    if (*text != NULL)
        return CP_OK;
    return cp_fail(error, CP_BAD_INPUT, "%s:%zu: <%s> must have the attribute %s, found none",
                   element->path, element->line, element->name, name);
}

cp_status cp_xml_number(const cp_xml_element *element, const char *name, double smallest,
                        double largest, double *value, cp_error *error)
{
    const char *text = NULL;
    char *end = NULL;
    cp_status status = cp_xml_text(element, name, &text, error);
    if (status != CP_OK)
        return status;
    *value = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(*value))
        return cp_fail(error, CP_BAD_INPUT, "%s:%zu: %s of <%s> must be a number, found '%s'",
                       element->path, element->line, name, element->name, text);
    if (*value < smallest || *value > largest)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s:%zu: %s of <%s> must be between %g and %g, found %s", element->path,
                       element->line, name, element->name, smallest, largest, text);
    return CP_OK;
}

cp_status cp_xml_time(const cp_xml_element *element, const char *name, double *time_s,
                      cp_error *error)
{
    static const double UNIT_S[] = {1.0, 60.0, 3600.0, 86400.0};
    const char *text = NULL;
    double part[4];
    int parts = 0;
    cp_status status = cp_xml_text(element, name, &text, error);
    if (status != CP_OK)
        return status;
    if (strchr(text, ':') == NULL)
        return cp_xml_number(element, name, -HUGE_VAL, HUGE_VAL, time_s, error);
    for (const char *c = text; parts < 4;) {
        char *end = NULL;
        part[parts] = strtod(c, &end);
        if (end == c || !(part[parts] >= 0.0) || (*end != ':' && *end != '\0'))
            break;
        parts++;
        if (*end == '\0') {
            *time_s = 0.0;
            for (int k = 0; k < parts; k++)
                *time_s += part[k] * UNIT_S[parts - 1 - k];
            return CP_OK;
        }
        c = end + 1;
    }
    return cp_fail(error, CP_BAD_INPUT,
                   "%s:%zu: %s of <%s> must be a time in s or [days:]hours:minutes:seconds, found "
                   "'%s'",
                   element->path, element->line, name, element->name, text);
}
