/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/encounter.h"

#include "crash/block_yield.h"
#include "crash/struck_structure.h"

#include <string.h>

// Number of outlines of a party: a car's, or the barrier's one.
static int outline_count(const cp_encounter *encounter, int party)
{
    return encounter->car[party] != NULL ? encounter->car[party]->outline_count : 1;
}

static bool is_absent(const cp_car *car, int outline)
{
    return car != NULL && car->outline[outline].absent;
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
            if (is_absent(encounter->car[0], i) || is_absent(encounter->car[1], j))
                continue;
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

static bool is_cross_member(const cp_car *car, int outline)
{
    return car != NULL && (car->outline[outline].body == CP_BODY_CROSS_MEMBER_LEFT ||
                           car->outline[outline].body == CP_BODY_CROSS_MEMBER_RIGHT);
}

static bool is_upper_path(const cp_car *car, int outline)
{
    if (car == NULL || outline < CP_OUTLINE_BLOCKS)
        return false;
    int part = cp_car_part_of_block(car, outline - CP_OUTLINE_BLOCKS);
    return part == 2 || part == 3;
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
                .never_meets = is_absent(a, i) || is_absent(b, j) ||
                               (is_cross_member(a, i) && is_upper_path(b, j)) ||
                               (is_upper_path(a, i) && is_cross_member(b, j)),
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

cp_crush_block *cp_encounter_block(const cp_encounter *encounter, int party, int outline)
{
    cp_car *car = encounter->car[party];
    int block = car != NULL ? car->outline[outline].block : -1;
    return block >= 0 ? &car->block[block] : NULL;
}

// What presses on a block from nearer to its side than this does not count as its face's.
static const double FACE_COSINE = 0.2;

// A block resists by at least this share of its force wherever it is pressed on.
static const double LEAST_SHARE_1 = 0.05;

// Where a block's face is pressed on, along its own left, and how far the outermost of it lies
// inside the nearer edge of the block.
typedef struct covered_face {
    double right_m;
    double left_m;
    double inside_m;
} covered_face;

static void cover_face(const cp_encounter_pair *pair, int party, const cp_outline *outline,
                       covered_face *covered)
{
    if (pair->cosine[party] < FACE_COSINE)
        return;
    cp_vec2 left = {-outline->along.y, outline->along.x};
    for (int k = 0; k < pair->manifold.count; k++) {
        cp_vec2 reach = cp_vec2_sub(pair->manifold.point[k].position_m, outline->centre_m);
        double at_m = cp_vec2_dot(reach, left);
        covered->right_m = fmin(covered->right_m, at_m);
        covered->left_m = fmax(covered->left_m, at_m);
        covered->inside_m = fmax(covered->inside_m, outline->half_width_m - fabs(at_m));
    }
}

// The share of every block's face that is pressed on: what meets half of its width meets half of
// its force.
static void share_faces(cp_encounter *encounter, int party, const cp_outline outline[])
{
    covered_face covered[CP_OUTLINES_MAX];
    for (int k = 0; k < outline_count(encounter, party); k++)
        covered[k] = (covered_face){INFINITY, -INFINITY, 0.0};
    for (int k = 0; k < encounter->touching_count; k++) {
        const int *index = encounter->touching[k].outline;
        if (cp_encounter_block(encounter, party, index[party]) != NULL)
            cover_face(&encounter->pair[index[0]][index[1]], party, &outline[index[party]],
                       &covered[index[party]]);
    }
    for (int k = 0; k < outline_count(encounter, party); k++) {
        cp_crush_block *block = cp_encounter_block(encounter, party, k);
        if (block == NULL)
            continue;
        cp_car *car = encounter->car[party];
        if (cp_car_is_struck(car) && k >= CP_OUTLINE_BLOCKS + car->struck_block) {
            cp_struck_cover(car, k - CP_OUTLINE_BLOCKS, covered[k].right_m, covered[k].left_m,
                            covered[k].inside_m);
            continue;
        }

        // A dent spreads, but not beyond the block's edge: what only grazes it meets next to
        // nothing.
        double dent_m = fmin(CP_CONTACT_PATCH_M, 2.0 * covered[k].inside_m);
        double covered_m = fmax(0.0, covered[k].left_m - covered[k].right_m) + dent_m;
        block->share_1 = fmin(1.0, fmax(LEAST_SHARE_1, covered_m / block->full_width_m));
    }
}

// Spring and damper of every point; returns the whole pressure, and where its middle is.
static double press(cp_encounter *encounter, cp_encounter_pair *pair, double time_step_s)
{
    const cp_manifold *manifold = &pair->manifold;
    double total_n = 0.0, weight = cp_manifold_point_weight(manifold);
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

// How the pair's push stands to the block of a party: the normal points from [0] to [1].
static void set_cosines(const cp_encounter *encounter, cp_encounter_pair *pair, int party,
                        int index, const cp_outline *outline)
{
    pair->cosine[party] = pair->side_cosine[party] = 0.0;
    if (encounter->car[party] == NULL || encounter->car[party]->outline[index].block < 0)
        return;
    cp_vec2 push = cp_vec2_scale(pair->manifold.normal, party == 0 ? -1.0 : 1.0);
    cp_vec2 left = {-outline->along.y, outline->along.x};
    pair->cosine[party] = -cp_vec2_dot(push, outline->along);
    pair->side_cosine[party] = cp_vec2_dot(push, left);
}

// Whether the pair touches; how, and which way its blocks give.
static bool touch_pair(cp_encounter *encounter, const party_now now[2], int i, int j)
{
    cp_encounter_pair *pair = &encounter->pair[i][j];
    if (pair->never_meets)
        return false;
    double reach_m = now[0].reach_m[i] + now[1].reach_m[j];
    cp_vec2 apart = cp_vec2_sub(now[0].outline[i].centre_m, now[1].outline[j].centre_m);
    if (cp_vec2_dot(apart, apart) > reach_m * reach_m)
        return false;
    cp_manifold manifold = cp_outline_contact(&now[0].outline[i], &now[1].outline[j], 0.0);
    if (manifold.count == 0)
        return false;
    pair->manifold = manifold;
    pair->give_m = 0.0;
    set_cosines(encounter, pair, 0, i, &now[0].outline[i]);
    set_cosines(encounter, pair, 1, j, &now[1].outline[j]);
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
    for (int party = 0; party < 2; party++)
        share_faces(encounter, party, now[party].outline);
}

void cp_encounter_apply_forces(cp_encounter *encounter, double time_step_s)
{
    encounter->elastic_normal_j = 0.0;
    encounter->elastic_friction_j = 0.0;
    find_touching(encounter);
    cp_yield_blocks(encounter, time_step_s);
    for (int k = 0; k < encounter->touching_count; k++) {
        const int *index = encounter->touching[k].outline;
        cp_encounter_pair *pair = &encounter->pair[index[0]][index[1]];
        double pressure_n = press(encounter, pair, time_step_s);
        drag(encounter, pair, pressure_n, time_step_s);
    }
}

// Work of a pair's forces over the step: force times mean of the relative velocities at its point
// before and after. The friction spring follows the motion. Returns how hard it pressed.
static double settle_pair(cp_encounter *encounter, cp_encounter_pair *pair, double time_step_s)
{
    cp_vec2 normal = pair->manifold.normal, tangent = {-normal.y, normal.x};
    double pressed_n = 0.0;
    for (int k = 0; k < pair->manifold.count; k++) {
        cp_vec2 after_m_s = relative_velocity(pair, pair->manifold.point[k].position_m);
        double mean_m_s = 0.5 * cp_vec2_dot(cp_vec2_add(pair->relative_m_s[k], after_m_s), normal);
        encounter->normal_work_j += pair->press_n[k] * mean_m_s * time_step_s;
        pressed_n += pair->press_n[k];
    }
    double before_m_s = cp_vec2_dot(pair->relative_m_s[2], tangent);
    double after_m_s = cp_vec2_dot(relative_velocity(pair, pair->friction_at_m), tangent);
    encounter->friction_work_j += pair->drag_n * 0.5 * (before_m_s + after_m_s) * time_step_s;
    pair->stuck_m += after_m_s * time_step_s;
    return pressed_n;
}

double cp_encounter_end_step(cp_encounter *encounter, double time_step_s)
{
    double pressed_n = 0.0;
    for (int k = 0; k < encounter->touching_count; k++) {
        const int *index = encounter->touching[k].outline;
        pressed_n += settle_pair(encounter, &encounter->pair[index[0]][index[1]], time_step_s);
    }
    return pressed_n;
}
