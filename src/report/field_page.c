/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/field_page.h"

#include "analysis/field_table.h"

#include <math.h>

/* Above it the field has 7 vehicles in ten thousand. */
enum { KM_H_MOST = 80 };

// Share of the weight up to each whole km/h, of one crash type or of all (CP_FIELD_UNKNOWN).
static json_t *curve_of(const cp_field_table *table, unsigned char type)
{
    double weight[KM_H_MOST + 1] = {0.0}, all = 0.0, sum = 0.0;
    size_t count = 0;
    for (size_t k = 0; k < table->count; k++) {
        double value = ceil(table->value[CP_FIELD_VALUE_DELTA_V][k]);
        if (isnan(value) || (type != CP_FIELD_UNKNOWN && table->type[k] != type))
            continue;
        count++;
        all += table->weight[k];
        if (value <= KM_H_MOST)
            weight[(size_t)value] += table->weight[k];
    }
    json_t *share = json_array();
    for (size_t k = 0; k <= KM_H_MOST; k++) {
        sum += weight[k];
        json_array_append_new(share, json_real(round(1e4 * sum / all) / 1e4));
    }
    return json_pack("{s:I, s:o}", "n", (json_int_t)count, "share", share);
}

cp_status cp_field_page_add(json_t *page, cp_error *error)
{
    cp_field_table table;
    cp_status status = cp_field_table_read("nass", &table, error);
    if (status == CP_OK) {
        json_t *x = json_array(), *curves = json_object();
        for (int k = 0; k <= KM_H_MOST; k++)
            json_array_append_new(x, json_integer(k));
        json_object_set_new(curves, "all", curve_of(&table, CP_FIELD_UNKNOWN));
        for (size_t k = 0; k < CP_FIELD_MARGIN_CLASSES[CP_FIELD_TYPE]; k++)
            json_object_set_new(curves, cp_field_class_text(CP_FIELD_TYPE, k),
                                curve_of(&table, (unsigned char)k));
        json_t *field = json_pack("{s:s, s:s, s:o, s:o}", "name", table.name, "bias",
                                  table.bias ? table.bias : "", "x", x, "curves", curves);
        if (json_object_set_new(page, "field", field) != 0)
            status = cp_fail_memory(error, "the field's delta-v");
    }
    cp_field_table_destroy(&table);
    return status;
}
