/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CRASHPULSE_FUNCTION_H
#define CRASHPULSE_FUNCTION_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* (Compiles as C17 and as C++17.) A driver assistance function as crashpulse runs it: its own and
 * those that a study brings along as a shared library,
 *
 *   functions:
 *     - {function: plugin, library: ./my_aeb.so, parameters: {ttc_s: 1.0}}
 *
 * The host has the sensor, the brake, the steering, who is equipped, pairing, branches of
 * counterfactual pairs, the record of what was done and the counters; the function decides. In
 * every step, after the traffic has moved, `step` is called once for each equipped car in a fixed
 * order; what it requests holds for the coming step only.
 *
 * Rules: all state lives in what `create` returns and in the memory of each car, never in static
 * variables; no threads, files or signal handlers. Runs are compared bit by bit: the same calls
 * must give the same requests, so random numbers come from `seed` and the car's id alone.
 * Counterfactual branches are forked copies of the process; nothing needs to be saved or restored.
 * A step that crashes, takes longer than step_limit_s, gives a number that is not finite or out of
 * range, or lets memory grow beyond memory_limit_mb fails the replication, by name.
 *
 * Units are SI. Frames: the car's own has its origin at the middle of its front, x ahead, y to the
 * left, angles counter-clockwise. Times are SUMO's clock. */

#ifdef __cplusplus
extern "C" {
#endif

/* Goes up when anything below changes its meaning or place; the host takes only its own. */
#define CRASHPULSE_FUNCTION_ABI 1u

#define CRASHPULSE_PARAMETERS_MAX 40 /* of a function's table */
#define CRASHPULSE_COUNTERS_MAX 16   /* of its own */
#define CRASHPULSE_NOBODY UINT32_MAX
/* In a request: not asked for. (Not NAN: what comes out of a wrong sum is a fault, not a wish.) */
#define CRASHPULSE_NONE (-1e300)

/* A parameter: its key in the study file, default, range, and a line on what it is with its source.
 * Some keys are the host's, whether they stand in the table (with a default of the function's own)
 * or not; their defaults: penetration_1 1; sensor_range_m 80, sensor_field_of_view_deg 60,
 * sensor_latency_s 0.1, sensor_confirmation_s 0.2, sensor_detection_probability_1 1,
 * sensor_occlusion_1 1 (0: nothing hides anything); dead_time_s 0.1, jerk_m_s3 40, friction_1 0.9;
 * of a library also step_limit_s 10 (wall clock of one call) and memory_limit_mb 1024. */
typedef struct crashpulse_parameter {
    const char *name;
    double standard;
    double smallest;
    double largest;
    const char *what;
} crashpulse_parameter;

/* What a function does: it is counted by that, and may request nothing else. */
enum {
    CRASHPULSE_BRAKES = 1 << 0, /* activations by class of target, without an error, for nothing */
    CRASHPULSE_WARNS = 1 << 1,  /* warnings, those without an error, those that came true */
    CRASHPULSE_STEERS = 1 << 2, /* interventions */
    CRASHPULSE_LIMITS = 1 << 3, /* limited_vehicles */
    CRASHPULSE_DRIVES = 1 << 4, /* asks for accelerations > 0 */
    CRASHPULSE_DRIVER_BRAKES = 1 << 5,    /* when warned: no dead time, no activation */
    CRASHPULSE_ACTS_LONG_BEFORE = 1 << 6, /* no treatment of counterfactual pairs */
    CRASHPULSE_ANY_PARAMETER = 1 << 7,    /* keys outside the table are handed over (extra) */
};

/* By the headings where the two would meet. */
typedef enum crashpulse_class {
    CRASHPULSE_REAR_END, /* within 45 degrees */
    CRASHPULSE_ONCOMING, /* apart by more than 135 degrees, nobody turns */
    CRASHPULSE_CROSSING, /* in between, nobody turns */
    CRASHPULSE_TURNING,  /* not the same direction, and one of the two turns */
    CRASHPULSE_CLASSES
} crashpulse_class;

/* A key and value as the study file has them. */
typedef struct crashpulse_extra {
    const char *name;
    const char *text;
    double number; /* NAN: the text is none */
} crashpulse_extra;

/* For create; valid until destroy. */
typedef struct crashpulse_setup {
    const double *parameter; /* by index of the function's own table, in range */
    const crashpulse_extra *extra;
    size_t extra_count;
    const char *data;     /* path of the study's `data:` file; NULL: none */
    double step_s;        /* > 0 */
    uint64_t seed;        /* of study seed, replication and the function's name */
    double brake_delay_s; /* from request to first deceleration: sensor latency and dead time */
} crashpulse_setup;

/* What the function looks out for; create may change it. */
typedef struct crashpulse_outlook {
    double horizon_s;     /* whoever can be met within this is looked for; default 6 */
    double ttc_s;         /* of `threat`; default 0: nothing is one */
    double required_m_s2; /* the same: contact avoided by less than this is no threat; default 4.5,
                             what SUMO's drivers brake at ease */
    bool has_class[CRASHPULSE_CLASSES]; /* that `threat` and `is_danger` know; default all */
} crashpulse_outlook;

/* Another vehicle that the sensor knows: in view without a break for as long as it takes to
 * confirm. */
typedef struct crashpulse_object {
    uint32_t id;            /* the same while it is in view */
    double ahead_m, left_m; /* the middle of its front */
    double heading_rad;     /* (-pi, pi], 0: as the own car */
    double speed_m_s;       /* along its heading, >= 0 */
    double acceleration_m_s2;
    double yaw_rate_rad_s;
    double length_m, width_m;
    double in_view_s;
} crashpulse_object;

/* The most urgent threat, by the rules that crashpulse's own functions use (the page of
 * src/control, and lookout.h): foretold along the lanes, unless a driver sees to it. */
typedef struct crashpulse_threat {
    uint32_t id;
    crashpulse_class class_of;
    double ttc_s;     /* at the end of the step */
    double instant_s; /* inside the step: when it became one */
} crashpulse_threat;

#define CRASHPULSE_ROAD_POINTS 64

/* The own lane and those that follow it along the route, corner by corner of its centre line, from
 * the place beside the car's front on. */
typedef struct crashpulse_road {
    size_t count; /* >= 2 */
    struct {
        double ahead_m, left_m;
        double way_m;         /* along the line from the first */
        double curvature_1_m; /* left positive; of the circle through its neighbours */
    } point[CRASHPULSE_ROAD_POINTS];
    double lane_width_m;
    double lane_left_m;     /* of the centre line the car's front is this far left */
    double speed_limit_m_s; /* of the lane; INFINITY: not known */
} crashpulse_road;

typedef struct crashpulse_view crashpulse_view;

/* What a function may ask during a step, of the view it was called with. What is looked at costs;
 * a sensor that is not asked in a step has lost its targets in the next. */
typedef struct crashpulse_host {
    /* Use the sensor; objects (may be NULL) are those known, in no particular order, until step
     * returns. Without it in this step, the next two tell of nobody. */
    size_t (*look)(const crashpulse_view *view, const crashpulse_object **objects);
    /* The threat that came first in this step; false: none. */
    bool (*threat)(const crashpulse_view *view, crashpulse_threat *threat);
    /* Whether anybody detected, of a class looked out for, is met within horizon_s. */
    bool (*is_danger)(const crashpulse_view *view, double horizon_s);
    /* False where no lane is known. */
    bool (*road)(const crashpulse_view *view, crashpulse_road *road);
    /* Of the lane it is on, m; 3.2, SUMO's default, where that is not known. */
    double (*lane_width_m)(const crashpulse_view *view);
} crashpulse_host;

/* The own car at the end of the step. */
struct crashpulse_view {
    const char *id; /* SUMO's */
    double time_s;
    double step_s; /* the step that has ended, and the coming one */
    double speed_m_s;
    double acceleration_m_s2;
    double yaw_rate_rad_s;
    double length_m, width_m;
    double drift_m;    /* off the path that SUMO drives, to the left */
    double drift_1;    /* metres to the left of it a metre driven */
    double brake_m_s2; /* deceleration that the host holds for this function now; 0: none */
    double *counter;   /* of the function, by index of counter_names: to be added to */
    const crashpulse_host *host;
    void *handle; /* the host's */
};

/* What is asked for in the coming step; at first everything is CRASHPULSE_NONE, target nobody. */
typedef struct crashpulse_request {
    /* Below 0: brake that hard. Deceleration begins brake_delay_s after since_s, rises with
     * jerk_m_s3 to what is asked or friction allows, and holds while it is asked for; SUMO's driver
     * may brake harder. From 0 on: that acceleration, as far as SUMO's driver follows. [-20, 20] */
    double acceleration_m_s2;
    double
        since_s; /* when braking was decided, inside the step (none: at its end); of a driver who
                    brakes when warned: when he begins. It counts when braking is first asked for */
    /* Drift in the coming step: mean and end of its slope (a lateral acceleration of a is a change
     * of a * step_s / speed); none: not steered. [-1, 1] */
    double steer_mean_1, steer_end_1;
    bool is_back;          /* on the path again: the driver steers */
    double steer_since_s;  /* none: at the end of the step */
    double announced_s;    /* since when steering is decided that has not begun */
    double warned_s;       /* since when the driver is warned */
    double speed_factor_1; /* he drives no faster than this many times the limit, (0, 10] */
    /* Because of whom it brakes or warns, and TTC to it: when that begins, for the counters. */
    uint32_t target;
    double target_ttc_s; /* none: 0 */
} crashpulse_request;

/* A function. All texts and tables live as long as the library. */
typedef struct crashpulse_function {
    uint32_t abi; /* CRASHPULSE_FUNCTION_ABI */
    uint32_t does;
    const char *what; /* one line */
    const crashpulse_parameter *parameters;
    size_t parameter_count; /* at most CRASHPULSE_PARAMETERS_MAX */
    const char *const *counter_names;
    size_t counter_count; /* at most CRASHPULSE_COUNTERS_MAX */
    size_t car_size; /* bytes of memory of each car, zero when it comes; may move between steps */
    /* Once for a replication or branch. Returns NULL, or what is wrong; *self (may stay NULL) goes
     * to the others. */
    const char *(*create)(const crashpulse_setup *setup, crashpulse_outlook *outlook, void **self);
    /* One car. Returns NULL, or what went wrong, which fails the replication. */
    const char *(*step)(void *self, void *car, const crashpulse_view *view,
                        crashpulse_request *request);
    void (*leave)(void *self, void *car); /* it has left the road, or all ends; may be NULL */
    void (*destroy)(void *self);          /* may be NULL */
} crashpulse_function;

/* The only symbol of a library that the host asks for. */
__attribute__((visibility("default"))) const crashpulse_function *crashpulse_function_entry(void);

#ifdef __cplusplus
}
#endif

#endif
