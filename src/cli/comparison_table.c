/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/comparison_table.h"

#include "report/answer.h"

#include <math.h>
#include <string.h>

#define TEXT_SIZE 64

/* One quantity of a comparison: a number, perhaps one-sided, perhaps with an interval. */
typedef struct quantity {
    const char *name;  /* of the CSV */
    const char *label; /* of the table; NULL: not there */
    int scope;         /* CP_SCOPE_..., -1: none */
    int digits;        /* of the table, after the point */
    const char *kind;  /* of the interval; NULL: none */
    cp_interval interval;
    cp_estimate estimate;
} quantity;

static cp_estimate exactly(double value)
{
    return (cp_estimate){isnan(value) ? CP_NO_VALUE : CP_EXACTLY, value};
}

static cp_estimate counted(size_t value)
{
    return exactly((double)value);
}

enum {
    VARIANT_QUANTITIES = 12 + CP_SCOPE_COUNT * 10,
    CONTRAST_QUANTITIES = 4 + CP_SCOPE_COUNT * 8
};

// Append rows to q from place n on, all of one scope; the place behind them.
static size_t append(quantity *q, size_t n, const quantity *rows, size_t count, int scope)
{
    for (size_t k = 0; k < count; k++) {
        q[n] = rows[k];
        q[n++].scope = scope;
    }
    return n;
}

static size_t rate_quantities(const cp_variant_figures *v, quantity *q, size_t n)
{
    double share = v->frontal_vehicles ? (double)v->inside / (double)v->frontal_vehicles : NAN;
    const quantity rows[] = {
        {.name = "replications", .label = "replications", .estimate = counted(v->replications)},
        {.name = "vehicle_km",
         .label = "vehicle-km",
         .digits = 1,
         .estimate = exactly(v->vehicle_km)},
        {.name = "vehicle_h", .label = "vehicle-h", .digits = 1, .estimate = exactly(v->vehicle_h)},
        {.name = "crashes", .label = "crashes", .estimate = counted(v->crashes)},
        {.name = "frontal_crashes",
         .label = "frontal crashes",
         .estimate = counted(v->frontal_crashes)},
        {.name = "front_front_inside",
         .label = "  front-front inside validity",
         .estimate = counted(v->front_front_inside)},
        {.name = "frontal_crashes_per_million_km",
         .label = "frontal crashes per 10^6 veh-km",
         .estimate = exactly(v->rate),
         .kind = "poisson",
         .interval = v->rate_garwood},
        {.name = "frontal_crashes_per_million_km",
         .estimate = exactly(v->rate),
         .kind = "bootstrap",
         .interval = v->rate_bootstrap},
        {.name = "dispersion",
         .label = "  dispersion over replications",
         .digits = 2,
         .estimate = exactly(v->dispersion_1)},
        {.name = "frontal_vehicles",
         .label = "vehicles struck on the front",
         .estimate = counted(v->frontal_vehicles)},
        {.name = "simulation_failed",
         .label = "  crash simulation failed",
         .estimate = counted(v->simulation_failed)},
        {.name = "share_inside_validity",
         .label = "  share inside validity",
         .digits = 2,
         .estimate = exactly(share)},
    };
    return append(q, n, rows, sizeof rows / sizeof *rows, -1);
}

static size_t olc_quantities(const cp_description *d, int scope, quantity *q, size_t n)
{
    const quantity rows[] = {
        {.name = "n", .label = "  n", .estimate = counted(d->count)},
        {.name = "censored", .label = "  left-censored", .estimate = counted(d->censored)},
        {.name = "olc_mean_g", .label = "  mean", .digits = 1, .estimate = exactly(d->mean)},
        {.name = "olc_sd_g", .label = "  sd", .digits = 1, .estimate = exactly(d->sd)},
        {.name = "olc_min_g", .label = "  min", .digits = 1, .estimate = d->minimum},
        {.name = "olc_q25_g", .label = "  25 %", .digits = 1, .estimate = d->q25},
        {.name = "olc_median_g", .label = "  median", .digits = 1, .estimate = d->median},
        {.name = "olc_q75_g", .label = "  75 %", .digits = 1, .estimate = d->q75},
        {.name = "olc_p90_g", .label = "  90 %", .digits = 1, .estimate = d->p90},
        {.name = "olc_max_g", .label = "  max", .digits = 1, .estimate = d->maximum},
    };
    return append(q, n, rows, sizeof rows / sizeof *rows, scope);
}

static size_t variant_quantities(const cp_variant_figures *v, quantity q[VARIANT_QUANTITIES])
{
    size_t n = rate_quantities(v, q, 0);
    for (int scope = 0; scope < CP_SCOPE_COUNT; scope++)
        n = olc_quantities(&v->olc_g[scope], scope, q, n);
    return n;
}

static size_t rate_contrast_quantities(const cp_contrast_figures *c, quantity *q, size_t n)
{
    const quantity rows[] = {
        {.name = "rate_ratio",
         .label = "rate ratio of frontal crashes",
         .digits = 2,
         .estimate = exactly(c->rate_ratio),
         .kind = "poisson",
         .interval = c->rate_ratio_poisson},
        {.name = "rate_ratio",
         .estimate = exactly(c->rate_ratio),
         .digits = 2,
         .kind = "bootstrap",
         .interval = c->rate_ratio_bootstrap},
        {.name = "rate_p", .label = "  p", .digits = 4, .estimate = exactly(c->rate_p)},
        {.name = "rate_p_holm",
         .label = "  p, Holm",
         .digits = 4,
         .estimate = exactly(c->rate_p_holm)},
    };
    return append(q, n, rows, sizeof rows / sizeof *rows, -1);
}

static size_t olc_contrast_quantities(const cp_contrast_figures *c, int scope, quantity *q,
                                      size_t n)
{
    const cp_contrast *o = &c->olc_g[scope];
    const quantity rows[] = {
        {.name = "olc_median_difference_g",
         .label = "  difference of medians",
         .digits = 1,
         .estimate = o->median_difference,
         .kind = "bootstrap",
         .interval = o->median_interval},
        {.name = "olc_mean_difference_g",
         .label = "  difference of means",
         .digits = 1,
         .estimate = o->mean_difference,
         .kind = "bootstrap",
         .interval = o->mean_interval},
        {.name = "olc_p90_difference_g",
         .label = "  difference of 90 % quantiles",
         .digits = 1,
         .estimate = o->p90_difference,
         .kind = "bootstrap",
         .interval = o->p90_interval},
        {.name = "olc_cliffs_delta",
         .label = "  Cliff's delta",
         .digits = 2,
         .estimate = exactly(o->cliffs_delta),
         .kind = "bootstrap",
         .interval = o->cliffs_delta_interval},
        {.name = "olc_mann_whitney_p",
         .label = "  p (Mann-Whitney)",
         .digits = 4,
         .estimate = exactly(o->mann_whitney.p)},
        {.name = "olc_mann_whitney_p_holm",
         .label = "  p, Holm",
         .digits = 4,
         .estimate = exactly(c->olc_p_holm[scope])},
        {.name = "olc_kolmogorov_smirnov_d",
         .label = "  largest distance of ECDFs",
         .digits = 2,
         .estimate = exactly(o->kolmogorov_smirnov.statistic)},
        {.name = "olc_kolmogorov_smirnov_p",
         .label = "  p (Kolmogorov-Smirnov)",
         .digits = 4,
         .estimate = exactly(o->kolmogorov_smirnov.p)},
    };
    return append(q, n, rows, sizeof rows / sizeof *rows, scope);
}

static size_t contrast_quantities(const cp_contrast_figures *c, quantity q[CONTRAST_QUANTITIES])
{
    size_t n = rate_contrast_quantities(c, q, 0);
    for (int scope = 0; scope < CP_SCOPE_COUNT; scope++)
        n = olc_contrast_quantities(c, scope, q, n);
    return n;
}

static const char *interval_text(const quantity *q, char text[TEXT_SIZE])
{
    if (q->interval.status != CP_INTERVAL_VALUE)
        snprintf(text, TEXT_SIZE, "%s", cp_interval_status_text(q->interval.status));
    else
        snprintf(text, TEXT_SIZE, "%.*f to %.*f", q->digits, q->interval.low, q->digits,
                 q->interval.high);
    return text;
}

// Columns start with the quantity, then one a variant (or treatment).
static void begin(cp_table *table, const char *first, const cp_study_data *data,
                  const size_t *variant, size_t count)
{
    const char *column[64] = {first};
    for (size_t k = 0; k < count && k < 63; k++)
        column[k + 1] = data->variant[variant[k]].name;
    cp_table_begin(table, column, 1 + (count < 63 ? count : 63));
    table->right_from = 1;
}

static void heading(cp_table *table, const char *text)
{
    cp_table_text(table, text);
    for (size_t k = 1; k < table->column_count; k++)
        cp_table_text(table, "");
}

// One row of estimates and, where there is one, a row of intervals below it.
static void add_rows(cp_table *table, const quantity *const *of, size_t row)
{
    char text[TEXT_SIZE], label[TEXT_SIZE];
    const quantity *first = &of[0][row];
    if (first->label) {
        cp_table_text(table, first->label);
        for (size_t k = 0; k + 1 < table->column_count; k++)
            cp_table_text(table, cp_estimate_text(of[k][row].estimate, first->digits, text));
    }
    if (!first->kind)
        return;
    snprintf(label, sizeof label, "    95 %% %s",
             strcmp(first->kind, "poisson") == 0 ? "Poisson" : first->kind);
    cp_table_text(table, label);
    for (size_t k = 0; k + 1 < table->column_count; k++)
        cp_table_text(table, interval_text(&of[k][row], text));
}

static void fill(cp_table *table, const quantity *const *of, size_t rows, const char *unit)
{
    static const char *const SCOPE[] = {"over all of them", "over those inside validity"};
    char text[TEXT_SIZE];
    int scope = -1;
    for (size_t row = 0; row < rows; row++) {
        if (of[0][row].scope != scope) {
            scope = of[0][row].scope;
            snprintf(text, sizeof text, "%s %s", unit, SCOPE[scope]);
            heading(table, text);
        }
        add_rows(table, of, row);
    }
}

enum { COLUMNS_MAX = 63 };

static cp_status print_variants(const cp_study_data *data, const cp_comparison *comparison,
                                FILE *file, cp_error *error)
{
    quantity q[COLUMNS_MAX][VARIANT_QUANTITIES];
    const quantity *of[COLUMNS_MAX];
    size_t variant[COLUMNS_MAX], count = 0, rows = 0;
    for (; count < comparison->variant_count && count < COLUMNS_MAX; count++) {
        rows = variant_quantities(&comparison->variant[count], q[count]);
        of[count] = q[count];
        variant[count] = comparison->variant[count].variant;
    }
    cp_table table;
    begin(&table, "variants", data, variant, count);
    fill(&table, of, rows, "OLC, g,");
    cp_status status = cp_table_print(&table, CP_FORMAT_TABLE, file, error);
    cp_table_destroy(&table);
    return status;
}

static cp_status print_contrasts(const cp_study_data *data, const cp_comparison *comparison,
                                 FILE *file, cp_error *error)
{
    quantity q[COLUMNS_MAX][CONTRAST_QUANTITIES];
    const quantity *of[COLUMNS_MAX];
    size_t variant[COLUMNS_MAX], count = 0, rows = 0;
    for (; count < comparison->contrast_count && count < COLUMNS_MAX; count++) {
        rows = contrast_quantities(&comparison->contrast[count], q[count]);
        of[count] = q[count];
        variant[count] = comparison->contrast[count].variant;
    }
    char first[TEXT_SIZE * 2];
    snprintf(first, sizeof first, "against %.100s", data->variant[comparison->baseline].name);
    cp_table table;
    begin(&table, first, data, variant, count);
    fill(&table, of, rows, "OLC, g,");
    cp_status status = cp_table_print(&table, CP_FORMAT_TABLE, file, error);
    cp_table_destroy(&table);
    return status;
}

// A paragraph broken at spaces after at most 79 characters.
static void print_wrapped(const char *text, FILE *file)
{
    size_t column = 0;
    while (*text) {
        size_t length = strcspn(text, " "), width = 0;
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
}

cp_status cp_comparison_print_table(const cp_study_data *data, const cp_comparison *comparison,
                                    const char *answer, FILE *file, cp_error *error)
{
    fprintf(file, "Study %s, %s\n\n", data->name,
            data->paired ? "paired seeds" : "independent seeds");
    cp_status status = print_variants(data, comparison, file, error);
    if (status == CP_OK && comparison->contrast_count > 0) {
        fputc('\n', file);
        status = print_contrasts(data, comparison, file, error);
    }
    fputc('\n', file);
    print_wrapped(answer, file);
    return status;
}

static void add_csv(cp_table *table, const char *variant, const char *against, const quantity *q)
{
    static const char *const RELATION[] = {
        [CP_NO_VALUE] = "", [CP_EXACTLY] = "=", [CP_LESS_THAN] = "<", [CP_MORE_THAN] = ">"};
    bool interval = q->kind && q->interval.status == CP_INTERVAL_VALUE;
    cp_table_text(table, variant);
    cp_table_text(table, against);
    cp_table_text(table, q->scope < 0 ? "" : CP_SCOPE_TEXT[q->scope]);
    cp_table_text(table, q->name);
    cp_table_text(table, RELATION[q->estimate.relation]);
    cp_table_real(table, q->estimate.value);
    cp_table_real(table, interval ? q->interval.low : NAN);
    cp_table_real(table, interval ? q->interval.high : NAN);
    if (!q->kind)
        cp_table_null(table);
    else
        cp_table_text(table, interval ? q->kind : cp_interval_status_text(q->interval.status));
}

cp_status cp_comparison_print_csv(const cp_study_data *data, const cp_comparison *comparison,
                                  FILE *file, cp_error *error)
{
    static const char *const COLUMN[] = {"variant", "against", "scope", "quantity", "relation",
                                         "value",   "low",     "high",  "interval"};
    cp_table table;
    cp_table_begin(&table, COLUMN, sizeof COLUMN / sizeof *COLUMN);
    for (size_t k = 0; k < comparison->variant_count; k++) {
        const cp_variant_figures *v = &comparison->variant[k];
        quantity q[VARIANT_QUANTITIES];
        size_t rows = variant_quantities(v, q);
        for (size_t row = 0; row < rows; row++)
            add_csv(&table, data->variant[v->variant].name, "", &q[row]);
    }
    for (size_t k = 0; k < comparison->contrast_count; k++) {
        const cp_contrast_figures *c = &comparison->contrast[k];
        quantity q[CONTRAST_QUANTITIES];
        size_t rows = contrast_quantities(c, q);
        for (size_t row = 0; row < rows; row++)
            add_csv(&table, data->variant[c->variant].name,
                    data->variant[comparison->baseline].name, &q[row]);
    }
    cp_status status = cp_table_print(&table, CP_FORMAT_CSV, file, error);
    cp_table_destroy(&table);
    return status;
}
