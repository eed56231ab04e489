/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef EXCHANGE_SUMO_FCD_H
#define EXCHANGE_SUMO_FCD_H

#include "core/geometry.h"
#include "exchange/sumo_collisions.h"

#include <stdbool.h>
#include <stdint.h>

/* The ways of colliding vehicles out of a SUMO run's --fcd-output. SUMO's frame becomes ours here:
 * headings counter-clockwise from +x, rad. */

typedef struct cp_fcd_sample {
    double time_s;
    cp_vec2 front_m; /* middle of the front bumper */
    double yaw_rad;
    double speed_m_s;
    double lane_position_m; /* NAN where the file does not tell */
    size_t lane;            /* index in lanes of the record; CP_FCD_NO_LANE likewise */
} cp_fcd_sample;

#define CP_FCD_NO_LANE SIZE_MAX

/* One vehicle around one collision, in order of time. */
typedef struct cp_fcd_track {
    cp_fcd_sample *sample;
    size_t count;
    char *type; /* the vehicle's, where the list of collisions does not tell and the record does */
} cp_fcd_track;

typedef struct cp_fcd_record {
    cp_fcd_track (*track)[2]; /* one pair of tracks for each collision of the list */
    size_t collision_count;
    char **lanes; /* names of SUMO's lanes, each once */
    size_t lane_count;
    double step_length_s; /* between the time steps of the file */
    double simulated_s;   /* from the first to the last */
    double vehicle_km;    /* driven by all vehicles of the file, by their speeds; 0 without one */
    double vehicle_h;
    size_t departed; /* different vehicles in the file */
    bool of_places; /* from the collision output alone (sumo_places.h): ways begin at the reports */
} cp_fcd_record;

#define CP_FCD_COARSEST_PERIOD_S 0.25

/* Append, in order of time. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_fcd_track_append(cp_fcd_track *track, cp_fcd_sample sample,
                                            cp_error *error);
void cp_fcd_track_destroy(cp_fcd_track *track);

/* Read a file: of each listed collision both vehicles from before_s before its first report to
 * after_s after its last one. The caller destroys. A record coarser than SUMO's own steps is told,
 * one coarser than CP_FCD_COARSEST_PERIOD_S refused. Errors: CP_BAD_INPUT with file, line,
 * attribute, also for time steps that do not follow each other at one distance or multiples of it,
 * fewer than two of them, or a file written with --fcd-output.geo; CP_NO_MEMORY. After an error the
 * record is destroyed already. */
CP_MUST_CHECK cp_status cp_sumo_fcd_read(const char *path, const cp_collision_list *list,
                                         double before_s, double after_s, cp_fcd_record *record,
                                         cp_error *error);
void cp_fcd_record_destroy(cp_fcd_record *record);

#endif
