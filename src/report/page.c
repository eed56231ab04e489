/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/page.h"

#include "core/memory_stream.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const cp_page_part *find_part(const cp_page_part *part, size_t count, const char *name,
                                     size_t length)
{
    for (size_t k = 0; k < count; k++)
        if (strlen(part[k].name) == length && strncmp(part[k].name, name, length) == 0)
            return &part[k];
    return NULL;
}

// A stream in memory that cannot grow tells it by what it returns, and by nothing else.
static cp_status put(FILE *out, const char *text, size_t size, cp_error *error)
{
    return fwrite(text, 1, size, out) == size ? CP_OK : cp_fail_memory(error, "a page");
}

static cp_status fill(FILE *out, const char *text, const cp_page_part *part, size_t part_count,
                      cp_error *error)
{
    for (const char *open; (open = strstr(text, "{{")) != NULL;) {
        const char *close = strstr(open, "}}");
        if (!close)
            return cp_fail(error, CP_BAD_INPUT, "page template: {{ without }}");
        size_t length = (size_t)(close - open) - 2;
        const cp_page_part *found = find_part(part, part_count, open + 2, length);
        if (!found)
            return cp_fail(error, CP_BAD_INPUT, "page template: nothing fills {{%.*s}}",
                           (int)length, open + 2);
        cp_status status = put(out, text, (size_t)(open - text), error);
        if (status == CP_OK)
            status = put(out, found->text, strlen(found->text), error);
        if (status != CP_OK)
            return status;
        text = close + 2;
    }
    return put(out, text, strlen(text), error);
}

cp_status cp_page_fill(const char *template_text, const cp_page_part *part, size_t part_count,
                       char **page, size_t *size, cp_error *error)
{
    *page = NULL;
    FILE *out = cp_memory_stream(page, size);
    if (!out)
        return cp_fail_memory(error, "a page");
    cp_status status = fill(out, template_text, part, part_count, error);
    int failed = ferror(out);
    if ((fclose(out) != 0 || failed) && status == CP_OK)
        status = cp_fail_memory(error, "a page");
    if (status != CP_OK) {
        free(*page);
        *page = NULL;
    }
    return status;
}

char *cp_page_escape(const char *text)
{
    char *escaped = malloc(6 * strlen(text) + 1), *end = escaped;
    for (const char *c = text; escaped && *c; c++) {
        switch (*c) {
        case '&':
            end += sprintf(end, "&amp;");
            break;
        case '<':
            end += sprintf(end, "&lt;");
            break;
        case '>':
            end += sprintf(end, "&gt;");
            break;
        case '"':
            end += sprintf(end, "&quot;");
            break;
        default:
            *end++ = *c;
        }
    }
    if (escaped)
        *end = '\0';
    return escaped;
}

char *cp_page_json_text(const json_t *json)
{
    char *text = json_dumps(json, JSON_COMPACT | JSON_ENSURE_ASCII | JSON_REAL_PRECISION(10));
    if (!text)
        return NULL;
    // In JSON these three occur inside strings only, where \u003c means the same.
    size_t size = 1;
    for (const char *c = text; *c; c++)
        size += strchr("<>&", *c) ? 6 : 1;
    char *safe = malloc(size), *end = safe;
    for (const char *c = text; safe && *c; c++) {
        if (strchr("<>&", *c))
            end += sprintf(end, "\\u%04x", (unsigned)*c);
        else
            *end++ = *c;
    }
    if (safe)
        *end = '\0';
    free(text);
    return safe;
}
