/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef MATRIX_MATRIX_STUDY_H
#define MATRIX_MATRIX_STUDY_H

#include "matrix/matrix_file.h"

/* A matrix as an ordinary study of SUMO: one scenario, in which every cell has a track and two cars
 * of its own ("c12_own", "c12_target"), without and with the functions. The two lines of a cell are
 * lanes of one edge, or the two directions of a road, so that SUMO's drivers do not see each other
 * and a contact is one on the ground. */

#define CP_MATRIX_BASELINE "without"
#define CP_MATRIX_TREATED "with"

/* Write network, demand, configuration and study file into folder, which is made; *study_path is
 * the study's, the caller frees. Libraries are named by their absolute paths. Errors: CP_BAD_INPUT
 * for a car that would begin before its track; CP_IO_FAILED; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_matrix_study_write(const cp_matrix *matrix, const char *folder,
                                              char **study_path, cp_error *error);

#endif
