/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/contact.h"

#include <stddef.h>

// The core rectangle of an outline as a polygon, counter-clockwise, with outward edge normals;
// edge k runs from corner k to corner k + 1.
typedef struct polygon {
    cp_vec2 corner[4];
    cp_vec2 normal[4];
} polygon;

static polygon core_polygon(const cp_outline *outline)
{
    double a = outline->half_length_m - outline->radius_m;
    double b = outline->half_width_m - outline->radius_m;
    cp_vec2 along = outline->along;
    cp_vec2 across = {-along.y, along.x};
    polygon core;
    static const double SIGN_ALONG[4] = {1, -1, -1, 1};
    static const double SIGN_ACROSS[4] = {1, 1, -1, -1};
    for (int k = 0; k < 4; k++) {
        cp_vec2 reach = cp_vec2_add(cp_vec2_scale(along, SIGN_ALONG[k] * a),
                                    cp_vec2_scale(across, SIGN_ACROSS[k] * b));
        core.corner[k] = cp_vec2_add(outline->centre_m, reach);
    }
    core.normal[0] = across;
    core.normal[1] = cp_vec2_scale(along, -1.0);
    core.normal[2] = cp_vec2_scale(across, -1.0);
    core.normal[3] = along;
    return core;
}

// The face of a polygon that another one is farthest in front of, and the other's corner nearest
// to that face.
typedef struct face_view {
    double gap_m;
    int face;
    int corner;
} face_view;

static face_view face_gap(const polygon *a, const polygon *b)
{
    face_view widest = {.gap_m = -INFINITY};
    for (int k = 0; k < 4; k++) {
        face_view nearest = {.gap_m = INFINITY, .face = k};
        for (int j = 0; j < 4; j++) {
            cp_vec2 reach = cp_vec2_sub(b->corner[j], a->corner[k]);
            double gap_m = cp_vec2_dot(reach, a->normal[k]);
            if (gap_m < nearest.gap_m) {
                nearest.gap_m = gap_m;
                nearest.corner = j;
            }
        }
        if (nearest.gap_m > widest.gap_m)
            widest = nearest;
    }
    return widest;
}

// Whether the nearest corner lies straight in front of the face: then nothing is nearer.
static bool straight_ahead(const polygon *a, const polygon *b, const face_view *view)
{
    // Along the normal's own tangent, so that a face without width is no face.
    cp_vec2 origin = a->corner[view->face], normal = a->normal[view->face];
    cp_vec2 tangent = {-normal.y, normal.x};
    double width_m = cp_vec2_dot(cp_vec2_sub(a->corner[(view->face + 1) % 4], origin), tangent);
    double along_m = cp_vec2_dot(cp_vec2_sub(b->corner[view->corner], origin), tangent);
    return along_m >= 0.0 && along_m <= width_m;
}

static cp_vec2 nearest_on_edge(cp_vec2 from, cp_vec2 to, cp_vec2 point)
{
    cp_vec2 edge = cp_vec2_sub(to, from);
    double square = cp_vec2_dot(edge, edge);
    double share = square > 0.0 ? cp_vec2_dot(cp_vec2_sub(point, from), edge) / square : 0.0;
    return cp_vec2_add(from, cp_vec2_scale(edge, fmin(1.0, fmax(0.0, share))));
}

// Take the pair (p on a, q on b) if it is nearer than what was found so far.
static void keep_nearer(cp_vec2 p, cp_vec2 q, double *nearest_square, cp_vec2 *on_a, cp_vec2 *on_b)
{
    cp_vec2 apart = cp_vec2_sub(q, p);
    double square = cp_vec2_dot(apart, apart);
    if (square < *nearest_square) {
        *nearest_square = square;
        *on_a = p;
        *on_b = q;
    }
}

// Nearest points of two polygons that do not overlap; returns their distance.
static double nearest_points(const polygon *a, const polygon *b, cp_vec2 *on_a, cp_vec2 *on_b)
{
    double nearest_square = INFINITY;
    for (int k = 0; k < 4; k++) {
        for (int j = 0; j < 4; j++) {
            keep_nearer(nearest_on_edge(a->corner[k], a->corner[(k + 1) % 4], b->corner[j]),
                        b->corner[j], &nearest_square, on_a, on_b);
            keep_nearer(a->corner[k],
                        nearest_on_edge(b->corner[j], b->corner[(j + 1) % 4], a->corner[k]),
                        &nearest_square, on_a, on_b);
        }
    }
    return sqrt(nearest_square);
}

// Round corner against round corner: one point on the line between the two core corners.
static cp_manifold corner_contact(cp_vec2 on_a, cp_vec2 on_b, double distance_m, double radius_a_m,
                                  double radius_b_m, double reach_m)
{
    cp_manifold manifold = {0};
    double depth_m = radius_a_m + radius_b_m - distance_m;
    if (depth_m <= -reach_m || distance_m <= 0.0)
        return manifold;
    manifold.normal = cp_vec2_scale(cp_vec2_sub(on_b, on_a), 1.0 / distance_m);
    manifold.count = 1;
    manifold.point[0].depth_m = depth_m;
    manifold.point[0].position_m =
        cp_vec2_add(on_a, cp_vec2_scale(manifold.normal, radius_a_m - 0.5 * depth_m));
    return manifold;
}

// Face of the reference polygon against the edge of the other that faces it most: the part of
// that edge within the face's width, up to two points.
static cp_manifold face_contact(const polygon *reference, int face, const polygon *other,
                                double radius_reference_m, double radius_other_m, double reach_m)
{
    cp_vec2 normal = reference->normal[face];
    int facing = 0;
    double lowest = INFINITY;
    for (int k = 0; k < 4; k++) {
        double cosine = cp_vec2_dot(other->normal[k], normal);
        if (cosine < lowest) {
            lowest = cosine;
            facing = k;
        }
    }

    // Both ends of the facing edge, in coordinates along the face and away from it.
    cp_vec2 origin = reference->corner[face];
    cp_vec2 edge = cp_vec2_sub(reference->corner[(face + 1) % 4], origin);
    double width_m = cp_vec2_length(edge);
    cp_vec2 along = {-normal.y, normal.x};
    cp_vec2 end[2] = {other->corner[facing], other->corner[(facing + 1) % 4]};
    double s[2], gap[2];
    for (int k = 0; k < 2; k++) {
        s[k] = cp_vec2_dot(cp_vec2_sub(end[k], origin), along);
        gap[k] = cp_vec2_dot(cp_vec2_sub(end[k], origin), normal);
    }

    // Cut the edge at the ends of the face.
    cp_manifold manifold = {.normal = normal};
    double span = s[1] - s[0];
    for (int k = 0; k < 2; k++) {
        double at = fmin(width_m, fmax(0.0, s[k]));
        double share = fabs(span) > 1e-12 ? (at - s[0]) / span : 0.0;
        if (share < -1e-9 || share > 1.0 + 1e-9)
            continue;
        double gap_m = gap[0] + share * (gap[1] - gap[0]);
        double depth_m = radius_reference_m + radius_other_m - gap_m;
        if (depth_m <= -reach_m || (k == 1 && fabs(span) <= 1e-12))
            continue;
        cp_vec2 foot = cp_vec2_add(origin, cp_vec2_scale(along, at));
        cp_contact_point *point = &manifold.point[manifold.count++];
        point->depth_m = depth_m;
        point->position_m =
            cp_vec2_add(foot, cp_vec2_scale(normal, radius_reference_m - 0.5 * depth_m));
    }
    return manifold;
}

// Quick rejection by the circles around both.
static bool far_apart(const cp_outline *a, const cp_outline *b, double reach_m)
{
    double reach = sqrt(a->half_length_m * a->half_length_m + a->half_width_m * a->half_width_m) +
                   sqrt(b->half_length_m * b->half_length_m + b->half_width_m * b->half_width_m) +
                   reach_m;
    cp_vec2 apart = cp_vec2_sub(a->centre_m, b->centre_m);
    return cp_vec2_dot(apart, apart) > reach * reach;
}

// Whether b lies beyond one of a's four sides.
static bool beyond_a_side(const cp_outline *a, const cp_outline *b, double reach_m)
{
    cp_vec2 apart = cp_vec2_sub(b->centre_m, a->centre_m), ahead = a->along;
    double cosine = fabs(cp_vec2_dot(ahead, b->along)), sine = fabs(cp_vec2_cross(ahead, b->along));
    double along_m = fabs(cp_vec2_dot(apart, ahead)), across_m = fabs(cp_vec2_cross(ahead, apart));
    return along_m >
               a->half_length_m + b->half_length_m * cosine + b->half_width_m * sine + reach_m ||
           across_m >
               a->half_width_m + b->half_length_m * sine + b->half_width_m * cosine + reach_m;
}

cp_manifold cp_outline_contact(const cp_outline *a, const cp_outline *b, double reach_m)
{
    cp_manifold none = {0};
    if (far_apart(a, b, reach_m) || beyond_a_side(a, b, reach_m) || beyond_a_side(b, a, reach_m))
        return none;
    polygon core_a = core_polygon(a), core_b = core_polygon(b);
    face_view from_a = face_gap(&core_a, &core_b), from_b = face_gap(&core_b, &core_a);
    bool a_leads = from_a.gap_m >= from_b.gap_m - 1e-9;
    double gap_m = fmax(from_a.gap_m, from_b.gap_m);
    if (gap_m > a->radius_m + b->radius_m + reach_m)
        return none;

    // Separated cores whose nearest features are two corners meet on their rounding.
    bool ahead = a_leads ? straight_ahead(&core_a, &core_b, &from_a)
                         : straight_ahead(&core_b, &core_a, &from_b);
    if (gap_m > 0.0 && !ahead) {
        cp_vec2 on_a, on_b;
        double distance_m = nearest_points(&core_a, &core_b, &on_a, &on_b);
        if (distance_m > gap_m + 1e-9)
            return corner_contact(on_a, on_b, distance_m, a->radius_m, b->radius_m, reach_m);
    }
    if (a_leads)
        return face_contact(&core_a, from_a.face, &core_b, a->radius_m, b->radius_m, reach_m);
    cp_manifold manifold =
        face_contact(&core_b, from_b.face, &core_a, b->radius_m, a->radius_m, reach_m);
    manifold.normal = cp_vec2_scale(manifold.normal, -1.0);
    return manifold;
}

double cp_manifold_point_weight(const cp_manifold *manifold)
{
    if (manifold->count < 2)
        return 1.0;
    double apart_m =
        cp_vec2_length(cp_vec2_sub(manifold->point[1].position_m, manifold->point[0].position_m));
    return 0.5 + 0.5 * fmin(1.0, apart_m / CP_CONTACT_PATCH_M);
}

double cp_outline_distance_below(const cp_outline *a, const cp_outline *b, double limit_m)
{
    if (far_apart(a, b, limit_m))
        return INFINITY;
    polygon core_a = core_polygon(a), core_b = core_polygon(b);
    double radii_m = a->radius_m + b->radius_m;
    double gap_m = fmax(face_gap(&core_a, &core_b).gap_m, face_gap(&core_b, &core_a).gap_m);
    if (gap_m - radii_m >= limit_m)
        return INFINITY;
    if (gap_m > 0.0) {
        cp_vec2 on_a, on_b;
        gap_m = nearest_points(&core_a, &core_b, &on_a, &on_b);
    }
    return gap_m - radii_m;
}

double cp_outline_distance(const cp_outline *a, const cp_outline *b)
{
    return cp_outline_distance_below(a, b, INFINITY);
}
