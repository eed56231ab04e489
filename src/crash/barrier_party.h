/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_BARRIER_PARTY_H
#define CRASH_BARRIER_PARTY_H

#include "crash/front_structure.h"

/* A barrier that moves or has a deformable face, as a party of a crash: one rigid body with its
 * centre of gravity in its middle, in front of it the face as crush blocks side by side
 * (crash/crush_block.h), each a share of cp_barrier_face_law(). It keeps momentum and energy as a
 * car does; a fixed one is heavy instead. model: cp_vehicle_model_of_barrier(). */
void cp_barrier_party_build(cp_car *car, const cp_vehicle_model *model, dWorldID world,
                            const cp_body_state *state);

#endif
