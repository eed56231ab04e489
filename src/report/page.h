/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef REPORT_PAGE_H
#define REPORT_PAGE_H

#include "core/error.h"

#include <jansson.h>
#include <stddef.h>

/* A page template with places to fill: {{name}}. */
typedef struct cp_page_part {
    const char *name;
    const char *text;
} cp_page_part;

/* The template with every place filled with the text of its part, as it is. *page is the caller's
 * to free. Errors: CP_NO_MEMORY; CP_BAD_INPUT for a place that no part fills. */
CP_MUST_CHECK cp_status cp_page_fill(const char *template_text, const cp_page_part *part,
                                     size_t part_count, char **page, size_t *size, cp_error *error);

/* Text that may stand between tags: &, <, > and quotes escaped. The caller frees; NULL when memory
 * is gone. */
char *cp_page_escape(const char *text);

/* JSON text that may stand in a script element: every <, >, & and character beyond ASCII is
 * escaped. The caller frees; NULL when memory is gone. */
char *cp_page_json_text(const json_t *json);

#endif
