/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_BLOCK_YIELD_H
#define CRASH_BLOCK_YIELD_H

#include "crash/encounter.h"

/* How far the crush blocks of an encounter give way in a step: the slips, >= 0 of every face and
 * either way of every side, at which each block resists what the contact springs press on it, or
 * more where it does not give. All blocks at once, by Newton's method on the set of those that
 * give, so that two blocks that face each other share the way by their own resistances, whatever
 * the order of the pairs. Sets give_m of every touching pair and settles the blocks.
 * The pairs' manifolds and cosines, and the blocks' share_1, must stand. */
void cp_yield_blocks(cp_encounter *encounter, double time_step_s);

#endif
