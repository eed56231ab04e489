/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASH_VEHICLE_MODEL_H
#define CRASH_VEHICLE_MODEL_H

#include "core/error.h"
#include "crash/barrier.h"

#include <stdbool.h>
#include <stddef.h>

/* The parameters of one car of the multibody surrogate. Constant once loaded and validated; any
 * number of simulations may share it. Lengths are of the undeformed car, x forward from the centre
 * of gravity or as named. X(field, unit, default, smallest, largest, what it is). The defaults are
 * a mid-size car (first parameter set, not fitted). */
#define CP_VEHICLE_PARAMETERS(X)                                                                   \
    X(mass_kg, "kg", 1640, 500, 60000, "whole car as it crashes, occupants included")              \
    X(yaw_inertia_kg_m2, "kg m2", 2700, 500, 2500000, "whole car about its centre of gravity")     \
    X(length_m, "m", 4.86, 2.5, 26.0, "bumper to bumper")                                          \
    X(width_m, "m", 1.85, 1.3, 2.7, "without mirrors")                                             \
    X(cg_to_front_m, "m", 2.05, 0.8, 12, "centre of gravity to front bumper")                      \
    X(longitudinal_y_m, "m", 0.47, 0.3, 0.7,                                                       \
      "middle of a longitudinal member from the centre line")                                      \
    X(longitudinal_length_m, "m", 0.62, 0.3, 1.0, "longitudinal member, hinge to crash box")       \
    X(longitudinal_mass_kg, "kg", 22, 10, 60, "one longitudinal member")                           \
    X(longitudinal_collapse_begin_m, "m", 0.02, 0.005, 0.1, "compression where collapse begins")   \
    X(longitudinal_collapse_begin_kn, "kN", 150, 10, 800, "force where collapse begins")           \
    X(longitudinal_collapse_middle_kn, "kN", 205, 10, 1000,                                        \
      "force half-way between begin and end; not given: on the line between them")                 \
    X(longitudinal_collapse_end_m, "m", 0.5, 0.1, 0.9,                                             \
      "compression where nothing is left to collapse")                                             \
    X(longitudinal_collapse_end_kn, "kN", 260, 10, 1500,                                           \
      "force where nothing is left to collapse")                                                   \
    X(longitudinal_bending_kn_m, "kN m", 20, 0.5, 200, "bending moment where its foot yields")     \
    X(longitudinal_bending_begin_rad, "rad", 0.04, 0.005, 0.3, "rotation where its foot yields")   \
    X(bumper_stroke_m, "m", 0, 0, 0.12,                                                            \
      "travel of the bumper (foam, beam section) before a crash box collapses; 0: none")           \
    X(bumper_kn, "kN", 20, 1, 150, "force of the bumper over its travel, on each box")             \
    X(crash_box_length_m, "m", 0.2, 0.08, 0.35, "one crash box")                                   \
    X(crash_box_mass_kg, "kg", 8, 2, 30, "one crash box with what is bolted to it")                \
    X(crash_box_collapse_begin_m, "m", 0.015, 0.005, 0.1, "compression where collapse begins")     \
    X(crash_box_collapse_begin_kn, "kN", 60, 5, 500, "force where collapse begins")                \
    X(crash_box_collapse_end_m, "m", 0.16, 0.05, 0.35, "compression where nothing is left")        \
    X(crash_box_collapse_end_kn, "kN", 110, 5, 800, "force where nothing is left")                 \
    X(cross_member_half_width_m, "m", 0.75, 0.45, 1.2, "middle to tip of the cross member")        \
    X(cross_member_depth_m, "m", 0.12, 0.06, 0.25, "cross member, front to back")                  \
    X(cross_member_sweep_rad, "rad", 0, 0, 0.5,                                                    \
      "how far the front of a half is swept back from the middle to the tip")                      \
    X(cross_member_mass_kg, "kg", 10, 3, 40, "one half of the cross member with bumper")           \
    X(cross_member_bending_kn_m, "kN m", 6, 0.1, 100,                                              \
      "bending moment where a half yields at its box")                                             \
    X(cross_member_bending_begin_rad, "rad", 0.05, 0.005, 0.3, "rotation where a half yields")     \
    X(engine_mass_kg, "kg", 260, 50, 600, "engine, gearbox and what moves with them")              \
    X(engine_gap_front_m, "m", 0.32, 0.05, 0.8, "cross member's back to engine's front")           \
    X(engine_gap_firewall_m, "m", 0.14, 0.02, 0.5, "engine's back to firewall")                    \
    X(engine_width_m, "m", 0.75, 0.3, 1.2, "across the car")                                       \
    X(engine_mount_kn_m, "kN/m", 1500, 10, 20000, "stiffness of one of its two ties")              \
    X(engine_mount_yield_kn, "kN", 30, 1, 300, "force where a tie yields")                         \
    X(engine_mount_damping_kn_s_m, "kN s/m", 3, 0, 50, "damping of one tie")                       \
    X(engine_cradle_kn, "kN", 0, 0, 500,                                                           \
      "force at which subframe and mounts let the engine move back towards the firewall")          \
    X(firewall_stiffness_kn_m, "kN/m", 4000, 100, 50000, "engine against firewall")                \
    X(corner_gap_m, "m", 0.3, 0.0, 0.8,                                                            \
      "bumper front to front of the outboard corner (fender, wheel)")                              \
    X(corner_width_m, "m", 0.3, 0.1, 0.6, "outboard corner, across the car from its side inwards") \
    X(corner_strips_1, "1", 1, 1, 4,                                                               \
      "strips side by side that the corner collapses in, a whole number")                          \
    X(corner_collapse_begin_m, "m", 0.05, 0.005, 0.3, "compression where collapse begins")         \
    X(corner_collapse_begin_kn, "kN", 40, 1, 400, "force where collapse begins")                   \
    X(corner_collapse_end_m, "m", 0.5, 0.1, 0.9, "compression where nothing is left")              \
    X(corner_collapse_end_kn, "kN", 90, 1, 800, "force where nothing is left")                     \
    X(corner_side_kn, "kN", 80, 5, 400,                                                            \
      "sideways force at which a corner or half of the upper path is pushed aside")                \
    X(corner_side_m, "m", 0.25, 0.05, 0.6, "way aside until it rests on the body")                 \
    X(corner_edge_radius_m, "m", 0.12, 0.01, 0.4, "rounding of the outboard corner in plan")       \
    X(upper_gap_m, "m", 0.15, 0.0, 0.8,                                                            \
      "bumper front to front of the upper load path (radiator support, hood, upper rails)")        \
    X(upper_strips_1, "1", 1, 1, 4,                                                                \
      "strips that half of the upper load path collapses in, likewise")                            \
    X(upper_collapse_begin_m, "m", 0.05, 0.005, 0.3, "compression where collapse begins")          \
    X(upper_collapse_begin_kn, "kN", 10, 0.5, 400, "force where collapse begins")                  \
    X(upper_collapse_end_m, "m", 0.5, 0.1, 0.9, "compression where nothing is left")               \
    X(upper_collapse_end_kn, "kN", 20, 0.5, 800, "force where nothing is left")                    \
    X(unload_factor_1, "1", 2, 1, 30,                                                              \
      "unloading stiffness over loading stiffness of every element where its collapse begins")     \
    X(unload_end_factor_1, "1", 4, 1, 60, "the same where nothing is left to collapse")            \
    X(stop_stiffness_kn_m, "kN/m", 4000, 200, 50000,                                               \
      "members and crash boxes beyond the end of their collapse")                                  \
    X(strain_rate_gain_1, "1", 0.25, 0, 0.4,                                                       \
      "what a crush rate of 10 m/s adds to every collapse force (Cowper-Symonds)")                 \
    X(cell_edge_kn, "kN", 200, 50, 600,                                                            \
      "force at which the edge of the passenger cell (hinge pillar, sill) behind a corner yields") \
    X(cell_kn, "kN", 650, 200, 2000,                                                               \
      "force at which the rest of the cell's front yields: feet of the longitudinal members, "     \
      "firewall behind the engine, cowl")                                                          \
    X(cell_radius_m, "m", 0.15, 0.01, 0.4, "rounding of the passenger cell in plan")               \
    X(contact_stiffness_kn_m, "kN/m", 8000, 1000, 50000, "front outlines in contact")              \
    X(contact_damping_1, "1", 0.3, 0, 1,                                                           \
      "share of critical damping of front contacts at a cross member half")                        \
    X(body_stiffness_kn_m, "kN/m", 700, 50, 20000,                                                 \
      "sides and rear as struck by another, and the cell behind used up corners and upper parts")  \
    X(body_damping_1, "1", 0.7, 0, 3,                                                              \
      "share of critical damping of body contacts at half the car's mass")                         \
    X(corner_radius_m, "m", 0.06, 0.01, 0.3, "rounding of cross member, engine and upper path")    \
    X(friction_1, "1", 0.45, 0, 1.5, "Coulomb friction against barrier or opponent")               \
    X(side_collapse_begin_m, "m", 0.03, 0.005, 0.2, "depth where the side begins to collapse")     \
    X(side_collapse_end_m, "m", 0.6, 0.1, 1.0, "depth where nothing of the side is left")          \
    X(side_front_wheel_1, "1", 0.15, 0.02, 0.45,                                                   \
      "share of the side, firewall to rear structure, that is the front wheel's zone")             \
    X(side_rear_wheel_1, "1", 0.25, 0.02, 0.45, "likewise the rear wheel's; between: the door's")  \
    X(side_front_wheel_begin_kn_m, "kN/m", 25, 2, 2000,                                            \
      "force on a metre of the front wheel's zone where collapse begins")                          \
    X(side_front_wheel_end_kn_m, "kN/m", 220, 2, 4000, "the same where nothing is left")           \
    X(side_door_begin_kn_m, "kN/m", 18, 2, 2000,                                                   \
      "force on a metre of door and B-pillar where collapse begins")                               \
    X(side_door_end_kn_m, "kN/m", 160, 2, 4000, "the same where nothing is left")                  \
    X(side_rear_wheel_begin_kn_m, "kN/m", 22, 2, 2000,                                             \
      "force on a metre of the rear wheel's zone where collapse begins")                           \
    X(side_rear_wheel_end_kn_m, "kN/m", 180, 2, 4000, "the same where nothing is left")            \
    X(side_spread_m, "m", 1.8, 0.05, 3,                                                            \
      "how much wider than what presses on it the side yields: sill, roof rail, pillars")          \
    X(rear_bumper_m, "m", 0.06, 0.005, 0.3, "travel of the rear bumper")                           \
    X(rear_bumper_kn, "kN", 60, 2, 800, "force of the rear bumper over its travel, whole width")   \
    X(rear_collapse_begin_kn, "kN", 160, 2, 2000,                                                  \
      "force on the whole width where rails and floor begin to collapse, 3 cm behind the bumper")  \
    X(rear_collapse_end_m, "m", 0.75, 0.15, 1.5,                                                   \
      "depth from the bumper where nothing of rails and luggage compartment is left")              \
    X(rear_collapse_end_kn, "kN", 380, 2, 4000, "force there")                                     \
    X(rear_spread_m, "m", 0.3, 0.05, 2, "how much wider than what presses on it the rear yields")  \
    X(rear_side_kn, "kN", 60, 2, 800, "sideways force at which the rear overhang is pushed aside") \
    X(rear_side_m, "m", 0.3, 0.05, 0.8, "way aside until it rests on the body")

/* The parameters from side_collapse_begin_m on are the side and rear of a car struck there
 * (crash/struck_structure.h). Their defaults give the middle of NHTSA's tests of struck sides and
 * rears (db/validation/README.md); files of earlier versions, which do not name them, get these. */

/* Parameters of earlier versions of the model, still read in vehicle files and no longer used:
 * X(name, what takes its place). */
#define CP_VEHICLE_FORMER_PARAMETERS(X)                                                            \
    X("member_damping_kn_s_m", "strain_rate_gain_1")                                               \
    X("crush_rate_s_m", "strain_rate_gain_1")

/* Number of parameters. */
enum {
#define CP_VEHICLE_COUNT_ONE(field, unit, value, smallest, largest, what) +1
    CP_VEHICLE_PARAMETER_TOTAL = 0 CP_VEHICLE_PARAMETERS(CP_VEHICLE_COUNT_ONE)
#undef CP_VEHICLE_COUNT_ONE
};

/* Most parameter sets of an ensemble. */
enum { CP_ENSEMBLE_MAX = 10 };

typedef struct cp_vehicle_model {
    char name[64]; /* of the file: "honda_accord_2014" */
    char description[256];
    char hash[65]; /* SHA-256 of the file it was loaded from; "" for the default */
    /* Range the model was calibrated in; outside it results are marked. Equal bounds of speed
     * (0, 0) mean: never calibrated. */
    double calibrated_speed_min_m_s;
    double calibrated_speed_max_m_s;
    double calibrated_offset_max_m; /* to either side */
    double calibrated_angle_max_rad;
    cp_barrier barrier; /* of the study it was calibrated against */
    bool is_barrier;    /* it is no car but that barrier (cp_vehicle_model_of_barrier) */
    bool is_stretched;  /* its outline, far beyond that of the car (cp_vehicle_model_cover) */
    /* Relative standard deviation of each parameter, 0 = certain; in the order of the table. */
    double scatter_1[CP_VEHICLE_PARAMETER_TOTAL];
    /* Bounds of each parameter: the file's own, else the table's. */
    double smallest[CP_VEHICLE_PARAMETER_TOTAL];
    double largest[CP_VEHICLE_PARAMETER_TOTAL];
    /* Parameter sets that fit its references about as well: what the fit does not know. */
    size_t member_count; /* 0: none kept */
    double member[CP_ENSEMBLE_MAX][CP_VEHICLE_PARAMETER_TOTAL];
#define CP_VEHICLE_FIELD(field, unit, value, smallest, largest, what) double field;
    CP_VEHICLE_PARAMETERS(CP_VEHICLE_FIELD)
#undef CP_VEHICLE_FIELD
} cp_vehicle_model;

/* One row a parameter, in the order above: name as in the file, place in the struct, range. */
typedef struct cp_vehicle_parameter {
    const char *name;
    const char *unit;
    size_t offset;
    double standard;
    double smallest;
    double largest;
    const char *what;
} cp_vehicle_parameter;

extern const cp_vehicle_parameter CP_VEHICLE_PARAMETER[];
extern const size_t CP_VEHICLE_PARAMETER_COUNT;

cp_vehicle_model cp_vehicle_model_default(void);

/* A barrier that moves or has a deformable face as a vehicle, its face the front: mass, outline and
 * friction are its own, nothing else of the model is used. Fixed ones weigh CP_FIXED_BARRIER_KG. */
#define CP_FIXED_BARRIER_KG 1e9
cp_vehicle_model cp_vehicle_model_of_barrier(const cp_barrier *barrier);

/* Value of parameter number index. */
double cp_vehicle_model_get(const cp_vehicle_model *model, size_t index);
void cp_vehicle_model_set(cp_vehicle_model *model, size_t index, double value);
/* The car by parameter set number index (< member_count) of its ensemble. */
cp_vehicle_model cp_vehicle_model_member(const cp_vehicle_model *model, size_t index);
/* Index of a parameter by name, or CP_VEHICLE_PARAMETER_COUNT. */
size_t cp_vehicle_parameter_index(const char *name);

/* Read a vehicle YAML file (format: db/vehicles/README.md) and validate it. Errors: CP_BAD_INPUT
 * with file, line and field. */
CP_MUST_CHECK cp_status cp_vehicle_model_load(const char *path, cp_vehicle_model *model,
                                              cp_error *error);
/* The same from memory; name stands for the path in messages. */
CP_MUST_CHECK cp_status cp_vehicle_model_parse(const char *name, const char *content, size_t size,
                                               cp_vehicle_model *model, cp_error *error);

/* The model with an outline that covers a rectangle of that length and width, front on front: where
 * the rectangle is longer the body goes on behind, where it is wider sides and outboard corners
 * move out. Mass, inertia and front structure stay. So what touches as rectangles touches as
 * models. By more than 0.6 m or 0.2 m the model says that it is stretched. */
#define CP_VEHICLE_STRETCHED_LENGTH_M 0.6
#define CP_VEHICLE_STRETCHED_WIDTH_M 0.2
cp_vehicle_model cp_vehicle_model_cover(const cp_vehicle_model *model, double length_m,
                                        double width_m);

/* Mass of all behind the firewall: the car without engine, members, boxes and cross member. */
double cp_vehicle_model_cell_mass(const cp_vehicle_model *model);

/* The largest time step the explicit force elements of the model stand: their fastest oscillation
 * turns 1.2 rad in it. element (may be NULL) receives what sets it, static text. */
double cp_vehicle_model_largest_step(const cp_vehicle_model *model, const char **element);

/* Ranges of every field and what must hold between fields (lengths add up, masses leave a root,
 * stiffness is stable at a time step of 0.5 ms). Errors: CP_BAD_INPUT naming the field. */
CP_MUST_CHECK cp_status cp_vehicle_model_validate(const cp_vehicle_model *model, cp_error *error);

#endif
