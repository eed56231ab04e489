/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_SIMULATION_H
#define RUN_SIMULATION_H

#include "control/control.h"
#include "impact/impact.h"
#include "run/cross_check.h"
#include "run/found_as.h"
#include "run/history.h"
#include "run/sumo_words.h"
#include "store/participant_rows.h"

/* The traffic of one replication, step by step: what the baseline and every branch from a
 * checkpoint of it go through alike. In the worker process only. */

/* What is known of one of the two cars of a contact, at the end of its step. */
typedef struct cp_found_car {
    bool at_fault;        /* a driver error is at work on it; never on a car that had crashed */
    bool errs_alone;      /* one that is at work whoever the other is */
    bool had_crashed;     /* it stands there since an earlier crash */
    double error_since_s; /* SUMO clock: since when it has erred towards the other; INFINITY */
} cp_found_car;

/* A contact and what became of it. */
typedef struct cp_found_contact {
    cp_impact impact;
    cp_found_as found_as;
    cp_found_car car[2]; /* by role */
    size_t follows;      /* index of the first of the cars' earlier crashes; CP_FOLLOWS_NONE */
    cp_participant_rows participants; /* of crashes; owned by the simulation */
} cp_found_contact;

/* What the two cars of a counted crash did before it. */
typedef struct cp_found_history {
    size_t found;         /* index of the crash */
    cp_history_row *rows; /* owned */
    size_t count;
} cp_found_history;

/* What a simulation is of. Borrowed: the path as long as it lives, all else until it has begun. */
typedef struct cp_simulation_settings {
    cp_sumo_start sumo;
    const cp_control_settings *drivers; /* driver errors */
    size_t driver_count;
    const cp_control_settings *functions; /* of every car */
    size_t function_count;
    bool is_treated;     /* functions will be added to it later (cp_controls_add_treatment) */
    uint64_t study_seed; /* of draws that the replications of a study share, see control.h */
    uint64_t seed;       /* of this replication */
    double step_length_s;
    double warmup_s;  /* contacts and exposure before it do not count */
    double stay_s;    /* crashed cars stand on the road this long; 0: they leave it at once */
    double history_s; /* kept of both cars before each counted crash; 0: none */
} cp_simulation_settings;

/* Zero-initialise, begin, step, end. */
typedef struct cp_simulation {
    const char *sumocfg_path; /* of the scenario; borrowed */
    cp_traffic *traffic;
    cp_controls *controls; /* drivers and functions of the variant; in a branch the treatment too */
    cp_detector *detector;
    cp_cross_check check;
    double counted_from_s; /* SUMO clock: end of the warm-up */
    long long steps, warmup_steps;
    cp_exposure warmup_exposure; /* at the end of the warm-up, once that is over */
    double stay_s;               /* of the study: how long crashed cars stay */
    cp_history *history;         /* NULL: none is kept */
    cp_found_history *before;    /* one for each counted crash, in their order; if history */
    size_t before_count;
    size_t before_room;
    cp_found_contact *found; /* since the beginning, in order of time, then ids */
    size_t found_count;
    size_t found_room;
    uint32_t *crashed; /* vehicles that crashed in this step */
    size_t crashed_count;
    size_t crashed_room;
} cp_simulation;

/* Start SUMO with its drivers and functions. Errors: CP_BAD_INPUT for a configuration that does not
 * start, CP_NO_MEMORY. End it in any case. */
CP_MUST_CHECK cp_status cp_simulation_begin(const cp_simulation_settings *settings,
                                            cp_simulation *simulation, cp_error *error);
/* The same on traffic that is there already and that the simulation takes over: a scripted road. */
CP_MUST_CHECK cp_status cp_simulation_begin_on(const cp_simulation_settings *settings,
                                               cp_traffic *traffic, cp_simulation *simulation,
                                               cp_error *error);
/* End SUMO and what works on it; what was found stays. Nothing of it may be asked of SUMO then. */
void cp_simulation_end_traffic(cp_simulation *simulation);
void cp_simulation_end(cp_simulation *simulation);

/* One step: traffic, controls, contacts; crashed cars leave the road, or stand there as long as the
 * study says. */
CP_MUST_CHECK cp_status cp_simulation_step(cp_simulation *simulation, cp_error *error);

/* What counts: exposure after the warm-up, and the time it took, s. */
cp_exposure cp_simulation_counted(const cp_simulation *simulation, double *simulated_s);

/* Whether a found contact is a confirmed crash, counted or not. */
bool cp_found_is_crash(const cp_found_contact *found);

#endif
