/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef REPORT_PLOT_H
#define REPORT_PLOT_H

#include "analysis/figures.h"
#include "report/plot_kind.h"

/* Figures for papers, drawn by gnuplot without a browser. In the counterfactual design treatments
 * are drawn too: single crashes as what the baseline's became, distributions and crashes above a
 * severity over the crashes judged with every treatment (judged.h). */

/* Draw a comparison to path, whose ending says how: .svg or .pdf. store: of the pulses. gnuplot
 * gets a fixed script and the data in a file of their own: no text of a database or a command line
 * is ever part of a script. Errors: CP_BAD_INPUT for another ending, for nothing to draw, and when
 * gnuplot is missing; CP_RUN_FAILED with gnuplot's words on stderr; CP_IO_FAILED. */
CP_MUST_CHECK cp_status cp_plot_write(cp_store *store, const cp_study_data *study,
                                      const cp_comparison *comparison, int scope, cp_plot_kind kind,
                                      const char *path, cp_error *error);

/* The data that are drawn: rows of cells with tabs between, texts in double quotes, two empty lines
 * between the variants; the caller frees. Errors: as above. */
CP_MUST_CHECK cp_status cp_plot_data(cp_store *store, const cp_study_data *study,
                                     const cp_comparison *comparison, int scope, cp_plot_kind kind,
                                     char **data, cp_error *error);

#endif
