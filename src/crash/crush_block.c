/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/crush_block.h"

#include <math.h>

// What resists per m/s of crush rate: the damper, and a share of the collapse force (not of a
// stop).
static double rate_coefficient(const cp_crush_block *block)
{
    double collapse_n = fmin(cp_crush_loading_force(&block->law, block->s_m),
                             fmax(block->law.begin_n, block->law.end_n));
    return block->damping_n_s_m + block->rate_s_m * collapse_n;
}

double cp_crush_block_resistance(const cp_crush_block *block, double slip_m, double time_step_s)
{
    return cp_crush_loading_force(&block->law, block->s_m + slip_m) +
           rate_coefficient(block) * slip_m / time_step_s;
}

double cp_crush_block_slope(const cp_crush_block *block, double slip_m, double time_step_s)
{
    return cp_crush_loading_slope(&block->law, block->s_m + slip_m) +
           rate_coefficient(block) / time_step_s;
}

void cp_crush_block_settle(cp_crush_block *block, double time_step_s)
{
    if (block->slip_m <= 0.0)
        return;
    block->damping_j += rate_coefficient(block) * block->slip_m * block->slip_m / time_step_s;
    block->plastic_j += cp_crush_loading_work(&block->law, block->s_m + block->slip_m) -
                        cp_crush_loading_work(&block->law, block->s_m);
    block->s_m += block->slip_m;
    block->slip_m = 0.0;
}
