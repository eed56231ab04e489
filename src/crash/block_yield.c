/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/block_yield.h"

#include <string.h>

// A round that moves no block farther than this is the last: a few newtons of any contact.
static const double SETTLED_M = 1e-6;

// Of a contact's stiffness, the least that a block's slope counts: what two blocks in series give
// together is stiff, how they share it is not, and softening laws must not turn the search round.
static const double LEAST_SLOPE_1 = 1e-4;

// Each block that something presses on can give back, and aside.
enum { WAYS_MAX = 2 * 2 * CP_OUTLINES_MAX, ROUNDS = 16, WHOLE_ROUNDS = 6, WAYS_OF_POINT = 4 };

// One way that one block can give, and how it stands in the present round.
typedef struct way {
    cp_crush_block *block;
    bool aside;
    double load_n;    /* what presses that way, signed where aside */
    double excess_n;  /* of the load over the resistance, likewise */
    double slope_n_m; /* of the resistance */
    bool pressed;     /* any contact presses that way */
    bool gives;       /* in this round */
    double gap_m;     /* not pressed though it gave: the depth, <= 0, of its nearest point */
    int gap_pair;     /* and where that is */
    int gap_point;
} way;

typedef struct yielding {
    cp_encounter *encounter;
    double time_step_s;
    way way[WAYS_MAX];
    int count;
    int of[2][CP_OUTLINES_MAX][2]; /* number of the way back, aside, of a party's outline; -1 */
    double stiffness_n_m[WAYS_MAX][WAYS_MAX]; /* of all contacts over all ways */
    double largest_n_m;                       /* stiffest contact */
} yielding;

// How a contact point answers to the ways of the two blocks it lies between.
typedef struct point_ways {
    int count;
    int index[WAYS_OF_POINT];
    double cosine[WAYS_OF_POINT]; /* depth lost for a metre of slip */
} point_ways;

static void add_way(yielding *all, int party, int outline, bool aside)
{
    int *index = &all->of[party][outline][aside];
    if (*index >= 0)
        return;
    *index = all->count;
    all->way[all->count++] =
        (way){.block = cp_encounter_block(all->encounter, party, outline), .aside = aside};
}

static cp_encounter_pair *touching_pair(const yielding *all, int touch)
{
    const int *index = all->encounter->touching[touch].outline;
    return &all->encounter->pair[index[0]][index[1]];
}

// All ways that the touching pairs press on.
static void find_ways(yielding *all)
{
    memset(all->of, -1, sizeof all->of);
    for (int k = 0; k < all->encounter->touching_count; k++) {
        const int *index = all->encounter->touching[k].outline;
        const cp_encounter_pair *pair = touching_pair(all, k);
        for (int party = 0; party < 2; party++) {
            const cp_crush_block *block = cp_encounter_block(all->encounter, party, index[party]);
            if (block != NULL && pair->cosine[party] > 0.0)
                add_way(all, party, index[party], false);
            if (block != NULL && block->side_law.points > 0 && pair->side_cosine[party] != 0.0)
                add_way(all, party, index[party], true);
        }
    }
}

static point_ways ways_of_pair(const yielding *all, int touch)
{
    const int *index = all->encounter->touching[touch].outline;
    const cp_encounter_pair *pair = touching_pair(all, touch);
    point_ways ways = {0};
    for (int party = 0; party < 2; party++) {
        const double cosine[2] = {fmax(0.0, pair->cosine[party]), pair->side_cosine[party]};
        for (int aside = 0; aside < 2; aside++) {
            int number = all->of[party][index[party]][aside];
            if (number < 0 || cosine[aside] == 0.0)
                continue;
            ways.index[ways.count] = number;
            ways.cosine[ways.count++] = cosine[aside];
        }
    }
    return ways;
}

static double slip_of(const way *one)
{
    return one->aside ? one->block->side_slip_m : one->block->slip_m;
}

// Force and stiffness of one contact point, pressed or (for a way that gave too much) about to be.
static void add_point(yielding *all, const point_ways *ways, double stiffness_n_m, double depth_m)
{
    for (int i = 0; i < ways->count; i++) {
        int row = ways->index[i];
        all->way[row].load_n += stiffness_n_m * depth_m * ways->cosine[i];
        for (int j = 0; j < ways->count; j++)
            all->stiffness_n_m[row][ways->index[j]] +=
                stiffness_n_m * ways->cosine[i] * ways->cosine[j];
    }
}

// Note the nearest point of ways that nothing presses on any more.
static void note_gap(yielding *all, const point_ways *ways, int touch, int point, double depth_m)
{
    for (int i = 0; i < ways->count; i++) {
        way *one = &all->way[ways->index[i]];
        if (depth_m <= one->gap_m)
            continue;
        one->gap_m = depth_m;
        one->gap_pair = touch;
        one->gap_point = point;
    }
}

// What presses on every way now.
static void load_ways(yielding *all)
{
    for (int i = 0; i < all->count; i++) {
        all->way[i].load_n = 0.0;
        all->way[i].pressed = false;
        all->way[i].gap_m = -INFINITY;
        memset(all->stiffness_n_m[i], 0, (size_t)all->count * sizeof all->stiffness_n_m[i][0]);
    }
    for (int k = 0; k < all->encounter->touching_count; k++) {
        const cp_encounter_pair *pair = touching_pair(all, k);
        point_ways ways = ways_of_pair(all, k);
        double stiffness_n_m = cp_manifold_point_weight(&pair->manifold) * pair->stiffness_n_m;
        for (int point = 0; ways.count > 0 && point < pair->manifold.count; point++) {
            double depth_m = pair->manifold.point[point].depth_m - pair->give_m;
            if (depth_m <= 0.0) {
                note_gap(all, &ways, k, point, depth_m);
                continue;
            }
            add_point(all, &ways, stiffness_n_m, depth_m);
            all->largest_n_m = fmax(all->largest_n_m, stiffness_n_m);
            for (int i = 0; i < ways.count; i++)
                all->way[ways.index[i]].pressed = true;
        }
    }

    // What has given too much comes back to its nearest point.
    for (int i = 0; i < all->count; i++) {
        const way *one = &all->way[i];
        if (one->pressed || slip_of(one) == 0.0 || isinf(one->gap_m))
            continue;
        const cp_encounter_pair *pair = touching_pair(all, one->gap_pair);
        point_ways ways = ways_of_pair(all, one->gap_pair);
        add_point(all, &ways, cp_manifold_point_weight(&pair->manifold) * pair->stiffness_n_m,
                  one->gap_m);
    }
}

// What every way resists, and whether it gives in this round.
static void resist(yielding *all)
{
    for (int i = 0; i < all->count; i++) {
        way *one = &all->way[i];
        double slip_m = slip_of(one);
        cp_crush_loading own =
            one->aside ? cp_crush_block_side_resistance(one->block, slip_m)
                       : cp_crush_block_resistance(one->block, slip_m, all->time_step_s);
        double sign = one->aside ? copysign(1.0, slip_m != 0.0 ? slip_m : one->load_n) : 1.0;
        one->excess_n = one->load_n - sign * own.force_n;
        one->slope_n_m = fmax(own.slope_n_m, LEAST_SLOPE_1 * all->largest_n_m);
        one->gives = slip_m != 0.0 || sign * one->excess_n > 0.0;
    }
}

// Cholesky's factors of the stiffness over the ways that give, and the slips that balance them.
static void solve(const yielding *all, double move_m[])
{
    static const double NEAR_ZERO = 1e-12;
    double factor[WAYS_MAX][WAYS_MAX];
    int index[WAYS_MAX], count = 0;
    for (int i = 0; i < all->count; i++)
        if (all->way[i].gives)
            index[count++] = i;
    for (int i = 0; i < count; i++) {
        for (int j = 0; j <= i; j++) {
            double sum = all->stiffness_n_m[index[i]][index[j]];
            if (i == j)
                sum += all->way[index[i]].slope_n_m;
            for (int k = 0; k < j; k++)
                sum -= factor[i][k] * factor[j][k];
            factor[i][j] = i == j ? sqrt(fmax(NEAR_ZERO, sum)) : sum / factor[j][j];
        }
    }
    double value[WAYS_MAX];
    for (int i = 0; i < count; i++) {
        double sum = all->way[index[i]].excess_n;
        for (int k = 0; k < i; k++)
            sum -= factor[i][k] * value[k];
        value[i] = sum / factor[i][i];
    }
    for (int i = count - 1; i >= 0; i--) {
        for (int k = i + 1; k < count; k++)
            value[i] -= factor[k][i] * value[k];
        value[i] /= factor[i][i];
    }
    for (int i = 0; i < all->count; i++)
        move_m[i] = 0.0;
    for (int i = 0; i < count; i++)
        move_m[index[i]] = value[i];
}

// Move the slips by a share of the way, none in one round beyond where nothing would press on it;
// returns the farthest that any moved.
static double move(yielding *all, const double move_m[], double share_1)
{
    double farthest_m = 0.0;
    for (int i = 0; i < all->count; i++) {
        way *one = &all->way[i];
        if (!one->gives)
            continue;
        double most_m = fabs(one->load_n) / all->stiffness_n_m[i][i];
        double before_m = slip_of(one), sign = 1.0;
        double after_m = before_m + fmin(most_m, share_1 * move_m[i]);
        if (one->aside)
            after_m = before_m + fmax(-most_m, fmin(most_m, share_1 * move_m[i]));
        if (one->aside)
            sign = copysign(1.0, before_m != 0.0 ? before_m : one->load_n);
        after_m = sign * fmax(0.0, sign * after_m);
        *(one->aside ? &one->block->side_slip_m : &one->block->slip_m) = after_m;
        farthest_m = fmax(farthest_m, fabs(after_m - before_m));
    }
    return farthest_m;
}

// What the blocks of every touching pair give along its normal.
static void share_slip(yielding *all)
{
    for (int k = 0; k < all->encounter->touching_count; k++) {
        cp_encounter_pair *pair = touching_pair(all, k);
        point_ways ways = ways_of_pair(all, k);
        pair->give_m = 0.0;
        for (int i = 0; i < ways.count; i++)
            pair->give_m += slip_of(&all->way[ways.index[i]]) * ways.cosine[i];
    }
}

void cp_yield_blocks(cp_encounter *encounter, double time_step_s)
{
    yielding all;
    all.encounter = encounter;
    all.time_step_s = time_step_s;
    all.count = 0;
    all.largest_n_m = 0.0;
    find_ways(&all);

    // Whole steps settle all but contacts that come and go: half steps for those.
    for (int round = 0; all.count > 0 && round < ROUNDS; round++) {
        double move_m[WAYS_MAX];
        load_ways(&all);
        resist(&all);
        solve(&all, move_m);
        double moved_m = move(&all, move_m, round < WHOLE_ROUNDS ? 1.0 : 0.5);
        share_slip(&all);
        if (moved_m < SETTLED_M)
            break;
    }
    for (int i = 0; i < all.count; i++)
        cp_crush_block_settle(all.way[i].block, time_step_s);
}
