/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TESTS_STORE_FIXTURE_H
#define TESTS_STORE_FIXTURE_H

#include "store/claim.h"
#include "store/plan_rows.h"
#include "store/query.h"
#include "store/result_rows.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A folder of its own for each test, a small planned study, and results to put into it. */

typedef struct fixture {
    char folder[64];
    char db[96];
} fixture;

static inline int fixture_begin(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    snprintf(f->folder, sizeof f->folder, "/tmp/crashpulse-test-XXXXXX");
    assert_non_null(mkdtemp(f->folder));
    snprintf(f->db, sizeof f->db, "%s/study.db", f->folder);
    *state = f;
    return 0;
}

static inline int fixture_end(void **state)
{
    fixture *f = *state;
    char command[128];
    snprintf(command, sizeof command, "rm -r '%s'", f->folder);
    int failed = system(command);
    free(f);
    return failed;
}

static inline void assert_ok(cp_status status, const cp_error *error)
{
    if (status != CP_OK)
        fail_msg("%s: %s", cp_status_text(status), error->text);
}

/* Two variants of one scenario with two replications each; nothing in it is owned. */
typedef struct small_plan {
    cp_scenario_row scenario;
    cp_variant_row variant[2];
    cp_vehicle_model_row model;
    cp_replication_row replication[4];
    cp_plan_rows rows;
} small_plan;

static inline void small_plan_fill(small_plan *plan)
{
    *plan = (small_plan){
        .scenario = {"crossing", "crossing.sumocfg", "[]", "{\"crossing.sumocfg\":\"00\"}", "[]"},
        .variant = {{"baseline", true, "[]"}, {"aeb", false, "[{\"function\":\"aeb\"}]"}},
        .model = {.name = "car", .hash = "11", .yaml = "name: car"}};
    plan->rows = (cp_plan_rows){.study = {.name = "small",
                                          .design = "paired_seeds",
                                          .seed = 7,
                                          .replications = 2,
                                          .duration_s = 60,
                                          .step_length_s = 0.05,
                                          .vehicles = "{}",
                                          .yaml = "study: small",
                                          .hash = "22"},
                                .scenario = &plan->scenario,
                                .scenario_count = 1,
                                .variant = plan->variant,
                                .variant_count = 2,
                                .vehicle_model = &plan->model,
                                .vehicle_model_count = 1,
                                .replication = plan->replication,
                                .replication_count = 4};
    for (size_t k = 0; k < 4; k++) {
        cp_replication_row *row = &plan->replication[k];
        *row = (cp_replication_row){.variant = k % 2, .number = k / 2, .seed = 100 + k / 2};
        row->id = cp_replication_row_id("crossing", plan->variant[k % 2].name, "", row->seed);
        snprintf(row->configuration_hash, sizeof row->configuration_hash, "configuration %zu", k);
    }
}

static const cp_owner SOMEBODY = {.host = "here", .pid = 4711, .process_start = 99};

/* A database with the small plan in it. */
static inline cp_store *open_planned(const fixture *f, small_plan *plan)
{
    cp_store *store = NULL;
    cp_error error = {0};
    small_plan_fill(plan);
    assert_ok(cp_store_open(f->db, CP_STORE_CREATE, &store, &error), &error);
    assert_ok(cp_plan_rows_write(store, &plan->rows, &error), &error);
    return store;
}

/* A front-front crash; olc_g NAN means that the OLC is left-censored. */
static inline void add_crash(cp_result_rows *results, double time_s, double olc_g_a, double olc_g_b)
{
    cp_crash_row *crash = cp_result_rows_add_crash(results);
    assert_non_null(crash);
    crash->time_s = time_s;
    crash->contact_m = (cp_vec2){1.0, 2.0};
    crash->description = (cp_crash_description){.closing_speed_m_s = 20, .overlap_1 = 0.5};
    for (int role = 0; role < 2; role++) {
        cp_crash_vehicle_row *vehicle = &crash->vehicle[role];
        double olc_g = role == 0 ? olc_g_a : olc_g_b;
        vehicle->sumo_id = strdup(role == 0 ? "left" : "right");
        vehicle->sumo_type = strdup("passenger");
        vehicle->vehicle_model = strdup("car");
        vehicle->side = CP_SIDE_FRONT;
        vehicle->body.cog_m = (cp_vec2){3.0, 4.0 + role};
        vehicle->severity = (cp_severity){.delta_v_m_s = 12, .t_v0_s = NAN};
        vehicle->severity.olc.status = isnan(olc_g) ? CP_OLC_BEYOND_HORIZON : CP_OLC_VALUE;
        vehicle->severity.olc.olc_g = olc_g;
    }
}

/* Claim replication number k of the plan and commit one crash for each of count OLC values. */
static inline void finish_replication_with(cp_store *store, const small_plan *plan, size_t k,
                                           const double *olc_g, size_t count)
{
    cp_error error = {0};
    cp_result_rows results = {.replication_id = plan->replication[k].id,
                              .simulated_s = 60,
                              .vehicle_km = 50,
                              .vehicle_h = 1};
    assert_ok(cp_claim_take(store, results.replication_id, plan->replication[k].configuration_hash,
                            &SOMEBODY, &results.attempt, &error),
              &error);
    assert_true(results.attempt > 0);
    results.counters = strdup("{}");
    for (size_t c = 0; c < count; c++)
        add_crash(&results, 1.0 + (double)c, olc_g[c], 10.0 + olc_g[c]);
    assert_ok(cp_result_rows_commit(store, &results, &error), &error);
    cp_result_rows_destroy(&results);
}

static inline double number_of(cp_store *store, const char *sql)
{
    cp_error error = {0};
    double value = NAN;
    assert_ok(cp_query_number(store, sql, &value, &error), &error);
    return value;
}

#endif
