/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TRAFFIC_SUMO_BRIDGE_H
#define TRAFFIC_SUMO_BRIDGE_H

/* C interface over libsumo. Conventions:
 *  - One simulation per process (libsumo's rule); one thread only.
 *  - No C++ exception crosses: every failure is a cp_status with SUMO's own message in the error
 *    (CP_BAD_INPUT from a configuration that cannot be started, CP_TRAFFIC_FAILED later).
 *  - SUMO's abort() on a failed assertion is not caught: callers run this in a worker process.
 *  - Frame and units: plane x east, y north, m; headings counter-clockwise from +x, rad, in
 *    (-pi, pi]; speeds m/s; time s. SUMO's degrees clockwise from north never leave the bridge.
 *  - Positions are of the middle of the front bumper.
 *  - Vehicles, types and lanes are numbered when first seen (0, 1, 2, ...); numbers stay for the
 *    life of the simulation and are never reused, names are looked up by number.
 *  - Text returned is owned by the bridge and valid until sumo_bridge_stop. Arrays returned by
 *    sumo_bridge_step are valid until the next step.
 *  - The header compiles as C and as C++. */

#include "core/error.h"
#include "traffic/lane_map.h"
#include "traffic/vehicle_state.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define SUMO_BRIDGE_MODEL_KEY "crashpulse.model"

/* Start a simulation. options: option_count further SUMO command line words
 * ("--lateral-resolution", "0.8"), which override the configuration; the bridge appends
 * the options every run of ours sets (traffic/sumo_options.h), thread-rngs (one random stream a
 * lane, at least 64), seed and step length; a word of those in options is refused by SUMO as given
 * twice. SUMO takes 31 bits of the seed, and its clock counts milliseconds: a step length of
 * another kind is refused. begin/end times stay those of the configuration. Sets SUMO_HOME when it
 * is unset. SUMO's warnings go to stderr (but those of collisions and emergency braking, which are
 * what a run is for), its errors into error. */
CP_MUST_CHECK cp_status sumo_bridge_start(const char *sumocfg, uint64_t seed, double step_length_s,
                                          const char *const *options, size_t option_count,
                                          cp_error *error);
/* Close; safe without a start and after a failure. */
void sumo_bridge_stop(void);

/* Advance one step; states of all vehicles on the road after it, in SUMO's order. */
CP_MUST_CHECK cp_status sumo_bridge_step(const cp_vehicle_state **states, size_t *count,
                                         cp_error *error);
/* Whether states come with lane, place along it and is_in_junction, which take SUMO's look-up by id
 * three times a vehicle; default true. Without, sumo_bridge_place tells them of one vehicle. */
void sumo_bridge_read_places(bool wanted);
/* Fill these three of a state of the last step. A vehicle that is gone is CP_TRAFFIC_FAILED. */
CP_MUST_CHECK cp_status sumo_bridge_place(cp_vehicle_state *state, cp_error *error);
/* SUMO's clock after the last step, s. */
double sumo_bridge_time_s(void);
/* Vehicles loaded but not yet arrived, waiting ones included: 0 means nothing more will come. */
int sumo_bridge_expected_vehicles(void);
/* Version text of the linked SUMO, "SUMO 1.15.0". */
const char *sumo_bridge_version(void);
/* The complete command line of the last start, words separated by blanks. */
const char *sumo_bridge_command_line(void);

/* SUMO's own collisions of the last step. Valid until the next step. */
CP_MUST_CHECK cp_status sumo_bridge_collisions(const cp_sumo_collision **collisions, size_t *count,
                                               cp_error *error);

/* Whether two vehicles that touch in the plane can do so on the ground. The network is read at the
 * first question (milliseconds for a town). */
CP_MUST_CHECK cp_status sumo_bridge_road_relation(const cp_vehicle_state *one,
                                                  const cp_vehicle_state *other,
                                                  cp_road_relation *relation, cp_error *error);

/* Where the lanes run, by the numbers of lanes; owned by the bridge. Read like the above. */
CP_MUST_CHECK cp_status sumo_bridge_lane_map(const cp_lane_map **map, cp_error *error);
/* The lanes of edges that a vehicle will take next on its route, staying in its lane as long as it
 * can; the first room of them. While it is in a junction SUMO knows the edges only: the first lane
 * of each that it may use. */
CP_MUST_CHECK cp_status sumo_bridge_next_lanes(uint32_t vehicle, uint32_t *lanes, size_t room,
                                               size_t *count, cp_error *error);

/* Width of a lane, m. */
CP_MUST_CHECK cp_status sumo_bridge_lane_width(uint32_t lane, double *width_m, cp_error *error);

/* The traffic light a vehicle comes to next. */
CP_MUST_CHECK cp_status sumo_bridge_next_light(uint32_t vehicle, cp_next_light *light,
                                               cp_error *error);

/* Names; "" for a number never given out. */
const char *sumo_bridge_vehicle_id(uint32_t vehicle);
const char *sumo_bridge_type_id(uint32_t type);
const char *sumo_bridge_lane_id(uint32_t lane);

/* A vehicle type by its id. Errors: CP_TRAFFIC_FAILED for one SUMO does not have; CP_BAD_INPUT for
 * a parameter that is too long or no number. */
CP_MUST_CHECK cp_status sumo_bridge_type(const char *type_id, cp_sumo_type *type, cp_error *error);

/* Vehicles inserted in the last step. Valid until the next step. */
CP_MUST_CHECK cp_status sumo_bridge_departed(const uint32_t **vehicles, size_t *count,
                                             cp_error *error);

/* Commands. A vehicle that is gone is CP_TRAFFIC_FAILED. */
CP_MUST_CHECK cp_status sumo_bridge_remove(uint32_t vehicle, cp_error *error);
/* Command a speed for the coming step and on; negative hands the vehicle back to SUMO's driver. Of
 * several commands before one step the lowest speed holds, and handing back counts for nothing
 * while another commands a speed: a driver and an assistance function may brake the same car. */
CP_MUST_CHECK cp_status sumo_bridge_set_speed(uint32_t vehicle, double speed_m_s, cp_error *error);
/* SUMO's speed mode bit set (31 = all checks on). */
CP_MUST_CHECK cp_status sumo_bridge_set_speed_mode(uint32_t vehicle, int mode, cp_error *error);
/* SUMO's lane change mode bit set (1621 = all changes of its own; 0 = none). */
CP_MUST_CHECK cp_status sumo_bridge_set_lane_change_mode(uint32_t vehicle, int mode,
                                                         cp_error *error);
CP_MUST_CHECK cp_status sumo_bridge_speed_mode(uint32_t vehicle, int *mode, cp_error *error);
/* Factor on the speed limits that the vehicle's driver takes as his own, > 0. */
CP_MUST_CHECK cp_status sumo_bridge_set_speed_factor(uint32_t vehicle, double factor_1,
                                                     cp_error *error);
CP_MUST_CHECK cp_status sumo_bridge_speed_factor(uint32_t vehicle, double *factor_1,
                                                 cp_error *error);
CP_MUST_CHECK cp_status sumo_bridge_set_parameter(uint32_t vehicle, const char *key,
                                                  const char *value, cp_error *error);

#ifdef __cplusplus
}
#endif

#endif
