/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef MATRIX_MATRIX_FILE_H
#define MATRIX_MATRIX_FILE_H

#include "control/control.h"

/* A matrix of encounters of two cars, as its YAML file describes it: what kind of encounter, which
 * of its parameters take which values, and the functions of the own car. Its cells are all
 * combinations of the values. */

/* X(symbol, text): how the two meet. Own car: front at (0, 0) heading along x when they would meet.
 */
#define CP_ENCOUNTERS(X)                                                                           \
    X(CP_ENCOUNTER_REAR_END, "rear_end") /* the target is ahead in the same direction */           \
    X(CP_ENCOUNTER_BRAKING, "braking")   /* the same, and brakes to a stop from 2 s on */          \
    X(CP_ENCOUNTER_HEAD_ON, "head_on")   /* it comes the other way */                              \
    X(CP_ENCOUNTER_CROSSING, "crossing") /* it crosses at a right angle */                         \
    X(CP_ENCOUNTER_TURNING, "turning")   /* the own car turns left across its way */

typedef enum cp_encounter {
#define CP_ENCOUNTER_NAME(symbol, text) symbol,
    CP_ENCOUNTERS(CP_ENCOUNTER_NAME)
#undef CP_ENCOUNTER_NAME
        CP_ENCOUNTER_COUNT
} cp_encounter;

/* X(symbol, name, default, smallest, largest, what). */
#define CP_CELL_PARAMETERS(X)                                                                      \
    X(CP_CELL_OWN_KM_H, "own_km_h", 50, 1, 130, "speed of the own car")                            \
    X(CP_CELL_TARGET_KM_H, "target_km_h", 0, 0, 130, "speed of the target")                        \
    X(CP_CELL_OFFSET_1, "offset_1", 0, -0.99, 0.99,                                                \
      "rear_end, braking, head_on: the target's middle this many widths left of the own car's")    \
    X(CP_CELL_IMPACT_1, "impact_1", 0.5, 0, 1,                                                     \
      "crossing, turning: where on the target's length the middle of the own front would strike, " \
      "0 its front, 1 its rear")                                                                   \
    X(CP_CELL_FROM_LEFT_1, "from_left_1", 0, 0, 1, "crossing: 1: the target comes from the left")  \
    X(CP_CELL_RADIUS_M, "radius_m", 10, 3.5, 100, "turning: of the own front's path")              \
    X(CP_CELL_LANE_M, "lane_m", 3.5, 2, 10, "turning: from the own lane to the target's")          \
    X(CP_CELL_HEADWAY_M, "headway_m", 12, 1, 100, "braking: from own front to the target's rear")  \
    X(CP_CELL_DECELERATION_M_S2, "target_deceleration_m_s2", 6, 0.5, 9, "braking: of the target")

typedef enum cp_cell_parameter {
#define CP_CELL_NAME(symbol, name, standard, smallest, largest, what) symbol,
    CP_CELL_PARAMETERS(CP_CELL_NAME)
#undef CP_CELL_NAME
        CP_CELL_PARAMETER_COUNT
} cp_cell_parameter;

const char *cp_cell_parameter_name(cp_cell_parameter parameter);

#define CP_MATRIX_AXES 3
#define CP_MATRIX_CELLS 1000

/* A parameter that takes several values. */
typedef struct cp_matrix_axis {
    cp_cell_parameter parameter;
    double *values;
    size_t count; /* >= 1 */
} cp_matrix_axis;

typedef struct cp_matrix {
    char *name;   /* letters, digits, '_', '-', '.' */
    char *source; /* where scenario and figures come from, or that they are assumed */
    cp_encounter encounter;
    double step_length_s;                  /* default 0.01; [0.001, 0.1] */
    double lead_s;                         /* the run begins that long before they would meet; 6 */
    double length_m, width_m;              /* of both cars; 4.5, 1.8 */
    char *model;                           /* vehicle model of both; default honda_accord_2014 */
    double fixed[CP_CELL_PARAMETER_COUNT]; /* where no axis has it */
    cp_matrix_axis axis[CP_MATRIX_AXES];   /* the last changes fastest */
    size_t axis_count;
    cp_control_settings *functions; /* of the own car; may be none */
    size_t function_count;
} cp_matrix;

/* Load and check. Errors: CP_BAD_INPUT "file:line: ..."; CP_NO_MEMORY. After an error it is
 * destroyed already. */
CP_MUST_CHECK cp_status cp_matrix_load(const char *path, cp_matrix *matrix, cp_error *error);
void cp_matrix_destroy(cp_matrix *matrix);

size_t cp_matrix_cells(const cp_matrix *matrix);
/* Parameters of cell k. */
void cp_matrix_cell(const cp_matrix *matrix, size_t k, double parameter[CP_CELL_PARAMETER_COUNT]);

#endif
