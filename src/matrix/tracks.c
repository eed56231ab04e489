/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "matrix/tracks.h"

#include "core/units.h"

#include <math.h>

#define ARC_STEPS 90
#define BEYOND_M (CP_TRACK_LENGTH_M - CP_TRACK_MEET_M)

// A straight line that passes a point, CP_TRACK_MEET_M along it, with a heading.
static void lay_straight(cp_track_line *line, cp_vec2 at_m, double heading_rad)
{
    cp_vec2 along = cp_vec2_heading(heading_rad);
    line->point_m[0] = cp_vec2_add(at_m, cp_vec2_scale(along, -CP_TRACK_MEET_M));
    line->point_m[1] = cp_vec2_add(at_m, cp_vec2_scale(along, BEYOND_M));
    line->count = 2;
}

static void add(cp_track_line *line, cp_vec2 point_m, double *length_m)
{
    if (line->count > 0)
        *length_m += cp_vec2_length(cp_vec2_sub(point_m, line->point_m[line->count - 1]));
    line->point_m[line->count++] = point_m;
}

// Straight along x, a quarter of a circle to the left, straight on: so that the front is at
// CP_TRACK_MEET_M, and x = 0, when it has come meet_y_m to the left.
static void lay_turn(cp_track_line *line, double radius_m, double meet_y_m)
{
    double meet_rad = acos(1.0 - meet_y_m / radius_m), length_m = 0.0, met_m = 0.0;
    double begin_x_m = -radius_m * sin(meet_rad);
    line->count = 0;
    add(line, (cp_vec2){begin_x_m - CP_TRACK_MEET_M, 0.0}, &length_m);
    add(line, (cp_vec2){begin_x_m, 0.0}, &length_m);
    for (int k = 1; k <= ARC_STEPS; k++) {
        double before_rad = 0.5 * CP_PI * (k - 1) / ARC_STEPS,
               now_rad = 0.5 * CP_PI * k / ARC_STEPS;
        // The place where they meet is a corner too.
        if (before_rad < meet_rad && meet_rad <= now_rad) {
            add(line, (cp_vec2){0.0, meet_y_m}, &length_m);
            met_m = length_m;
        }
        if (now_rad != meet_rad)
            add(line,
                (cp_vec2){begin_x_m + radius_m * sin(now_rad), radius_m * (1.0 - cos(now_rad))},
                &length_m);
    }
    // The first piece is as long as makes it CP_TRACK_MEET_M, the last as makes it whole.
    line->point_m[0].x += met_m - CP_TRACK_MEET_M;
    double so_far_m = length_m + CP_TRACK_MEET_M - met_m;
    cp_vec2 end_m = line->point_m[line->count - 1];
    add(line, (cp_vec2){end_m.x, end_m.y + CP_TRACK_LENGTH_M - so_far_m}, &length_m);
}

static void lay_rear_end(const cp_matrix *matrix, const double *parameter, cp_cell_tracks *tracks)
{
    double side_m = parameter[CP_CELL_OFFSET_1] * matrix->width_m;
    lay_straight(&tracks->target, (cp_vec2){0.0, side_m}, 0.0);
    tracks->target.start_m =
        CP_TRACK_MEET_M + matrix->length_m - tracks->target.speed_m_s * matrix->lead_s;
}

// Both as fast, apart by the headway, in the first third of the lines.
static void lay_braking(const cp_matrix *matrix, const double *parameter, cp_cell_tracks *tracks)
{
    double speed_m_s = tracks->own.speed_m_s;
    lay_rear_end(matrix, parameter, tracks);
    tracks->target.speed_m_s = speed_m_s;
    tracks->deceleration_m_s2 = parameter[CP_CELL_DECELERATION_M_S2];
    tracks->own.start_m = CP_TRACK_MEET_M - speed_m_s * matrix->lead_s;
    tracks->target.start_m = tracks->own.start_m + parameter[CP_CELL_HEADWAY_M] + matrix->length_m;
    tracks->target.stop_m = tracks->target.start_m + speed_m_s * CP_TRACK_BRAKES_AT_S +
                            speed_m_s * speed_m_s / (2.0 * tracks->deceleration_m_s2);
}

static void lay_head_on(const cp_matrix *matrix, const double *parameter, cp_cell_tracks *tracks)
{
    double side_m = parameter[CP_CELL_OFFSET_1] * matrix->width_m;
    lay_straight(&tracks->target, (cp_vec2){0.0, side_m}, CP_PI);
    tracks->is_opposite = true;
    tracks->target.start_m = CP_TRACK_MEET_M - tracks->target.speed_m_s * matrix->lead_s;
}

// The target's near side passes x = 0; its front is past the middle of the own car by as much as
// lies before the place that would be struck.
static void lay_crossing(const cp_matrix *matrix, const double *parameter, cp_cell_tracks *tracks)
{
    double heading_rad = parameter[CP_CELL_FROM_LEFT_1] >= 0.5 ? -0.5 * CP_PI : 0.5 * CP_PI;
    lay_straight(&tracks->target, (cp_vec2){0.5 * matrix->width_m, 0.0}, heading_rad);
    tracks->target.start_m = CP_TRACK_MEET_M + parameter[CP_CELL_IMPACT_1] * matrix->length_m -
                             tracks->target.speed_m_s * matrix->lead_s;
}

static void lay_turning(const cp_matrix *matrix, const double *parameter, cp_cell_tracks *tracks)
{
    double lane_m = parameter[CP_CELL_LANE_M];
    lay_turn(&tracks->own, parameter[CP_CELL_RADIUS_M], lane_m - 0.5 * matrix->width_m);
    lay_straight(&tracks->target, (cp_vec2){0.0, lane_m}, CP_PI);
    tracks->target.start_m = CP_TRACK_MEET_M + parameter[CP_CELL_IMPACT_1] * matrix->length_m -
                             tracks->target.speed_m_s * matrix->lead_s;
}

void cp_tracks_of(const cp_matrix *matrix, size_t cell, cp_cell_tracks *tracks)
{
    double parameter[CP_CELL_PARAMETER_COUNT];
    cp_matrix_cell(matrix, cell, parameter);
    *tracks = (cp_cell_tracks){0};
    tracks->own.speed_m_s = parameter[CP_CELL_OWN_KM_H] / 3.6;
    tracks->target.speed_m_s = parameter[CP_CELL_TARGET_KM_H] / 3.6;
    tracks->own.stop_m = tracks->target.stop_m = INFINITY;
    lay_straight(&tracks->own, (cp_vec2){0.0, 0.0}, 0.0);
    tracks->own.start_m = CP_TRACK_MEET_M - tracks->own.speed_m_s * matrix->lead_s;
    static void (*const LAY[CP_ENCOUNTER_COUNT])(const cp_matrix *, const double *,
                                                 cp_cell_tracks *) = {
        [CP_ENCOUNTER_REAR_END] = lay_rear_end, [CP_ENCOUNTER_BRAKING] = lay_braking,
        [CP_ENCOUNTER_HEAD_ON] = lay_head_on,   [CP_ENCOUNTER_CROSSING] = lay_crossing,
        [CP_ENCOUNTER_TURNING] = lay_turning,
    };
    LAY[matrix->encounter](matrix, parameter, tracks);
    // Each cell has a place of its own.
    double up_m = CP_TRACK_APART_M * (double)cell;
    cp_track_line *const lines[2] = {&tracks->own, &tracks->target};
    for (int line = 0; line < 2; line++)
        for (size_t k = 0; k < lines[line]->count; k++)
            lines[line]->point_m[k].y += up_m;
}
