/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/plot.h"

#include "analysis/slice_sample.h"
#include "core/gnuplot.h"
#include "core/memory_stream.h"
#include "report/plot_data.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const char CP_PLOT_NOTHING[] = "0\tNaN\tNaN\tNaN\n";

// A cell of text. gnuplot has no word for a quotation mark within one.
void cp_plot_text(FILE *out, const char *text)
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

const char *cp_plot_name(const cp_plot *p, size_t variant)
{
    return p->data->variant[variant].name;
}

void cp_plot_begin_block(cp_plot *p, size_t variant, const char *title)
{
    fputs(p->block_count > 0 ? "\n\n\"\"\t" : "\"\"\t", p->out);
    cp_plot_text(p->out, title);
    fputs("\t\"\"\t\"\"\n", p->out);
    fprintf(p->variants, "%zu ", variant);
    p->block_count++;
}

void cp_plot_begin_panel(cp_plot *p)
{
    fprintf(p->panels, "%zu ", p->block_count);
    p->panel_count++;
}

size_t cp_plot_variants(const cp_plot *p, size_t *variant)
{
    const cp_comparison *c = p->comparison;
    size_t count = 0;
    for (size_t k = 0; k < c->variant_count; k++)
        variant[count++] = c->variant[k].variant;
    for (size_t k = 0; k < c->counterfactual_count; k++)
        variant[count++] = c->counterfactual[k].variant;
    return count;
}

bool cp_plot_has_vehicle(const cp_plot *p, const cp_study_vehicle *vehicle, size_t chosen)
{
    cp_slice slice = p->comparison->slice;
    return vehicle->frontal && (p->scope == CP_SCOPE_ALL || vehicle->validity == 0) &&
           (!slice.chosen || chosen == SIZE_MAX || slice.chosen[chosen]) &&
           cp_slice_has_crash(p->data, slice, &p->data->crash[vehicle->crash]);
}

// ---- data, script and gnuplot ------------------------------------------------------------------

static cp_status write_data(cp_plot *p, cp_plot_kind kind, cp_error *error)
{
    switch (kind) {
    case CP_PLOT_RATES:
        return cp_plot_rates(p, error);
    case CP_PLOT_OLC:
        return cp_plot_distribution(p, CP_EXCEEDED_OLC, error);
    case CP_PLOT_DELTA_V:
        return cp_plot_distribution(p, CP_EXCEEDED_DELTA_V, error);
    case CP_PLOT_DIFFERENCE:
        return cp_plot_difference(p, error);
    case CP_PLOT_FOREST:
        return cp_plot_forest(p, error);
    case CP_PLOT_SEVERITY:
    case CP_PLOT_MAP:
    case CP_PLOT_SITES:
        return cp_plot_points(p, kind, error);
    case CP_PLOT_OUTCOMES:
        return cp_plot_outcomes(p, error);
    case CP_PLOT_BENEFIT:
        return cp_plot_benefit(p, error);
    case CP_PLOT_RISK:
        return cp_plot_risk(p, error);
    case CP_PLOT_CORRIDOR:
        return cp_plot_corridor(p, error);
    case CP_PLOT_ABOVE_OLC:
        return cp_plot_exceedance(p, CP_EXCEEDED_OLC, error);
    case CP_PLOT_ABOVE_DELTA_V:
        return cp_plot_exceedance(p, CP_EXCEEDED_DELTA_V, error);
    case CP_PLOT_CONVERGENCE:
        return cp_plot_convergence(p, error);
    case CP_PLOT_DOSE:
        return cp_plot_dose(p, error);
    case CP_PLOT_KIND_COUNT:
        break;
    }
    return cp_fail(error, CP_BAD_INPUT, "there is no such kind of plot");
}

static cp_status write_streams(cp_plot *p, cp_plot_kind kind, cp_error *error)
{
    cp_status status = write_data(p, kind, error);
    if (status == CP_OK && (ferror(p->out) || ferror(p->variants) || ferror(p->bars)))
        status = cp_fail_memory(error, "a figure");
    if (status == CP_OK && p->drawn == 0)
        status = cp_fail(error, CP_BAD_INPUT, "there is nothing to draw: no such crash");
    return status;
}

/* Lists of numbers that the script begins with. */
enum { LIST_VARIANTS, LIST_BARS, LIST_PANELS, LIST_BOXES, LISTS };

// Data of a figure as text, and the numbers that its script begins with.
static cp_status make(cp_plot *p, cp_plot_kind kind, char **data, char **numbers, cp_error *error)
{
    char *list[LISTS] = {NULL};
    size_t data_size = 0, size[LISTS] = {0}, all = 128;
    FILE **const stream[LISTS] = {&p->variants, &p->bars, &p->panels, &p->boxes};
    p->out = cp_memory_stream(data, &data_size);
    for (int k = 0; k < LISTS; k++)
        *stream[k] = cp_memory_stream(&list[k], &size[k]);
    cp_status status = p->out && p->variants && p->bars && p->panels && p->boxes
                           ? write_streams(p, kind, error)
                           : cp_fail_memory(error, "a figure");
    int bad = p->out && fclose(p->out) != 0;
    for (int k = 0; k < LISTS; k++) {
        bad |= *stream[k] && fclose(*stream[k]) != 0;
        all += size[k];
    }
    if (status == CP_OK && (bad || (*numbers = malloc(all)) == NULL))
        status = cp_fail_memory(error, "a figure");
    if (status == CP_OK)
        sprintf(
            *numbers,
            "n = %zu\npairs = %d\nalone = %d\nvariants = \"%s\"\nbars = \"%s\"\npanels = \"%s\"\n"
            "boxes = \"%s\"\n",
            p->block_count, p->data->counterfactual,
            p->comparison->contrast_count + p->comparison->counterfactual_count == 0,
            list[LIST_VARIANTS], list[LIST_BARS], list[LIST_PANELS], list[LIST_BOXES]);
    for (int k = 0; k < LISTS; k++)
        free(list[k]);
    if (status != CP_OK) {
        free(*data);
        *data = NULL;
    }
    return status;
}

static cp_plot plot_of(cp_store *store, const cp_study_data *study, const cp_comparison *comparison,
                       int scope)
{
    cp_plot p = {.store = store,
                 .data = study,
                 .comparison = comparison,
                 .options = cp_comparison_options_default(),
                 .scope = scope};
    p.options.permutations = 0; // no figure shows a p-value
    return p;
}

cp_status cp_plot_data(cp_store *store, const cp_study_data *study, const cp_comparison *comparison,
                       int scope, cp_plot_kind kind, char **data, cp_error *error)
{
    cp_plot p = plot_of(store, study, comparison, scope);
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
                                   "bar(j) = words(bars) < j ? 0 : int(word(bars, j))\n"
                                   "edge(q, k) = real(word(boxes, 4 * (q - 1) + k))\n"
                                   "panel(q) = q > words(panels) ? n : int(word(panels, q))\n"
                                   "ratio(x) = x < 0.01 ? 0.01 : x > 100 ? 100 : x\n"
                                   "headline = alone ? \"frontal crashes per 10^6 vehicle-km\" : "
                                   "pairs ? \"share of crashes avoided, %\" : \"frontal "
                                   "crash rate over that of the baseline\"\n";

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
// Of a ratio on a logarithmic axis; what lies beyond its ends stands there.
#define FOREST                                                                                     \
    "set xlabel headline\nset yrange [n - 0.5:-0.5]\nset grid xtics lc rgb \"#d9dde2\"\nunset "    \
    "key\n"                                                                                        \
    "if (!pairs) { set logscale x; set arrow from 1, graph 0 to 1, graph 1 nohead lc rgb "         \
    "\"#1c2430\" } else { set xrange [0:100] }\n"                                                  \
    "f(x) = pairs ? x : ratio(x)\n"                                                                \
    "plot for [k=0:n-1] \"data\" every ::k::k using (f($2)):3:ytic(1) with points "                \
    "pt point(k) ps 1 lc rgb colour(k), "                                                          \
    "for [j=1:words(bars)] \"data\" every ::bar(j)::bar(j) using (f($2)):3:(f($4)):(f($5)) with "  \
    "xerrorbars lw 2 pt point(bar(j)) ps 1 lc rgb colour(bar(j))\n"
// One figure above the other.
#define PANELS(content)                                                                            \
    GRID "set key autotitle columnhead\nset multiplot layout words(panels), 1\n"                   \
         "do for [q=1:words(panels)] {\n" content "}\nunset multiplot\n"
#define SHARE                                                                                      \
    "set ylabel (pairs ? \"share of crashes, avoided ones below every value\" : \"share of "       \
    "vehicles\")\nset yrange [0:1]\nset xrange [0:*]\nset key bottom right\n"
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
    [CP_PLOT_OLC] = "set xlabel \"OLC, g\"\n" SHARE CURVES,
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
    [CP_PLOT_SITES] =
        "set xlabel \"x, m\"\nset ylabel \"y, m\"\nset size ratio -1\n"
        "set key outside right\n" PANELS(
            "set xrange [edge(q, 1):edge(q, 2)]\nset yrange [edge(q, 3):edge(q, 4)]\n"
            "plot for [k=panel(q):panel(q + 1)-1] \"data\" index k using 1:2 with points "
            "pt point(k) ps 0.6 lc rgb colour(k) title columnhead(2)\n"),
    [CP_PLOT_DOSE] =
        "set xlabel \"value of the parameter\"\nset ylabel headline\nset key tmargin center\n"
        "set offsets graph 0.05, graph 0.05, 0, 0\nset yrange [0:*]\n"
        // Lines side by side, so that their intervals do not hide each other.
        "beside(q, k) = 0.012 * (edge(q, 2) - edge(q, 1)) * (k - panel(q))\n" PANELS(
            "plot for [k=panel(q):panel(q + 1)-1] \"data\" index k using ($1 + beside(q, "
            "k)):2:3:4 with yerrorbars lw 1.5 pt point(k) ps 1 lc rgb colour(k) notitle, "
            "for [k=panel(q):panel(q + 1)-1] \"data\" index k using ($1 + beside(q, k)):2 with "
            "linespoints lw 1.5 pt point(k) ps 1 lc rgb colour(k) title columnhead(2)\n"),
    [CP_PLOT_FOREST] = FOREST,
    [CP_PLOT_RISK] = "set xlabel \"delta-v, km/h\"\nset ylabel \"probability of the injury\"\n"
                     "set yrange [0:1]\nset key top left\n" CURVES,
    [CP_PLOT_CONVERGENCE] = "set xlabel \"replications\"\nset ylabel headline\nset xrange [0:*]\n"
                            "set yrange [0:*]\nset key top right\n" CURVES,
    [CP_PLOT_DELTA_V] = "set xlabel \"delta-v, km/h\"\n" SHARE CURVES,
    [CP_PLOT_OUTCOMES] =
        "set style data histograms\nset style histogram rowstacked\n"
        "set style fill solid 0.8 noborder\nset boxwidth 0.6\n"
        "set ylabel \"frontal crashes of the baseline\"\nset key outside right\nset yrange [0:*]\n"
        "plot for [o=2:7] \"data\" using o:xtic(1) lc rgb word(fills, o - 1) "
        "title columnhead(o)\n",
};

#define TERMINAL_SIZE 128

static cp_status draw(const char *terminal, const char *numbers, const char *script,
                      const char *data, const char *path, cp_error *error)
{
    const char *const parts[] = {"set terminal ", terminal,     "\nset output \"figure\"\n",
                                 numbers,         BEGIN_SCRIPT, script,
                                 "unset output\n"};
    return cp_gnuplot_draw(parts, sizeof parts / sizeof *parts, data, path, error);
}

/* Height of a panel besides the first, of one figure's. */
#define PANEL_SHARE_1 0.7

// The terminal of an ending, as high as its panels need; false for another ending.
static bool terminal_of(const char *path, size_t panels, char terminal[TERMINAL_SIZE])
{
    const char *ending = strrchr(path, '.');
    double height = panels > 1 ? 1.0 + PANEL_SHARE_1 * (double)(panels - 1) : 1.0;
    if (ending && strcmp(ending, ".svg") == 0)
        snprintf(terminal, TERMINAL_SIZE,
                 "svg size 720,%.0f font \"Helvetica,13\" noenhanced background \"#ffffff\"",
                 450.0 * height);
    else if (ending && strcmp(ending, ".pdf") == 0)
        snprintf(terminal, TERMINAL_SIZE,
                 "pdfcairo size 16cm,%.1fcm font \"Helvetica,11\" noenhanced", 10.0 * height);
    else
        return false;
    return true;
}

cp_status cp_plot_write(cp_store *store, const cp_study_data *study,
                        const cp_comparison *comparison, int scope, cp_plot_kind kind,
                        const char *path, cp_error *error)
{
    char terminal[TERMINAL_SIZE];
    if (!terminal_of(path, 1, terminal))
        return cp_fail(error, CP_BAD_INPUT, "%s: the file must end in .svg or .pdf", path);
    cp_plot p = plot_of(store, study, comparison, scope);
    char *data = NULL, *numbers = NULL;
    cp_status status = make(&p, kind, &data, &numbers, error);
    if (status == CP_OK) {
        (void)terminal_of(path, p.panel_count, terminal);
        status = draw(terminal, numbers, SCRIPT[kind], data, path, error);
    }
    free(numbers);
    free(data);
    return status;
}
