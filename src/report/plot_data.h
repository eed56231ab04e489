/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef REPORT_PLOT_DATA_H
#define REPORT_PLOT_DATA_H

#include "analysis/judged.h"
#include "report/plot_kind.h"

#include <stdio.h>

/* What figures are drawn from, kind by kind (plot.h). Data are blocks of rows, tabs between the
 * columns, two empty lines between the blocks; gnuplot reads them as data, never as a part of its
 * script. */
typedef struct cp_plot {
    cp_store *store;
    const cp_study_data *data;
    const cp_comparison *comparison;
    cp_comparison_options options; /* of further comparisons that a figure needs */
    int scope;
    FILE *out;
    size_t drawn;       /* values written: 0 means nothing to show */
    size_t block_count; /* blocks begun, or rows of a figure of intervals */
    size_t panel_count; /* drawn one above the other */
    FILE *panels;       /* the first block of each, numbers with blanks between */
    FILE *boxes;        /* x from, x to, y from, y to of each panel, likewise; of dose x only */
    FILE *variants;     /* of each block or row, likewise */
    FILE *bars;         /* the rows that have an interval, likewise */
} cp_plot;

#define CP_PLOT_TITLE_SIZE 512

extern const char CP_PLOT_NOTHING[]; /* a row that draws nothing: a block needs one */

const char *cp_plot_name(const cp_plot *p, size_t variant);

/* A cell of text. */
void cp_plot_text(FILE *out, const char *text);

/* The next block; the colour, the point and, by the head of its second column, the title of what is
 * drawn from it are the variant's. */
void cp_plot_begin_block(cp_plot *p, size_t variant, const char *title);

/* The next panel, which begins with the next block. */
void cp_plot_begin_panel(cp_plot *p);

/* Variants that single crashes are drawn of: those with replications, then treatments that have
 * treated crashes. Written to variant, room for all of the study; returns their number. */
size_t cp_plot_variants(const cp_plot *p, size_t *variant);

/* Whether a crash of the baseline, or its vehicle, is in the figure's slice and scope. */
bool cp_plot_has_vehicle(const cp_plot *p, const cp_study_vehicle *vehicle, size_t chosen);

/* Rows with an interval (plot_rows.c). */
CP_MUST_CHECK cp_status cp_plot_rates(cp_plot *p, cp_error *error);
CP_MUST_CHECK cp_status cp_plot_difference(cp_plot *p, cp_error *error);
CP_MUST_CHECK cp_status cp_plot_benefit(cp_plot *p, cp_error *error);
CP_MUST_CHECK cp_status cp_plot_forest(cp_plot *p, cp_error *error);

/* Curves over one axis, with a band where there is one (plot_curves.c). what: CP_EXCEEDED_... */
CP_MUST_CHECK cp_status cp_plot_distribution(cp_plot *p, int what, cp_error *error);
CP_MUST_CHECK cp_status cp_plot_exceedance(cp_plot *p, int what, cp_error *error);
CP_MUST_CHECK cp_status cp_plot_corridor(cp_plot *p, cp_error *error);
CP_MUST_CHECK cp_status cp_plot_risk(cp_plot *p, cp_error *error);
CP_MUST_CHECK cp_status cp_plot_convergence(cp_plot *p, cp_error *error);

/* Points of single crashes; counts of outcomes (plot_points.c). */
CP_MUST_CHECK cp_status cp_plot_points(cp_plot *p, cp_plot_kind kind, cp_error *error);
CP_MUST_CHECK cp_status cp_plot_outcomes(cp_plot *p, cp_error *error);

/* The headline figure over a swept parameter (plot_dose.c). */
CP_MUST_CHECK cp_status cp_plot_dose(cp_plot *p, cp_error *error);

/* The headline of a treatment in a comparison: the rate ratio, counterfactual the share of the
 * valid pairs that were avoided, in %. */
typedef struct cp_plot_headline {
    double value; /* NAN: none */
    cp_interval interval;
} cp_plot_headline;

cp_plot_headline cp_plot_headline_of(const cp_comparison *comparison, size_t variant);

/* Treatments of a comparison, of either design; returns their number. */
size_t cp_plot_treatments(const cp_comparison *comparison, size_t *variant);

/* The comparison of a figure, of one of its scenarios only. The caller destroys. */
CP_MUST_CHECK cp_status cp_plot_compare_scenario(const cp_plot *p, size_t scenario,
                                                 cp_comparison *comparison, cp_error *error);

#endif
