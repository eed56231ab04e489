/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_XML_FILE_H
#define CORE_XML_FILE_H

#include "core/error.h"

#include <stddef.h>

/* Reading SUMO's XML files element by element (expat): files of any size, plain or compressed with
 * gzip, every message with file, line, element and attribute. */

/* One element as it begins; valid during the call. */
typedef struct cp_xml_element {
    const char *path; /* of the file */
    size_t line;
    const char *name;
    const char *const *attribute; /* name, value, name, value, ..., NULL */
} cp_xml_element;

/* Called for every element in the order of the file; anything but CP_OK ends the reading. */
typedef cp_status (*cp_xml_visit)(void *context, const cp_xml_element *element, cp_error *error);

/* Read a file whose outermost element must be `root` (NULL: any). Errors: CP_BAD_INPUT for a file
 * that cannot be read, is no XML or has another root; those of visit. */
CP_MUST_CHECK cp_status cp_xml_read(const char *path, const char *root, cp_xml_visit visit,
                                    void *context, cp_error *error);

/* What a reader of everything is called for; NULL: not called. A text may come in pieces. A file
 * that the document's type or an entity names (SYSTEM "...") is told by name and not read. */
typedef struct cp_xml_visitor {
    cp_xml_visit begin;
    cp_status (*text)(void *context, const char *text, size_t size, cp_error *error);
    cp_status (*end)(void *context, const char *name, cp_error *error);
    cp_status (*outside)(void *context, const char *name, cp_error *error);
} cp_xml_visitor;

/* The same with all of that. */
CP_MUST_CHECK cp_status cp_xml_read_all(const char *path, const char *root,
                                        const cp_xml_visitor *visitor, void *context,
                                        cp_error *error);

/* Value of an attribute; NULL when the element does not have it. */
const char *cp_xml_attribute(const cp_xml_element *element, const char *name);

/* The same where it must be there. Error: CP_BAD_INPUT. */
CP_MUST_CHECK cp_status cp_xml_text(const cp_xml_element *element, const char *name,
                                    const char **text, cp_error *error);

/* An attribute as a time in s: a number, or [days:]hours:minutes:seconds as SUMO writes it with
 * --human-readable-time. Error: CP_BAD_INPUT. */
CP_MUST_CHECK cp_status cp_xml_time(const cp_xml_element *element, const char *name, double *time_s,
                                    cp_error *error);

/* An attribute as a finite number, the whole text, in [smallest, largest]. Error: CP_BAD_INPUT. */
CP_MUST_CHECK cp_status cp_xml_number(const cp_xml_element *element, const char *name,
                                      double smallest, double largest, double *value,
                                      cp_error *error);

#endif
