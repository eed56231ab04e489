/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_CRUSH_BLOCK_H
#define CRASH_CRUSH_BLOCK_H

#include "crash/crush_element.h"

/* A massless part of the front that is pushed in where something presses on it and stays there:
 * outboard corner (fender, wheel), upper load path (radiator support, hood, upper rails). Its face
 * moves along the car's x axis only; sideways it passes on what it meets. It carries what presses
 * on it elastically (by the stiffness of the contact) up to its resistance, then gives way. Used
 * up, it rests on the passenger cell: its stop is the stiffness of the body there, and its face
 * goes on into the cell.
 *
 * Resistance at slip d within a step dt: F(s + d) + (c + kappa F) d / dt, F the loading curve of a
 * crush element (its collapse only for the rate), c a damper, kappa the rate share. */
typedef struct cp_crush_block {
    cp_crush_law law;
    double damping_n_s_m;
    double rate_s_m;
    double s_m;       /* permanent crush so far */
    double slip_m;    /* of the present step */
    double plastic_j; /* dissipated so far by the collapse */
    double damping_j; /* and by what its rate adds */
} cp_crush_block;

/* Resistance after slip_m in a step, and its slope over the slip. */
double cp_crush_block_resistance(const cp_crush_block *block, double slip_m, double time_step_s);
double cp_crush_block_slope(const cp_crush_block *block, double slip_m, double time_step_s);

/* Take the present step's slip into the permanent crush and account for its work. */
void cp_crush_block_settle(cp_crush_block *block, double time_step_s);

#endif
