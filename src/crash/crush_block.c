/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/crush_block.h"

#include <math.h>

// What the rate multiplies: the force of the collapse, not of a stop.
static double collapse_force(const cp_crush_block *block)
{
    return fmin(cp_crush_loading_force(&block->law, block->s_m),
                cp_crush_collapse_force(&block->law));
}

cp_crush_loading cp_crush_block_resistance(const cp_crush_block *block, double slip_m,
                                           double time_step_s)
{
    cp_crush_loading at = cp_crush_loading_at(&block->law, block->s_m + slip_m);
    cp_strain_rate rate = cp_strain_rate_at(block->rate_gain_1, slip_m / time_step_s);
    double collapse_n = collapse_force(block);
    at.force_n = block->share_1 * (at.force_n + (rate.factor_1 - 1.0) * collapse_n);
    at.slope_n_m = block->share_1 * (at.slope_n_m + rate.slope_s_m * collapse_n / time_step_s);
    return at;
}

cp_crush_loading cp_crush_block_side_resistance(const cp_crush_block *block, double slip_m)
{
    return cp_crush_loading_at(&block->side_law, block->side_way_m + fabs(slip_m));
}

void cp_crush_block_settle(cp_crush_block *block, double time_step_s)
{
    if (block->slip_m > 0.0) {
        double factor_1 = cp_strain_rate_factor(block->rate_gain_1, block->slip_m / time_step_s);
        block->rate_j += block->share_1 * (factor_1 - 1.0) * collapse_force(block) * block->slip_m;
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
