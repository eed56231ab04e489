/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef EXCHANGE_CRASH_SITES_H
#define EXCHANGE_CRASH_SITES_H

#include "exchange/crash_selection.h"
#include "exchange/network_projection.h"

#include <stdio.h>

/* Where crashes happened, for maps. Texts are escaped as the format asks. */

/* A SUMO additional file of points of interest, as sumo-gui draws them on the network
 * (--additional-files): id "crash.<id>", colour by the larger OLC of its frontally struck vehicles
 * from yellow (0 g and none) to red (40 g and more), the rest as parameters. */
void cp_sumo_poi_begin(FILE *file);
void cp_sumo_poi_write(FILE *file, const cp_selected_crash *crash);
void cp_sumo_poi_end(FILE *file);

/* A GeoJSON FeatureCollection (RFC 7946) of points with the crash as properties. projection:
 * coordinates are degrees of longitude and latitude; NULL: metres of the network's plane, which is
 * no GeoJSON that a map lays in its place, and said in a member "coordinates". Errors: those of the
 * projection. */
void cp_geojson_begin(FILE *file, const cp_network_projection *projection);
CP_MUST_CHECK cp_status cp_geojson_write(FILE *file, const cp_selected_crash *crash,
                                         const cp_network_projection *projection, size_t number,
                                         cp_error *error);
void cp_geojson_end(FILE *file);

#endif
