/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TRAFFIC_TRAFFIC_H
#define TRAFFIC_TRAFFIC_H

#include "traffic/lane_map.h"
#include "traffic/lateral_overlay.h"
#include "traffic/vehicle_state.h"

/* The step loop around the bridge: this step's and last step's states matched per vehicle,
 * exposure, removal of crashed cars or their standing on the road. One a process. */

/* Motion of one vehicle through the step that has just ended, lateral overlays included. */
typedef struct cp_vehicle_motion {
    cp_vehicle_state before; /* at the beginning of the step; valid if was_present */
    cp_vehicle_state after;
    double yaw_rate_rad_s; /* mean over the step; 0 unless was_present */
    bool was_present;      /* false: inserted in this step, or jumped (teleport) */
} cp_vehicle_motion;

typedef struct cp_traffic cp_traffic;

/* Where the states come from and the commands go to: SUMO through the bridge, or a scripted road in
 * a test. The functions mean what those of sumo_bridge.h mean. */
typedef struct cp_traffic_source {
    cp_status (*step)(const cp_vehicle_state **states, size_t *count, cp_error *error);
    cp_status (*departed)(const uint32_t **vehicles, size_t *count, cp_error *error);
    double (*time_s)(void);
    int (*expected_vehicles)(void);
    const char *(*vehicle_id)(uint32_t vehicle);
    const char *(*type_id)(uint32_t type); /* may be NULL: types have no names */
    const char *(*lane_id)(uint32_t lane); /* may be NULL: lanes have none */
    /* May be NULL: nothing is known of types but the sizes in the states. */
    cp_status (*type)(const char *type_id, cp_sumo_type *type, cp_error *error);
    /* May be NULL: the source finds no collisions itself. */
    cp_status (*collisions)(const cp_sumo_collision **collisions, size_t *count, cp_error *error);
    const char *(*version)(void);      /* may be NULL: "" */
    const char *(*command_line)(void); /* may be NULL: "" */
    cp_status (*remove)(uint32_t vehicle, cp_error *error);
    cp_status (*set_speed)(uint32_t vehicle, double speed_m_s, cp_error *error);
    cp_status (*set_speed_mode)(uint32_t vehicle, int mode, cp_error *error);
    /* May be NULL: nobody changes lanes. */
    cp_status (*set_lane_change_mode)(uint32_t vehicle, int mode, cp_error *error);
    cp_status (*speed_mode)(uint32_t vehicle, int *mode, cp_error *error);
    cp_status (*set_speed_factor)(uint32_t vehicle, double factor_1, cp_error *error);
    cp_status (*speed_factor)(uint32_t vehicle, double *factor_1, cp_error *error);
    cp_status (*set_parameter)(uint32_t vehicle, const char *key, const char *value,
                               cp_error *error);
    /* May be NULL: states come with their places. */
    void (*read_places)(bool wanted);
    cp_status (*place)(cp_vehicle_state *state, cp_error *error);
    /* May be NULL: all lanes are SUMO's default, 3.2 m wide. */
    cp_status (*lane_width)(uint32_t lane, double *width_m, cp_error *error);
    /* May be NULL: there are no lights. */
    cp_status (*next_light)(uint32_t vehicle, cp_next_light *light, cp_error *error);
    /* May be NULL: all roads meet. */
    cp_status (*road_relation)(const cp_vehicle_state *one, const cp_vehicle_state *other,
                               cp_road_relation *relation, cp_error *error);
    /* May both be NULL: nobody knows where lanes run. */
    cp_status (*lane_map)(const cp_lane_map **map, cp_error *error);
    cp_status (*next_lanes)(uint32_t vehicle, uint32_t *lanes, size_t room, size_t *count,
                            cp_error *error);
    void (*stop)(void);
} cp_traffic_source;

typedef struct cp_traffic_options {
    const char *sumocfg;
    uint64_t seed;
    double step_length_s;       /* default 0.05 */
    const char *const *options; /* further SUMO words */
    size_t option_count;
} cp_traffic_options;

/* Exposure so far. */
typedef struct cp_exposure {
    double vehicle_km;
    double vehicle_h;
    size_t departed; /* vehicles inserted */
} cp_exposure;

CP_MUST_CHECK cp_status cp_traffic_create(const cp_traffic_options *options, cp_traffic **traffic,
                                          cp_error *error);
/* The same over a source that is started already; it must outlive the traffic, whose destroy stops
 * it. (cp_traffic_create is in the library cp_sumo_bridge, all else in cp_traffic.) */
CP_MUST_CHECK cp_status cp_traffic_create_from(const cp_traffic_source *source,
                                               double step_length_s, cp_traffic **traffic,
                                               cp_error *error);
void cp_traffic_destroy(cp_traffic *traffic); /* NULL is fine */

/* Advance one step. */
CP_MUST_CHECK cp_status cp_traffic_step(cp_traffic *traffic, cp_error *error);
double cp_traffic_time_s(const cp_traffic *traffic); /* end of the last step */
double cp_traffic_step_length_s(const cp_traffic *traffic);
bool cp_traffic_finished(const cp_traffic *traffic); /* nothing on the road, nothing to come */
const cp_vehicle_motion *cp_traffic_motions(const cp_traffic *traffic, size_t *count);
/* Motion of one vehicle, NULL when it is not on the road. */
const cp_vehicle_motion *cp_traffic_motion_of(const cp_traffic *traffic, uint32_t vehicle);
/* Vehicles inserted in the last step, in SUMO's order; valid until the next step. */
const uint32_t *cp_traffic_departed(const cp_traffic *traffic, size_t *count);
/* The traffic light a vehicle comes to next (sumo_bridge.h). */
CP_MUST_CHECK cp_status cp_traffic_next_light(const cp_traffic *traffic, uint32_t vehicle,
                                              cp_next_light *light, cp_error *error);
/* Whether states come with lane, place along it and is_in_junction (sumo_bridge.h; default true):
 * nobody but controls needs them of all vehicles. cp_traffic_place fills them in for one. */
void cp_traffic_read_places(cp_traffic *traffic, bool wanted);
CP_MUST_CHECK cp_status cp_traffic_place(const cp_traffic *traffic, cp_vehicle_state *state,
                                         cp_error *error);
/* Whether two vehicles that touch in the plane can do so on the ground (sumo_bridge.h). */
CP_MUST_CHECK cp_status cp_traffic_road_relation(const cp_traffic *traffic,
                                                 const cp_vehicle_state *one,
                                                 const cp_vehicle_state *other,
                                                 cp_road_relation *relation, cp_error *error);
const char *cp_traffic_vehicle_id(const cp_traffic *traffic, uint32_t vehicle);
/* SUMO vehicle type of a vehicle on the road; "" of any other. */
const char *cp_traffic_vehicle_type(const cp_traffic *traffic, uint32_t vehicle);
/* Names by the numbers in states; "" where there are none. */
const char *cp_traffic_type_id(const cp_traffic *traffic, uint32_t type);
const char *cp_traffic_lane_id(const cp_traffic *traffic, uint32_t lane);
/* What a vehicle type is (sumo_bridge.h); sizes 0, mass NAN and no class where that is not known.
 */
CP_MUST_CHECK cp_status cp_traffic_type(const cp_traffic *traffic, const char *type_id,
                                        cp_sumo_type *type, cp_error *error);
/* Collisions of the last step as SUMO itself reports them; valid until the next step. */
CP_MUST_CHECK cp_status cp_traffic_collisions(const cp_traffic *traffic,
                                              const cp_sumo_collision **collisions, size_t *count,
                                              cp_error *error);
/* Of the simulation behind it: version text, and the complete command line it was started with. */
const char *cp_traffic_version(const cp_traffic *traffic);
const char *cp_traffic_command_line(const cp_traffic *traffic);
/* Where the lanes run and which lanes a vehicle takes next (sumo_bridge.h); *map is
 * NULL and *count 0 where that is not known. */
CP_MUST_CHECK cp_status cp_traffic_lane_map(const cp_traffic *traffic, const cp_lane_map **map,
                                            cp_error *error);
CP_MUST_CHECK cp_status cp_traffic_next_lanes(const cp_traffic *traffic, uint32_t vehicle,
                                              uint32_t *lanes, size_t room, size_t *count,
                                              cp_error *error);
/* Width of the lane that a vehicle is on, m. */
CP_MUST_CHECK cp_status cp_traffic_lane_width(const cp_traffic *traffic,
                                              const cp_vehicle_state *state, double *width_m,
                                              cp_error *error);
/* Where to send commands for the coming step. */
const cp_traffic_source *cp_traffic_commands(const cp_traffic *traffic);
/* Where the cars are that drift off SUMO's path; commands for the coming step like the others. */
cp_lateral_overlays *cp_traffic_overlays(const cp_traffic *traffic);
cp_exposure cp_traffic_exposure(const cp_traffic *traffic);
/* Take a crashed vehicle off the road now; gone already is fine. */
CP_MUST_CHECK cp_status cp_traffic_remove(cp_traffic *traffic, uint32_t vehicle, cp_error *error);
/* Leave a crashed vehicle where it is, standing, until the clock is at until_s; then it is removed.
 * Its state from now on is the present pose at speed 0, in which everybody sees it; SUMO's own car
 * is stopped by command, comes to rest within half a metre or so, and the traffic behind it brakes.
 * A vehicle that SUMO teleports meanwhile (time-to-teleport) is removed where it reappears. Again
 * for a held one, or for one that is gone: nothing. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_traffic_hold(cp_traffic *traffic, uint32_t vehicle, double until_s,
                                        cp_error *error);
bool cp_traffic_is_held(const cp_traffic *traffic, uint32_t vehicle);

#endif
