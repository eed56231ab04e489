/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact/touch.h"

/* What counts as parallel, and as at a corner. */
#define TOLERANCE_M 0.01

/* One edge of a rectangle and how the other rectangle lies before it, all in the frame of the
 * rectangle that owns the edge. */
typedef struct edge_view {
    int owner;
    cp_contact_side side;
    cp_vec2 normal;      /* outward */
    cp_vec2 along;       /* normal turned left */
    double out_m;        /* centre to edge */
    double half_m;       /* half the edge's length */
    double gap_m;        /* nearest corner of the other beyond the edge */
    int nearest;         /* that corner, 0..3 as in core/geometry.h */
    cp_vec2 corner_m[4]; /* of the other */
} edge_view;

static cp_pose frame_of(const cp_rectangle *rectangle)
{
    return (cp_pose){rectangle->centre_m, rectangle->yaw_rad};
}

static edge_view view_from(const cp_touching_body body[2], int owner, cp_contact_side side)
{
    static const cp_vec2 NORMAL[] = {[CP_SIDE_FRONT] = {1.0, 0.0},
                                     [CP_SIDE_LEFT] = {0.0, 1.0},
                                     [CP_SIDE_RIGHT] = {0.0, -1.0},
                                     [CP_SIDE_REAR] = {-1.0, 0.0}};
    const cp_rectangle *own = &body[owner].rectangle;
    bool is_end = side == CP_SIDE_FRONT || side == CP_SIDE_REAR;
    edge_view view = {.owner = owner,
                      .side = side,
                      .normal = NORMAL[side],
                      .along = {-NORMAL[side].y, NORMAL[side].x},
                      .out_m = 0.5 * (is_end ? own->length_m : own->width_m),
                      .half_m = 0.5 * (is_end ? own->width_m : own->length_m),
                      .gap_m = INFINITY};
    cp_rectangle_corners(&body[1 - owner].rectangle, view.corner_m);
    for (int k = 0; k < 4; k++) {
        view.corner_m[k] = cp_pose_to_local(frame_of(own), view.corner_m[k]);
        double gap_m = cp_vec2_dot(view.normal, view.corner_m[k]) - view.out_m;
        if (gap_m < view.gap_m) {
            view.gap_m = gap_m;
            view.nearest = k;
        }
    }
    return view;
}

// The edge that separates the two best: contact is on it.
static edge_view touching_edge(const cp_touching_body body[2])
{
    edge_view best = view_from(body, 0, CP_SIDE_FRONT);
    for (int owner = 0; owner < 2; owner++)
        for (int side = CP_SIDE_FRONT; side <= CP_SIDE_REAR; side++) {
            edge_view view = view_from(body, owner, (cp_contact_side)side);
            if (view.gap_m > best.gap_m)
                best = view;
        }
    return best;
}

// The other's corner next to its nearest one that comes second: the two ends of its facing edge.
static int second_corner(const edge_view *view)
{
    int next = (view->nearest + 1) % 4, previous = (view->nearest + 3) % 4;
    return cp_vec2_dot(view->normal, view->corner_m[next]) <
                   cp_vec2_dot(view->normal, view->corner_m[previous])
               ? next
               : previous;
}

// Side between two neighbouring corners: front left, rear left, rear right, front right.
static cp_contact_side side_between(int one, int other)
{
    static const cp_contact_side FROM[] = {CP_SIDE_LEFT, CP_SIDE_REAR, CP_SIDE_RIGHT,
                                           CP_SIDE_FRONT};
    return FROM[(one + 1) % 4 == other ? one : other];
}

static cp_vec2 velocity_at(const cp_touching_body *body, cp_vec2 point_m)
{
    cp_vec2 forward = cp_vec2_heading(body->rectangle.yaw_rad);
    cp_vec2 front_m = cp_vec2_add(body->rectangle.centre_m,
                                  cp_vec2_scale(forward, 0.5 * body->rectangle.length_m));
    return cp_point_velocity(body->front_velocity_m_s, body->yaw_rate_rad_s,
                             cp_vec2_sub(point_m, front_m));
}

// At a corner: the edge that faces the other's relative velocity more.
static cp_contact_side side_at_corner(const cp_touching_body body[2], int own, cp_vec2 point_m)
{
    const cp_rectangle *rectangle = &body[own].rectangle;
    cp_vec2 local_m = cp_pose_to_local(frame_of(rectangle), point_m);
    cp_vec2 relative_m_s =
        cp_vec2_sub(velocity_at(&body[1 - own], point_m), velocity_at(&body[own], point_m));
    relative_m_s = cp_vec2_rotate(relative_m_s, -rectangle->yaw_rad);
    double against_end = local_m.x > 0.0 ? -relative_m_s.x : relative_m_s.x;
    double against_flank = local_m.y > 0.0 ? -relative_m_s.y : relative_m_s.y;
    if (against_end >= against_flank)
        return local_m.x > 0.0 ? CP_SIDE_FRONT : CP_SIDE_REAR;
    return local_m.y > 0.0 ? CP_SIDE_LEFT : CP_SIDE_RIGHT;
}

cp_first_touch cp_touch_of(const cp_touching_body body[2])
{
    // What of the other faces the edge: a corner, or an edge parallel to it.
    edge_view view = touching_edge(body);
    int owner = view.owner, second = second_corner(&view);
    double begin_m = cp_vec2_dot(view.along, view.corner_m[view.nearest]);
    double end_m = cp_vec2_dot(view.along, view.corner_m[second]);
    double second_gap_m = cp_vec2_dot(view.normal, view.corner_m[second]) - view.out_m;
    bool is_parallel = second_gap_m - view.gap_m <= TOLERANCE_M;
    double low_m = fmax(-view.half_m, is_parallel ? fmin(begin_m, end_m) : begin_m);
    double high_m = fmin(view.half_m, is_parallel ? fmax(begin_m, end_m) : begin_m);

    // The point lies on the edge, in the middle of what touches.
    double place_m = 0.5 * (low_m + high_m);
    cp_vec2 local_m =
        cp_vec2_add(cp_vec2_scale(view.normal, view.out_m), cp_vec2_scale(view.along, place_m));
    cp_first_touch touch = {.point_m = cp_pose_to_world(frame_of(&body[owner].rectangle), local_m)};

    // Two edges are two sides; a corner is of the side that meets the other.
    if (is_parallel && high_m - low_m > TOLERANCE_M) {
        touch.side[owner] = view.side;
        touch.side[1 - owner] = side_between(view.nearest, second);
        return touch;
    }
    bool at_own_corner = fabs(place_m) > view.half_m - TOLERANCE_M;
    touch.side[owner] = at_own_corner ? side_at_corner(body, owner, touch.point_m) : view.side;
    touch.side[1 - owner] = side_at_corner(body, 1 - owner, touch.point_m);
    return touch;
}
