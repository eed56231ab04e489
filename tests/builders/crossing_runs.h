/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BUILDERS_CROSSING_RUNS_H
#define BUILDERS_CROSSING_RUNS_H

#include "core/file.h"
#include "run/runner.h"
#include "store/query.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

/* Studies of the crossing of tests/run on real SUMO with real workers: a folder of their own with
 * its configuration and a car; the routes are the test's. */

#define CROSSING_PATH_SIZE 512

typedef struct crossing_runs {
    char folder[64];
    char worker[CROSSING_PATH_SIZE];
} crossing_runs;

static inline void assert_ok(cp_status status, const cp_error *error)
{
    if (status != CP_OK)
        fail_msg("%s: %s", cp_status_text(status), error->text);
}

static inline void crossing_write(const crossing_runs *f, const char *name, const char *text)
{
    char path[CROSSING_PATH_SIZE];
    cp_error error = {0};
    snprintf(path, sizeof path, "%s/%s", f->folder, name);
    assert_ok(cp_file_write(path, text, strlen(text), &error), &error);
}

/* sections: further ones of the .sumocfg. The caller ends them. */
static inline crossing_runs *crossing_begin(const char *sections)
{
    crossing_runs *f = calloc(1, sizeof *f);
    assert_non_null(f);
    const char *build = getenv("CRASHPULSE_BUILD");
    if (build == NULL)
        fail_msg("CRASHPULSE_BUILD names the build folder; run this by ctest");
    snprintf(f->folder, sizeof f->folder, "/tmp/crashpulse-test-XXXXXX");
    assert_non_null(mkdtemp(f->folder));
    snprintf(f->worker, sizeof f->worker, "%s/crashpulse-worker", build);
    char cfg[2 * CROSSING_PATH_SIZE];
    snprintf(cfg, sizeof cfg,
             "<configuration><input>"
             "<net-file value=\"%s/tests/run/crossing/crossing.net.xml\"/>"
             "<route-files value=\"crossing.rou.xml\"/></input>%s</configuration>",
             build, sections);
    crossing_write(f, "crossing.sumocfg", cfg);
    crossing_write(f, "car.yaml", "vehicle: car\nparameters:\n  - {name: mass_kg, value: 1500}\n");
    return f;
}

static inline int crossing_end(void **state)
{
    crossing_runs *f = *state;
    char command[128];
    snprintf(command, sizeof command, "rm -r '%s'", f->folder);
    int failed = system(command);
    free(f);
    return failed;
}

/* NAME.yaml: one replication of 100 s in which everybody overlooks everybody, without a background.
 * head: further lines of its head; sumo_options: a list's entries; variants: besides the baseline.
 */
static inline void crossing_write_study(const crossing_runs *f, const char *name,
                                        const char *design, const char *head,
                                        const char *sumo_options, const char *variants)
{
    char text[4096], file[64];
    snprintf(text, sizeof text,
             "study: crossing\n"
             "design: %s\n"
             "seed: 5\n"
             "replications: 1\n"
             "duration_s: 100\n"
             "background: {duration_s: 0}\n"
             "%s"
             "scenarios:\n"
             "  - name: crossing\n"
             "    sumocfg: crossing.sumocfg\n"
             "    sumo_options: [%s]\n"
             "    driver_errors:\n"
             "      - model: failed_to_see\n"
             "        parameters: {probability_1: 1}\n"
             "variants:\n"
             "  - name: baseline\n"
             "%s"
             "vehicles:\n"
             "  default: car.yaml\n"
             "  types: [{type: van, model: car.yaml}]\n",
             design, head, sumo_options, variants);
    snprintf(file, sizeof file, "%s.yaml", name);
    crossing_write(f, file, text);
}

/* NAME.yaml into NAME.db. */
static inline void crossing_run(const crossing_runs *f, const char *name)
{
    char study[CROSSING_PATH_SIZE], db[CROSSING_PATH_SIZE];
    cp_runner_summary summary;
    cp_error error = {0};
    snprintf(study, sizeof study, "%s/%s.yaml", f->folder, name);
    snprintf(db, sizeof db, "%s/%s.db", f->folder, name);
    cp_runner_options options = {
        .study_path = study, .db_path = db, .jobs = 1, .worker_path = f->worker};
    assert_ok(cp_runner_run(&options, &summary, &error), &error);
    assert_int_equal(summary.failed, 0);
}

/* The one number of a query on NAME.db. */
static inline double crossing_number(const crossing_runs *f, const char *name, const char *sql)
{
    char db[CROSSING_PATH_SIZE];
    cp_store *store = NULL;
    cp_error error = {0};
    double value = NAN;
    snprintf(db, sizeof db, "%s/%s.db", f->folder, name);
    assert_ok(cp_store_open(db, CP_STORE_READ, &store, &error), &error);
    assert_ok(cp_query_number(store, sql, &value, &error), &error);
    cp_store_close(store);
    return value;
}

#endif
