/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/encounter.h"

#include <string.h>

// Number of outlines of a party: a car's, or the barrier's one.
static int outline_count(const cp_encounter *encounter, int party)
{
    return encounter->car[party] != NULL ? encounter->car[party]->outline_count : 1;
}

static cp_outline outline_now(const cp_encounter *encounter, int party, int index)
{
    const cp_car *car = encounter->car[party];
    return car != NULL ? cp_car_outline_now(car, index) : encounter->barrier;
}

static cp_outline displaced(cp_outline outline, cp_vec2 pivot_m, cp_displacement displacement)
{
    cp_vec2 arm = cp_vec2_rotate(cp_vec2_sub(outline.centre_m, pivot_m), displacement.turn_rad);
    outline.centre_m = cp_vec2_add(cp_vec2_add(pivot_m, arm), displacement.shift_m);
    outline.along = cp_vec2_rotate(outline.along, displacement.turn_rad);
    return outline;
}

static cp_vec2 pivot_of(const cp_encounter *encounter, int party)
{
    const cp_car *car = encounter->car[party];
    return car != NULL ? cp_car_cog_state(car).cog_m : encounter->barrier.centre_m;
}

double cp_encounter_distance(const cp_encounter *encounter, const cp_displacement displacement[2],
                             double limit_m)
{
    cp_outline outline[2][CP_OUTLINES_MAX];
    for (int party = 0; party < 2; party++) {
        cp_vec2 pivot_m = pivot_of(encounter, party);
        for (int k = 0; k < outline_count(encounter, party); k++)
            outline[party][k] =
                displaced(outline_now(encounter, party, k), pivot_m, displacement[party]);
    }
    double nearest_m = INFINITY;
    for (int i = 0; i < outline_count(encounter, 0); i++) {
        for (int j = 0; j < outline_count(encounter, 1); j++) {
            double distance_m = cp_outline_distance_below(&outline[0][i], &outline[1][j], limit_m);
            nearest_m = fmin(nearest_m, distance_m);
            limit_m = fmin(limit_m, nearest_m);
        }
    }
    return nearest_m;
}

// Two springs (or dampers) in series; a rigid partner has none.
static double in_series(double one, double other)
{
    if (one <= 0.0 || other <= 0.0)
        return 0.0;
    return isinf(other) ? one : one * other / (one + other);
}

void cp_encounter_set_pairs(cp_encounter *encounter)
{
    for (int i = 0; i < outline_count(encounter, 0); i++) {
        for (int j = 0; j < outline_count(encounter, 1); j++) {
            const cp_car *a = encounter->car[0], *b = encounter->car[1];
            double stiffness_b_n_m = b != NULL ? b->outline[j].stiffness_n_m : (double)INFINITY;
            double damping_b_n_s_m = b != NULL ? b->outline[j].damping_n_s_m : (double)INFINITY;
            encounter->pair[i][j] = (cp_encounter_pair){
                .body = {a->body[a->outline[i].body],
                         b != NULL ? b->body[b->outline[j].body] : NULL},
                .stiffness_n_m = in_series(a->outline[i].stiffness_n_m, stiffness_b_n_m),
                .damping_n_s_m = in_series(a->outline[i].damping_n_s_m, damping_b_n_s_m)};
        }
    }
}

static cp_vec2 relative_velocity(const cp_encounter_pair *pair, cp_vec2 point_m)
{
    cp_vec2 velocity = cp_body_velocity_at(pair->body[0], point_m);
    if (pair->body[1] == NULL)
        return velocity;
    return cp_vec2_sub(velocity, cp_body_velocity_at(pair->body[1], point_m));
}

// Inverse of the mass a push at point_m along direction meets on one free body.
static double inverse_mass(dBodyID body, cp_vec2 point_m, cp_vec2 direction)
{
    if (body == NULL)
        return 0.0;
    dMass mass;
    dBodyGetMass(body, &mass);
    const dReal *p = dBodyGetPosition(body);
    double arm_m = cp_vec2_cross(cp_vec2_sub(point_m, (cp_vec2){p[0], p[1]}), direction);
    return 1.0 / mass.mass + arm_m * arm_m / mass.I[10];
}

// The most a damper may be: two points together stop the bodies, taken alone, within one step.
static double damping_limit(const cp_encounter_pair *pair, cp_vec2 point_m, cp_vec2 direction,
                            double time_step_s)
{
    double inverse_kg = inverse_mass(pair->body[0], point_m, direction) +
                        inverse_mass(pair->body[1], point_m, direction);
    return 0.5 / (inverse_kg * time_step_s);
}

static void push(const cp_encounter_pair *pair, cp_vec2 force_n, cp_vec2 at)
{
    dBodyAddForceAtPos(pair->body[0], -force_n.x, -force_n.y, 0.0, at.x, at.y, 0.0);
    if (pair->body[1] != NULL)
        dBodyAddForceAtPos(pair->body[1], force_n.x, force_n.y, 0.0, at.x, at.y, 0.0);
}

// A pair that touches at two points pushes with both. Near each other they are one patch, no
// stiffer than a single corner: its stiffness grows with the distance of the points up to this.
static const double CONTACT_PATCH_M = 0.12;

static double point_weight(const cp_manifold *manifold)
{
    if (manifold->count < 2)
        return 1.0;
    double apart_m =
        cp_vec2_length(cp_vec2_sub(manifold->point[1].position_m, manifold->point[0].position_m));
    return 0.5 + 0.5 * fmin(1.0, apart_m / CONTACT_PATCH_M);
}

static cp_crush_block *block_of(const cp_encounter *encounter, int party, int index)
{
    cp_car *car = encounter->car[party];
    return car != NULL && car->outline[index].block >= 0 ? &car->block[car->outline[index].block]
                                                         : NULL;
}

// A block gives way only to what presses on its face, not on its sides.
static const double FACE_COSINE = 0.2;

// All that presses on the faces of a party's blocks along their way, and how much that falls per
// metre of slip; facing: whether any of it is a block itself.
typedef struct block_loads {
    double load_n[CP_OUTLINES_MAX];
    double slope_n_m[CP_OUTLINES_MAX];
    bool facing[CP_OUTLINES_MAX];
} block_loads;

static void add_load(const cp_encounter_pair *pair, int party, int own, block_loads *loads)
{
    double cosine = pair->cosine[party], weight = point_weight(&pair->manifold);
    if (cosine < FACE_COSINE)
        return;
    for (int k = 0; k < pair->manifold.count; k++) {
        double depth_m = pair->manifold.point[k].depth_m - pair->give_m;
        if (depth_m <= 0.0)
            continue;
        loads->load_n[own] += weight * pair->stiffness_n_m * depth_m * cosine;
        loads->slope_n_m[own] += weight * pair->stiffness_n_m * cosine * cosine;
        loads->facing[own] = loads->facing[own] || pair->cosine[1 - party] >= FACE_COSINE;
    }
}

// One round: every block takes the slip that balances its load as it is; where two blocks face
// each other each takes half. Returns whether any did.
static bool yield_round(cp_encounter *encounter, double time_step_s, bool *facing)
{
    block_loads loads[2] = {0};
    for (int k = 0; k < encounter->touching_count; k++) {
        const cp_touch *touch = &encounter->touching[k];
        const cp_encounter_pair *pair = &encounter->pair[touch->outline[0]][touch->outline[1]];
        for (int party = 0; party < 2; party++)
            add_load(pair, party, touch->outline[party], &loads[party]);
    }
    bool gave = false;
    *facing = false;
    for (int party = 0; party < 2; party++) {
        for (int k = 0; k < outline_count(encounter, party); k++) {
            cp_crush_block *block = block_of(encounter, party, k);
            if (block == NULL)
                continue;
            double excess_n = loads[party].load_n[k] -
                              cp_crush_block_resistance(block, block->slip_m, time_step_s);
            double slope_n_m =
                loads[party].slope_n_m[k] + cp_crush_block_slope(block, block->slip_m, time_step_s);
            double more_m = slope_n_m > 0.0 ? excess_n / slope_n_m : 0.0;
            bool faces = loads[party].facing[k];
            block->slip_m = fmax(0.0, block->slip_m + (faces ? 0.5 : 1.0) * more_m);
            gave = gave || block->slip_m > 0.0;
            *facing = *facing || faces;
        }
    }
    return gave;
}

// What the blocks of every touching pair give along its normal.
static void share_slip(cp_encounter *encounter)
{
    for (int k = 0; k < encounter->touching_count; k++) {
        const int *index = encounter->touching[k].outline;
        cp_encounter_pair *pair = &encounter->pair[index[0]][index[1]];
        pair->give_m = 0.0;
        for (int party = 0; party < 2; party++) {
            const cp_crush_block *block = block_of(encounter, party, index[party]);
            if (block != NULL && pair->cosine[party] >= FACE_COSINE)
                pair->give_m += block->slip_m * pair->cosine[party];
        }
    }
}

// Blocks give way until what presses on them is what they resist.
static void yield_blocks(cp_encounter *encounter, double time_step_s)
{
    enum { ROUNDS = 2, ROUNDS_FACING = 8 };
    bool facing = false;
    for (int round = 0; round < (facing ? ROUNDS_FACING : ROUNDS); round++) {
        if (!yield_round(encounter, time_step_s, &facing))
            break;
        share_slip(encounter);
    }
    for (int party = 0; party < 2; party++)
        for (int k = 0; k < outline_count(encounter, party); k++)
            if (block_of(encounter, party, k) != NULL)
                cp_crush_block_settle(block_of(encounter, party, k), time_step_s);
}

// Spring and damper of every point; returns the whole pressure, and where its middle is.
static double press(cp_encounter *encounter, cp_encounter_pair *pair, double time_step_s)
{
    const cp_manifold *manifold = &pair->manifold;
    double total_n = 0.0, weight = point_weight(manifold);
    cp_vec2 moment = {0.0, 0.0};
    for (int k = 0; k < manifold->count; k++) {
        cp_vec2 at = manifold->point[k].position_m;
        double depth_m = fmax(0.0, manifold->point[k].depth_m - pair->give_m);
        pair->relative_m_s[k] = relative_velocity(pair, at);
        double damping_n_s_m =
            fmin(pair->damping_n_s_m, damping_limit(pair, at, manifold->normal, time_step_s));
        double force_n = depth_m * pair->stiffness_n_m +
                         damping_n_s_m * cp_vec2_dot(pair->relative_m_s[k], manifold->normal);
        pair->press_n[k] = depth_m > 0.0 ? weight * fmax(0.0, force_n) : 0.0;
        encounter->elastic_normal_j += weight * 0.5 * pair->stiffness_n_m * depth_m * depth_m;
        push(pair, cp_vec2_scale(manifold->normal, pair->press_n[k]), at);
        total_n += pair->press_n[k];
        moment = cp_vec2_add(moment, cp_vec2_scale(at, pair->press_n[k]));
    }
    pair->friction_at_m =
        total_n > 0.0 ? cp_vec2_scale(moment, 1.0 / total_n) : manifold->point[0].position_m;
    return total_n;
}

// Friction spring with a damper, both together within Coulomb's limit; beyond it the spring slides.
static void drag(cp_encounter *encounter, cp_encounter_pair *pair, double pressure_n,
                 double time_step_s)
{
    cp_vec2 tangent = {-pair->manifold.normal.y, pair->manifold.normal.x};
    cp_vec2 at = pair->friction_at_m;
    double limit_n = encounter->friction_1 * pressure_n;
    double slack_m = limit_n / pair->stiffness_n_m;
    pair->stuck_m = fmin(slack_m, fmax(-slack_m, pair->stuck_m));
    pair->relative_m_s[2] = relative_velocity(pair, at);
    double damping_n_s_m = fmin(pair->damping_n_s_m, damping_limit(pair, at, tangent, time_step_s));
    double force_n = pair->stiffness_n_m * pair->stuck_m +
                     damping_n_s_m * cp_vec2_dot(pair->relative_m_s[2], tangent);
    pair->drag_n = fmin(limit_n, fmax(-limit_n, force_n));
    encounter->elastic_friction_j += 0.5 * pair->stiffness_n_m * pair->stuck_m * pair->stuck_m;
    push(pair, cp_vec2_scale(tangent, pair->drag_n), at);
}

// The outlines of a party where they are now, and the circles around them.
typedef struct party_now {
    cp_outline outline[CP_OUTLINES_MAX];
    double reach_m[CP_OUTLINES_MAX];
} party_now;

static void place_party(const cp_encounter *encounter, int party, party_now *now)
{
    for (int k = 0; k < outline_count(encounter, party); k++) {
        now->outline[k] = outline_now(encounter, party, k);
        double half_length_m = now->outline[k].half_length_m;
        double half_width_m = now->outline[k].half_width_m;
        now->reach_m[k] = sqrt(half_length_m * half_length_m + half_width_m * half_width_m);
    }
}

// Whether the pair touches; how, and which way its blocks give.
static bool touch_pair(cp_encounter *encounter, const party_now now[2], int i, int j)
{
    double reach_m = now[0].reach_m[i] + now[1].reach_m[j];
    cp_vec2 apart = cp_vec2_sub(now[0].outline[i].centre_m, now[1].outline[j].centre_m);
    if (cp_vec2_dot(apart, apart) > reach_m * reach_m)
        return false;
    cp_manifold manifold = cp_outline_contact(&now[0].outline[i], &now[1].outline[j], 0.0);
    if (manifold.count == 0)
        return false;
    cp_encounter_pair *pair = &encounter->pair[i][j];
    pair->manifold = manifold;
    pair->give_m = 0.0;
    pair->cosine[0] = block_of(encounter, 0, i) == NULL
                          ? 0.0
                          : cp_vec2_dot(manifold.normal, now[0].outline[i].along);
    pair->cosine[1] = block_of(encounter, 1, j) == NULL
                          ? 0.0
                          : -cp_vec2_dot(manifold.normal, now[1].outline[j].along);
    return true;
}

// All touching pairs of the coming step; the friction spring of one that touches no longer lets go.
static void find_touching(cp_encounter *encounter)
{
    party_now now[2];
    for (int party = 0; party < 2; party++)
        place_party(encounter, party, &now[party]);
    for (int k = 0; k < encounter->touching_count; k++) {
        const int *index = encounter->touching[k].outline;
        encounter->pair[index[0]][index[1]].manifold.count = 0;
    }
    cp_touch before[CP_OUTLINES_MAX * CP_OUTLINES_MAX];
    int before_count = encounter->touching_count;
    memcpy(before, encounter->touching, (size_t)before_count * sizeof *before);
    encounter->touching_count = 0;
    for (int i = 0; i < outline_count(encounter, 0); i++)
        for (int j = 0; j < outline_count(encounter, 1); j++)
            if (touch_pair(encounter, now, i, j))
                encounter->touching[encounter->touching_count++] = (cp_touch){{i, j}};
    for (int k = 0; k < before_count; k++) {
        cp_encounter_pair *pair = &encounter->pair[before[k].outline[0]][before[k].outline[1]];
        if (pair->manifold.count == 0)
            pair->stuck_m = 0.0;
    }
}

void cp_encounter_apply_forces(cp_encounter *encounter, double time_step_s)
{
    encounter->elastic_normal_j = 0.0;
    encounter->elastic_friction_j = 0.0;
    find_touching(encounter);
    yield_blocks(encounter, time_step_s);
    for (int k = 0; k < encounter->touching_count; k++) {
        const int *index = encounter->touching[k].outline;
        cp_encounter_pair *pair = &encounter->pair[index[0]][index[1]];
        double pressure_n = press(encounter, pair, time_step_s);
        drag(encounter, pair, pressure_n, time_step_s);
    }
}

// Work of a pair's forces over the step: force times mean of the relative velocities at its point
// before and after. The friction spring follows the motion.
static bool settle_pair(cp_encounter *encounter, cp_encounter_pair *pair, double time_step_s)
{
    cp_vec2 normal = pair->manifold.normal, tangent = {-normal.y, normal.x};
    bool pressed = false;
    for (int k = 0; k < pair->manifold.count; k++) {
        cp_vec2 after_m_s = relative_velocity(pair, pair->manifold.point[k].position_m);
        double mean_m_s = 0.5 * cp_vec2_dot(cp_vec2_add(pair->relative_m_s[k], after_m_s), normal);
        encounter->normal_work_j += pair->press_n[k] * mean_m_s * time_step_s;
        pressed = pressed || pair->press_n[k] > 0.0;
    }
    double before_m_s = cp_vec2_dot(pair->relative_m_s[2], tangent);
    double after_m_s = cp_vec2_dot(relative_velocity(pair, pair->friction_at_m), tangent);
    encounter->friction_work_j += pair->drag_n * 0.5 * (before_m_s + after_m_s) * time_step_s;
    pair->stuck_m += after_m_s * time_step_s;
    return pressed;
}

bool cp_encounter_end_step(cp_encounter *encounter, double time_step_s)
{
    bool pressed = false;
    for (int k = 0; k < encounter->touching_count; k++) {
        const int *index = encounter->touching[k].outline;
        if (settle_pair(encounter, &encounter->pair[index[0]][index[1]], time_step_s))
            pressed = true;
    }
    return pressed;
}
