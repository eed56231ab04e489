/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef EXCHANGE_NETWORK_PROJECTION_H
#define EXCHANGE_NETWORK_PROJECTION_H

#include "core/error.h"
#include "core/geometry.h"

/* Where a SUMO network lies on the earth: the element <location> of its file, offset and PROJ's
 * definition of its plane. */
typedef struct cp_network_projection cp_network_projection;

/* Read a network file, plain or compressed. *projection is NULL where the network has none ("!" or
 * "-"). The caller destroys. Errors: CP_BAD_INPUT for a file that is no network, a location that is
 * not understood; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_network_projection_read(const char *path,
                                                   cp_network_projection **projection,
                                                   cp_error *error);
/* NULL is fine. */
void cp_network_projection_destroy(cp_network_projection *projection);

/* A place of the network's plane, m, as degrees of longitude (x) and latitude (y), WGS 84. Error:
 * CP_BAD_INPUT where the projection has no such place. */
CP_MUST_CHECK cp_status cp_network_projection_degrees(const cp_network_projection *projection,
                                                      cp_vec2 place_m, cp_vec2 *degrees,
                                                      cp_error *error);

#endif
