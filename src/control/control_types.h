/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_CONTROL_TYPES_H
#define CONTROL_CONTROL_TYPES_H

#include "control/control.h"

/* The rows of CP_CONTROL_TYPE, each defined in the file of its name (driver errors in
 * driver_error/). */

/* Looked but failed to see: a driver overlooks certain others at junctions. */
extern const cp_control_type CP_CONTROL_FAILED_TO_SEE;
/* A share of drivers overtakes with too little room. */
extern const cp_control_type CP_CONTROL_RISKY_OVERTAKING;
/* Inattention: the car drifts off its lane. */
extern const cp_control_type CP_CONTROL_LANE_DRIFT;
/* Automatic emergency braking. */
extern const cp_control_type CP_CONTROL_AEB;
/* Forward collision warning: the driver brakes after a reaction time. */
extern const cp_control_type CP_CONTROL_FCW;
/* Intelligent speed assistance: limits the speed. */
extern const cp_control_type CP_CONTROL_ISA;

#endif
