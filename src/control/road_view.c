/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/road_view.h"

#include <stdlib.h>

/* How far ways are laid out: 5 s at motorway speed, and what a sensor sees. */
#define REACH_S 5.0
#define REACH_MIN_M 40.0
#define EDGES_AHEAD 12
#define NO_STEP (-1.0)

/* The ways of one vehicle in one step. */
typedef struct view_ways {
    double at_s[2]; /* clock of the step for which each choice was laid out; NO_STEP before */
    bool is_known[2];
    uint32_t route_of; /* lane on which its route was asked */
    size_t next_count;
    bool is_route; /* they are all there are */
    uint32_t next_lanes[EDGES_AHEAD];
    cp_lane_ahead *way[2];
} view_ways;

static double length_of(cp_vec2 vector)
{
    return sqrt(cp_vec2_dot(vector, vector));
}

struct cp_road_view {
    const cp_traffic *traffic;
    const cp_lane_map *map; /* NULL: not read yet, or there is none */
    bool is_read;
    double pruned_s;
    cp_vehicle_table ways; /* a view_ways of each */
};

static void release_ways(void *item)
{
    view_ways *ways = item;
    free(ways->way[0]);
    free(ways->way[1]);
}

cp_status cp_road_view_create(const cp_traffic *traffic, cp_road_view **view, cp_error *error)
{
    *view = calloc(1, sizeof **view);
    if (*view == NULL)
        return cp_fail_memory(error, "road view");
    (*view)->traffic = traffic;
    (*view)->pruned_s = NO_STEP;
    (*view)->ways = cp_vehicle_table_create(sizeof(view_ways), release_ways);
    return CP_OK;
}

void cp_road_view_destroy(cp_road_view *view)
{
    if (view == NULL)
        return;
    cp_vehicle_table_destroy(&view->ways);
    free(view);
}

// ---- ways ----------------------------------------------------------------------------------

// Once a step: whoever is gone needs no ways.
static cp_status prune(cp_road_view *view, cp_error *error)
{
    double now_s = cp_traffic_time_s(view->traffic);
    if (view->pruned_s == now_s)
        return CP_OK;
    view->pruned_s = now_s;
    return cp_vehicle_table_prune(&view->ways, view->traffic, error);
}

// Its route, asked again whenever it has come to another lane.
static cp_status ask_route(cp_road_view *view, const cp_vehicle_state *state, view_ways *ways,
                           cp_error *error)
{
    if (ways->route_of == state->lane + 1)
        return CP_OK;
    ways->route_of = state->lane + 1; // 0: of none
    const cp_lane *lane = cp_lane_map_lane(view->map, state->lane);
    cp_status status = cp_traffic_next_lanes(view->traffic, state->vehicle, ways->next_lanes,
                                             EDGES_AHEAD, &ways->next_count, error);
    // Out of a junction a route always leads on.
    ways->is_route = lane != NULL && (!lane->is_inside || ways->next_count > 0);
    return status;
}

static cp_status lay(cp_road_view *view, const cp_vehicle_motion *motion, cp_way_choice choice,
                     view_ways *ways, cp_error *error)
{
    const cp_vehicle_state *state = &motion->after;
    double reach_m = fmax(REACH_S * state->speed_m_s, REACH_MIN_M);
    size_t next_count = 0;
    bool is_route = false;
    cp_status status = CP_OK;
    if (ways->way[choice] == NULL)
        ways->way[choice] = malloc(sizeof *ways->way[choice]);
    if (ways->way[choice] == NULL)
        return cp_fail_memory(error, "road view");
    if (choice == CP_WAY_ROUTE) {
        status = ask_route(view, state, ways, error);
        next_count = ways->next_count;
        is_route = ways->is_route && next_count < EDGES_AHEAD;
    }
    if (status != CP_OK)
        return status;
    double slope_1 =
        cp_lateral_overlay_get(cp_traffic_overlays(view->traffic), state->vehicle).slope_1;
    ways->is_known[choice] = cp_lane_ahead_lay(view->map, motion, slope_1, ways->next_lanes,
                                               next_count, is_route, reach_m, ways->way[choice]);
    ways->at_s[choice] = cp_traffic_time_s(view->traffic);
    return CP_OK;
}

cp_status cp_road_view_way(cp_road_view *view, const cp_vehicle_motion *motion,
                           cp_way_choice choice, const cp_lane_ahead **way, cp_error *error)
{
    void *item;
    *way = NULL;
    if (view == NULL)
        return CP_OK;
    cp_status status = CP_OK;
    if (!view->is_read) {
        status = cp_traffic_lane_map(view->traffic, &view->map, error);
        view->is_read = status == CP_OK;
    }
    if (status != CP_OK || view->map == NULL)
        return status;
    status = prune(view, error);
    if (status == CP_OK)
        status = cp_vehicle_table_take(&view->ways, motion->after.vehicle, &item, error);
    if (status != CP_OK)
        return status;
    view_ways *ways = item;
    if (ways->way[choice] == NULL || ways->at_s[choice] != cp_traffic_time_s(view->traffic))
        status = lay(view, motion, choice, ways, error);
    if (status == CP_OK && ways->is_known[choice])
        *way = ways->way[choice];
    return status;
}

// ---- where they will be --------------------------------------------------------------------

cp_mover cp_mover_inside(const cp_vehicle_motion *motion, const cp_lane_ahead *way, double fraction)
{
    cp_mover mover = {.now = cp_moving_rectangle_inside(motion, fraction), .way = way};
    if (way == NULL || fraction >= 1.0)
        return mover;
    cp_vec2 half_m = cp_vec2_scale(cp_vec2_heading(mover.now.rectangle.yaw_rad),
                                   0.5 * mover.now.rectangle.length_m);
    cp_vec2 front_m = cp_vec2_add(mover.now.rectangle.centre_m, half_m);
    cp_vec2 after_m = {motion->after.front_x_m, motion->after.front_y_m};
    mover.begin_m = -length_of(cp_vec2_sub(after_m, front_m));
    return mover;
}

cp_rectangle cp_mover_at(const cp_mover *mover, double time_s)
{
    if (mover->way == NULL)
        return cp_moving_rectangle_at(&mover->now, time_s);
    double speed_m_s = length_of(mover->now.velocity_m_s);
    return cp_lane_ahead_at(mover->way, mover->begin_m + speed_m_s * time_s,
                            mover->now.rectangle.length_m, mover->now.rectangle.width_m);
}

// Nearer than half a metre to the centre of where it is then.
static cp_vec2 middle_at(const cp_mover *mover, double time_s)
{
    if (mover->way == NULL)
        return cp_moving_rectangle_at(&mover->now, time_s).centre_m;
    double way_m = mover->begin_m + length_of(mover->now.velocity_m_s) * time_s;
    return cp_lane_ahead_middle(mover->way, way_m, mover->now.rectangle.length_m);
}

// No point of its body is faster than this: front and rear keep its speed along the way, what lies
// beside the axis turns with it, by at most twice the speed over the length.
static double fastest_m_s(const cp_mover *mover)
{
    double speed_m_s = length_of(mover->now.velocity_m_s);
    const cp_rectangle *body = &mover->now.rectangle;
    if (mover->way != NULL)
        return speed_m_s * (1.0 + body->width_m / body->length_m);
    return speed_m_s + fabs(mover->now.yaw_rate_rad_s) * cp_rectangle_half_diagonal_m(body);
}

// Time after which a follower on one way could be at the other's rear; 0 when it is not like that.
// Who drives behind another in the same lanes is most of what there is to look at.
static double earliest_behind_s(const cp_mover *one, const cp_mover *other)
{
    if (one->way == NULL || other->way == NULL || one->way->is_inside || other->way->is_inside ||
        other->way->lane_step_1 < 0.0)
        return 0.0;
    const cp_way_point *front = &other->way->corner[other->way->front];
    double ahead_m = cp_lane_ahead_way_to_m(one->way, front->lane, front->lane_at_m);
    double own_m_s = length_of(one->now.velocity_m_s);
    double its_m_s = length_of(other->now.velocity_m_s);
    double gap_m = ahead_m - other->now.rectangle.length_m - 1.0;
    if (!(gap_m > 0.0) || ahead_m == INFINITY)
        return 0.0;
    return own_m_s > its_m_s ? gap_m / (own_m_s - its_m_s) : INFINITY;
}

// When SUMO takes it off the road.
static double leaves_after_s(const cp_mover *mover)
{
    double speed_m_s = length_of(mover->now.velocity_m_s);
    if (mover->way == NULL || mover->way->ends_m == INFINITY || !(speed_m_s > 0.0))
        return INFINITY;
    return (mover->way->ends_m - mover->begin_m) / speed_m_s;
}

double cp_mover_ttc_s(const cp_mover *one, const cp_mover *other, double horizon_s)
{
    const double contact_m = 1e-3;
    if (one->way == NULL && other->way == NULL)
        return cp_ttc_s(&one->now, &other->now, horizon_s);
    double bound_m_s = fastest_m_s(one) + fastest_m_s(other), time_s = 0.0;
    if (!(bound_m_s > 0.0) || earliest_behind_s(one, other) > horizon_s)
        return INFINITY;
    horizon_s = fmin(horizon_s, fmin(leaves_after_s(one), leaves_after_s(other)));
    // Conservative advancement: the gap closes by no more than the bound. Far apart, the circles
    // round the middles tell enough of it.
    double reach_m = cp_rectangle_half_diagonal_m(&one->now.rectangle) +
                     cp_rectangle_half_diagonal_m(&other->now.rectangle);
    while (time_s <= horizon_s) {
        double gap_m = length_of(cp_vec2_sub(middle_at(one, time_s), middle_at(other, time_s))) -
                       reach_m - 1.0;
        if (gap_m < 0.5) {
            cp_rectangle there = cp_mover_at(one, time_s), other_there = cp_mover_at(other, time_s);
            gap_m = cp_rectangle_separation(&there, &other_there);
        }
        if (gap_m <= contact_m)
            return time_s;
        time_s += gap_m / bound_m_s;
    }
    return INFINITY;
}

// ---- whether roads meet --------------------------------------------------------------------

static cp_status place_at(const cp_road_view *view, const cp_vehicle_motion *motion,
                          const cp_mover *mover, double time_s, cp_vehicle_state *state,
                          cp_error *error)
{
    *state = motion->after;
    if (mover->way == NULL)
        return cp_traffic_place(view->traffic, state, error);
    double speed_m_s = length_of(mover->now.velocity_m_s);
    cp_lane_ahead_place(mover->way, mover->begin_m + speed_m_s * time_s, state);
    return CP_OK;
}

cp_status cp_road_view_meet(cp_road_view *view, const cp_vehicle_motion *one,
                            const cp_mover *one_moves, const cp_vehicle_motion *other,
                            const cp_mover *other_moves, double time_s, bool *meet, cp_error *error)
{
    cp_vehicle_state states[2];
    cp_road_relation relation = CP_ROADS_MEET;
    cp_status status = CP_OK;
    *meet = true;
    if (view == NULL || (one_moves->way == NULL && other_moves->way == NULL))
        return CP_OK;
    status = place_at(view, one, one_moves, time_s, &states[0], error);
    if (status == CP_OK)
        status = place_at(view, other, other_moves, time_s, &states[1], error);
    if (status == CP_OK)
        status = cp_traffic_road_relation(view->traffic, &states[0], &states[1], &relation, error);
    *meet = relation == CP_ROADS_MEET;
    return status;
}

cp_status cp_road_view_ttc_s(cp_road_view *view, const cp_vehicle_motion *own,
                             const cp_vehicle_motion *other, double horizon_s, double *ttc_s,
                             cp_error *error)
{
    const cp_lane_ahead *own_way = NULL, *other_way = NULL;
    bool meet = true;
    *ttc_s = INFINITY;
    cp_status status = cp_road_view_way(view, own, CP_WAY_ROUTE, &own_way, error);
    if (status == CP_OK)
        status = cp_road_view_way(view, other, CP_WAY_STRAIGHT, &other_way, error);
    if (status != CP_OK)
        return status;
    cp_mover one = cp_mover_inside(own, own_way, 1.0);
    cp_mover two = cp_mover_inside(other, other_way, 1.0);
    one.now.yaw_rate_rad_s = two.now.yaw_rate_rad_s = 0.0; // of those without a way
    double found_s = cp_mover_ttc_s(&one, &two, horizon_s);
    if (found_s == INFINITY)
        return CP_OK;
    status = cp_road_view_meet(view, own, &one, other, &two, found_s, &meet, error);
    if (meet)
        *ttc_s = found_s;
    return status;
}
