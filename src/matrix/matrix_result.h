/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef MATRIX_MATRIX_RESULT_H
#define MATRIX_MATRIX_RESULT_H

#include "matrix/matrix_file.h"
#include "store/store.h"

/* What became of the cells, out of the database of the matrix's study. */

/* Of the own car, NAN where there is nothing of it; without its function and with it. */
typedef struct cp_cell_outcome {
    bool is_impact;
    double impact_m_s; /* its speed at first contact */
    double closing_m_s;
    double delta_v_m_s;
    double olc_g;
    double overlap_1;
    char contact_side[8]; /* "" without an impact */
    bool is_inside;       /* the surrogate's validated range */
    char touch[24];       /* verdict of a contact that is no crash: "graze"; "" without one */
} cp_cell_outcome;

typedef struct cp_matrix_result {
    cp_cell_outcome *without, *with; /* by cell */
    size_t count;
} cp_matrix_result;

/* Read; the caller destroys, after a failure too. Errors: those of the store; CP_RUN_FAILED when
 * the study is not done. */
CP_MUST_CHECK cp_status cp_matrix_result_read(cp_store *store, const cp_matrix *matrix,
                                              cp_matrix_result *result, cp_error *error);
void cp_matrix_result_destroy(cp_matrix_result *result);

/* The first two axes as a map of impact speeds, a panel for each value of the third, into an .svg
 * or .pdf. Errors: as cp_plot_write. */
CP_MUST_CHECK cp_status cp_matrix_plot(const cp_matrix *matrix, const cp_matrix_result *result,
                                       const char *path, cp_error *error);

#endif
