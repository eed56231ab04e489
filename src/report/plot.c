/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/plot.h"

#include "core/file.h"
#include "core/memory_stream.h"
#include "core/scratch.h"
#include "core/units.h"
#include "report/gallery.h"
#include "report/slice_sample.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* What every figure is drawn from. Its data are blocks of rows, tabs between the columns, two empty
 * lines between the blocks; gnuplot reads them as data, never as a part of its script. */
typedef struct plot {
    cp_store *store;
    const cp_study_data *data;
    const cp_comparison *comparison;
    int scope;
    FILE *out;
    size_t drawn;       /* values written: 0 means nothing to show */
    size_t block_count; /* blocks begun, or rows of a figure of intervals */
    FILE *variants;     /* of each block or row, numbers with blanks between */
    FILE *bars;         /* the rows that have an interval, likewise */
} plot;

static const char NOTHING[] = "0\tNaN\tNaN\tNaN\n"; // a block needs a row

// A cell of text. gnuplot has no word for a quotation mark within one.
static void put_text(FILE *out, const char *text)
{
    fputc('"', out);
    for (; *text; text++) {
        if (*text == '\\')
            fputc('\\', out);
        unsigned char c = (unsigned char)(*text == '"' ? '\'' : *text);
        fputc(c < ' ' || c == 0x7f ? ' ' : c, out);
    }
    fputc('"', out);
}

static const char *name_of(const plot *p, size_t variant)
{
    return p->data->variant[variant].name;
}

// The next block; the colour, the point and, by the head of its second column, the title of what is
// drawn from it are the variant's.
static void begin_block(plot *p, size_t variant, const char *title)
{
    fputs(p->block_count > 0 ? "\n\n\"\"\t" : "\"\"\t", p->out);
    put_text(p->out, title);
    fputs("\t\"\"\t\"\"\n", p->out);
    fprintf(p->variants, "%zu ", variant);
    p->block_count++;
}

// ---- rows with an interval: rates, differences, benefits
// -----------------------------------------

/* One row of a figure of intervals. */
typedef struct row {
    size_t variant;
    const char *label;
    double value;
    cp_interval interval;
} row;

static bool closed(const row *r)
{
    return r->interval.status == CP_INTERVAL_VALUE && isfinite(r->interval.low) &&
           isfinite(r->interval.high);
}

static void put_row(plot *p, const row *r)
{
    if (isnan(r->value))
        return;
    char label[512];
    snprintf(label, sizeof label, "%.200s%s%.200s", name_of(p, r->variant), *r->label ? ": " : "",
             r->label);
    put_text(p->out, label);
    fprintf(p->out, "\t%.9g\t%zu", r->value, p->drawn);
    // No bar where there is no interval: none of no width is drawn.
    if (closed(r)) {
        fprintf(p->out, "\t%.9g\t%.9g\n", r->interval.low, r->interval.high);
        fprintf(p->bars, "%zu ", p->drawn);
    } else {
        fputs("\tNaN\tNaN\n", p->out);
    }
    fprintf(p->variants, "%zu ", r->variant);
    p->block_count++;
    p->drawn++;
}

static void write_rows(plot *p, const row *rows, size_t count)
{
    for (size_t k = 0; k < count; k++)
        put_row(p, &rows[k]);
}

static cp_status plot_rates(plot *p, cp_error *error)
{
    const cp_comparison *c = p->comparison;
    row *rows = calloc(c->variant_count + 1, sizeof *rows);
    if (!rows)
        return cp_fail_memory(error, "a figure");
    for (size_t k = 0; k < c->variant_count; k++) {
        const cp_variant_figures *v = &c->variant[k];
        bool bootstrap = v->rate_bootstrap.status == CP_INTERVAL_VALUE;
        rows[k] =
            (row){v->variant, bootstrap ? "" : "Poisson, widened", v->rate, cp_rate_interval(v)};
    }
    write_rows(p, rows, c->variant_count);
    free(rows);
    return CP_OK;
}

// A difference that censoring leaves open has no place on an axis.
static double known(cp_estimate estimate)
{
    return estimate.relation == CP_EXACTLY ? estimate.value : NAN;
}

static cp_status plot_difference(plot *p, cp_error *error)
{
    const cp_comparison *c = p->comparison;
    row *rows = calloc(3 * c->contrast_count + 2 * c->counterfactual_count + 1, sizeof *rows);
    if (!rows)
        return cp_fail_memory(error, "a figure");
    size_t count = 0;
    for (size_t k = 0; k < c->contrast_count; k++) {
        const cp_contrast *o = &c->contrast[k].severity[CP_QUANTITY_OLC];
        size_t v = c->contrast[k].variant;
        rows[count++] = (row){v, "median", known(o->median_difference), o->median_interval};
        rows[count++] = (row){v, "mean", known(o->mean_difference), o->mean_interval};
        rows[count++] = (row){v, "90 % quantile", known(o->p90_difference), o->p90_interval};
    }
    for (size_t k = 0; k < c->counterfactual_count; k++) {
        const cp_counterfactual_figures *f = &c->counterfactual[k];
        rows[count++] = (row){f->variant, "all pairs", f->olc_g[CP_PAIRED_ALL].hodges_lehmann,
                              f->olc_g[CP_PAIRED_ALL].hodges_lehmann_interval};
        rows[count++] = (row){f->variant, "crashing", f->olc_g[CP_PAIRED_CRASHING].hodges_lehmann,
                              f->olc_g[CP_PAIRED_CRASHING].hodges_lehmann_interval};
    }
    write_rows(p, rows, count);
    free(rows);
    return CP_OK;
}

static cp_status plot_benefit(plot *p, cp_error *error)
{
    const cp_comparison *c = p->comparison;
    size_t risks = p->data->risk_count, count = 0;
    size_t most = risks * (c->contrast_count + c->counterfactual_count);
    row *rows = calloc(most + 1, sizeof *rows);
    char(*label)[128] = calloc(most + 1, sizeof *label);
    if (!rows || !label) {
        free(rows);
        free(label);
        return cp_fail_memory(error, "a figure");
    }
    for (size_t k = 0; k < c->contrast_count + c->counterfactual_count; k++) {
        bool pairs = k >= c->contrast_count;
        const cp_counterfactual_figures *f = &c->counterfactual[pairs ? k - c->contrast_count : 0];
        for (size_t r = 0; r < risks; r++, count++) {
            const cp_benefit_figures *b = pairs ? &f->benefit[r] : &c->contrast[k].benefit[r];
            const cp_study_risk *risk = &p->data->risk[r];
            snprintf(label[count], sizeof label[count], "%.50s (%.50s)", risk->level, risk->name);
            rows[count] =
                (row){pairs ? f->variant : c->contrast[k].variant,
                      label[count],
                      100.0 * b->benefit_1,
                      {b->interval.status, 100.0 * b->interval.low, 100.0 * b->interval.high}};
        }
    }
    write_rows(p, rows, count);
    free(rows);
    free(label);
    return CP_OK;
}

// ---- curves ------------------------------------------------------------------------------------

// A point of a distribution function and its band, if there is one.
static void put_share(plot *p, double x, double share, double half_width)
{
    if (isnan(half_width))
        fprintf(p->out, "%.6g\t%.6g\tNaN\tNaN\n", x, share);
    else
        fprintf(p->out, "%.6g\t%.6g\t%.6g\t%.6g\n", x, share, fmax(0.0, share - half_width),
                fmin(1.0, share + half_width));
}

static void put_steps(plot *p, const cp_sample *sample, double half_width)
{
    double n = (double)sample->count, before = 0.0;
    size_t censored = cp_sample_censored(sample);
    // The share before each step and after it, so that lines and areas are stairs.
    before = (double)censored / n;
    put_share(p, 0.0, before, half_width);
    for (size_t k = censored; k < sample->count; k++) {
        double after = (double)(k + 1) / n, x = sample->value[k];
        put_share(p, x, before, half_width);
        put_share(p, x, after, half_width);
        before = after;
    }
    p->drawn += sample->count;
}

static cp_status plot_olc(plot *p, cp_error *error)
{
    const cp_comparison *c = p->comparison;
    for (size_t k = 0; k < c->variant_count; k++) {
        cp_replication_set set;
        cp_sample sample = {0};
        cp_status status =
            cp_replication_set_create(p->data, c->slice, c->variant[k].variant, &set, error);
        if (status == CP_OK)
            status =
                cp_slice_sample(p->data, &set, c->slice, p->scope, CP_QUANTITY_OLC, &sample, error);
        if (status == CP_OK) {
            char title[512];
            snprintf(title, sizeof title, "%.400s (n = %zu)", name_of(p, c->variant[k].variant),
                     c->variant[k].description[CP_QUANTITY_OLC][p->scope].count);
            begin_block(p, c->variant[k].variant, title);
            if (sample.count > 0)
                put_steps(p, &sample, c->variant[k].olc_band[p->scope].half_width_1);
            else
                fputs(NOTHING, p->out);
        }
        cp_sample_destroy(&sample);
        cp_replication_set_destroy(&set);
        if (status != CP_OK)
            return status;
    }
    return CP_OK;
}

// Crashes above a severity per vehicle-km over that severity, with the band of single points.
static cp_status plot_exceedance(plot *p, int what, cp_error *error)
{
    (void)error;
    const cp_comparison *c = p->comparison;
    double factor = what == CP_EXCEEDED_DELTA_V ? 3.6 : 1.0;
    for (size_t k = 0; k < c->variant_count; k++) {
        char title[512];
        snprintf(title, sizeof title, "%.400s, 95 %% at each point",
                 name_of(p, c->variant[k].variant));
        begin_block(p, c->variant[k].variant, title);
        for (size_t j = 0; j < CP_EXCEEDANCE_POINTS; j++) {
            const cp_exceedance *e = &c->variant[k].curve[what][j];
            if (isnan(e->rate)) {
                fputs(NOTHING, p->out);
                break;
            }
            fprintf(p->out, "%.6g\t%.6g\t%.6g\t%.6g\n", factor * e->x, e->rate, e->interval.low,
                    e->interval.high);
            p->drawn += e->crashes;
        }
    }
    return CP_OK;
}

static bool in_slice(const plot *p, size_t vehicle)
{
    const cp_study_vehicle *v = &p->data->vehicle[vehicle];
    cp_slice slice = p->comparison->slice;
    return v->frontal && (p->scope == CP_SCOPE_ALL || v->validity == 0) &&
           (!slice.chosen || slice.chosen[vehicle]) &&
           cp_slice_has_crash(p->data, slice, &p->data->crash[v->crash]);
}

static size_t variant_of(const plot *p, size_t vehicle)
{
    const cp_study_crash *crash = &p->data->crash[p->data->vehicle[vehicle].crash];
    return p->data->replication[crash->replication].variant;
}

static cp_status plot_corridor(plot *p, cp_error *error)
{
    cp_corridor_pulses pulses;
    unsigned char *chosen = calloc(p->data->vehicle_count + 1, sizeof *chosen);
    if (!chosen)
        return cp_fail_memory(error, "a figure");
    cp_status status = cp_corridor_read(p->store, p->data, &pulses, error);
    if (status != CP_OK) {
        free(chosen);
        return status;
    }
    const cp_comparison *c = p->comparison;
    for (size_t k = 0; k < c->variant_count; k++) {
        for (size_t j = 0; j < p->data->vehicle_count; j++)
            chosen[j] = in_slice(p, j) && variant_of(p, j) == c->variant[k].variant;
        json_t *corridor = cp_corridor_json(&pulses, chosen);
        const json_t *p10 = json_object_get(corridor, "p10"),
                     *p50 = json_object_get(corridor, "p50"),
                     *p90 = json_object_get(corridor, "p90");
        char title[512];
        snprintf(title, sizeof title, "%.400s, median, 10–90 %%",
                 name_of(p, c->variant[k].variant));
        begin_block(p, c->variant[k].variant, title);
        for (size_t t = 0; t < json_array_size(p50); t++, p->drawn++)
            fprintf(p->out, "%g\t%g\t%g\t%g\n", 1e3 * CP_CORRIDOR_INTERVAL_S * (double)t,
                    json_number_value(json_array_get(p50, t)),
                    json_number_value(json_array_get(p10, t)),
                    json_number_value(json_array_get(p90, t)));
        if (json_array_size(p50) == 0)
            fputs(NOTHING, p->out);
        json_decref(corridor);
    }
    cp_corridor_destroy(&pulses);
    free(chosen);
    return CP_OK;
}

// ---- points ------------------------------------------------------------------------------------

// Columns of a vehicle: x, y, colour (km/h). False: not drawn.
static bool coordinates(const plot *p, cp_plot_kind kind, size_t vehicle, double xyz[3])
{
    const cp_study_vehicle *v = &p->data->vehicle[vehicle];
    const cp_study_crash *crash = &p->data->crash[v->crash];
    xyz[2] = cp_km_h_from_m_s(v->closing_speed_m_s);
    if (kind == CP_PLOT_SEVERITY) {
        xyz[0] = xyz[2];
        xyz[1] = v->olc_g;
        return v->olc == CP_OLC_KNOWN;
    }
    xyz[0] = kind == CP_PLOT_MAP ? v->lateral_offset_m : crash->x_m;
    xyz[1] = kind == CP_PLOT_MAP ? cp_deg_from_rad(v->angle_rad) : crash->y_m;
    return v->role == 'a';
}

static cp_status plot_points(plot *p, cp_plot_kind kind, cp_error *error)
{
    (void)error;
    const cp_comparison *c = p->comparison;
    for (size_t k = 0; k < c->variant_count; k++) {
        begin_block(p, c->variant[k].variant, name_of(p, c->variant[k].variant));
        fputs(NOTHING, p->out);
        for (size_t j = 0; j < p->data->vehicle_count; j++) {
            double xyz[3];
            if (variant_of(p, j) != c->variant[k].variant || !in_slice(p, j) ||
                !coordinates(p, kind, j, xyz))
                continue;
            fprintf(p->out, "%.6g\t%.6g\t%.6g\n", xyz[0], xyz[1], xyz[2]);
            p->drawn++;
        }
    }
    return CP_OK;
}

// ---- counterfactual outcomes
// ---------------------------------------------------------------------

static cp_status plot_outcomes(plot *p, cp_error *error)
{
    static const cp_outcome ORDER[] = {CP_OUTCOME_AVOIDED,          CP_OUTCOME_MITIGATED,
                                       CP_OUTCOME_UNCHANGED,        CP_OUTCOME_AGGRAVATED,
                                       CP_OUTCOME_CHANGED_OPPONENT, CP_OUTCOME_INVALID};
    const cp_comparison *c = p->comparison;
    if (c->counterfactual_count == 0)
        return cp_fail(error, CP_BAD_INPUT,
                       "outcomes are of studies with the design counterfactual only");
    fputs("\"\"", p->out);
    for (size_t o = 0; o < 6; o++) {
        fputs("\t\"", p->out);
        for (const char *t = cp_outcome_text(ORDER[o]); *t; t++)
            fputc(*t == '_' ? ' ' : *t, p->out);
        fputc('"', p->out);
    }
    fputc('\n', p->out);
    for (size_t k = 0; k < c->counterfactual_count; k++) {
        put_text(p->out, name_of(p, c->counterfactual[k].variant));
        for (size_t o = 0; o < 6; o++)
            fprintf(p->out, "\t%zu", c->counterfactual[k].outcome[ORDER[o]]);
        fputc('\n', p->out);
        p->drawn += c->counterfactual[k].crashes;
    }
    return CP_OK;
}

// ---- data, script and gnuplot ------------------------------------------------------------------

static cp_status write_data(plot *p, cp_plot_kind kind, cp_error *error)
{
    switch (kind) {
    case CP_PLOT_RATES:
        return plot_rates(p, error);
    case CP_PLOT_OLC:
        return plot_olc(p, error);
    case CP_PLOT_DIFFERENCE:
        return plot_difference(p, error);
    case CP_PLOT_SEVERITY:
    case CP_PLOT_MAP:
    case CP_PLOT_SITES:
        return plot_points(p, kind, error);
    case CP_PLOT_OUTCOMES:
        return plot_outcomes(p, error);
    case CP_PLOT_BENEFIT:
        return plot_benefit(p, error);
    case CP_PLOT_CORRIDOR:
        return plot_corridor(p, error);
    case CP_PLOT_ABOVE_OLC:
        return plot_exceedance(p, CP_EXCEEDED_OLC, error);
    case CP_PLOT_ABOVE_DELTA_V:
        return plot_exceedance(p, CP_EXCEEDED_DELTA_V, error);
    case CP_PLOT_KIND_COUNT:
        break;
    }
    return cp_fail(error, CP_BAD_INPUT, "there is no such kind of plot");
}

static cp_status write_streams(plot *p, cp_plot_kind kind, cp_error *error)
{
    cp_status status = write_data(p, kind, error);
    if (status == CP_OK && (ferror(p->out) || ferror(p->variants) || ferror(p->bars)))
        status = cp_fail_memory(error, "a figure");
    if (status == CP_OK && p->drawn == 0)
        status = cp_fail(error, CP_BAD_INPUT, "there is nothing to draw: no such crash");
    return status;
}

// Data of a figure as text, and the numbers that its script begins with.
static cp_status make(plot *p, cp_plot_kind kind, char **data, char **numbers, cp_error *error)
{
    size_t data_size = 0, variants_size = 0, bars_size = 0;
    char *variants = NULL, *bars = NULL;
    p->out = cp_memory_stream(data, &data_size);
    p->variants = cp_memory_stream(&variants, &variants_size);
    p->bars = cp_memory_stream(&bars, &bars_size);
    cp_status status = p->out && p->variants && p->bars ? write_streams(p, kind, error)
                                                        : cp_fail_memory(error, "a figure");
    int bad = p->out && fclose(p->out) != 0;
    bad |= p->variants && fclose(p->variants) != 0;
    bad |= p->bars && fclose(p->bars) != 0;
    if (status == CP_OK && (bad || (*numbers = malloc(variants_size + bars_size + 64)) == NULL))
        status = cp_fail_memory(error, "a figure");
    if (status == CP_OK)
        sprintf(*numbers, "n = %zu\nvariants = \"%s\"\nbars = \"%s\"\n", p->block_count,
                variants != NULL ? variants : "", bars != NULL ? bars : "");
    free(variants);
    free(bars);
    if (status != CP_OK) {
        free(*data);
        *data = NULL;
    }
    return status;
}

cp_status cp_plot_data(cp_store *store, const cp_study_data *study, const cp_comparison *comparison,
                       int scope, cp_plot_kind kind, char **data, cp_error *error)
{
    plot p = {.store = store, .data = study, .comparison = comparison, .scope = scope};
    char *numbers = NULL;
    *data = NULL;
    cp_status status = make(&p, kind, data, &numbers, error);
    free(numbers);
    return status;
}

// Colours as on the page: the baseline neutral, then Okabe and Ito's.
static const char BEGIN_SCRIPT[] = "set encoding utf8\n"
                                   "set datafile separator \"\\t\"\n"
                                   "set border 3 lc rgb \"#58636f\"\n"
                                   "set tics nomirror\n"
                                   "colours = \"#4d5a68 #0072b2 #d55e00 #009e73 #b0518e #b07d00\"\n"
                                   "points = \"7 9 5 13 11 15\"\n"
                                   "fills = \"#009e73 #0072b2 #4d5a68 #d55e00 #b0518e #d9dde2\"\n"
                                   "number(k) = int(word(variants, k + 1)) % 6 + 1\n"
                                   "colour(k) = word(colours, number(k))\n"
                                   "point(k) = int(word(points, number(k)))\n"
                                   "bar(j) = words(bars) < j ? 0 : int(word(bars, j))\n";

#define GRID "set grid lc rgb \"#d9dde2\"\n"
#define ROWS                                                                                       \
    "set xrange [*<0:0<*]\nset yrange [n - 0.5:-0.5]\nset grid xtics lc rgb \"#d9dde2\"\n"         \
    "unset key\n"                                                                                  \
    "plot for [k=0:n-1] \"data\" every ::k::k using 2:3:ytic(1) with points "                      \
    "pt point(k) ps 1 lc rgb colour(k), "                                                          \
    "for [j=1:words(bars)] \"data\" every ::bar(j)::bar(j) using 2:3:4:5 with xerrorbars lw 2 "    \
    "pt point(bar(j)) ps 1 lc rgb colour(bar(j))\n"
#define ZERO "set arrow from 0, graph 0 to 0, graph 1 nohead lc rgb \"#1c2430\"\n"
#define CURVES                                                                                     \
    GRID "set key autotitle columnhead\n"                                                          \
         "plot for [k=0:n-1] \"data\" index k using 1:3:4 with filledcurves fs transparent "       \
         "solid 0.15 noborder lc rgb colour(k) notitle, "                                          \
         "for [k=0:n-1] \"data\" index k using 1:2 with lines lw 2 lc rgb colour(k) "              \
         "title columnhead(2)\n"
#define ABOVE                                                                                      \
    "set ylabel \"frontal crashes above it per 10^6 vehicle-km\"\n"                                \
    "set xrange [0:*]\nset yrange [0:*]\nset key top right\n"
#define POINTS(columns, ink)                                                                       \
    GRID "set key autotitle columnhead\n"                                                          \
         "plot for [k=0:n-1] \"data\" index k using " columns " with points pt point(k) ps 0.6 "   \
         "lc " ink " title columnhead(2)\n"

// What gnuplot does with the data of each kind. Nothing from a database or a command line is in it.
static const char *const SCRIPT[CP_PLOT_KIND_COUNT] = {
    [CP_PLOT_RATES] = "set xlabel \"frontal crashes per 10^6 vehicle-km\"\n" ROWS,
    [CP_PLOT_DIFFERENCE] = "set xlabel \"change of OLC against the baseline, g\"\n" ZERO ROWS,
    [CP_PLOT_BENEFIT] = "set xlabel \"fewer expected injured drivers, %\"\n" ZERO ROWS,
    [CP_PLOT_OLC] = "set xlabel \"OLC, g\"\nset ylabel \"share of vehicles\"\nset yrange [0:1]\n"
                    "set xrange [0:*]\nset key bottom right\n" CURVES,
    [CP_PLOT_CORRIDOR] = "set xlabel \"time from first contact, ms\"\n"
                         "set ylabel \"deceleration, g (CFC60)\"\nset key top right\n" CURVES,
    [CP_PLOT_ABOVE_OLC] = "set xlabel \"OLC, g\"\n" ABOVE CURVES,
    [CP_PLOT_ABOVE_DELTA_V] = "set xlabel \"delta-v, km/h\"\n" ABOVE CURVES,
    [CP_PLOT_SEVERITY] =
        "set xlabel \"closing speed, km/h\"\nset ylabel \"OLC, g\"\nset key top left\n"
        "set xrange [0:*]\nset yrange [0:*]\n" POINTS("1:2", "rgb colour(k)"),
    [CP_PLOT_MAP] = "set xlabel \"lateral offset, m\"\nset ylabel \"angle, degrees\"\n"
                    "set cblabel \"closing speed, km/h\"\n"
                    "set palette defined (0 \"#fde725\", 0.33 \"#35b779\", 0.66 \"#31688e\", "
                    "1 \"#440154\")\nset key outside top\n" POINTS("1:2:3", "palette"),
    [CP_PLOT_SITES] = "set xlabel \"x, m\"\nset ylabel \"y, m\"\nset size ratio -1\n"
                      "set key outside top\n" POINTS("1:2", "rgb colour(k)"),
    [CP_PLOT_OUTCOMES] =
        "set style data histograms\nset style histogram rowstacked\n"
        "set style fill solid 0.8 noborder\nset boxwidth 0.6\n"
        "set ylabel \"frontal crashes of the baseline\"\nset key outside right\nset yrange [0:*]\n"
        "plot for [o=2:7] \"data\" using o:xtic(1) lc rgb word(fills, o - 1) "
        "title columnhead(o)\n",
};

// Let gnuplot work in a folder of its own, where all files have names of ours.
static cp_status run_gnuplot(const char *terminal, const char *numbers, const char *script,
                             const char *data, cp_scratch *scratch, cp_error *error)
{
    static const char *const WORDS[] = {"gnuplot", "--default-settings", "script", NULL};
    const char *const parts[] = {"set terminal ", terminal,     "\nset output \"figure\"\n",
                                 numbers,         BEGIN_SCRIPT, script,
                                 "unset output\n"};
    int code = 0;
    cp_status status =
        cp_scratch_write(scratch, "script", parts, sizeof parts / sizeof *parts, error);
    if (status == CP_OK)
        status = cp_scratch_write(scratch, "data", &data, 1, error);
    if (status == CP_OK)
        status = cp_scratch_run(scratch, WORDS, &code, error);
    if (status == CP_BAD_INPUT)
        return cp_fail(error, CP_BAD_INPUT,
                       "gnuplot is missing; on Debian: apt-get install gnuplot-nox");
    if (status == CP_OK && code != 0)
        status = cp_fail(error, CP_RUN_FAILED, "gnuplot failed, see its words above");
    return status;
}

static cp_status draw(const char *terminal, const char *numbers, const char *script,
                      const char *data, const char *path, cp_error *error)
{
    cp_scratch scratch;
    char *figure = NULL;
    size_t size = 0;
    cp_status status = cp_scratch_open(&scratch, error);
    if (status != CP_OK)
        return status;
    status = run_gnuplot(terminal, numbers, script, data, &scratch, error);
    if (status == CP_OK)
        status = cp_scratch_read(&scratch, "figure", &figure, &size, error);
    if (status == CP_OK)
        status = cp_file_write(path, figure, size, error);
    free(figure);
    cp_scratch_close(&scratch);
    return status;
}

cp_status cp_plot_write(cp_store *store, const cp_study_data *study,
                        const cp_comparison *comparison, int scope, cp_plot_kind kind,
                        const char *path, cp_error *error)
{
    const char *ending = strrchr(path, '.');
    const char *terminal = NULL;
    if (ending && strcmp(ending, ".svg") == 0)
        terminal = "svg size 720,450 font \"Helvetica,13\" noenhanced background \"#ffffff\"";
    else if (ending && strcmp(ending, ".pdf") == 0)
        terminal = "pdfcairo size 16cm,10cm font \"Helvetica,11\" noenhanced";
    if (!terminal)
        return cp_fail(error, CP_BAD_INPUT, "%s: the file must end in .svg or .pdf", path);
    plot p = {.store = store, .data = study, .comparison = comparison, .scope = scope};
    char *data = NULL, *numbers = NULL;
    cp_status status = make(&p, kind, &data, &numbers, error);
    if (status == CP_OK)
        status = draw(terminal, numbers, SCRIPT[kind], data, path, error);
    free(numbers);
    free(data);
    return status;
}
