/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef REPORT_NETWORK_H
#define REPORT_NETWORK_H

#include "analysis/study_data.h"

/* The roads of a scenario, to draw crash sites on: lane shapes of the SUMO network that its
 * replications used, found by the path of the sumocfg in their command line, from the folder they
 * were started in. */

/* {"file": name, "lanes": [[x, y, x, y, …], …], "width_m": […]} in the world's axes, rounded to
 * 0.1 m; or {"missing": why} when the files are not where they were. *network is the caller's to
 * release. Errors: those of the store, CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_network_json(cp_store *store, const char *scenario, json_t **network,
                                        cp_error *error);

/* Lane shapes in the text of a SUMO network; for tests too. At most points_max points: internal
 * lanes go first, then all but the first lane of an edge. NULL when memory is gone. */
json_t *cp_network_lanes(const char *net_xml, size_t points_max);

#endif
