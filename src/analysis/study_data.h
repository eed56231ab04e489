/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_STUDY_DATA_H
#define ANALYSIS_STUDY_DATA_H

#include "stats/risk_function.h"
#include "store/counterfactual_rows.h"
#include "store/store.h"

#include <jansson.h>

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What comparisons and reports need of a study's database, read once: exposure of every finished
 * replication, its crashes and their vehicles, counterfactual pairs, risk functions. Rows refer to
 * each other by index. */

typedef struct cp_study_scenario {
    char *name;
    json_t *driver_errors; /* [{"model", "parameters": {}}]: what every rate is conditional on */
} cp_study_scenario;

/* A variant of the study; with a sweep, one of its points. */
typedef struct cp_study_variant {
    char *name; /* "aeb", with a sweep "aeb [ttc_s=1.2]" */
    bool is_baseline;
    json_t *functions; /* [{"function", "parameters": {}}] */
} cp_study_variant;

typedef struct cp_study_replication {
    size_t scenario;
    size_t variant;
    int64_t number;
    int64_t seed;
    double vehicle_km;
    double vehicle_h;
} cp_study_replication;

typedef struct cp_study_crash {
    int64_t id; /* of its row */
    size_t replication;
    size_t crash_type;
    bool frontal;
    bool inside; /* validity of both vehicles */
    double time_s;
    double x_m; /* first contact, world */
    double y_m;
} cp_study_crash;

/* What risk functions may depend on: X(name, column). */
#define CP_PREDICTORS(X)                                                                           \
    X(CP_PREDICTOR_DELTA_V, "delta_v_m_s")                                                         \
    X(CP_PREDICTOR_DELTA_V_X, "delta_v_x_m_s")                                                     \
    X(CP_PREDICTOR_CLOSING_SPEED, "closing_speed_m_s")                                             \
    X(CP_PREDICTOR_MAX_50MS, "max_50ms_g")                                                         \
    X(CP_PREDICTOR_ASI, "asi_1")                                                                   \
    X(CP_PREDICTOR_DELTA_V_COMMON, "delta_v_without_rebound_m_s")

typedef enum cp_predictor {
#define CP_PREDICTOR_NAME(name, column) name,
    CP_PREDICTORS(CP_PREDICTOR_NAME)
#undef CP_PREDICTOR_NAME
        CP_PREDICTOR_COUNT
} cp_predictor;

/* Whether a predictor is a speed, which risk curves are drawn over. */
bool cp_predictor_is_speed(cp_predictor predictor);

/* A row of the table risk_function that comparisons use. */
typedef struct cp_study_risk {
    char *name;
    char *level;
    char *source;
    char *note;
    cp_predictor predictor;
    cp_risk_function function;
    bool
        frontal_only; /* of drivers of frontally struck vehicles, else of both of a frontal crash */
} cp_study_risk;

/* What is known of a vehicle's OLC; the page of a report uses the same numbers. */
typedef enum cp_olc_known {
    CP_OLC_KNOWN,    /* a value */
    CP_OLC_CENSORED, /* left-censored: below every value */
    CP_OLC_FAILED    /* its crash could not be simulated */
} cp_olc_known;

/* A vehicle of a crash. Only frontally struck ones have an OLC. */
typedef struct cp_study_vehicle {
    size_t crash;
    char role; /* 'a' or 'b' */
    bool frontal;
    cp_olc_known olc;
    double olc_g;       /* NAN without a value */
    double delta_v_m_s; /* NAN when unknown */
    double closing_speed_m_s;
    double lateral_offset_m;
    double angle_rad;
    size_t validity;                      /* index into validity texts; 0 is "inside" */
    double predictor[CP_PREDICTOR_COUNT]; /* NAN when unknown */
    size_t evidence;      /* index into the classes of tests; of a baseline's or own crash only */
    double class_error_g; /* of its class; NAN without one, or when that error is not known */
} cp_study_vehicle;

/* A baseline's crash under a treatment, in the counterfactual design. */
typedef struct cp_study_pair {
    size_t crash;
    size_t variant;
    cp_outcome outcome;
    cp_outcome outcome_olc;
    size_t reason; /* cp_null_status; CP_NULL_REPRODUCED unless invalid */
    double new_crashes;
    double vanished_crashes; /* NAN: not known */
    double olc_g[2]; /* baseline, treated: the larger of the frontally struck vehicles, 0 when left-
                        censored or avoided; NAN without one */
    double closing_speed_m_s[2];             /* treated: 0 when avoided, NAN when invalid */
    double predictor[2][CP_PREDICTOR_COUNT]; /* of the treated crash's vehicles; NAN without */
    bool treated_inside[2];                  /* these vehicles inside validity */
    bool treated_frontal[2];                 /* and struck on their front */
    char treated_type[16];                   /* "front-side", …; empty without a frontal one */
} cp_study_pair;

/* A vehicle of a crash that a baseline's crash became under a treatment; its crash is the
 * baseline's, everything else its own. */
typedef struct cp_study_treated {
    size_t variant;
    cp_study_vehicle vehicle;
    double x_m; /* first contact of the treated crash, world */
    double y_m;
} cp_study_treated;

typedef struct cp_study_data {
    json_t *about; /* the study's row, program versions, vehicle models: as stored, for reports */
    char *name;
    bool counterfactual; /* treatments have pairs, not replications */
    bool paired;         /* replications with the same number ran the same seed in every variant */
    uint64_t seed;
    size_t unfinished; /* replications planned, running or failed */

    size_t scenario_count;
    cp_study_scenario *scenario;
    size_t variant_count;
    cp_study_variant *variant;
    size_t replication_count; /* finished, by scenario, number, variant */
    cp_study_replication *replication;
    size_t crash_type_count;
    char **crash_type; /* those that occur, in the order of the alphabet */
    size_t crash_count;
    cp_study_crash *crash;
    size_t vehicle_count;
    cp_study_vehicle *vehicle; /* two a crash, by crash and role */
    size_t frontal_vehicle_count;
    size_t evidence_count;
    char **evidence; /* classes of tests that occur, in the order of the alphabet */
    size_t pair_count;
    cp_study_pair *pair; /* by crash and variant */
    size_t treated_count;
    cp_study_treated *treated; /* of all treated crashes, by crash, variant and role */
    size_t risk_count;
    cp_study_risk *risk; /* by name and level */
    size_t validity_count;
    char **validity; /* [0] "inside", then the lists that occur, treated crashes included */
} cp_study_data;

/* Read a study. The caller destroys it, also after an error. Errors: those of the store;
 * CP_BAD_INPUT for a database without a study. */
CP_MUST_CHECK cp_status cp_study_data_read(cp_store *store, cp_study_data *data, cp_error *error);
void cp_study_data_destroy(cp_study_data *data);

/* Index of the variant called name; of the baseline when name is NULL. Error: CP_BAD_INPUT with
 * the names there are. */
CP_MUST_CHECK cp_status cp_study_data_variant(const cp_study_data *data, const char *name,
                                              size_t *variant, cp_error *error);

#endif
