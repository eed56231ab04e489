/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/plot_data.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The headline over the value of a swept parameter: a panel a parameter, a line for everything else
 * that is swept. */

/* One point: which line it belongs to is its label. */
typedef struct dose_point {
    char label[CP_PLOT_TITLE_SIZE];
    double x;
    cp_plot_headline headline;
} dose_point;

/* What a panel is made from. of: the comparison of each scenario, or of all together at [0]. */
typedef struct panel {
    cp_plot *p;
    const char *parameter;
    const char *owner; /* "variant", "scenario" */
    const cp_comparison *of;
    bool by_scenario;
    dose_point *point;
    size_t count;
} panel;

static const char *text_of(const json_t *entry, const char *key)
{
    const char *text = json_string_value(json_object_get(entry, key));
    return text ? text : "";
}

static const json_t *sweep_of(const cp_plot *p)
{
    return json_object_get(p->data->about, "sweep");
}

// The last word of a key path.
static const char *short_name(const char *parameter)
{
    const char *dot = strrchr(parameter, '.');
    return dot ? dot + 1 : parameter;
}

// Value of a parameter that a scenario or variant has by the sweep; NAN when it has none.
static double value_of(const cp_plot *p, const char *name, const char *parameter)
{
    size_t k;
    json_t *entry;
    json_array_foreach((json_t *)sweep_of(p), k, entry)
    {
        if (strcmp(text_of(entry, "name"), name) == 0 &&
            strcmp(text_of(entry, "parameter"), parameter) == 0)
            return json_number_value(json_object_get(entry, "value"));
    }
    return NAN;
}

// A name without the parameter: as in the study file, with what else is swept of it.
static void write_rest(const cp_plot *p, const char *name, const char *parameter, FILE *out)
{
    size_t k;
    json_t *entry;
    bool any = false;
    json_array_foreach((json_t *)sweep_of(p), k, entry)
    {
        if (strcmp(text_of(entry, "name"), name) != 0)
            continue;
        if (!any)
            fputs(text_of(entry, "base"), out);
        any = true;
        if (strcmp(text_of(entry, "parameter"), parameter) != 0)
            fprintf(out, ", %s %g", short_name(text_of(entry, "parameter")),
                    json_number_value(json_object_get(entry, "value")));
    }
    if (!any)
        fputs(name, out);
}

static void add_point(panel *a, size_t scenario, size_t variant)
{
    const cp_study_data *data = a->p->data;
    const char *scenario_name = data->scenario[scenario].name, *name = data->variant[variant].name;
    bool of_variant = strcmp(a->owner, "variant") == 0;
    double x = value_of(a->p, of_variant ? name : scenario_name, a->parameter);
    cp_plot_headline headline = cp_plot_headline_of(&a->of[scenario], variant);
    dose_point *point = &a->point[a->count];
    if (isnan(x) || isnan(headline.value))
        return;
    *point = (dose_point){.x = x, .headline = headline};
    FILE *out = fmemopen(point->label, sizeof point->label, "w");
    if (!out)
        return;
    write_rest(a->p, name, a->parameter, out);
    if (a->by_scenario) {
        fputs("; ", out);
        write_rest(a->p, scenario_name, a->parameter, out);
    }
    fclose(out);
    point->label[sizeof point->label - 1] = '\0';
    a->count++;
}

static int by_line_and_value(const void *one, const void *other)
{
    const dose_point *a = one, *b = other;
    int order = strcmp(a->label, b->label);
    return order != 0 ? order : (a->x > b->x) - (a->x < b->x);
}

static void put_point(cp_plot *p, const dose_point *point)
{
    const cp_interval *i = &point->headline.interval;
    if (i->status == CP_INTERVAL_VALUE && isfinite(i->high))
        fprintf(p->out, "%.6g\t%.6g\t%.6g\t%.6g\n", point->x, point->headline.value, i->low,
                i->high);
    else
        fprintf(p->out, "%.6g\t%.6g\tNaN\tNaN\n", point->x, point->headline.value);
    p->drawn++;
}

static void put_panel(panel *a)
{
    cp_plot *p = a->p;
    size_t line = 0;
    double from = INFINITY, to = -INFINITY;
    qsort(a->point, a->count, sizeof *a->point, by_line_and_value);
    for (size_t k = 0; k < a->count; k++) {
        from = fmin(from, a->point[k].x);
        to = fmax(to, a->point[k].x);
    }
    if (a->count > 0) {
        cp_plot_begin_panel(p);
        fprintf(p->boxes, "%.6g %.6g 0 0 ", from, to);
    }
    for (size_t k = 0; k < a->count; k++) {
        if (k == 0 || strcmp(a->point[k].label, a->point[k - 1].label) != 0) {
            char title[2 * CP_PLOT_TITLE_SIZE];
            snprintf(title, sizeof title, "%s over %.200s", a->point[k].label,
                     short_name(a->parameter));
            cp_plot_begin_block(p, ++line, title);
        }
        put_point(p, &a->point[k]);
    }
}

static bool sweeps_scenarios(const cp_plot *p)
{
    size_t k;
    json_t *entry;
    json_array_foreach((json_t *)sweep_of(p), k, entry)
    {
        if (strcmp(text_of(entry, "owner"), "scenario") == 0)
            return true;
    }
    return false;
}

// A panel for every parameter, in the order of the list, which is by parameter.
static void put_panels(cp_plot *p, const cp_comparison *of, bool by_scenario,
                       const size_t *treatment, size_t treatments, dose_point *room)
{
    const char *last = "";
    size_t k;
    json_t *entry;
    json_array_foreach((json_t *)sweep_of(p), k, entry)
    {
        panel a = {.p = p,
                   .parameter = text_of(entry, "parameter"),
                   .owner = text_of(entry, "owner"),
                   .of = of,
                   .by_scenario = by_scenario,
                   .point = room};
        if (strcmp(a.parameter, last) == 0)
            continue;
        last = a.parameter;
        for (size_t s = 0; s < (by_scenario ? p->data->scenario_count : 1); s++)
            for (size_t v = 0; v < treatments; v++)
                add_point(&a, s, treatment[v]);
        put_panel(&a);
    }
}

cp_status cp_plot_dose(cp_plot *p, cp_error *error)
{
    const cp_study_data *data = p->data;
    if (json_array_size(sweep_of(p)) == 0)
        return cp_fail(error, CP_BAD_INPUT, "dose is of studies with a sweep only");
    // Of a sweep over scenarios each is looked at by itself, else all of them together.
    bool by_scenario = p->comparison->slice.scenario == CP_SLICE_ALL && sweeps_scenarios(p);
    size_t points = data->scenario_count * data->variant_count + 1;
    cp_comparison *of = calloc(data->scenario_count + 1, sizeof *of);
    size_t *treatment = calloc(data->variant_count + 1, sizeof *treatment);
    dose_point *room = calloc(points, sizeof *room);
    cp_status status = of && treatment && room ? CP_OK : cp_fail_memory(error, "a figure");
    for (size_t s = 0; s < data->scenario_count && by_scenario && status == CP_OK; s++)
        status = cp_plot_compare_scenario(p, s, &of[s], error);
    if (status == CP_OK) {
        size_t treatments = cp_plot_treatments(p->comparison, treatment);
        put_panels(p, by_scenario ? of : p->comparison, by_scenario, treatment, treatments, room);
    }
    for (size_t s = 0; of && s < data->scenario_count; s++)
        cp_comparison_destroy(&of[s]);
    free(of);
    free(treatment);
    free(room);
    return status;
}
