/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CONTROL_CONTROL_H
#define CONTROL_CONTROL_H

#include "api/crashpulse/function.h"
#include "control/acts.h"
#include "control/actuation.h"
#include "control/equipment.h"
#include "control/error_log.h"
#include "control/library.h"
#include "core/rng.h"
#include "traffic/traffic.h"

/* What acts on vehicles besides SUMO's own driver: driver errors (baseline humans) and driver
 * assistance functions. All share one table; another one is one file and one row (README of this
 * folder). Functions decide by crashpulse/function.h, ours as those of a library that a study
 * brings along, and function_host.h does the rest. Parameters are numbers with a unit in the name.
 */

typedef enum cp_control_kind {
    CP_CONTROL_DRIVER_ERROR, /* belongs to a scenario: drivers as they are */
    CP_CONTROL_FUNCTION      /* belongs to a variant: a driver assistance function */
} cp_control_kind;

/* One parameter of a control: name as in the study file ("ttc_s"), range, default and source. */
typedef crashpulse_parameter cp_control_parameter;

/* First parameter of every function: share of vehicles that have it (equipment.h). */
#define CP_CONTROL_PENETRATION                                                                     \
    {                                                                                              \
        "penetration_1", 1.0, 0.0, 1.0,                                                            \
            "share of vehicles equipped, drawn once per vehicle (assumed)"                         \
    }

#define CP_CONTROL_PARAMETERS_MAX CRASHPULSE_PARAMETERS_MAX

/* What a control sees when it acts. seed_key already holds study seed, replication seed and the
 * control's name: derive from it by vehicle ids and occasion only (core/rng.h). */
typedef struct cp_control_context {
    const cp_traffic *traffic;
    const struct cp_control_settings *settings;
    cp_rng_key seed_key;
    const double *parameter;         /* by index of the type's parameter table */
    cp_equipment *equipment;         /* of functions: who has it */
    cp_actuation *actuation;         /* of functions: where to ask for braking */
    cp_acts *acts;                   /* of functions: where to note what else they do; else NULL */
    struct cp_ignored_foes *ignored; /* shared by all (driver_error/ignored_foes.h) */
    struct cp_road_view *view;       /* likewise (road_view.h) */
    const struct cp_controls *controls; /* it is one of these: for cp_controls_has_cause */
} cp_control_context;

/* Called for an error at work: who errs, and towards whom (CP_EVERYBODY: whoever it is). */
typedef cp_status (*cp_error_visit)(void *context, uint32_t vehicle, uint32_t other,
                                    cp_error *error);

/* A kind of control. create/step/destroy handle its mutable state of one replication. */
typedef struct cp_control_type {
    const char *name; /* "failed_to_see", "aeb" */
    cp_control_kind kind;
    const char *what; /* one line for --help and reports */
    /* It changes how a car is driven long before a crash: no treatment of a counterfactual pair. */
    bool acts_long_before;
    const cp_control_parameter *parameters;
    size_t parameter_count;
    /* Of a function what decides; NULL: a library that the settings name. create ... destroy are
     * then those of function_host.h. */
    const crashpulse_function *function;
    CP_MUST_CHECK cp_status (*create)(const cp_control_context *context, void **state,
                                      cp_error *error);
    /* After each traffic step; commands hold for the next one. */
    CP_MUST_CHECK cp_status (*step)(void *state, const cp_control_context *context,
                                    cp_error *error);
    /* Whether this control made the vehicle err (role a goes to the one at fault); may be NULL. */
    bool (*is_at_fault)(const void *state, uint32_t vehicle);
    /* Of errors towards one particular other: the moment, SUMO clock, since which the vehicle has
     * erred towards other without a break; INFINITY when it does not. May be NULL: the error is the
     * vehicle's alone, as long as is_at_fault says so. */
    double (*error_since_s)(const void *state, uint32_t vehicle, uint32_t other);
    /* Visit all errors at work after the last step, each once; ends with the first failure. NULL:
     * everybody on the road is asked by is_at_fault. */
    cp_status (*visit_errors)(const void *state, cp_error_visit visit, void *context,
                              cp_error *error);
    /* What it did, e.g. {"activations": 12}; names static. May be NULL. */
    size_t (*counters)(const void *state, const char **names, double *values, size_t room);
    void (*destroy)(void *state);
} cp_control_type;

extern const cp_control_type *const CP_CONTROL_TYPE[];
extern const size_t CP_CONTROL_TYPE_COUNT;

/* NULL when there is none of that name and kind. */
const cp_control_type *cp_control_type_find(cp_control_kind kind, const char *name);

/* One control as a study configures it. */
typedef struct cp_control_settings {
    const cp_control_type *type;
    double parameter[CP_CONTROL_PARAMETERS_MAX];
    cp_equipment_share *shares; /* penetration by vehicle type; owned by the study */
    size_t share_count;
    cp_library *library; /* of the type CP_CONTROL_PLUGIN; else NULL. Owned by the study */
} cp_control_settings;

cp_control_settings cp_control_settings_default(const cp_control_type *type);
/* What it is called in tables and counters, and draws by: the library's name, else the type's. */
const char *cp_control_name(const cp_control_settings *settings);

/* All controls of one replication together. */
typedef struct cp_controls cp_controls;

/* settings: count controls, driver errors first, in the study's order; copied. Draws depend on
 * study_seed, replication_seed, the control's name and vehicle ids only, so paired variants share
 * the driver errors and the equipped cars. */
CP_MUST_CHECK cp_status cp_controls_create(const cp_control_settings *settings, size_t count,
                                           uint64_t study_seed, uint64_t replication_seed,
                                           const cp_traffic *traffic, cp_controls **controls,
                                           cp_error *error);
/* Add functions on two vehicles only, named by their SUMO ids (copied), to controls at work: a
 * treatment. Who of the two has a function is still drawn. seeds: as above. */
CP_MUST_CHECK cp_status cp_controls_add_treatment(cp_controls *controls,
                                                  const cp_control_settings *settings, size_t count,
                                                  uint64_t study_seed, uint64_t replication_seed,
                                                  const char *const ids[2], cp_error *error);
void cp_controls_destroy(cp_controls *controls);
CP_MUST_CHECK cp_status cp_controls_step(cp_controls *controls, cp_error *error);
/* Signature fits cp_detector_step: context is the cp_controls. */
bool cp_controls_is_at_fault(void *context, uint32_t vehicle);
/* Whether a control makes the vehicle err whoever the other is. */
bool cp_controls_errs_alone(const cp_controls *controls, uint32_t vehicle);
/* Since when a control has had the vehicle err towards that other, SUMO clock; INFINITY: none does.
 */
double cp_controls_error_since_s(const cp_controls *controls, uint32_t vehicle, uint32_t other);
/* Whether a function that acts on own towards target has a cause that the study made: one of the
 * two errs, or the target is a wreck that stays on the road. */
bool cp_controls_has_cause(const cp_controls *controls, uint32_t own, uint32_t target);

/* ---- how a crash came about: at an instant within the last step --------------------------------
 */

#define CP_CAUSE_WINDOW_S                                                                          \
    3.0 /* an error that ended this long before a crash may have led to it                         \
         */

typedef enum cp_error_towards {
    CP_TOWARDS_EVERYBODY,
    CP_TOWARDS_OPPONENT,
    CP_TOWARDS_ANOTHER
} cp_error_towards;

/* One driver error of one driver. Times are before the instant. */
typedef struct cp_error_at {
    const char *name; /* of the control; as long as its settings */
    cp_error_towards towards;
    double began_s; /* the last time it began, to within a step; >= ended_s */
    double ended_s; /* 0 ... CP_ERROR_MEMORY_S; 0: at work */
    bool is_cause;  /* towards everybody or the opponent, within CP_CAUSE_WINDOW_S */
} cp_error_at;

/* One function in one car. */
typedef struct cp_function_at {
    const char *name; /* of the control; as long as its settings */
    bool is_equipped;
    cp_act_at act;
} cp_function_at;

size_t cp_controls_driver_error_count(const cp_controls *controls);
size_t cp_controls_function_count(const cp_controls *controls);
/* Whether driver error number 0, 1, ... was at work on a vehicle within CP_ERROR_MEMORY_S before
 * the instant, and how. An error towards the opponent comes before one towards another. */
bool cp_controls_error_at(const cp_controls *controls, size_t number, uint32_t vehicle,
                          uint32_t opponent, double instant_s, cp_error_at *at);
/* What function number 0, 1, ... did to a vehicle on the road, whose speed at the instant is
 * speed_m_s. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_controls_function_at(cp_controls *controls, size_t number,
                                                uint32_t vehicle, double instant_s,
                                                double speed_m_s, cp_function_at *at,
                                                cp_error *error);

/* Deceleration that the functions ask of a vehicle in the coming step, m/s^2; 0 for none. */
double cp_controls_brake_request_m_s2(const cp_controls *controls, uint32_t vehicle);
/* What has been counted so far does not count: the warm-up is over. */
void cp_controls_count_from_now(cp_controls *controls);
/* Counters of all controls, "aeb.activations" style, as one JSON object text; caller frees. */
CP_MUST_CHECK cp_status cp_controls_counters_json(const cp_controls *controls, char **json,
                                                  cp_error *error);

#endif
