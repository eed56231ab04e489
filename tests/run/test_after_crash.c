/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/file.h"
#include "run/runner.h"
#include "store/query.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* What comes after a crash and what came before it, on real SUMO with real workers: the crossing of
 * tests/run, its through cars in platoons of three, 0.9 s apart and slow to brake, so that those
 * behind a crash run into it. */

#define PATH_SIZE 512

typedef struct fixture {
    char folder[64];
    char worker[PATH_SIZE];
} fixture;

static void assert_ok(cp_status status, const cp_error *error)
{
    if (status != CP_OK)
        fail_msg("%s: %s", cp_status_text(status), error->text);
}

static void write_text(const fixture *f, const char *name, const char *text)
{
    char path[PATH_SIZE];
    cp_error error = {0};
    snprintf(path, sizeof path, "%s/%s", f->folder, name);
    assert_ok(cp_file_write(path, text, strlen(text), &error), &error);
}

static void write_routes(const fixture *f)
{
    char text[16384];
    size_t used = (size_t)snprintf(
        text, sizeof text,
        "<routes><vType id=\"car\" length=\"4.5\" width=\"1.8\" tau=\"0.5\" minGap=\"1\" "
        "decel=\"3\" emergencyDecel=\"3\" sigma=\"0\" speedFactor=\"1\"/>\n"
        "<route id=\"through\" edges=\"west_in east_out\"/>\n"
        "<route id=\"left\" edges=\"east_in south_out\"/>\n");
    for (int k = 0; k < 36; k++) {
        bool is_left = k % 4 == 0;
        double depart_s = 8.0 * (k / 4) + (is_left ? 1.2 : 0.9 * (k % 4));
        used += (size_t)snprintf(text + used, sizeof text - used,
                                 "<vehicle id=\"%s.%d\" type=\"car\" route=\"%s\" "
                                 "depart=\"%.1f\" departSpeed=\"desired\"/>\n",
                                 is_left ? "left" : "through", k, is_left ? "left" : "through",
                                 depart_s);
    }
    snprintf(text + used, sizeof text - used, "</routes>\n");
    write_text(f, "crossing.rou.xml", text);
}

// A study of the crossing; options: further lines of its head.
static void run(const fixture *f, const char *name, const char *design, const char *options)
{
    char text[2048], study[PATH_SIZE], db[PATH_SIZE];
    cp_runner_summary summary;
    cp_error error = {0};
    snprintf(text, sizeof text,
             "study: crossing\n"
             "design: %s\n"
             "seed: 5\n"
             "replications: 1\n"
             "duration_s: 100\n"
             "%s"
             "scenarios:\n"
             "  - name: crossing\n"
             "    sumocfg: crossing.sumocfg\n"
             "    driver_errors:\n"
             "      - model: failed_to_see\n"
             "        parameters: {probability_1: 1}\n"
             "variants:\n"
             "  - name: baseline\n"
             "%s"
             "vehicles:\n"
             "  default: car.yaml\n",
             design, options, strcmp(design, "counterfactual") == 0 ? "  - name: nothing\n" : "");
    snprintf(study, sizeof study, "%s/%s.yaml", f->folder, name);
    snprintf(db, sizeof db, "%s/%s.db", f->folder, name);
    cp_status status = cp_file_write(study, text, strlen(text), &error);
    assert_ok(status, &error);
    cp_runner_options runner = {
        .study_path = study, .db_path = db, .jobs = 1, .worker_path = f->worker};
    assert_ok(cp_runner_run(&runner, &summary, &error), &error);
    assert_int_equal(summary.failed, 0);
}

static int runs_begin(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    const char *build = getenv("CRASHPULSE_BUILD");
    if (build == NULL)
        fail_msg("CRASHPULSE_BUILD names the build folder; run this by ctest");
    snprintf(f->folder, sizeof f->folder, "/tmp/crashpulse-test-XXXXXX");
    assert_non_null(mkdtemp(f->folder));
    snprintf(f->worker, PATH_SIZE, "%s/crashpulse-worker", build);
    char cfg[2 * PATH_SIZE];
    snprintf(cfg, sizeof cfg,
             "<configuration><input>"
             "<net-file value=\"%s/tests/run/crossing/crossing.net.xml\"/>"
             "<route-files value=\"crossing.rou.xml\"/></input></configuration>",
             build);
    write_text(f, "crossing.sumocfg", cfg);
    write_text(f, "car.yaml", "vehicle: car\nparameters:\n  - {name: mass_kg, value: 1500}\n");
    write_routes(f);
    run(f, "removed", "paired_seeds", "");
    run(f, "history", "paired_seeds", "history_s: 2\n");
    run(f, "stays", "paired_seeds", "after_crash: {stay_s: 5}\nhistory_s: 2\n");
    run(f, "pairs", "counterfactual",
        "after_crash: {stay_s: 5}\nhistory_s: 2\ncounterfactual: {checkpoints: 60}\n");
    run(f, "late", "paired_seeds", "after_crash: {stay_s: 5}\nwarmup_s: 37.5\n");
    *state = f;
    return 0;
}

static int runs_end(void **state)
{
    fixture *f = *state;
    char command[128];
    snprintf(command, sizeof command, "rm -r '%s'", f->folder);
    int failed = system(command);
    free(f);
    return failed;
}

static double number_of(const fixture *f, const char *name, const char *sql)
{
    char db[PATH_SIZE];
    cp_store *store = NULL;
    cp_error error = {0};
    double value = NAN;
    snprintf(db, sizeof db, "%s/%s.db", f->folder, name);
    assert_ok(cp_store_open(db, CP_STORE_READ, &store, &error), &error);
    assert_ok(cp_query_number(store, sql, &value, &error), &error);
    cp_store_close(store);
    return value;
}

static void assert_same_tables(const fixture *f, const char *one, const char *other)
{
    char command[4 * PATH_SIZE];
    snprintf(command, sizeof command,
             "for d in %s %s; do for t in crash crash_vehicle contact sumo_collision pulse "
             "pre_crash_sample; do sqlite3 -cmd '.mode quote' %s/$d.db \"SELECT * FROM $t ORDER "
             "BY 1, 2, 3\"; done > %s/$d.txt; done; test -s %s/%s.txt && cmp %s/%s.txt %s/%s.txt",
             one, other, f->folder, f->folder, f->folder, one, f->folder, one, f->folder, other);
    assert_int_equal(system(command), 0);
}

static void crashed_cars_leave_at_once_unless_the_study_says_otherwise(void **state)
{
    const fixture *f = *state;
    assert_true(number_of(f, "removed", "SELECT count(*) FROM crash") >= 3);
    assert_true(number_of(f, "removed", "SELECT sum(is_secondary) FROM crash") == 0);
    assert_true(number_of(f, "removed", "SELECT stay_s FROM study") == 0);
    // No vehicle has two.
    assert_true(number_of(f, "removed",
                          "SELECT count(*) - count(DISTINCT sumo_id) FROM "
                          "crash_vehicle") == 0);
}

static void who_runs_into_standing_cars_has_a_secondary_crash(void **state)
{
    const fixture *f = *state;
    assert_true(number_of(f, "stays", "SELECT stay_s FROM study") == 5);
    assert_true(number_of(f, "stays", "SELECT count(*) FROM secondary_crash") >= 3);

    // It names a crash that one of the two had, at most as long before as they stay, and the car
    // that stood is at rest, where it crashed, and not at fault.
    assert_true(
        number_of(f, "stays",
                  "SELECT count(*) FROM crash AS c WHERE is_secondary AND NOT EXISTS (SELECT 1 "
                  "FROM crash AS o JOIN crash_vehicle AS was ON was.crash_id = o.id JOIN "
                  "crash_vehicle AS is_now ON is_now.crash_id = c.id AND is_now.sumo_id = "
                  "was.sumo_id WHERE o.id = c.follows_crash_id AND c.time_s - o.time_s BETWEEN 0 "
                  "AND 5.05 AND is_now.speed_m_s = 0 AND is_now.velocity_x_m_s = 0 AND "
                  "is_now.at_fault = 0 AND abs(is_now.cog_x_m - was.cog_x_m) + "
                  "abs(is_now.cog_y_m - was.cog_y_m) < 1.5)") == 0);
    assert_true(number_of(f, "stays",
                          "SELECT count(*) FROM crash WHERE is_secondary <> "
                          "(validity LIKE '%damaged%')") == 0);
    // The first crash is the same as where nobody stays: everything before it is.
    assert_true(number_of(f, "stays", "SELECT time_s FROM crash WHERE number = 0") ==
                number_of(f, "removed", "SELECT time_s FROM crash WHERE number = 0"));
}

static void a_crash_of_the_warm_up_is_no_row_to_name(void **state)
{
    const fixture *f = *state;
    // A crash at 37.1 s, run into at 37.9 s.
    assert_true(number_of(f, "late", "SELECT count(*) FROM contact WHERE verdict = 'warmup'") > 0);
    assert_true(number_of(f, "late",
                          "SELECT count(*) FROM crash WHERE follows_crash_id IS NULL "
                          "AND is_secondary AND time_s < 39") > 0);
}

static void checkpoints_and_branches_hold_standing_cars(void **state)
{
    const fixture *f = *state;
    assert_same_tables(f, "stays", "pairs");
    assert_true(number_of(f, "pairs",
                          "SELECT count(*) FROM null_treatment JOIN crash ON id = "
                          "crash_id WHERE is_secondary AND status = 'reproduced'") >= 2);
    assert_true(number_of(f, "pairs",
                          "SELECT count(*) FROM null_treatment WHERE status NOT IN "
                          "('reproduced', 'inserted_late', 'no_checkpoint')") == 0);
    assert_true(number_of(f, "pairs",
                          "SELECT count(*) FROM counterfactual WHERE outcome NOT IN "
                          "('unchanged', 'invalid')") == 0);
}

static void history_ends_at_the_contact_and_changes_nothing(void **state)
{
    const fixture *f = *state;
    assert_true(number_of(f, "removed", "SELECT count(*) FROM pre_crash_sample") == 0);
    assert_true(number_of(f, "history", "SELECT count(*) FROM crash") ==
                number_of(f, "removed", "SELECT count(*) FROM crash"));
    assert_true(number_of(f, "history", "SELECT sum(time_s * closing_speed_m_s) FROM crash") ==
                number_of(f, "removed", "SELECT sum(time_s * closing_speed_m_s) FROM crash"));

    // Two seconds of steps of 0.05 s for both cars, the last within a step before contact.
    assert_true(number_of(f, "history", "SELECT count(*) FROM crash_vehicle") ==
                number_of(f, "history",
                          "SELECT count(*) FROM (SELECT 1 FROM pre_crash GROUP BY "
                          "crash_id, role HAVING count(*) = 40 AND max(number) = 39 "
                          "AND max(from_contact_s) BETWEEN -0.05 AND 0 AND "
                          "min(from_contact_s) >= -2)"));
    // It leads to the configuration at contact: front of the car, heading and speed of its last
    // step, carried on.
    assert_true(number_of(f, "history",
                          "SELECT count(*) FROM pre_crash AS p JOIN crash_vehicle AS x USING "
                          "(crash_id, role) WHERE p.number = 39 AND (abs(p.yaw_rad - x.yaw_rad) > "
                          "0.05 OR abs(p.speed_m_s - x.speed_m_s) > 0.5 OR abs(p.front_x_m - "
                          "p.from_contact_s * p.speed_m_s * cos(p.yaw_rad) - x.cog_x_m - 0.42 * "
                          "x.length_m * cos(x.yaw_rad)) > 0.3)") == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(crashed_cars_leave_at_once_unless_the_study_says_otherwise),
        cmocka_unit_test(who_runs_into_standing_cars_has_a_secondary_crash),
        cmocka_unit_test(a_crash_of_the_warm_up_is_no_row_to_name),
        cmocka_unit_test(checkpoints_and_branches_hold_standing_cars),
        cmocka_unit_test(history_ends_at_the_contact_and_changes_nothing),
    };
    return cmocka_run_group_tests(tests, runs_begin, runs_end);
}
