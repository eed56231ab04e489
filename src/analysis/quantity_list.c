/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/quantity_list.h"

#include "core/array.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

void cp_quantities_destroy(cp_quantities *list)
{
    free(list->row);
    *list = (cp_quantities){0};
}

cp_quantity *cp_quantities_append(cp_quantities *list)
{
    cp_quantity *row = cp_array_add(list->row, list->count);
    list->failed |= !row;
    return row ? row : &list->spare;
}

cp_quantity *cp_quantities_add(cp_quantities *list, const char *section, const char *name,
                               const char *label, int digits, double factor, double value)
{
    cp_quantity *q = cp_quantities_append(list);
    *q = (cp_quantity){.section = section,
                       .scope = -1,
                       .digits = digits,
                       .factor = factor,
                       .estimate = cp_estimate_of(value)};
    snprintf(q->name, sizeof q->name, "%s", name);
    snprintf(q->label, sizeof q->label, "%s", label);
    return q;
}

const char *cp_quantity_text(char text[CP_QUANTITY_TEXT_SIZE], const char *format, ...)
{
    va_list list;
    va_start(list, format);
    vsnprintf(text, CP_QUANTITY_TEXT_SIZE, format, list);
    va_end(list);
    return text;
}

double cp_quantity_rounded(double x)
{
    return round(x * 1e6) / 1e6;
}

const char *cp_relation_text(cp_relation relation)
{
    static const char *const RELATION[] = {
        [CP_NO_VALUE] = "", [CP_EXACTLY] = "=", [CP_LESS_THAN] = "<", [CP_MORE_THAN] = ">"};
    return RELATION[relation];
}

const char *cp_injury_kind(const cp_study_risk *risk)
{
    return risk->function.has_covariance ? "bootstrap and risk function" : "bootstrap";
}
