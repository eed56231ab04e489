/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/field_output.h"

#include "cli/output.h"

#include <math.h>
#include <string.h>

enum { TEXT_SIZE = 96 };

static void number(cp_table *table, double value, double factor, int digits)
{
    char text[TEXT_SIZE];
    if (isnan(value))
        snprintf(text, sizeof text, "n/a");
    else
        snprintf(text, sizeof text, "%.*f", digits, factor * value);
    cp_table_text(table, text);
}

static void add_classes(cp_table *table, const cp_field_shape *s, int margin)
{
    static const char *const HEADING[CP_FIELD_MARGIN_COUNT] = {
        "crash type, %", "delta-v without rebound, %", "overlap, %"};
    char text[TEXT_SIZE];
    cp_table_text(table, HEADING[margin]);
    for (int c = 0; c < 4; c++)
        cp_table_text(table, "");
    for (size_t k = 0; k < CP_FIELD_MARGIN_CLASSES[margin]; k++) {
        const cp_field_class *c = &s->of[margin][k];
        snprintf(text, sizeof text, "  %s", cp_field_class_text((cp_field_margin)margin, k));
        cp_table_text(table, text);
        number(table, c->field_1, 100.0, 1);
        number(table, c->field_se_1, 100.0, 1);
        number(table, c->study_1, 100.0, 1);
        number(table, c->weighted_1, 100.0, 1);
    }
}

static void add_numbers(cp_table *table, const cp_field_shape *s)
{
    static const struct {
        const char *text;
        int digits;
    } OF[CP_FIELD_VALUE_COUNT] = {
        {"delta-v without rebound, km/h", 1}, {"direction of force, degrees", 1}, {"overlap", 2}};
    char text[TEXT_SIZE];
    for (int v = 0; v < CP_FIELD_VALUE_COUNT; v++) {
        const cp_field_number *n = &s->number[v];
        snprintf(text, sizeof text, "%s, median", OF[v].text);
        cp_table_text(table, text);
        number(table, n->median[0], 1.0, OF[v].digits);
        cp_table_text(table, "");
        number(table, n->median[1], 1.0, OF[v].digits);
        number(table, n->median[2], 1.0, OF[v].digits);
        cp_table_text(table, "  mean distance");
        cp_table_text(table, "");
        cp_table_text(table, "");
        number(table, n->distance[0].mean, 1.0, OF[v].digits);
        number(table, n->distance[1].mean, 1.0, OF[v].digits);
        cp_table_text(table, "  largest distance of ECDFs");
        cp_table_text(table, "");
        cp_table_text(table, "");
        number(table, n->distance[0].largest_1, 1.0, 2);
        number(table, n->distance[1].largest_1, 1.0, 2);
    }
    cp_table_text(table, "crash type, distance of shares");
    cp_table_text(table, "");
    cp_table_text(table, "");
    number(table, s->type_distance_1[0], 1.0, 2);
    number(table, s->type_distance_1[1], 1.0, 2);
}

cp_status cp_field_print_table(const cp_comparison *comparison, FILE *file, cp_error *error)
{
    static const char *const COLUMN[] = {"baseline beside the field", "field", "se", "study",
                                         "weighted"};
    const cp_variant_figures *baseline = cp_comparison_variant(comparison, comparison->baseline);
    const cp_field_variant *field = baseline ? baseline->field : NULL;
    if (!field)
        return CP_OK;
    cp_table table;
    cp_table_begin(&table, COLUMN, sizeof COLUMN / sizeof *COLUMN);
    table.right_from = 1;
    for (int m = 0; m < CP_FIELD_MARGIN_COUNT; m++)
        add_classes(&table, &field->shape, m);
    add_numbers(&table, &field->shape);
    fputc('\n', file);
    cp_status status = cp_table_print(&table, CP_FORMAT_TABLE, file, error);
    cp_table_destroy(&table);
    return status;
}
