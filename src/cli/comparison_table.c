/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/comparison_table.h"

#include "analysis/quantity.h"
#include "core/memory.h"
#include "core/safe_text.h"
#include "report/answer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TEXT_SIZE 128

/* One list of quantities a column, all of the same names. */
typedef struct columns {
    size_t count;
    cp_quantities *list;
    const char **name; /* [0] heads the quantities */
} columns;

static void columns_destroy(columns *c)
{
    for (size_t k = 0; c->list && k < c->count; k++)
        cp_quantities_destroy(&c->list[k]);
    free(c->list);
    free(c->name);
}

static cp_status columns_create(const char *first, size_t count, columns *c, cp_error *error)
{
    *c = (columns){.count = count};
    c->list = calloc(count + 1, sizeof *c->list);
    c->name = calloc(count + 1, sizeof *c->name);
    if (!c->list || !c->name) {
        columns_destroy(c);
        return cp_fail_memory(error, "a table");
    }
    c->name[0] = first;
    return CP_OK;
}

static const char *interval_text(const cp_quantity *q, char text[TEXT_SIZE])
{
    if (q->interval.status != CP_INTERVAL_VALUE) {
        snprintf(text, TEXT_SIZE, "%s", cp_interval_status_text(q->interval.status));
    } else {
        // A number that rounds to zero has no sign.
        double unit = pow(10.0, -q->digits);
        double low = q->factor * q->interval.low, high = q->factor * q->interval.high;
        low = fabs(low) < 0.5 * unit ? 0.0 : low;
        high = fabs(high) < 0.5 * unit ? 0.0 : high;
        snprintf(text, TEXT_SIZE, "%.*f to %.*f", q->digits, low, q->digits, high);
    }
    return text;
}

static bool is_p_value(const cp_quantity *q)
{
    size_t length = strlen(q->name);
    return (length > 2 && strcmp(q->name + length - 2, "_p") == 0) ||
           (length > 7 && strcmp(q->name + length - 7, "_p_holm") == 0);
}

// A p-value that its digits would round to zero is below the least that they can show.
static const char *value_text(const cp_quantity *q, cp_estimate estimate, int digits,
                              char text[TEXT_SIZE])
{
    double least = pow(10.0, -digits);
    if (!is_p_value(q) || !(estimate.value < 0.5 * least))
        return cp_estimate_text(estimate, digits, text);
    snprintf(text, TEXT_SIZE, "<%.*f", digits, least);
    return text;
}

// One row of estimates and, where there is one, a row of intervals below it.
static void add_rows(cp_table *table, const columns *c, size_t row)
{
    char text[TEXT_SIZE], label[TEXT_SIZE];
    const cp_quantity *first = &c->list[0].row[row];
    if (!first->label[0] && !first->second)
        return;
    if (first->label[0]) {
        cp_table_text(table, first->label);
        for (size_t k = 0; k < c->count; k++) {
            const cp_quantity *q = &c->list[k].row[row];
            cp_estimate estimate = q->estimate;
            estimate.value *= first->factor;
            cp_table_text(table,
                          q->missing ? q->missing : value_text(q, estimate, first->digits, text));
        }
    }
    if (!first->kind)
        return;
    // Columns may have intervals of unlike kinds; then the row names none.
    bool alike = true;
    for (size_t k = 1; k < c->count; k++)
        alike &= strcmp(c->list[k].row[row].kind, first->kind) == 0;
    bool poisson = strncmp(first->kind, "poisson", 7) == 0;
    snprintf(label, sizeof label, "    95 %% %s%s", poisson ? "Poisson" : first->kind,
             poisson && alike ? first->kind + 7 : "");
    cp_table_text(table, label);
    for (size_t k = 0; k < c->count; k++)
        cp_table_text(table, interval_text(&c->list[k].row[row], text));
}

static void heading(cp_table *table, const char *section, int scope)
{
    static const char *const SCOPE[] = {", over all of them", ", over those inside validity"};
    char text[TEXT_SIZE];
    snprintf(text, sizeof text, "%s%s", section, scope < 0 ? "" : SCOPE[scope]);
    cp_table_text(table, text);
    for (size_t k = 1; k < table->column_count; k++)
        cp_table_text(table, "");
}

static cp_status print_columns(const columns *c, FILE *file, cp_error *error)
{
    for (size_t k = 0; k < c->count; k++)
        if (c->list[k].failed)
            return cp_fail_memory(error, "a table");
    cp_table table;
    cp_table_begin(&table, c->name, c->count + 1);
    table.right_from = 1;
    const char *section = NULL;
    int scope = -1;
    for (size_t row = 0; row < c->list[0].count; row++) {
        const cp_quantity *q = &c->list[0].row[row];
        if (q->section && q->label[0] &&
            (!section || strcmp(section, q->section) != 0 || scope != q->scope)) {
            section = q->section;
            scope = q->scope;
            heading(&table, section, scope);
        }
        add_rows(&table, c, row);
    }
    cp_status status = cp_table_print(&table, CP_FORMAT_TABLE, file, error);
    cp_table_destroy(&table);
    return status;
}

static cp_status print_variants(const cp_study_data *data, const cp_comparison *comparison,
                                FILE *file, cp_error *error)
{
    columns c;
    cp_status status = columns_create("variants", comparison->variant_count, &c, error);
    if (status != CP_OK)
        return status;
    for (size_t k = 0; k < c.count; k++) {
        cp_quantities_of_variant(data, &comparison->variant[k], &c.list[k]);
        c.name[k + 1] = data->variant[comparison->variant[k].variant].name;
    }
    status = print_columns(&c, file, error);
    columns_destroy(&c);
    return status;
}

// Contrasts of replications, or of counterfactual pairs.
static cp_status print_contrasts(const cp_study_data *data, const cp_comparison *comparison,
                                 bool pairs, FILE *file, cp_error *error)
{
    char first[TEXT_SIZE];
    size_t count = pairs ? comparison->counterfactual_count : comparison->contrast_count;
    if (count == 0)
        return CP_OK;
    snprintf(first, sizeof first, "against %.100s", data->variant[comparison->baseline].name);
    columns c;
    cp_status status = columns_create(first, count, &c, error);
    if (status != CP_OK)
        return status;
    for (size_t k = 0; k < count; k++) {
        if (pairs)
            cp_quantities_of_pairs(data, &comparison->counterfactual[k], &c.list[k]);
        else
            cp_quantities_of_contrast(data, &comparison->contrast[k], &c.list[k]);
        size_t variant =
            pairs ? comparison->counterfactual[k].variant : comparison->contrast[k].variant;
        c.name[k + 1] = data->variant[variant].name;
    }
    fputc('\n', file);
    status = print_columns(&c, file, error);
    columns_destroy(&c);
    return status;
}

// Paragraphs, one a line of text, broken at spaces after at most 79 characters.
static void print_wrapped(const char *raw, FILE *file)
{
    size_t column = 0, room = 4 * strlen(raw) + 1;
    char *safe = cp_memory_or_end(room, "a paragraph");
    const char *text = cp_text_for_terminal(raw, "\n", safe, room);
    while (*text) {
        if (*text == '\n') {
            fputc('\n', file);
            column = 0;
            text++;
            continue;
        }
        size_t length = strcspn(text, " \n"), width = 0;
        for (size_t k = 0; k < length; k++)
            width += ((unsigned char)text[k] & 0xc0) != 0x80;
        if (column > 0 && column + 1 + width > 79) {
            fputc('\n', file);
            column = 0;
        } else if (column > 0) {
            fputc(' ', file);
            column++;
        }
        fwrite(text, 1, length, file);
        column += width;
        text += length;
        text += strspn(text, " ");
    }
    fputc('\n', file);
    free(safe);
}

void cp_comparison_print_paragraph(const char *text, FILE *file)
{
    fputc('\n', file);
    print_wrapped(text, file);
}

cp_status cp_comparison_print_table(const cp_study_data *data, const cp_comparison *comparison,
                                    const char *heading_text, const char *answer, FILE *file,
                                    cp_error *error)
{
    if (heading_text) {
        cp_text_print(file, heading_text, "");
        fputs("\n\n", file);
    }
    cp_status status = print_variants(data, comparison, file, error);
    if (status == CP_OK)
        status = print_contrasts(data, comparison, false, file, error);
    if (status == CP_OK)
        status = print_contrasts(data, comparison, true, file, error);
    fputc('\n', file);
    if (answer)
        print_wrapped(answer, file);
    return status;
}

static void add_csv(cp_table *table, const char *group, const char *variant, const char *against,
                    const cp_quantities *list)
{
    for (size_t k = 0; k < list->count; k++) {
        const cp_quantity *q = &list->row[k];
        bool interval = q->kind && q->interval.status == CP_INTERVAL_VALUE;
        if (group)
            cp_table_text(table, group);
        cp_table_text(table, variant);
        cp_table_text(table, against);
        cp_table_text(table, q->scope < 0 ? "" : CP_SCOPE_TEXT[q->scope]);
        cp_table_text(table, q->name);
        cp_table_text(table, cp_relation_text(q->estimate.relation));
        cp_table_real(table, q->estimate.value);
        cp_table_real(table, interval ? q->interval.low : NAN);
        cp_table_real(table, interval ? q->interval.high : NAN);
        if (q->missing)
            cp_table_text(table, q->missing);
        else if (!q->kind)
            cp_table_null(table);
        else
            cp_table_text(table, interval ? q->kind : cp_interval_status_text(q->interval.status));
    }
    table->failed |= list->failed;
}

static void add_group(cp_table *table, const cp_study_data *data, const cp_comparison *c,
                      const char *group)
{
    const char *baseline = data->variant[c->baseline].name;
    for (size_t k = 0; k < c->variant_count; k++) {
        cp_quantities list = {0};
        cp_quantities_of_variant(data, &c->variant[k], &list);
        add_csv(table, group, data->variant[c->variant[k].variant].name, "", &list);
        cp_quantities_destroy(&list);
    }
    for (size_t k = 0; k < c->contrast_count; k++) {
        cp_quantities list = {0};
        cp_quantities_of_contrast(data, &c->contrast[k], &list);
        add_csv(table, group, data->variant[c->contrast[k].variant].name, baseline, &list);
        cp_quantities_destroy(&list);
    }
    for (size_t k = 0; k < c->counterfactual_count; k++) {
        cp_quantities list = {0};
        cp_quantities_of_pairs(data, &c->counterfactual[k], &list);
        add_csv(table, group, data->variant[c->counterfactual[k].variant].name, baseline, &list);
        cp_quantities_destroy(&list);
    }
}

cp_status cp_comparison_print_csv(const cp_study_data *data, const cp_comparison *comparison,
                                  const char *const *group, size_t count, FILE *file,
                                  cp_error *error)
{
    static const char *const COLUMN[] = {"by_value", "variant", "against", "scope", "quantity",
                                         "relation", "value",   "low",     "high",  "interval"};
    size_t without = group ? 0 : 1;
    cp_table table;
    cp_table_begin(&table, COLUMN + without, sizeof COLUMN / sizeof *COLUMN - without);
    for (size_t k = 0; k < count; k++)
        add_group(&table, data, &comparison[k], group ? group[k] : NULL);
    cp_status status = cp_table_print(&table, CP_FORMAT_CSV, file, error);
    cp_table_destroy(&table);
    return status;
}
