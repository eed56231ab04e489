/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/crush_block.h"

#include <math.h>

// What the rate multiplies: the force of the collapse, not of a stop.
static double collapse_force(const cp_crush_block *block)
{
    return fmin(cp_crush_loading_force(&block->law, block->s_m),
                cp_crush_collapse_force(&block->law));
}

static double rate_force(const cp_crush_block *block, double slip_m, double time_step_s)
{
    double factor = cp_strain_rate_factor(block->rate_gain_1, slip_m / time_step_s);
    return (factor - 1.0) * collapse_force(block);
}

double cp_crush_block_resistance(const cp_crush_block *block, double slip_m, double time_step_s)
{
    return block->share_1 * (cp_crush_loading_force(&block->law, block->s_m + slip_m) +
                             rate_force(block, slip_m, time_step_s));
}

double cp_crush_block_slope(const cp_crush_block *block, double slip_m, double time_step_s)
{
    double rate_slope = cp_strain_rate_slope(block->rate_gain_1, slip_m / time_step_s);
    return block->share_1 * (cp_crush_loading_slope(&block->law, block->s_m + slip_m) +
                             rate_slope * collapse_force(block) / time_step_s);
}

double cp_crush_block_side_resistance(const cp_crush_block *block, double slip_m)
{
    return cp_crush_loading_force(&block->side_law, block->side_way_m + fabs(slip_m));
}

double cp_crush_block_side_slope(const cp_crush_block *block, double slip_m)
{
    return cp_crush_loading_slope(&block->side_law, block->side_way_m + fabs(slip_m));
}

void cp_crush_block_settle(cp_crush_block *block, double time_step_s)
{
    if (block->slip_m > 0.0) {
        block->rate_j +=
            block->share_1 * rate_force(block, block->slip_m, time_step_s) * block->slip_m;
        block->plastic_j +=
            block->share_1 * (cp_crush_loading_work(&block->law, block->s_m + block->slip_m) -
                              cp_crush_loading_work(&block->law, block->s_m));
        block->s_m += block->slip_m;
    }
    if (block->side_slip_m != 0.0) {
        double way_m = block->side_way_m + fabs(block->side_slip_m);
        block->plastic_j += cp_crush_loading_work(&block->side_law, way_m) -
                            cp_crush_loading_work(&block->side_law, block->side_way_m);
        block->side_way_m = way_m;
        block->side_m += block->side_slip_m;
    }
    block->slip_m = block->side_slip_m = 0.0;
}
