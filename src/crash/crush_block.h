/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_CRUSH_BLOCK_H
#define CRASH_CRUSH_BLOCK_H

#include "crash/crush_element.h"

/* A massless part of the front that is pushed in where something presses on it and stays there:
 * outboard corner (fender, wheel), upper load path (radiator support, hood, upper rails). It
 * carries what presses on it elastically (by the stiffness of the contact) up to its resistance,
 * then gives way: its face back along the car's x axis, and all of it sideways (a wheel is torn
 * from its suspension). Used up, it rests on the passenger cell: its stop is the stiffness of the
 * body there, the cell behind it yields at the law's plateau, and what is left of the block goes on
 * into it.
 *
 * Resistance at slip d within a step dt: w (F(s + d) + (f(d / dt) - 1) C), with F the loading curve
 * of a crush element, C the smaller of F and its largest collapse force, f the strain-rate factor
 * and w the share of the face that is pressed on. Sideways: the same without rate and share, over
 * the way it has been pushed aside, in either direction. */
typedef struct cp_crush_block {
    cp_crush_law law;
    cp_crush_law side_law; /* points 0: what presses on a side meets the contact's stiffness only */
    double full_width_m;   /* width that must be pressed on for the whole of the law */
    double rate_gain_1;    /* of cp_strain_rate_factor */
    double share_1;        /* of its face pressed on in the present step, in (0, 1] */
    double s_m;            /* permanent crush so far */
    double slip_m;         /* of the present step, >= 0 */
    double side_m;         /* permanent displacement to the left so far */
    double side_way_m;     /* all ways it was pushed aside together */
    double side_slip_m;    /* of the present step, to the left */
    double plastic_j;      /* dissipated so far by the collapse, both ways */
    double rate_j;         /* and by what its rate adds */
} cp_crush_block;

/* Resistance after slip_m in a step, and its slope over the slip. */
cp_crush_loading cp_crush_block_resistance(const cp_crush_block *block, double slip_m,
                                           double time_step_s);
/* The same sideways, over the slip of the step in either direction. */
cp_crush_loading cp_crush_block_side_resistance(const cp_crush_block *block, double slip_m);

/* Take the present step's slips into the permanent crush and account for their work. */
void cp_crush_block_settle(cp_crush_block *block, double time_step_s);

#endif
