/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/xml_file.h"

#include "core/file.h"

#include <errno.h>
#include <expat.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct reader {
    XML_Parser parser;
    const char *path;
    const char *root;
    size_t depth;
    cp_xml_visit visit;
    void *context;
    cp_status status; /* of what was visited last */
    cp_error *error;
} reader;

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
        self->status = cp_fail(self->error, CP_BAD_INPUT, "%s:%zu: must be <%s>, found <%s>",
                               self->path, element.line, self->root, name);
    else
        self->status = self->visit(self->context, &element, self->error);
    if (self->status != CP_OK)
        XML_StopParser(self->parser, XML_FALSE);
}

static void XMLCALL end_element(void *user, const XML_Char *name)
{
    reader *self = user;
    (void)name;
    self->depth--;
}

static cp_status parse(reader *self, FILE *file, cp_error *error)
{
    enum { CHUNK = 1 << 16 };
    int is_last = 0;
    while (!is_last) {
        void *buffer = XML_GetBuffer(self->parser, CHUNK);
        if (buffer == NULL)
            return cp_fail_memory(error, self->path);
        size_t size = fread(buffer, 1, CHUNK, file);
        if (ferror(file))
            return cp_fail(error, CP_BAD_INPUT, "%s: cannot be read: %s", self->path,
                           strerror(errno));
        is_last = size < CHUNK;
        enum XML_Status parsed = XML_ParseBuffer(self->parser, (int)size, is_last);
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

cp_status cp_xml_read(const char *path, const char *root, cp_xml_visit visit, void *context,
                      cp_error *error)
{
    FILE *file = NULL;
    cp_status status = cp_file_open(path, &file, error);
    if (status != CP_OK)
        return status;
    reader self = {.parser = XML_ParserCreate(NULL),
                   .path = path,
                   .root = root,
                   .visit = visit,
                   .context = context,
                   .error = error};
    if (self.parser == NULL) {
        status = cp_fail_memory(error, path);
    } else {
        XML_SetUserData(self.parser, &self);
        XML_SetElementHandler(self.parser, begin_element, end_element);
        status = parse(&self, file, error);
        XML_ParserFree(self.parser);
    }
    fclose(file);
    return status;
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
