/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/lane_ahead.h"

#include <string.h>

#define FAR_OFF_M 8.0 /* from its lane: a car pushed off it, or a lane read wrong */
#define CLOSE_CORNERS_M 0.3
#define LANES_MAX 24 /* that follow each other within any reach */
#define TRAIL_POINTS 48
#define TRAIL_LANES 6
#define REAR_OFF_1 0.1 /* rad between the heading and the way behind: a lane change is less */

// Without the care for overflow that hypot takes: this is asked millions of times.
static double length_of(cp_vec2 vector)
{
    return sqrt(cp_vec2_dot(vector, vector));
}

static cp_vec2 flat(const cp_lane_point *point)
{
    return (cp_vec2){point->x_m, point->y_m};
}

/* The place on a lane nearest to a point. */
typedef struct foot {
    size_t piece;    /* from this corner of the lane to the next */
    double share_1;  /* of the piece, from 0 to 1 but beyond the ends of the lane */
    double left_m;   /* how far left of the lane's direction the point lies */
    cp_vec2 tangent; /* of the piece, unit length */
} foot;

// Of all pieces the one the point is nearest to.
static foot find_foot(const cp_lane *lane, cp_vec2 point_m)
{
    foot best = {0};
    double nearest_m2 = INFINITY;
    for (size_t k = 0; k + 1 < lane->point_count; k++) {
        cp_vec2 from_m = flat(&lane->point[k]);
        cp_vec2 way_m = cp_vec2_sub(flat(&lane->point[k + 1]), from_m);
        double length_m = length_of(way_m);
        if (!(length_m > 0.0))
            continue;
        cp_vec2 tangent = cp_vec2_scale(way_m, 1.0 / length_m);
        cp_vec2 off_m = cp_vec2_sub(point_m, from_m);
        double share_1 = cp_vec2_dot(off_m, tangent) / length_m;
        double kept_1 = fmin(fmax(share_1, 0.0), 1.0);
        cp_vec2 rest_m = cp_vec2_sub(off_m, cp_vec2_scale(way_m, kept_1));
        double distance_m2 = cp_vec2_dot(rest_m, rest_m);
        if (distance_m2 >= nearest_m2)
            continue;
        nearest_m2 = distance_m2;
        bool is_end = (share_1 < 0.0 && k == 0) || (share_1 > 1.0 && k + 2 == lane->point_count);
        best = (foot){k, is_end ? share_1 : kept_1, cp_vec2_cross(tangent, off_m), tangent};
    }
    return best;
}

// ---- laying --------------------------------------------------------------------------------

/* A lane's centre line being followed. */
typedef struct layer {
    const cp_lane_map *map;
    cp_lane_ahead *ahead;
    bool is_reversed;
    bool is_route; /* what follows is told to its end */
} layer;

// A corner of the centre line; its way is told later.
static void add_corner(cp_lane_ahead *ahead, cp_vec2 point_m, uint32_t lane, double lane_at_m,
                       double z_m)
{
    const cp_way_point *last = &ahead->corner[ahead->count - 1];
    double step_m = length_of(cp_vec2_sub(point_m, last->point_m));
    if (ahead->count == CP_LANE_AHEAD_POINTS || step_m < 1e-6)
        return;
    ahead->corner[ahead->count++] =
        (cp_way_point){point_m, last->way_m + step_m, lane, lane_at_m, z_m};
}

// The corners of one lane from the one numbered first on, close ones left out but for the last.
static void follow_lane(layer *on, const cp_lane *lane, uint32_t number, size_t first,
                        double reach_m)
{
    cp_lane_ahead *ahead = on->ahead;
    size_t left = on->is_reversed ? first + 1 : lane->point_count - first;
    for (size_t k = 0; k < left; k++) {
        const cp_way_point *last = &ahead->corner[ahead->count - 1];
        const cp_lane_point *point = &lane->point[on->is_reversed ? first - k : first + k];
        bool is_close = length_of(cp_vec2_sub(flat(point), last->point_m)) < CLOSE_CORNERS_M;
        if (last->way_m > reach_m)
            return;
        if (!is_close || k + 1 == left)
            add_corner(ahead, flat(point), number, point->at_m, point->z_m);
    }
}

static void follow_lanes(layer *on, uint32_t number, size_t first, const uint32_t *next_lanes,
                         size_t next_count, double reach_m)
{
    cp_lane_ahead *ahead = on->ahead;
    for (size_t lanes = 0; lanes < LANES_MAX; lanes++) {
        const cp_lane *lane = cp_lane_map_lane(on->map, number);
        if (lane == NULL)
            return;
        follow_lane(on, lane, number, first, reach_m);
        double way_m = ahead->corner[ahead->count - 1].way_m;
        if (on->is_reversed || way_m > reach_m)
            return;
        if (on->is_route && next_count == 0 && !lane->is_inside) {
            ahead->ends_m = way_m;
            return;
        }
        const cp_lane_link *link =
            cp_lane_map_link(on->map, number, next_count > 0 ? next_lanes[0] : CP_LANE_NONE);
        number = link == NULL ? CP_LANE_NONE : cp_lane_link_next(link);
        const cp_lane *next = cp_lane_map_lane(on->map, number);
        // Between two lanes inside one junction SUMO's drivers wait for those who go first, too.
        bool is_within = lane->is_inside && next != NULL && next->is_inside;
        if (link != NULL && (link->gives_way || is_within) &&
            ahead->wait_count < CP_LANE_AHEAD_WAITS)
            ahead->wait_m[ahead->wait_count++] = way_m;
        // The lane that the route named is reached: the next one counts.
        if (next != NULL && !next->is_inside && next_count > 0) {
            next_lanes++;
            next_count--;
        }
        first = 0;
        // What lies on the last corner belongs to the lane that begins there.
        if (next != NULL)
            ahead->corner[ahead->count - 1].lane = number;
        if (next != NULL)
            ahead->corner[ahead->count - 1].lane_at_m = 0.0;
    }
}

// Shift the corners ahead to the left, each along the bisector of its two pieces, and tell the ways
// anew.
static void shift(cp_lane_ahead *ahead, double left_m, double slope_1)
{
    cp_vec2 before = {0.0, 0.0}, moved_m[CP_LANE_AHEAD_POINTS];
    for (size_t k = ahead->front; k < ahead->count; k++) {
        cp_vec2 after = before;
        if (k + 1 < ahead->count) {
            cp_vec2 piece_m = cp_vec2_sub(ahead->corner[k + 1].point_m, ahead->corner[k].point_m);
            after = cp_vec2_scale(piece_m, 1.0 / length_of(piece_m));
        }
        if (k == ahead->front)
            before = after;
        cp_vec2 sum = cp_vec2_add(before, after);
        cp_vec2 normal = {-sum.y, sum.x};
        // Half the sum is as long as the cosine of half the bend: the mitre divides by its square.
        double length_2 = fmax(cp_vec2_dot(sum, sum), 1.0);
        double here_m = left_m + slope_1 * ahead->corner[k].way_m;
        moved_m[k] =
            cp_vec2_add(ahead->corner[k].point_m, cp_vec2_scale(normal, 2.0 * here_m / length_2));
        before = after;
    }
    double way_m = 0.0;
    for (size_t k = ahead->front; k < ahead->count; k++) {
        if (k > ahead->front)
            way_m += length_of(cp_vec2_sub(moved_m[k], ahead->corner[k - 1].point_m));
        ahead->corner[k].point_m = moved_m[k];
        ahead->corner[k].way_m = way_m;
    }
}

bool cp_is_put_aside(const cp_vehicle_motion *motion)
{
    const cp_vehicle_state *then = &motion->before, *now = &motion->after;
    if (!motion->was_present)
        return false;
    double middle_rad = then->yaw_rad + 0.5 * cp_wrap_angle(now->yaw_rad - then->yaw_rad);
    cp_vec2 step_m = {now->front_x_m - then->front_x_m, now->front_y_m - then->front_y_m};
    cp_vec2 along = cp_vec2_heading(middle_rad);
    double aside_m = fabs(cp_vec2_cross(along, step_m));
    return aside_m > 1.0 && aside_m > 0.25 * cp_vec2_dot(along, step_m);
}

/* What lies behind a front, from there backwards. */
typedef struct trail {
    cp_way_point corner[TRAIL_POINTS];
    size_t count;
} trail;

static void add_behind(trail *behind, cp_vec2 point_m, uint32_t lane)
{
    const cp_way_point *last = &behind->corner[behind->count - 1];
    double step_m = length_of(cp_vec2_sub(point_m, last->point_m));
    if (behind->count < TRAIL_POINTS && step_m > 1e-6)
        behind->corner[behind->count++] =
            (cp_way_point){point_m, last->way_m - step_m, lane, 0.0, last->z_m};
}

static double distance_m(const cp_lane *lane, cp_vec2 point_m)
{
    foot at = find_foot(lane, point_m);
    cp_vec2 from_m = flat(&lane->point[at.piece]), to_m = flat(&lane->point[at.piece + 1]);
    double kept_1 = fmin(fmax(at.share_1, 0.0), 1.0);
    cp_vec2 there_m = cp_vec2_add(from_m, cp_vec2_scale(cp_vec2_sub(to_m, from_m), kept_1));
    return length_of(cp_vec2_sub(point_m, there_m));
}

// Of the lanes that lead here the one on which the rear is, or nearest to it.
static const cp_lane *lane_behind(const cp_lane_map *map, const cp_lane *lane, cp_vec2 rear_m,
                                  uint32_t *number)
{
    const cp_lane *nearest = NULL;
    double least_m = INFINITY;
    for (size_t k = 0; k < lane->from_count; k++) {
        const cp_lane *from = cp_lane_map_lane(map, lane->from[k]);
        double here_m = from != NULL ? distance_m(from, rear_m) : INFINITY;
        if (here_m < least_m) {
            least_m = here_m;
            nearest = from;
            *number = lane->from[k];
        }
    }
    return nearest;
}

// Back along the lanes, as far off them as the front is, for length_m and a little more. False when
// the rear is not there.
static bool trail_lanes(const cp_lane_map *map, const cp_vehicle_state *now, const cp_lane *lane,
                        const foot *at, double length_m, trail *behind)
{
    cp_vec2 heading = cp_vec2_heading(now->yaw_rad), front_m = {now->front_x_m, now->front_y_m};
    cp_vec2 rear_m = cp_vec2_sub(front_m, cp_vec2_scale(heading, now->length_m));
    size_t next = at->piece + 1; // corner from which on nothing is behind the front
    uint32_t number = now->lane;
    for (size_t lanes = 0; lanes < TRAIL_LANES && lane != NULL; lanes++) {
        for (size_t k = next; k-- > 0 && behind->corner[behind->count - 1].way_m > -length_m;) {
            size_t piece = k + 1 < lane->point_count ? k : k - 1;
            cp_vec2 along_m = cp_vec2_sub(flat(&lane->point[piece + 1]), flat(&lane->point[piece]));
            double off_1 = at->left_m / fmax(length_of(along_m), 1e-6);
            add_behind(behind,
                       cp_vec2_add(flat(&lane->point[k]),
                                   (cp_vec2){-along_m.y * off_1, along_m.x * off_1}),
                       number);
        }
        if (behind->corner[behind->count - 1].way_m <= -length_m)
            break;
        lane = lane_behind(map, lane, rear_m, &number);
        next = lane != NULL ? lane->point_count : 0;
    }
    // Where the rear would be on it.
    size_t k = 0;
    while (k + 2 < behind->count && behind->corner[k + 1].way_m > -now->length_m)
        k++;
    if (behind->count < 2)
        return false;
    const cp_way_point *from = &behind->corner[k], *to = from + 1;
    double share_1 = (from->way_m + now->length_m) / (from->way_m - to->way_m);
    cp_vec2 there_m =
        cp_vec2_add(from->point_m, cp_vec2_scale(cp_vec2_sub(to->point_m, from->point_m), share_1));
    cp_vec2 back = cp_vec2_sub(front_m, there_m);
    return share_1 >= 0.0 && share_1 <= 1.0 &&
           length_of(cp_vec2_sub(cp_vec2_scale(back, 1.0 / fmax(length_of(back), 1e-6)), heading)) <
               REAR_OFF_1;
}

// The way of this step, and before it that of the body, straight on.
static void trail_body(const cp_vehicle_motion *motion, trail *behind)
{
    const cp_vehicle_state *now = &motion->after;
    bool is_known = motion->was_present && !cp_is_put_aside(motion);
    const cp_vehicle_state *then = is_known ? &motion->before : now;
    cp_vec2 before_m = {then->front_x_m, then->front_y_m};
    cp_vec2 back_m = cp_vec2_scale(cp_vec2_heading(then->yaw_rad), -(now->length_m + 1.0));
    add_behind(behind, before_m, now->lane);
    add_behind(behind, cp_vec2_add(before_m, back_m), now->lane);
}

static void begin_behind(const cp_lane_map *map, const cp_vehicle_motion *motion,
                         const cp_lane *lane, const foot *at, bool is_lane_kept,
                         cp_lane_ahead *ahead)
{
    const cp_vehicle_state *now = &motion->after;
    cp_way_point front = {{now->front_x_m, now->front_y_m}, 0.0, now->lane, 0.0, now->elevation_m};
    trail behind = {.corner = {front}, .count = 1};
    cp_vec2 before_m = {motion->before.front_x_m, motion->before.front_y_m};
    double step_m = motion->was_present ? length_of(cp_vec2_sub(front.point_m, before_m)) : 0.0;
    if (!is_lane_kept || !trail_lanes(map, now, lane, at, now->length_m + 1.0 + step_m, &behind)) {
        behind.count = 1;
        trail_body(motion, &behind);
    }
    ahead->count = 0;
    while (behind.count > 1)
        ahead->corner[ahead->count++] = behind.corner[--behind.count];
    ahead->front = ahead->count;
}

// Whether it drives against its lane, as overtakers do. Where a lane begins with a hook the heading
// says little: who was on the lane, or on one beside it, moves on it one way or the other; who has
// come over a link drives along.
static bool is_against(const cp_lane_map *map, const cp_vehicle_motion *motion, const cp_lane *lane,
                       const foot *at)
{
    const cp_vehicle_state *now = &motion->after, *then = &motion->before;
    bool by_heading = cp_vec2_dot(at->tangent, cp_vec2_heading(now->yaw_rad)) < 0.0;
    const cp_lane *last = motion->was_present ? cp_lane_map_lane(map, then->lane) : NULL;
    if (!by_heading || last == NULL)
        return by_heading;
    if (last->edge == lane->edge) {
        foot was = find_foot(lane, (cp_vec2){then->front_x_m, then->front_y_m});
        double step_1 = (double)at->piece - (double)was.piece;
        if (at->piece == was.piece)
            step_1 = at->share_1 - was.share_1;
        return step_1 == 0.0 ? by_heading : step_1 < 0.0;
    }
    for (size_t k = 0; k < last->link_count; k++)
        if (last->link[k].to == now->lane || last->link[k].via == now->lane)
            return false;
    return by_heading;
}

bool cp_lane_ahead_lay(const cp_lane_map *map, const cp_vehicle_motion *motion, double slope_1,
                       const uint32_t *next_lanes, size_t next_count, bool is_route, double reach_m,
                       cp_lane_ahead *ahead)
{
    const cp_vehicle_state *now = &motion->after;
    const cp_lane *lane = cp_lane_map_lane(map, now->lane);
    if (lane == NULL)
        return false;
    cp_vec2 front_m = {now->front_x_m, now->front_y_m};
    foot at = find_foot(lane, front_m);
    if (!(fabs(at.left_m) <= FAR_OFF_M))
        return false;
    layer on = {map, ahead, is_against(map, motion, lane, &at), is_route};
    begin_behind(map, motion, lane, &at, !on.is_reversed && slope_1 == 0.0, ahead);
    const cp_lane_point *from = &lane->point[at.piece], *to = from + 1;
    cp_vec2 foot_m =
        cp_vec2_add(flat(from), cp_vec2_scale(cp_vec2_sub(flat(to), flat(from)), at.share_1));
    ahead->corner[ahead->count++] =
        (cp_way_point){foot_m, 0.0, now->lane, from->at_m + at.share_1 * (to->at_m - from->at_m),
                       from->z_m + at.share_1 * (to->z_m - from->z_m)};
    ahead->is_inside = lane->is_inside;
    ahead->ends_m = INFINITY;
    ahead->wait_count = 0;
    ahead->lane_step_1 = on.is_reversed ? -1.0 : 1.0;

    // Beyond the end of its lane there is nothing more of it to follow.
    bool is_beyond = on.is_reversed ? at.share_1 < 0.0 : at.share_1 > 1.0;
    if (!is_beyond)
        follow_lanes(&on, now->lane, on.is_reversed ? at.piece : at.piece + 1, next_lanes,
                     next_count, reach_m);
    // At least one piece ahead, for the direction.
    if (ahead->count == ahead->front + 1) {
        cp_vec2 along = cp_vec2_scale(at.tangent, on.is_reversed ? -1.0 : 1.0);
        const cp_way_point *last = &ahead->corner[ahead->count - 1];
        add_corner(ahead, cp_vec2_add(foot_m, along), now->lane,
                   last->lane_at_m + ahead->lane_step_1, last->z_m);
    }
    shift(ahead, on.is_reversed ? -at.left_m : at.left_m, slope_1);
    // The front itself is where it is.
    ahead->corner[ahead->front].point_m = front_m;
    return true;
}

// ---- asking --------------------------------------------------------------------------------

// The corner at or before a place on the way; the first for all before it.
static size_t corner_before(const cp_lane_ahead *ahead, double way_m)
{
    size_t low = 0, high = ahead->count - 1;
    while (low + 1 < high) {
        size_t middle = (low + high) / 2;
        if (ahead->corner[middle].way_m <= way_m)
            low = middle;
        else
            high = middle;
    }
    return low;
}

// A point of the way; before its first and behind its last corner it goes straight on.
static cp_vec2 point_at(const cp_lane_ahead *ahead, double way_m)
{
    size_t k = corner_before(ahead, way_m);
    const cp_way_point *from = &ahead->corner[k], *to = from + 1;
    double share_1 = (way_m - from->way_m) / (to->way_m - from->way_m);
    return cp_vec2_add(from->point_m,
                       cp_vec2_scale(cp_vec2_sub(to->point_m, from->point_m), share_1));
}

cp_rectangle cp_lane_ahead_at(const cp_lane_ahead *ahead, double way_m, double length_m,
                              double width_m)
{
    cp_vec2 front_m = point_at(ahead, way_m), rear_m = point_at(ahead, way_m - length_m);
    cp_vec2 axis_m = cp_vec2_sub(front_m, rear_m);
    double yaw_rad = atan2(axis_m.y, axis_m.x);
    cp_vec2 half_m = cp_vec2_scale(cp_vec2_heading(yaw_rad), 0.5 * length_m);
    return (cp_rectangle){cp_vec2_sub(front_m, half_m), yaw_rad, length_m, width_m};
}

cp_vec2 cp_lane_ahead_middle(const cp_lane_ahead *ahead, double way_m, double length_m)
{
    return cp_vec2_scale(cp_vec2_add(point_at(ahead, way_m), point_at(ahead, way_m - length_m)),
                         0.5);
}

void cp_lane_ahead_place(const cp_lane_ahead *ahead, double way_m, cp_vehicle_state *state)
{
    const cp_way_point *from = &ahead->corner[ahead->front];
    for (size_t k = ahead->front; k < ahead->count && ahead->corner[k].way_m <= way_m; k++)
        from = &ahead->corner[k];
    double further_m = fmax(way_m - from->way_m, 0.0);
    state->lane = from->lane;
    state->lane_position_m = from->lane_at_m + ahead->lane_step_1 * further_m;
    state->elevation_m = from->z_m;
    const cp_way_point *to = from + 1;
    if (to < ahead->corner + ahead->count && to->way_m > from->way_m)
        state->elevation_m +=
            (to->z_m - from->z_m) * fmin(further_m / (to->way_m - from->way_m), 1.0);
}

double cp_lane_ahead_way_to_m(const cp_lane_ahead *ahead, uint32_t lane, double lane_at_m)
{
    if (ahead->lane_step_1 < 0.0)
        return INFINITY;
    double way_m = INFINITY;
    for (size_t k = ahead->front; k < ahead->count; k++)
        if (ahead->corner[k].lane == lane && ahead->corner[k].lane_at_m <= lane_at_m + 1e-6)
            way_m = ahead->corner[k].way_m + lane_at_m - ahead->corner[k].lane_at_m;
    return way_m;
}
