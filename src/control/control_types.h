/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_CONTROL_TYPES_H
#define CONTROL_CONTROL_TYPES_H

#include "control/control.h"

/* The table of all controls, each defined in a file of this folder (driver errors in
 * driver_error/). X(symbol). */
#define CP_CONTROL_ROWS(X)                                                                         \
    /* looked but failed to see: a driver overlooks certain others at junctions */                 \
    X(CP_CONTROL_FAILED_TO_SEE)                                                                    \
    /* a share of drivers overtakes with too little room */                                        \
    X(CP_CONTROL_RISKY_OVERTAKING)                                                                 \
    /* inattention: the car drifts off its lane */                                                 \
    X(CP_CONTROL_LANE_DRIFT)                                                                       \
    /* a driver takes a gap at a junction for larger than it is */                                 \
    X(CP_CONTROL_MISJUDGED_GAP)                                                                    \
    /* a share of drivers runs red lights */                                                       \
    X(CP_CONTROL_RED_LIGHT)                                                                        \
    /* a driver looks up late and brakes weakly */                                                 \
    X(CP_CONTROL_LATE_BRAKING)                                                                     \
    /* automatic emergency braking */                                                              \
    X(CP_CONTROL_AEB)                                                                              \
    /* forward collision warning: the driver brakes after a reaction time */                       \
    X(CP_CONTROL_FCW)                                                                              \
    /* emergency lane keeping against drifting into oncoming traffic */                            \
    X(CP_CONTROL_ELK)                                                                              \
    /* intelligent speed assistance: limits the speed */                                           \
    X(CP_CONTROL_ISA)                                                                              \
    /* a function from a library that the study names */                                           \
    X(CP_CONTROL_PLUGIN)

#define CP_CONTROL_DECLARE(symbol) extern const cp_control_type symbol;
CP_CONTROL_ROWS(CP_CONTROL_DECLARE)
#undef CP_CONTROL_DECLARE

#endif
