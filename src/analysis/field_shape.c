/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/field_shape.h"

#include <gsl/gsl_sort.h>

#include <math.h>
#include <stdlib.h>

// Shares of the classes of one margin, unweighted and weighted, of vehicles where they are known.
static void fill_classes(const cp_field_source *s, const cp_field_units *u, const double *weight,
                         int margin, cp_field_shape *shape)
{
    size_t classes = CP_FIELD_MARGIN_CLASSES[margin];
    double count = 0.0, weighted = 0.0, of[CP_FIELD_CLASSES_MAX] = {0.0};
    cp_field_class *class = shape->of[margin];
    for (size_t k = 0; k < u->count; k++) {
        unsigned char own = cp_field_study_class(s->data, s->request->study, u->vehicle[k],
                                                 (cp_field_margin)margin);
        if (own == CP_FIELD_UNKNOWN)
            continue;
        class[own].vehicles++;
        of[own] += weight ? weight[k] : 0.0;
        count++;
        weighted += weight ? weight[k] : 0.0;
    }
    for (size_t c = 0; c < classes; c++) {
        const cp_field_share *field = &s->margins->share[margin][c];
        class[c].field_1 = field->share_1;
        class[c].field_se_1 = field->se_1;
        class[c].study_1 = count > 0.0 ? (double)class[c].vehicles / count : NAN;
        class[c].weighted_1 = weighted > 0.0 ? of[c] / weighted : NAN;
    }
}

static void compare_types(cp_field_shape *shape)
{
    for (size_t k = 0; k < CP_FIELD_MARGIN_CLASSES[CP_FIELD_TYPE]; k++) {
        const cp_field_class *c = &shape->of[CP_FIELD_TYPE][k];
        shape->type_distance_1[0] += 0.5 * fabs(c->study_1 - c->field_1);
        shape->type_distance_1[1] += 0.5 * fabs(c->weighted_1 - c->field_1);
    }
}

/* Values with weights, in order. */
typedef struct ordered {
    size_t count;
    double *value;
    double *weight;
    double *ones;
} ordered;

static void ordered_destroy(ordered *o)
{
    free(o->value);
    free(o->weight);
    free(o->ones);
}

// Those of count values that are known; place(k) of a value and its weight: index[k], or k.
static cp_status order(const double *value, const size_t *index, const double *weight, size_t count,
                       ordered *o, cp_error *error)
{
    *o = (ordered){0, calloc(count + 1, sizeof(double)), calloc(count + 1, sizeof(double)),
                   calloc(count + 1, sizeof(double))};
    if (!o->value || !o->weight || !o->ones)
        return cp_fail_memory(error, "values beside the field's");
    for (size_t k = 0; k < count; k++) {
        double own = value[index ? index[k] : k];
        if (isnan(own))
            continue;
        o->ones[o->count] = 1.0;
        o->value[o->count] = own;
        o->weight[o->count++] = weight ? weight[k] : 0.0;
    }
    gsl_sort2(o->value, 1, o->weight, 1, o->count);
    return CP_OK;
}

static cp_status compare_number(const cp_field_source *s, const cp_field_units *u,
                                const double *weight, int v, cp_field_number *number,
                                cp_error *error)
{
    ordered field = {0}, study = {0};
    const cp_field_table *table = s->request->table;
    cp_status status = order(table->value[v], NULL, table->weight, table->count, &field, error);
    if (status == CP_OK)
        status = order(s->request->study->value[v], u->vehicle, weight, u->count, &study, error);
    if (status == CP_OK) {
        number->known = study.count;
        number->median[0] = cp_weighted_quantile(field.value, field.weight, NULL, field.count, 0.5);
        number->median[1] = cp_weighted_quantile(study.value, study.ones, NULL, study.count, 0.5);
        number->median[2] = cp_weighted_quantile(study.value, study.weight, NULL, study.count, 0.5);
        number->distance[0] = cp_weighted_distance_of(study.value, study.ones, study.count,
                                                      field.value, field.weight, field.count);
        number->distance[1] = cp_weighted_distance_of(study.value, study.weight, study.count,
                                                      field.value, field.weight, field.count);
    }
    ordered_destroy(&field);
    ordered_destroy(&study);
    return status;
}

/* Of all margins' classes. */
enum {
#define CLASSES_TIMES(name, text, classes, ordered) classes *
    COMBINATIONS = CP_FIELD_MARGINS(CLASSES_TIMES) 1
#undef CLASSES_TIMES
};

// Place of a combination of classes; SIZE_MAX where one of them is not known.
static size_t combination(const unsigned char class[CP_FIELD_MARGIN_COUNT])
{
    size_t place = 0;
    for (int m = 0; m < CP_FIELD_MARGIN_COUNT; m++) {
        if (class[m] == CP_FIELD_UNKNOWN)
            return SIZE_MAX;
        place = place * CP_FIELD_MARGIN_CLASSES[m] + class[m];
    }
    return place;
}

// What either has of combinations that the other has none of.
static void compare_combinations(const cp_field_source *s, const cp_field_units *u,
                                 cp_field_shape *shape)
{
    double field[COMBINATIONS] = {0.0}, study[COMBINATIONS] = {0.0};
    double field_sum = 0.0, study_sum = 0.0;
    const cp_field_table *t = s->request->table;
    for (size_t k = 0; k < t->count; k++) {
        unsigned char own[CP_FIELD_MARGIN_COUNT];
        for (int m = 0; m < CP_FIELD_MARGIN_COUNT; m++)
            own[m] = cp_field_table_class(t, k, (cp_field_margin)m);
        size_t at = combination(own);
        field_sum += at != SIZE_MAX ? t->weight[k] : 0.0;
        if (at != SIZE_MAX)
            field[at] += t->weight[k];
    }
    for (size_t k = 0; k < u->count; k++) {
        unsigned char own[CP_FIELD_MARGIN_COUNT];
        for (int m = 0; m < CP_FIELD_MARGIN_COUNT; m++)
            own[m] =
                cp_field_study_class(s->data, s->request->study, u->vehicle[k], (cp_field_margin)m);
        size_t at = combination(own);
        study_sum += at != SIZE_MAX;
        if (at != SIZE_MAX)
            study[at]++;
    }
    for (size_t c = 0; c < COMBINATIONS; c++) {
        shape->never_made_1 += study[c] > 0.0 ? 0.0 : field[c] / field_sum;
        shape->never_seen_1 += field[c] > 0.0 || study_sum <= 0.0 ? 0.0 : study[c] / study_sum;
    }
    if (!(field_sum > 0.0) || !(study_sum > 0.0))
        shape->never_made_1 = shape->never_seen_1 = NAN;
}

cp_status cp_field_shape_of(const cp_field_source *source, const cp_field_units *units,
                            const double *weight, cp_field_shape *shape, cp_error *error)
{
    *shape = (cp_field_shape){.vehicles = units->count};
    for (int m = 0; m < CP_FIELD_MARGIN_COUNT; m++)
        fill_classes(source, units, weight, m, shape);
    compare_types(shape);
    compare_combinations(source, units, shape);
    shape->effective = weight ? cp_weighted_effective(weight, units->count) : NAN;
    for (size_t k = 0; weight && k < units->count; k++)
        shape->largest_weight = fmax(shape->largest_weight, weight[k]);
    for (size_t k = 0; weight && k < units->count; k++)
        shape->capped += shape->largest_weight >= source->request->cap &&
                         weight[k] >= shape->largest_weight * (1.0 - 1e-12);
    cp_status status = CP_OK;
    for (int v = 0; v < CP_FIELD_VALUE_COUNT && status == CP_OK; v++)
        status = compare_number(source, units, weight, v, &shape->number[v], error);
    return status;
}
