/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef MATRIX_TRACKS_H
#define MATRIX_TRACKS_H

#include "matrix/matrix_file.h"

#include "core/geometry.h"

/* Where the two cars of a cell drive. Both keep to lines of their own, fronts and rears on them, at
 * the speeds of the cell; the own car's would be at CP_TRACK_MEET_M along its line when they meet.
 * Lines are as long as CP_TRACK_LENGTH_M, to rounding, and kept apart cell from cell by
 * CP_TRACK_APART_M. */

#define CP_TRACK_MEET_M 300.0
#define CP_TRACK_LENGTH_M 600.0
#define CP_TRACK_APART_M 1000.0
#define CP_TRACK_POINTS 100
#define CP_TRACK_BRAKES_AT_S 2.0 /* encounter braking: from then on the target brakes */

/* One car: its line, and where its front begins on it. */
typedef struct cp_track_line {
    cp_vec2 point_m[CP_TRACK_POINTS];
    size_t count;
    double start_m;
    double speed_m_s;
    double stop_m; /* it brakes to a stop there; INFINITY: it does not */
} cp_track_line;

typedef struct cp_cell_tracks {
    cp_track_line own, target;
    bool is_opposite;         /* the target's road leads back between the own road's ends */
    double deceleration_m_s2; /* of the target's stop */
} cp_cell_tracks;

void cp_tracks_of(const cp_matrix *matrix, size_t cell, cp_cell_tracks *tracks);

#endif
