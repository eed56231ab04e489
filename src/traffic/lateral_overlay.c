/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "traffic/lateral_overlay.h"

#include "core/geometry.h"
#include "core/units.h"

#include <stdlib.h>

/* One vehicle's. */
typedef struct entry {
    uint32_t vehicle;
    cp_lateral_overlay now;
    double mean_slope_1; /* for the coming step, if is_steered */
    double end_slope_1;
    bool is_steered;
    bool was_applied;
} entry;

struct cp_lateral_overlays {
    entry *list;
    size_t count;
    size_t capacity;
};

cp_status cp_lateral_overlays_create(cp_lateral_overlays **overlays, cp_error *error)
{
    *overlays = calloc(1, sizeof **overlays);
    return *overlays != NULL ? CP_OK : cp_fail_memory(error, "lateral overlays");
}

void cp_lateral_overlays_destroy(cp_lateral_overlays *overlays)
{
    if (overlays == NULL)
        return;
    free(overlays->list);
    free(overlays);
}

static entry *find(const cp_lateral_overlays *overlays, uint32_t vehicle)
{
    for (size_t k = 0; k < overlays->count; k++)
        if (overlays->list[k].vehicle == vehicle)
            return &overlays->list[k];
    return NULL;
}

cp_lateral_overlay cp_lateral_overlay_get(const cp_lateral_overlays *overlays, uint32_t vehicle)
{
    const entry *found = find(overlays, vehicle);
    return found != NULL ? found->now : (cp_lateral_overlay){0.0, 0.0};
}

cp_status cp_lateral_overlay_steer(cp_lateral_overlays *overlays, uint32_t vehicle,
                                   double mean_slope_1, double end_slope_1, cp_error *error)
{
    entry *own = find(overlays, vehicle);
    if (own == NULL) {
        if (overlays->count == overlays->capacity) {
            size_t capacity = overlays->capacity == 0 ? 16 : 2 * overlays->capacity;
            entry *list = realloc(overlays->list, capacity * sizeof *list);
            if (list == NULL)
                return cp_fail_memory(error, "lateral overlays");
            overlays->list = list;
            overlays->capacity = capacity;
        }
        own = &overlays->list[overlays->count++];
        *own = (entry){.vehicle = vehicle, .was_applied = true};
    }
    own->mean_slope_1 = mean_slope_1;
    own->end_slope_1 = end_slope_1;
    own->is_steered = true;
    return CP_OK;
}

void cp_lateral_overlay_end(cp_lateral_overlays *overlays, uint32_t vehicle)
{
    entry *own = find(overlays, vehicle);
    if (own == NULL)
        return;
    own->now = (cp_lateral_overlay){0.0, 0.0};
    own->is_steered = false;
}

void cp_lateral_overlay_return(cp_lateral_overlay now, double left_m, double way_m,
                               double *mean_slope_1, double *end_slope_1)
{
    *mean_slope_1 = *end_slope_1 = now.slope_1;
    if (way_m <= 0.0)
        return;
    // Hermite's cubic from (offset, slope) at 0 to (0, 0) at left_m.
    double s = left_m > way_m ? way_m / left_m : 1.0, rest = 1.0 - s;
    double offset_m =
        rest * rest * (now.offset_m * (1.0 + 2.0 * s) + now.slope_1 * fmax(left_m, way_m) * s);
    *mean_slope_1 = (offset_m - now.offset_m) / way_m;
    *end_slope_1 =
        rest * (now.slope_1 * (1.0 - 3.0 * s) - 6.0 * s * now.offset_m / fmax(left_m, way_m));
}

void cp_lateral_overlay_apply(cp_lateral_overlays *overlays, cp_vehicle_state *state, double way_m)
{
    entry *own = overlays->count > 0 ? find(overlays, state->vehicle) : NULL;
    if (own == NULL)
        return;

    // As it was steered, or on as it was.
    own->now.offset_m += (own->is_steered ? own->mean_slope_1 : own->now.slope_1) * way_m;
    if (own->is_steered)
        own->now.slope_1 = own->end_slope_1;
    own->is_steered = false;
    own->was_applied = true;

    cp_vec2 left = cp_vec2_heading(state->yaw_rad + 0.5 * CP_PI);
    state->front_x_m += own->now.offset_m * left.x;
    state->front_y_m += own->now.offset_m * left.y;
    if (own->now.slope_1 != 0.0)
        state->yaw_rad = cp_wrap_angle(state->yaw_rad + atan(own->now.slope_1));
}

void cp_lateral_overlays_prune(cp_lateral_overlays *overlays)
{
    size_t kept = 0;
    for (size_t k = 0; k < overlays->count; k++) {
        entry own = overlays->list[k];
        bool is_over = !own.is_steered && own.now.offset_m == 0.0 && own.now.slope_1 == 0.0;
        if (!own.was_applied || is_over)
            continue;
        own.was_applied = false;
        overlays->list[kept++] = own;
    }
    overlays->count = kept;
}
