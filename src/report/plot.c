/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/plot.h"

#include "core/file.h"
#include "core/units.h"
#include "report/gallery.h"
#include "report/slice_sample.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* What every figure is drawn from. */
typedef struct plot {
    cp_store *store;
    const cp_study_data *data;
    const cp_comparison *comparison;
    int scope;
    FILE *out;
    size_t drawn; /* values written: 0 means nothing to show */
} plot;

// Colours as on the page: the baseline neutral, then Okabe and Ito's.
static const char *const COLOUR[] = {"#4d5a68", "#0072b2", "#d55e00",
                                     "#009e73", "#b0518e", "#b07d00"};
static const int POINT[] = {7, 9, 5, 13, 11, 15};

static const char *colour(size_t variant)
{
    return COLOUR[variant % (sizeof COLOUR / sizeof *COLOUR)];
}

static int point(size_t variant)
{
    return POINT[variant % (sizeof POINT / sizeof *POINT)];
}

// Text inside double quotes of gnuplot, as plain as it stands.
static void put_text(FILE *out, const char *text)
{
    for (const char *c = text; *c; c++) {
        if (*c == '"' || *c == '\\')
            fputc('\\', out);
        fputc(*c == '\n' ? ' ' : *c, out);
    }
}

// The same where gnuplot takes the text for a format: labels of tics.
static void put_label(FILE *out, const char *text)
{
    for (const char *c = text; *c; c++) {
        const char one[2] = {*c, '\0'};
        put_text(out, *c == '%' ? "%%" : one);
    }
}

static const char *name_of(const plot *p, size_t variant)
{
    return p->data->variant[variant].name;
}

static void begin_block(plot *p, const char *name, size_t number)
{
    fprintf(p->out, "$%s%zu << EOD\n", name, number);
}

static void end_block(plot *p)
{
    fputs("EOD\n", p->out);
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
    // No bar where there is no interval: none of no width is drawn.
    begin_block(p, "row", p->drawn);
    if (closed(r))
        fprintf(p->out, "%.9g %zu %.9g %.9g\n", r->value, p->drawn, r->interval.low,
                r->interval.high);
    else
        fprintf(p->out, "%.9g %zu\n", r->value, p->drawn);
    end_block(p);
    p->drawn++;
}

static void end_rows(plot *p, const row *rows, size_t count, const char *axis, bool zero)
{
    fprintf(p->out,
            "set xlabel \"%s\"\nset xrange [*<0:0<*]\nset yrange [%g:-0.5]\nset grid xtics lc rgb "
            "\"#d9dde2\"\n"
            "unset key\n",
            axis, (double)p->drawn - 0.5);
    if (zero)
        fputs("set arrow from 0, graph 0 to 0, graph 1 nohead lc rgb \"#1c2430\"\n", p->out);
    fputs("set ytics (", p->out);
    size_t place = 0;
    for (size_t k = 0; k < count; k++) {
        if (isnan(rows[k].value))
            continue;
        fprintf(p->out, "%s\"", place ? ", " : "");
        put_label(p->out, name_of(p, rows[k].variant));
        fputs(*rows[k].label ? ": " : "", p->out);
        put_label(p->out, rows[k].label);
        fprintf(p->out, "\" %zu", place++);
    }
    fputs(")\nplot ", p->out);
    place = 0;
    for (size_t k = 0; k < count; k++) {
        if (isnan(rows[k].value))
            continue;
        fprintf(p->out, "%s$row%zu using %s lw 2 pt %d ps 1 lc rgb \"%s\"", place ? ", \\\n  " : "",
                place, closed(&rows[k]) ? "1:2:3:4 with xerrorbars" : "1:2 with points",
                point(rows[k].variant), colour(rows[k].variant));
        place++;
    }
    fputc('\n', p->out);
}

static void write_rows(plot *p, const row *rows, size_t count, const char *axis, bool zero)
{
    for (size_t k = 0; k < count; k++)
        put_row(p, &rows[k]);
    end_rows(p, rows, count, axis, zero);
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
    write_rows(p, rows, c->variant_count, "frontal crashes per 10^6 vehicle-km", false);
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
    write_rows(p, rows, count, "change of OLC against the baseline, g", true);
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
    write_rows(p, rows, count, "fewer expected injured drivers, %", true);
    free(rows);
    free(label);
    return CP_OK;
}

// ---- curves ------------------------------------------------------------------------------------

static void put_steps(plot *p, const cp_sample *sample, double half_width)
{
    double n = (double)sample->count, before = 0.0;
    size_t censored = cp_sample_censored(sample);
    double half = isnan(half_width) ? 0.0 : half_width;
    // The share before each step and after it, so that lines and areas are stairs.
    before = (double)censored / n;
    fprintf(p->out, "0 %.6g %.6g %.6g\n", before, fmax(0.0, before - half),
            fmin(1.0, before + half));
    for (size_t k = censored; k < sample->count; k++) {
        double after = (double)(k + 1) / n, x = sample->value[k];
        for (int end = 0; end < 2; end++) {
            double share = end ? after : before;
            fprintf(p->out, "%.6g %.6g %.6g %.6g\n", x, share, fmax(0.0, share - half),
                    fmin(1.0, share + half));
        }
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
            begin_block(p, "olc", k);
            if (sample.count > 0)
                put_steps(p, &sample, c->variant[k].olc_band[p->scope].half_width_1);
            else
                fputs("0 NaN NaN NaN\n", p->out);
            end_block(p);
        }
        cp_sample_destroy(&sample);
        cp_replication_set_destroy(&set);
        if (status != CP_OK)
            return status;
    }
    fputs("set xlabel \"OLC, g\"\nset ylabel \"share of vehicles\"\nset yrange [0:1]\n"
          "set xrange [0:*]\nset key bottom right\nset grid lc rgb \"#d9dde2\"\nplot ",
          p->out);
    for (size_t k = 0; k < c->variant_count; k++) {
        size_t v = c->variant[k].variant;
        if (c->variant[k].olc_band[p->scope].status == CP_INTERVAL_VALUE)
            fprintf(p->out,
                    "$olc%zu using 1:3:4 with filledcurves fs transparent solid 0.15 noborder lc "
                    "rgb \"%s\" notitle, \\\n  ",
                    k, colour(v));
        fprintf(p->out, "$olc%zu using 1:2 with lines lw 2 lc rgb \"%s\" title \"", k, colour(v));
        put_text(p->out, name_of(p, v));
        fprintf(p->out, " (n = %zu)\"%s",
                c->variant[k].description[CP_QUANTITY_OLC][p->scope].count,
                k + 1 < c->variant_count ? ", \\\n  " : "\n");
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
        begin_block(p, "above", k);
        for (size_t j = 0; j < CP_EXCEEDANCE_POINTS; j++) {
            const cp_exceedance *e = &c->variant[k].curve[what][j];
            if (isnan(e->rate)) {
                fputs("0 NaN NaN NaN\n", p->out);
                break;
            }
            fprintf(p->out, "%.6g %.6g %.6g %.6g\n", factor * e->x, e->rate, e->interval.low,
                    e->interval.high);
            p->drawn += e->crashes;
        }
        end_block(p);
    }
    fprintf(p->out,
            "set xlabel \"%s\"\nset ylabel \"frontal crashes above it per 10^6 vehicle-km\"\n"
            "set xrange [0:*]\nset yrange [0:*]\nset key top right\nset grid lc rgb "
            "\"#d9dde2\"\nplot ",
            what == CP_EXCEEDED_DELTA_V ? "delta-v, km/h" : "OLC, g");
    for (size_t k = 0; k < c->variant_count; k++) {
        size_t v = c->variant[k].variant;
        fprintf(p->out,
                "$above%zu using 1:3:4 with filledcurves fs transparent solid 0.15 noborder lc rgb "
                "\"%s\" notitle, \\\n  $above%zu using 1:2 with lines lw 2 lc rgb \"%s\" title \"",
                k, colour(v), k, colour(v));
        put_text(p->out, name_of(p, v));
        fprintf(p->out, ", 95 %% at each point\"%s", k + 1 < c->variant_count ? ", \\\n  " : "\n");
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
        begin_block(p, "pulse", k);
        for (size_t t = 0; t < json_array_size(p50); t++, p->drawn++)
            fprintf(p->out, "%g %g %g %g\n", 1e3 * CP_CORRIDOR_INTERVAL_S * (double)t,
                    json_number_value(json_array_get(p50, t)),
                    json_number_value(json_array_get(p10, t)),
                    json_number_value(json_array_get(p90, t)));
        if (json_array_size(p50) == 0)
            fputs("0 NaN NaN NaN\n", p->out);
        end_block(p);
        json_decref(corridor);
    }
    fputs("set xlabel \"time from first contact, ms\"\nset ylabel \"deceleration, g (CFC60)\"\n"
          "set key top right\nset grid lc rgb \"#d9dde2\"\nplot ",
          p->out);
    for (size_t k = 0; k < c->variant_count; k++) {
        size_t v = c->variant[k].variant;
        fprintf(p->out,
                "$pulse%zu using 1:3:4 with filledcurves fs transparent solid 0.15 noborder lc rgb "
                "\"%s\" notitle, \\\n  $pulse%zu using 1:2 with lines lw 2 lc rgb \"%s\" title \"",
                k, colour(v), k, colour(v));
        put_text(p->out, name_of(p, v));
        fprintf(p->out, ", median, 10–90 %%\"%s", k + 1 < c->variant_count ? ", \\\n  " : "\n");
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
        begin_block(p, "points", k);
        fputs("NaN NaN NaN\n", p->out);
        for (size_t j = 0; j < p->data->vehicle_count; j++) {
            double xyz[3];
            if (variant_of(p, j) != c->variant[k].variant || !in_slice(p, j) ||
                !coordinates(p, kind, j, xyz))
                continue;
            fprintf(p->out, "%.6g %.6g %.6g\n", xyz[0], xyz[1], xyz[2]);
            p->drawn++;
        }
        end_block(p);
    }
    fputs("set grid lc rgb \"#d9dde2\"\n", p->out);
    if (kind == CP_PLOT_SEVERITY)
        fputs("set xlabel \"closing speed, km/h\"\nset ylabel \"OLC, g\"\nset key top left\n"
              "set xrange [0:*]\nset yrange [0:*]\n",
              p->out);
    else if (kind == CP_PLOT_MAP)
        fputs("set xlabel \"lateral offset, m\"\nset ylabel \"angle, degrees\"\nset cblabel "
              "\"closing speed, km/h\"\nset palette defined (0 \"#fde725\", 0.33 \"#35b779\", 0.66 "
              "\"#31688e\", 1 \"#440154\")\nset key outside top\n",
              p->out);
    else
        fputs("set xlabel \"x, m\"\nset ylabel \"y, m\"\nset size ratio -1\nset key outside top\n",
              p->out);
    fputs("plot ", p->out);
    for (size_t k = 0; k < c->variant_count; k++) {
        size_t v = c->variant[k].variant;
        fprintf(p->out, "$points%zu using 1:2%s with points pt %d ps 0.6 ", k,
                kind == CP_PLOT_MAP ? ":3" : "", point(v));
        if (kind == CP_PLOT_MAP)
            fputs("lc palette title \"", p->out);
        else
            fprintf(p->out, "lc rgb \"%s\" title \"", colour(v));
        put_text(p->out, name_of(p, v));
        fprintf(p->out, "\"%s", k + 1 < c->variant_count ? ", \\\n  " : "\n");
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
    static const char *const FILL[] = {"#009e73", "#0072b2", "#4d5a68",
                                       "#d55e00", "#b0518e", "#d9dde2"};
    const cp_comparison *c = p->comparison;
    if (c->counterfactual_count == 0)
        return cp_fail(error, CP_BAD_INPUT,
                       "outcomes are of studies with the design counterfactual only");
    fputs("$outcomes << EOD\n", p->out);
    for (size_t k = 0; k < c->counterfactual_count; k++) {
        fprintf(p->out, "\"");
        put_text(p->out, name_of(p, c->counterfactual[k].variant));
        fputc('"', p->out);
        for (size_t o = 0; o < 6; o++)
            fprintf(p->out, " %zu", c->counterfactual[k].outcome[ORDER[o]]);
        fputc('\n', p->out);
        p->drawn += c->counterfactual[k].crashes;
    }
    fputs(
        "EOD\nset style data histograms\nset style histogram rowstacked\nset style fill solid 0.8 "
        "noborder\nset boxwidth 0.6\nset ylabel \"frontal crashes of the baseline\"\nset key "
        "outside right\nset yrange [0:*]\nplot ",
        p->out);
    for (size_t o = 0; o < 6; o++) {
        fprintf(p->out, "$outcomes using %zu%s lc rgb \"%s\" title \"", o + 2,
                o == 0 ? ":xtic(1)" : "", FILL[o]);
        for (const char *t = cp_outcome_text(ORDER[o]); *t; t++)
            fputc(*t == '_' ? ' ' : *t, p->out);
        fputs(o < 5 ? "\", \\\n  " : "\"\n", p->out);
    }
    return CP_OK;
}

// ---- script and gnuplot
// --------------------------------------------------------------------------

static cp_status write_script(plot *p, cp_plot_kind kind, cp_error *error)
{
    fputs("set encoding utf8\nset border 3 lc rgb \"#58636f\"\nset tics nomirror\n", p->out);
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

cp_status cp_plot_script(cp_store *store, const cp_study_data *data,
                         const cp_comparison *comparison, int scope, cp_plot_kind kind,
                         char **script, cp_error *error)
{
    *script = NULL;
    size_t size = 0;
    plot p = {.store = store, .data = data, .comparison = comparison, .scope = scope};
    p.out = open_memstream(script, &size);
    if (!p.out)
        return cp_fail_memory(error, "a figure");
    cp_status status = write_script(&p, kind, error);
    int failed = ferror(p.out);
    if ((fclose(p.out) != 0 || failed) && status == CP_OK)
        status = cp_fail_memory(error, "a figure");
    if (status == CP_OK && p.drawn == 0)
        status = cp_fail(error, CP_BAD_INPUT, "there is nothing to draw: no such crash");
    if (status != CP_OK) {
        free(*script);
        *script = NULL;
    }
    return status;
}

// Run gnuplot on a script; what it says goes to stderr.
static cp_status run_gnuplot(const char *terminal, const char *script, const char *path,
                             cp_error *error)
{
    char temporary[4096];
    if ((size_t)snprintf(temporary, sizeof temporary, "%s.part", path) >= sizeof temporary)
        return cp_fail(error, CP_BAD_INPUT, "%s: the path is too long", path);
    // gnuplot would draw on stdout when it cannot write the file.
    FILE *probe = fopen(temporary, "w");
    if (!probe || fclose(probe) != 0)
        return cp_fail(error, CP_IO_FAILED, "%s: %s", path, strerror(errno));
    fflush(NULL);
    FILE *gnuplot = popen("gnuplot", "w");
    if (!gnuplot)
        return cp_fail(error, CP_RUN_FAILED, "gnuplot cannot be started: %s", strerror(errno));
    fprintf(gnuplot, "set terminal %s\nset output \"", terminal);
    put_text(gnuplot, temporary);
    fprintf(gnuplot, "\"\n%sunset output\n", script);
    int code = pclose(gnuplot);
    if (code == -1 || !WIFEXITED(code) || WEXITSTATUS(code) != 0) {
        unlink(temporary);
        if (code != -1 && WIFEXITED(code) && WEXITSTATUS(code) == 127)
            return cp_fail(error, CP_BAD_INPUT,
                           "gnuplot is missing; on Debian: apt-get install gnuplot-nox");
        return cp_fail(error, CP_RUN_FAILED, "gnuplot failed on %s, see its words above", path);
    }
    if (rename(temporary, path) != 0) {
        int why = errno;
        unlink(temporary);
        return cp_fail(error, CP_IO_FAILED, "%s: %s", path, strerror(why));
    }
    return CP_OK;
}

cp_status cp_plot_write(cp_store *store, const cp_study_data *data, const cp_comparison *comparison,
                        int scope, cp_plot_kind kind, const char *path, cp_error *error)
{
    const char *ending = strrchr(path, '.');
    const char *terminal = NULL;
    if (ending && strcmp(ending, ".svg") == 0)
        terminal = "svg size 720,450 font \"Helvetica,13\" noenhanced background \"#ffffff\"";
    else if (ending && strcmp(ending, ".pdf") == 0)
        terminal = "pdfcairo size 16cm,10cm font \"Helvetica,11\" noenhanced";
    if (!terminal)
        return cp_fail(error, CP_BAD_INPUT, "%s: the file must end in .svg or .pdf", path);
    char *script = NULL;
    cp_status status = cp_plot_script(store, data, comparison, scope, kind, &script, error);
    if (status == CP_OK)
        status = run_gnuplot(terminal, script, path, error);
    free(script);
    return status;
}
