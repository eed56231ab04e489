/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "traffic/lane_map.h"

#include "core/geometry.h"
#include "core/units.h"

#include <stdlib.h>
#include <string.h>

struct cp_lane_map {
    cp_lane *lane;
    size_t count;
    cp_lane_point *points; /* of all lanes */
    cp_lane_link *links;
    uint32_t *froms;
};

static double heading_rad(const cp_lane_point *from, const cp_lane_point *to)
{
    return atan2(to->y_m - from->y_m, to->x_m - from->x_m);
}

// How far a link turns from the end of a lane to the beginning of the lane beyond.
static double turn_rad(const cp_lane_map *map, const cp_lane *from, uint32_t to)
{
    if (to >= map->count || map->lane[to].point_count < 2 || from->point_count < 2)
        return CP_PI;
    const cp_lane_point *end = from->point + from->point_count - 1;
    const cp_lane_point *begin = map->lane[to].point;
    return fabs(cp_wrap_angle(heading_rad(begin, begin + 1) - heading_rad(end - 1, end)));
}

static void find_straight(cp_lane_map *map)
{
    for (size_t k = 0; k < map->count; k++) {
        cp_lane *lane = &map->lane[k];
        double least_rad = INFINITY;
        for (size_t i = 0; i < lane->link_count; i++) {
            double here_rad = turn_rad(map, lane, lane->link[i].to);
            if (here_rad < least_rad) {
                least_rad = here_rad;
                lane->straight = (uint32_t)i;
            }
        }
    }
}

uint32_t cp_lane_link_next(const cp_lane_link *link)
{
    return link->via != CP_LANE_NONE ? link->via : link->to;
}

// Links the other way round; room for as many as there are links. Links to lanes there are not are
// left out.
static void find_from(cp_lane_map *map)
{
    uint32_t *next = map->froms;
    for (size_t k = 0; k < map->count; k++)
        for (size_t i = 0; i < map->lane[k].link_count; i++)
            if (cp_lane_link_next(&map->lane[k].link[i]) < map->count)
                map->lane[cp_lane_link_next(&map->lane[k].link[i])].from_count++;
    for (size_t k = 0; k < map->count; k++) {
        map->lane[k].from = next;
        next += map->lane[k].from_count;
        map->lane[k].from_count = 0;
    }
    for (size_t k = 0; k < map->count; k++)
        for (size_t i = 0; i < map->lane[k].link_count; i++) {
            uint32_t to = cp_lane_link_next(&map->lane[k].link[i]);
            if (to >= map->count)
                continue;
            cp_lane *lane = &map->lane[to];
            map->froms[(size_t)(lane->from - map->froms) + lane->from_count++] = (uint32_t)k;
        }
}

cp_status cp_lane_map_create(const cp_lane *lanes, size_t count, cp_lane_map **map, cp_error *error)
{
    size_t points = 0, links = 0;
    for (size_t k = 0; k < count; k++) {
        points += lanes[k].point_count;
        links += lanes[k].link_count;
    }
    *map = NULL;
    cp_lane_map *created = calloc(1, sizeof *created);
    if (created == NULL)
        return cp_fail_memory(error, "lanes");
    created->lane = calloc(count + 1, sizeof *created->lane);
    created->points = calloc(points + 1, sizeof *created->points);
    created->links = calloc(links + 1, sizeof *created->links);
    created->froms = calloc(links + 1, sizeof *created->froms);
    created->count = count;
    if (created->lane == NULL || created->points == NULL || created->links == NULL ||
        created->froms == NULL) {
        cp_lane_map_destroy(created);
        return cp_fail_memory(error, "lanes");
    }
    cp_lane_point *point = created->points;
    cp_lane_link *link = created->links;
    for (size_t k = 0; k < count; k++) {
        cp_lane *lane = &created->lane[k];
        *lane = lanes[k];
        lane->point = point;
        lane->link = link;
        lane->from_count = 0;
        for (size_t i = 0; i < lane->point_count; i++)
            *point++ = lanes[k].point[i];
        for (size_t i = 0; i < lane->link_count; i++)
            *link++ = lanes[k].link[i];
    }
    find_straight(created);
    find_from(created);
    *map = created;
    return CP_OK;
}

void cp_lane_map_destroy(cp_lane_map *map)
{
    if (map == NULL)
        return;
    free(map->lane);
    free(map->points);
    free(map->links);
    free(map->froms);
    free(map);
}

const cp_lane *cp_lane_map_lane(const cp_lane_map *map, uint32_t lane)
{
    return lane < map->count && map->lane[lane].point_count >= 2 ? &map->lane[lane] : NULL;
}

const cp_lane_link *cp_lane_map_link(const cp_lane_map *map, uint32_t number, uint32_t towards)
{
    const cp_lane *lane = cp_lane_map_lane(map, number);
    const cp_lane *aim = cp_lane_map_lane(map, towards);
    if (lane == NULL || lane->link_count == 0)
        return NULL;
    const cp_lane_link *taken = &lane->link[lane->straight];
    bool is_on_edge = false;
    for (size_t k = 0; aim != NULL && !lane->is_inside && k < lane->link_count; k++) {
        const cp_lane *to = cp_lane_map_lane(map, lane->link[k].to);
        if (to == NULL || to->edge != aim->edge || (is_on_edge && lane->link[k].to != towards))
            continue;
        taken = &lane->link[k];
        is_on_edge = true;
    }
    return taken;
}
