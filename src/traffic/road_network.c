/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "traffic/road_network.h"

#include "core/geometry.h"

#include <stdlib.h>
#include <string.h>

/* Ends of roads that no connection names (the rim of the network): the two directions of one road
 * end at most this far apart. */
#define RIM_M 20.0

/* Junctions looked at on one search, all within a few car lengths; the nearest come first, so what
 * does not fit is further away. */
#define FRONTIER_MAX 64

/* A lane in the network: on an edge, or inside a junction. */
typedef struct lane {
    uint32_t edge;
    uint32_t junction; /* CP_ROAD_NONE on an edge */
} lane;

typedef struct edge {
    const char *name; /* while building */
    double length_m;
    cp_vec2 begin_m, end_m;
    uint32_t from, to; /* junctions */
    uint32_t road;     /* shared by both directions */
    bool is_reversed;  /* against the direction its road is measured in */
} edge;

struct cp_road_network {
    lane *lane;
    size_t lane_count;
    edge *edge;
    size_t edge_count;
    uint32_t junction_count;
    uint32_t *first_at; /* by junction: where its edges begin in edge_at; junction_count + 1 */
    uint32_t *edge_at;
};

// ---- names to numbers ----------------------------------------------------------------------

/* A name and whom it belongs to, for sorting. */
typedef struct named {
    const char *name;
    uint32_t lane;
} named;

static int compare_named(const void *left, const void *right)
{
    const named *a = left, *b = right;
    int order = strcmp(a->name, b->name);
    return order != 0 ? order : (a->lane > b->lane) - (a->lane < b->lane);
}

// The lanes' edges (or junctions), numbered in the order of their names; number_of by lane.
static cp_status number_names(const cp_road_lane *lanes, size_t count, bool junctions,
                              uint32_t *number_of, uint32_t *numbers, cp_error *error)
{
    named *list = malloc((count + 1) * sizeof *list);
    if (list == NULL)
        return cp_fail_memory(error, "road network");
    size_t used = 0;
    for (size_t k = 0; k < count; k++) {
        number_of[k] = CP_ROAD_NONE;
        bool is_inside = lanes[k].junction != NULL;
        if (is_inside == junctions)
            list[used++] = (named){is_inside ? lanes[k].junction : lanes[k].edge, (uint32_t)k};
    }
    qsort(list, used, sizeof *list, compare_named);
    *numbers = 0;
    for (size_t k = 0; k < used; k++) {
        *numbers += k == 0 || strcmp(list[k].name, list[k - 1].name) != 0;
        number_of[list[k].lane] = *numbers - 1;
    }
    free(list);
    return CP_OK;
}

// ---- building ------------------------------------------------------------------------------

// Edges from their lanes: the first lane stands for all.
static void take_lanes(cp_road_network *network, const cp_road_lane *lanes, const uint32_t *edge_of,
                       const uint32_t *junction_of)
{
    for (size_t k = 0; k < network->lane_count; k++) {
        network->lane[k] = (lane){edge_of[k], junction_of[k]};
        if (edge_of[k] == CP_ROAD_NONE)
            continue;
        edge *own = &network->edge[edge_of[k]];
        if (own->name == NULL)
            *own = (edge){.name = lanes[k].edge,
                          .length_m = lanes[k].length_m,
                          .begin_m = {lanes[k].begin_x_m, lanes[k].begin_y_m},
                          .end_m = {lanes[k].end_x_m, lanes[k].end_y_m},
                          .from = CP_ROAD_NONE,
                          .to = CP_ROAD_NONE,
                          .road = CP_ROAD_NONE};
    }
}

// All edge ends that carry one junction number get another.
static void rename_junction(cp_road_network *network, uint32_t old, uint32_t new)
{
    for (size_t k = 0; k < network->edge_count; k++) {
        if (network->edge[k].from == old)
            network->edge[k].from = new;
        if (network->edge[k].to == old)
            network->edge[k].to = new;
    }
}

// A connection joins the end of one edge, the beginning of another and the junction between.
static void take_connection(cp_road_network *network, const cp_road_connection *connection)
{
    size_t count = network->lane_count;
    if (connection->from_lane >= count || connection->to_lane >= count)
        return;
    const lane *from = &network->lane[connection->from_lane];
    const lane *to = &network->lane[connection->to_lane];
    if (from->edge == CP_ROAD_NONE || to->edge == CP_ROAD_NONE)
        return;
    uint32_t *ends[2] = {&network->edge[from->edge].to, &network->edge[to->edge].from};
    uint32_t junction = CP_ROAD_NONE;
    if (connection->via_lane < count)
        junction = network->lane[connection->via_lane].junction;
    for (int k = 0; k < 2 && junction == CP_ROAD_NONE; k++)
        junction = *ends[k];
    if (junction == CP_ROAD_NONE)
        junction = network->junction_count++;
    for (int k = 0; k < 2; k++) {
        if (*ends[k] != CP_ROAD_NONE && *ends[k] != junction)
            rename_junction(network, *ends[k], junction);
        *ends[k] = junction;
    }
}

static bool are_near(cp_vec2 one_m, cp_vec2 other_m)
{
    return cp_vec2_length(cp_vec2_sub(one_m, other_m)) <= RIM_M;
}

// At the rim of the network: one junction for a road that ends and one that begins beside it.
static void join_rim(cp_road_network *network)
{
    for (size_t k = 0; k < network->edge_count; k++) {
        edge *ending = &network->edge[k];
        if (ending->to != CP_ROAD_NONE)
            continue;
        ending->to = network->junction_count++;
        for (size_t i = 0; i < network->edge_count; i++) {
            edge *beginning = &network->edge[i];
            if (beginning->from == CP_ROAD_NONE && are_near(ending->end_m, beginning->begin_m))
                beginning->from = ending->to;
        }
    }
    for (size_t k = 0; k < network->edge_count; k++)
        if (network->edge[k].from == CP_ROAD_NONE)
            network->edge[k].from = network->junction_count++;
}

// Edges by the junctions they touch.
static cp_status index_junctions(cp_road_network *network, cp_error *error)
{
    size_t junctions = network->junction_count;
    network->first_at = calloc(junctions + 2, sizeof *network->first_at);
    network->edge_at = calloc(2 * network->edge_count + 1, sizeof *network->edge_at);
    if (network->first_at == NULL || network->edge_at == NULL)
        return cp_fail_memory(error, "road network");
    for (size_t k = 0; k < network->edge_count; k++) {
        network->first_at[network->edge[k].from + 1]++;
        network->first_at[network->edge[k].to + 1]++;
    }
    for (size_t k = 1; k <= junctions; k++)
        network->first_at[k] += network->first_at[k - 1];
    uint32_t *filled = calloc(junctions + 1, sizeof *filled);
    if (filled == NULL)
        return cp_fail_memory(error, "road network");
    for (size_t k = 0; k < network->edge_count; k++) {
        uint32_t ends[2] = {network->edge[k].from, network->edge[k].to};
        for (int end = 0; end < 2; end++)
            network->edge_at[network->first_at[ends[end]] + filled[ends[end]]++] = (uint32_t)k;
    }
    free(filled);
    return CP_OK;
}

// Both directions of a road share its number; it is measured along the one that comes first.
static void pair_directions(cp_road_network *network)
{
    uint32_t roads = 0;
    for (size_t k = 0; k < network->edge_count; k++) {
        edge *one = &network->edge[k];
        if (one->road != CP_ROAD_NONE)
            continue;
        one->road = roads++;
        for (uint32_t i = network->first_at[one->to]; i < network->first_at[one->to + 1]; i++) {
            edge *other = &network->edge[network->edge_at[i]];
            if (other->road == CP_ROAD_NONE && other->from == one->to && other->to == one->from) {
                other->road = one->road;
                other->is_reversed = true;
                break;
            }
        }
    }
}

cp_status cp_road_network_create(const cp_road_lane *lanes, size_t lane_count,
                                 const cp_road_connection *connections, size_t connection_count,
                                 cp_road_network **network, cp_error *error)
{
    *network = NULL;
    cp_status status = CP_OK;
    uint32_t edges = 0;
    cp_road_network *created = calloc(1, sizeof *created);
    uint32_t *edge_of = malloc((lane_count + 1) * sizeof *edge_of);
    uint32_t *junction_of = malloc((lane_count + 1) * sizeof *junction_of);
    if (created == NULL || edge_of == NULL || junction_of == NULL)
        status = cp_fail_memory(error, "road network");
    if (status == CP_OK)
        status = number_names(lanes, lane_count, false, edge_of, &edges, error);
    if (status == CP_OK)
        status =
            number_names(lanes, lane_count, true, junction_of, &created->junction_count, error);
    if (status != CP_OK)
        goto done;

    created->lane = calloc(lane_count + 1, sizeof *created->lane);
    created->edge = calloc((size_t)edges + 1, sizeof *created->edge);
    if (created->lane == NULL || created->edge == NULL) {
        status = cp_fail_memory(error, "road network");
        goto done;
    }
    created->lane_count = lane_count;
    created->edge_count = edges;
    take_lanes(created, lanes, edge_of, junction_of);
    for (size_t k = 0; k < connection_count; k++)
        take_connection(created, &connections[k]);
    join_rim(created);
    status = index_junctions(created, error);
    if (status == CP_OK)
        pair_directions(created);
done:
    free(junction_of);
    free(edge_of);
    if (status != CP_OK)
        cp_road_network_destroy(created);
    else
        *network = created;
    return status;
}

void cp_road_network_destroy(cp_road_network *network)
{
    if (network == NULL)
        return;
    free(network->lane);
    free(network->edge);
    free(network->first_at);
    free(network->edge_at);
    free(network);
}

// ---- asking --------------------------------------------------------------------------------

/* Junctions reached so far and how far they are. */
typedef struct frontier {
    uint32_t junction[FRONTIER_MAX];
    double distance_m[FRONTIER_MAX];
    size_t count;
} frontier;

// Note a junction at a distance; a shorter way replaces a longer one. True when it told something
// new.
static bool reach(frontier *reached, uint32_t junction, double distance_m, double reach_m)
{
    if (distance_m > reach_m)
        return false;
    size_t k = 0;
    while (k < reached->count && reached->junction[k] != junction)
        k++;
    if (k == FRONTIER_MAX || (k < reached->count && reached->distance_m[k] <= distance_m))
        return false;
    reached->junction[k] = junction;
    reached->distance_m[k] = distance_m;
    if (k == reached->count)
        reached->count++;
    return true;
}

// Where a place lies on its edge, kept within it (routes may be measured a little longer).
static double along(const edge *own, double position_m)
{
    return fmin(fmax(position_m, 0.0), own->length_m);
}

// The junctions a place lies at or between.
static void begin_at(const cp_road_network *network, cp_road_place place, frontier *reached,
                     double reach_m)
{
    const lane *own = &network->lane[place.lane];
    if (own->edge == CP_ROAD_NONE) {
        (void)reach(reached, own->junction, 0.0, reach_m);
        return;
    }
    const edge *on = &network->edge[own->edge];
    double position_m = along(on, place.position_m);
    (void)reach(reached, on->from, position_m, reach_m);
    (void)reach(reached, on->to, on->length_m - position_m, reach_m);
}

// On one road, in either direction: the difference of the places along it.
static double along_one_road_m(const cp_road_network *network, cp_road_place one,
                               cp_road_place other)
{
    uint32_t edges[2] = {network->lane[one.lane].edge, network->lane[other.lane].edge};
    if (edges[0] == CP_ROAD_NONE || edges[1] == CP_ROAD_NONE)
        return INFINITY;
    const edge *on[2] = {&network->edge[edges[0]], &network->edge[edges[1]]};
    if (on[0]->road != on[1]->road)
        return INFINITY;
    double place_m[2] = {along(on[0], one.position_m), along(on[1], other.position_m)};
    for (int k = 0; k < 2; k++)
        if (on[k]->is_reversed)
            place_m[k] = on[k]->length_m - place_m[k];
    return fabs(place_m[0] - place_m[1]);
}

// From the k-th junction reached along all its roads; true when a junction came nearer.
static bool go_on(const cp_road_network *network, frontier *reached, size_t k, double reach_m)
{
    bool is_news = false;
    uint32_t here = reached->junction[k];
    for (uint32_t i = network->first_at[here]; i < network->first_at[here + 1]; i++) {
        const edge *way = &network->edge[network->edge_at[i]];
        uint32_t there = way->from == here ? way->to : way->from;
        is_news |= reach(reached, there, reached->distance_m[k] + way->length_m, reach_m);
    }
    return is_news;
}

double cp_road_distance_m(const cp_road_network *network, cp_road_place one, cp_road_place other,
                          double reach_m)
{
    if (one.lane >= network->lane_count || other.lane >= network->lane_count)
        return INFINITY;
    double best_m = along_one_road_m(network, one, other);

    // From one place over the junctions around it, and from the other to its own.
    frontier reached = {.count = 0}, goal = {.count = 0};
    begin_at(network, one, &reached, reach_m);
    begin_at(network, other, &goal, reach_m);
    for (bool is_news = true; is_news;) {
        is_news = false;
        for (size_t k = 0; k < reached.count; k++)
            is_news |= go_on(network, &reached, k, reach_m);
    }
    for (size_t k = 0; k < reached.count; k++)
        for (size_t i = 0; i < goal.count; i++)
            if (reached.junction[k] == goal.junction[i])
                best_m = fmin(best_m, reached.distance_m[k] + goal.distance_m[i]);
    return best_m <= reach_m ? best_m : INFINITY;
}
