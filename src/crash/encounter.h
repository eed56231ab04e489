/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_ENCOUNTER_H
#define CRASH_ENCOUNTER_H

#include "crash/front_structure.h"

/* Contact between the two parties of a crash: finds touching outlines and pushes them apart at
 * their contact points, equally and oppositely, with Coulomb friction. Stiffness and damping of a
 * pair act in series, so two equal cars meet as each would meet a rigid wall.
 *
 * Friction is a tangential spring per pair of outlines that slides where it would exceed Coulomb's
 * limit (Cundall and Strack 1979), so that bodies can really stick.
 *
 * Applied forces rather than ODE contact joints: the joints of a car then form a system without
 * inequalities, which ODE solves by one factorisation, and two cars stay two independent systems.
 * Crush blocks give way where the contact springs press on them harder than they resist. What one
 * block gives depends on all that presses on it at once, never on the order of the pairs. It
 * resists by the share of its face that is covered, a single point counting as CP_CONTACT_PATCH_M,
 * less where it lies nearer to the block's edge than half of that.
 *
 * The upper load path (radiator support, hood, upper rails) lies above the cross members: those of
 * two cars pass each other, so that each front meets its like.
 *
 * Damping is limited to what stops the touching bodies within a step, so it only ever dissipates.
 */

/* One pair of outlines and its contact of the present step. */
typedef struct cp_encounter_pair {
    dBodyID body[2];  /* [1] NULL: the barrier */
    bool never_meets; /* they lie above each other */
    double stiffness_n_m;
    double damping_n_s_m;
    cp_manifold manifold;    /* count 0: not touching */
    cp_vec2 relative_m_s[3]; /* of [0] against [1] at the two points and at the friction point */
    double cosine[2];        /* of the push on the block of [0], [1] against its face; 0: none */
    double side_cosine[2];   /* of the same push to the block's left; 0: none */
    double give_m;           /* along the normal, by which blocks give way in this step */
    double press_n[2];       /* normal force at the two points */
    cp_vec2 friction_at_m;   /* where friction acts: the middle of the pressure */
    double drag_n;           /* friction force on [1] along the tangent */
    double stuck_m;          /* displacement of the friction spring; memory between steps */
} cp_encounter_pair;

/* Numbers of the two outlines of a pair that touches in the present step. */
typedef struct cp_touch {
    int outline[2];
} cp_touch;

typedef struct cp_encounter {
    cp_car *car[2]; /* [1] NULL against the barrier */
    cp_outline barrier;
    double friction_1;
    cp_encounter_pair pair[CP_OUTLINES_MAX][CP_OUTLINES_MAX]; /* [outline of a][of b] */
    cp_touch touching[CP_OUTLINES_MAX * CP_OUTLINES_MAX];     /* in the order of the pairs */
    int touching_count;
    double friction_work_j;  /* put into friction so far, stored and dissipated */
    double normal_work_j;    /* put into contact springs and dampers so far */
    double elastic_normal_j; /* stored in contact springs now */
    double elastic_friction_j;
} cp_encounter;

/* Smallest distance of the outlines of the two parties, each displaced by a translation and by a
 * turn about its centre of gravity: rigid extrapolation. INFINITY if it is not below limit_m. */
typedef struct cp_displacement {
    cp_vec2 shift_m;
    double turn_rad;
} cp_displacement;
double cp_encounter_distance(const cp_encounter *encounter, const cp_displacement displacement[2],
                             double limit_m);

/* Once both parties are set: stiffness and damping of every pair. */
void cp_encounter_set_pairs(cp_encounter *encounter);

/* The crush block whose outline it is; NULL: the outline of something else, or the barrier. */
cp_crush_block *cp_encounter_block(const cp_encounter *encounter, int party, int outline);

/* Detect contact and put its forces on the bodies for the coming step. */
void cp_encounter_apply_forces(cp_encounter *encounter, double time_step_s);
/* After the step: work done; returns the sum of the forces that the contacts pressed with, N. */
double cp_encounter_end_step(cp_encounter *encounter, double time_step_s);

#endif
