/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CALIBRATE_SUITE_CASE_H
#define CALIBRATE_SUITE_CASE_H

#include "calibrate/suite.h"
#include "core/csv_table.h"
#include "crash/vehicle_model.h"

/* One case of a class for one vehicle, what it is made of and what is simulated for it. */

enum { CP_SUITE_OFFSETS_MAX = 16 };

typedef struct cp_suite_case {
    char label[96];
    cp_vehicle_model model[2]; /* [1] with is_pair only */
    bool is_pair;
    bool has_barrier; /* with is_pair: the first car meets it too, for comparison */
    cp_barrier barrier;
    double speed_m_s[2];
    double angle_rad;
    double side_1; /* +1: the opponent stands to the left */
    /* Offsets of the opponent; more than one where the test's is not known. */
    double offset_m[CP_SUITE_OFFSETS_MAX];
    size_t offset_count;
    cp_contact_side struck; /* of the first car; not its front: the second's front strikes it, its
                             * middle at each of offset_m from the first's centre of gravity, turned
                             * from square by angle_rad */
    bool is_placed;         /* by configuration instead of offset and angle */
    cp_crash_configuration configuration;
    double reference[2][CP_SUITE_QUANTITY_COUNT]; /* of the test's two cars; NAN: none */
} cp_suite_case;

typedef struct cp_suite_cases {
    cp_suite_case *row; /* owned */
    size_t count;
    char skipped[256]; /* why there are none; "" otherwise */
} cp_suite_cases;

/* A case of the class, to be completed. */
cp_suite_case cp_suite_plain_case(const cp_suite_class *class, const cp_vehicle_model *vehicle);
/* Room for cases. */
CP_MUST_CHECK cp_status cp_suite_cases_make(cp_suite_cases *cases, size_t count, cp_error *error);
/* A car of another mass with the same structures: its yaw inertia in proportion. */
void cp_suite_set_mass(cp_vehicle_model *model, double mass_kg);

/* One number of a row of a test table into *value. */
typedef struct cp_suite_column {
    const char *column;
    double smallest;
    double largest;
    double *value;
} cp_suite_column;
CP_MUST_CHECK cp_status cp_suite_read_columns(const cp_csv_table *table, size_t k,
                                              const cp_suite_column *columns, size_t count,
                                              cp_error *error);

/* How many cars of a case a quantity is taken of: 1 or 2. */
int cp_suite_case_cars(const cp_suite_class *class, const cp_suite_comparison *comparison);

/* Load a vehicle by a shipped name or, with a '/' or a '.', by a path seen from the folder of base
 * (NULL: as it is). Errors: CP_BAD_INPUT naming what is allowed. */
CP_MUST_CHECK cp_status cp_suite_vehicle(const char *base, const char *text,
                                         cp_vehicle_model *model, cp_error *error);

void cp_suite_cases_destroy(cp_suite_cases *cases);

/* Simulate a case at offset number index. wall (when the case is of a pair and has a barrier too)
 * is the first car against that; zeroed otherwise. The caller destroys both results. */
CP_MUST_CHECK cp_status cp_suite_case_simulate(const cp_suite_case *row, size_t index,
                                               cp_crash_result *result, cp_crash_result *wall,
                                               cp_error *error);

#endif
