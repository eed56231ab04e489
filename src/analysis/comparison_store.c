/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/comparison_store.h"

#include "analysis/quantity.h"
#include "core/array.h"
#include "store/comparison_rows.h"

#include <math.h>
#include <stdlib.h>

/* Rows that borrow from lists which live as long. */
typedef struct stored {
    cp_comparison_figure_row *row;
    size_t count;
    size_t room;
} stored;

static cp_status append(stored *s, const char *group, const char *variant, const char *against,
                        const cp_quantities *list, cp_error *error)
{
    if (list->failed)
        return cp_fail_memory(error, "the figures of a comparison");
    cp_status status = cp_array_reserve(s->row, s->room, s->count + list->count,
                                        "the figures of a comparison", error);
    if (status != CP_OK)
        return status;
    for (size_t k = 0; k < list->count; k++) {
        const cp_quantity *q = &list->row[k];
        bool interval = q->kind && q->interval.status == CP_INTERVAL_VALUE;
        const char *kind = NULL;
        if (q->missing)
            kind = q->missing;
        if (q->kind)
            kind = interval ? q->kind : cp_interval_status_text(q->interval.status);
        s->row[s->count++] = (cp_comparison_figure_row){
            .by_value = group,
            .variant = variant,
            .against = against,
            .scope = q->scope < 0 ? "" : CP_SCOPE_TEXT[q->scope],
            .quantity = q->name,
            .relation = cp_relation_text(q->estimate.relation),
            .value = q->estimate.value,
            .low = interval ? q->interval.low : NAN,
            .high = interval ? q->interval.high : NAN,
            .interval = kind,
        };
    }
    return CP_OK;
}

cp_status cp_comparison_store(cp_store *store, const cp_study_data *data,
                              const cp_comparison *comparison, const char *const *group,
                              size_t group_count, const cp_comparison_options *options,
                              const char *scenario, const char *by, const char *where_sql,
                              const char *answer, cp_error *error)
{
    // One list for every figure list, kept until the rows that borrow from them are written.
    size_t most = 0, used = 0;
    for (size_t g = 0; g < group_count; g++)
        most += comparison[g].variant_count + comparison[g].contrast_count +
                comparison[g].counterfactual_count;
    cp_quantities *list = calloc(most + 1, sizeof *list);
    stored s = {0};
    cp_status status = list ? CP_OK : cp_fail_memory(error, "the figures of a comparison");
    for (size_t g = 0; g < group_count && status == CP_OK; g++) {
        const cp_comparison *c = &comparison[g];
        const char *baseline = data->variant[c->baseline].name;
        for (size_t k = 0; k < c->variant_count && status == CP_OK; k++, used++) {
            cp_quantities_of_variant(data, &c->variant[k], &list[used]);
            status = append(&s, group[g], data->variant[c->variant[k].variant].name, "",
                            &list[used], error);
        }
        for (size_t k = 0; k < c->contrast_count && status == CP_OK; k++, used++) {
            cp_quantities_of_contrast(data, &c->contrast[k], &list[used]);
            status = append(&s, group[g], data->variant[c->contrast[k].variant].name, baseline,
                            &list[used], error);
        }
        for (size_t k = 0; k < c->counterfactual_count && status == CP_OK; k++, used++) {
            cp_quantities_of_pairs(data, &c->counterfactual[k], &list[used]);
            status = append(&s, group[g], data->variant[c->counterfactual[k].variant].name,
                            baseline, &list[used], error);
        }
    }
    if (status == CP_OK && group_count > 0) {
        const char *design = json_string_value(
            json_object_get(json_array_get(json_object_get(data->about, "study"), 0), "design"));
        cp_comparison_rows rows = {
            .baseline = data->variant[comparison[0].baseline].name,
            .scenario = scenario,
            .by = by,
            .where_sql = where_sql,
            .design = design ? design : "",
            .seed = data->seed,
            .repetitions = options->repetitions,
            .permutations = options->permutations,
            .replications = data->replication_count,
            .crashes = data->crash_count,
            .answer = answer,
            .figure = s.row,
            .figure_count = s.count,
        };
        status = cp_comparison_rows_replace(store, &rows, error);
    }
    for (size_t k = 0; list && k <= most; k++)
        cp_quantities_destroy(&list[k]);
    free(list);
    free(s.row);
    return status;
}
