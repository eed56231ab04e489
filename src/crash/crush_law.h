/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_CRUSH_LAW_H
#define CRASH_CRUSH_LAW_H

#include "crash/crush_element.h"
#include "crash/vehicle_model.h"

/* The crush laws of a car's parts, from its parameters. Every stop yields where the passenger cell
 * behind it does: a fifth of cell_kn at each foot of a longitudinal member and at each half of the
 * engine's firewall, a tenth behind each half of the upper path, cell_edge_kn behind a corner; but
 * never below the largest force of the part's own collapse. Members and boxes hold what pulls at
 * them up to half of the largest force of their collapse: the side that nothing touches stays with
 * the car. */

/* A share of a law: of all its forces and stiffnesses. */
cp_crush_law cp_crush_law_share(cp_crush_law whole, double share_1);

/* One longitudinal member: three points. */
cp_crush_law cp_longitudinal_law(const cp_vehicle_model *model);
/* One crash box with the bumper in front of it: a third of the bumper's travel is its elastic rise.
 */
cp_crush_law cp_crash_box_law(const cp_vehicle_model *model);
/* Engine against firewall, one half of two: subframe and mounts give way at a constant force until
 * the engine meets the firewall. */
cp_crush_law cp_engine_bay_law(const cp_vehicle_model *model);
/* Outboard corner, half of the upper load path; whole parts, strips take shares. */
cp_crush_law cp_corner_law(const cp_vehicle_model *model);
cp_crush_law cp_upper_law(const cp_vehicle_model *model);
/* The edge of the passenger cell where it is pressed on itself: a constant force. */
cp_crush_law cp_cell_edge_law(const cp_vehicle_model *model);
/* Corner or upper load path pushed aside. */
cp_crush_law cp_corner_side_law(const cp_vehicle_model *model);

/* One metre of a side's zone, front to back: its stop is the whole side's. */
enum { CP_ZONE_FRONT_WHEEL, CP_ZONE_DOOR, CP_ZONE_REAR_WHEEL, CP_SIDE_ZONES };
cp_crush_law cp_side_zone_law(const cp_vehicle_model *model, int zone);
/* Points of a side whose zones are pressed on over those widths: the laws of all zones have their
 * points at the same depths, so that of the side is their sum. Beyond it stops as the body does,
 * up to cell_kn. */
cp_crush_law cp_side_law(const cp_crush_law zone[CP_SIDE_ZONES],
                         const double width_m[CP_SIDE_ZONES]);
/* The rear over its whole width: bumper, then rails, floor and luggage compartment. */
cp_crush_law cp_rear_law(const cp_vehicle_model *model);
/* The face of a barrier over its whole width. */
cp_crush_law cp_barrier_face_law(const cp_barrier *barrier);
/* The rear overhang pushed aside. */
cp_crush_law cp_rear_side_law(const cp_vehicle_model *model);

#endif
