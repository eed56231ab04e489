/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TRAFFIC_LANE_MAP_H
#define TRAFFIC_LANE_MAP_H

#include "core/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* (Compiles as C and as C++.) Where the lanes of a road network run and which follows which. */

#ifdef __cplusplus
extern "C" {
#endif

#define CP_LANE_NONE UINT32_MAX

/* A corner of a lane's centre line. */
typedef struct cp_lane_point {
    double x_m, y_m, z_m;
    double at_m; /* place along the lane, as the simulation counts it */
} cp_lane_point;

/* A way out of a lane. */
typedef struct cp_lane_link {
    uint32_t to;    /* lane beyond the junction */
    uint32_t via;   /* first lane inside the junction; CP_LANE_NONE without one */
    bool gives_way; /* by the signs: whoever takes it waits at its beginning for those who go first
                     */
} cp_lane_link;

typedef struct cp_lane {
    const cp_lane_point *point; /* at least two, or none: a lane that was never described */
    size_t point_count;
    const cp_lane_link *link;
    size_t link_count;
    const uint32_t *from; /* lanes that it follows right behind; worked out */
    size_t from_count;
    double width_m;
    uint32_t edge;          /* number of its edge */
    uint32_t straight;      /* index of the link that turns least; meaningless without links */
    bool is_inside;         /* of a junction */
    double speed_limit_m_s; /* 0: not known */
} cp_lane;

typedef struct cp_lane_map cp_lane_map;

/* Built once, constant; lanes by number, everything copied, from and straight are worked out.
 * Errors: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_lane_map_create(const cp_lane *lanes, size_t count, cp_lane_map **map,
                                           cp_error *error);
void cp_lane_map_destroy(cp_lane_map *map); /* NULL is fine */

/* A lane; NULL for one there is not. */
const cp_lane *cp_lane_map_lane(const cp_lane_map *map, uint32_t lane);

/* The link taken at the end of a lane: towards another lane if a link leads there (CP_LANE_NONE: no
 * matter where to), else to its edge, else straight on; NULL at the end of the road. */
const cp_lane_link *cp_lane_map_link(const cp_lane_map *map, uint32_t lane, uint32_t towards);

/* The lane right behind the end of another by one of its links. */
uint32_t cp_lane_link_next(const cp_lane_link *link);

#ifdef __cplusplus
}
#endif

#endif
