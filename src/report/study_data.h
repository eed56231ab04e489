/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef REPORT_STUDY_DATA_H
#define REPORT_STUDY_DATA_H

#include "store/store.h"

#include <jansson.h>

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What comparisons and reports need of a study's database, read once: exposure of every finished
 * replication, and its frontally struck vehicles. Rows refer to each other by index. */

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
    size_t replication;
    size_t crash_type;
    bool frontal;
    bool inside; /* validity of both vehicles */
} cp_study_crash;

/* What is known of a vehicle's OLC; the page of a report uses the same numbers. */
typedef enum cp_olc_known {
    CP_OLC_KNOWN,    /* a value */
    CP_OLC_CENSORED, /* left-censored: below every value */
    CP_OLC_FAILED    /* its crash could not be simulated */
} cp_olc_known;

/* A frontally struck vehicle. */
typedef struct cp_study_vehicle {
    size_t crash;
    char role; /* 'a' or 'b' */
    cp_olc_known olc;
    double olc_g;       /* NAN without a value */
    double delta_v_m_s; /* NAN when unknown */
    double closing_speed_m_s;
    double lateral_offset_m;
    double angle_rad;
    size_t validity; /* index into validity texts; 0 is "inside" */
} cp_study_vehicle;

typedef struct cp_study_data {
    json_t *about; /* the study's row, program versions, vehicle models: as stored, for reports */
    char *name;
    bool paired; /* replications with the same number ran the same seed in every variant */
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
    cp_study_vehicle *vehicle;
    size_t validity_count;
    char **validity; /* [0] "inside", then the lists that occur */
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
