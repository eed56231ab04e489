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

#endif
