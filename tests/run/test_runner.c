/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/runner.h"

#include "core/file.h"
#include "run/owner.h"
#include "store/query.h"
#include "store/result_rows.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* Studies on real SUMO, with real workers: the crossing of tests/run, sixty seconds. */

#define PATH_SIZE 512

typedef struct fixture {
    char folder[64];
    char study[PATH_SIZE];
    char db[PATH_SIZE];
    char worker[PATH_SIZE];
    char sumocfg[PATH_SIZE];
} fixture;

static void assert_ok(cp_status status, const cp_error *error)
{
    if (status != CP_OK)
        fail_msg("%s: %s", cp_status_text(status), error->text);
}

static void write_text(const char *folder, const char *name, const char *text)
{
    char path[PATH_SIZE];
    cp_error error = {0};
    snprintf(path, sizeof path, "%s/%s", folder, name);
    assert_ok(cp_file_write(path, text, strlen(text), &error), &error);
}

static void write_study(const fixture *f, const char *sumocfg, const char *duration_s,
                        const char *deceleration_m_s2)
{
    char text[4096];
    snprintf(text, sizeof text,
             "study: crossing\n"
             "design: paired_seeds\n"
             "seed: 5\n"
             "replications: 2\n"
             "duration_s: %s\n"
             "scenarios:\n"
             "  - name: crossing\n"
             "    sumocfg: %s\n"
             "    driver_errors:\n"
             "      - model: failed_to_see\n"
             "        parameters: {probability_1: 1}\n"
             "variants:\n"
             "  - name: baseline\n"
             "  - name: aeb\n"
             "    functions:\n"
             "      - function: aeb\n"
             "        parameters: {ttc_s: 1.2, deceleration_m_s2: %s}\n"
             "vehicles:\n"
             "  default: car.yaml\n"
             "  types:\n"
             "    - {type: van, model: van.yaml}\n",
             duration_s, sumocfg, deceleration_m_s2);
    write_text(f->folder, "study.yaml", text);
}

static int fixture_begin(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    const char *build = getenv("CRASHPULSE_BUILD");
    if (build == NULL)
        fail_msg("CRASHPULSE_BUILD names the build folder; run this by ctest");
    snprintf(f->folder, sizeof f->folder, "/tmp/crashpulse-test-XXXXXX");
    assert_non_null(mkdtemp(f->folder));
    snprintf(f->study, PATH_SIZE, "%s/study.yaml", f->folder);
    snprintf(f->db, PATH_SIZE, "%s/study.db", f->folder);
    snprintf(f->worker, PATH_SIZE, "%s/crashpulse-worker", build);
    snprintf(f->sumocfg, PATH_SIZE, "%s/tests/run/crossing/crossing.sumocfg", build);
    write_study(f, f->sumocfg, "60", "8");
    write_text(f->folder, "car.yaml",
               "vehicle: car\nparameters:\n"
               "  - {name: mass_kg, value: 1500}\n");
    write_text(f->folder, "van.yaml",
               "vehicle: van\nparameters:\n"
               "  - {name: mass_kg, value: 2100}\n");
    *state = f;
    return 0;
}

static int fixture_end(void **state)
{
    fixture *f = *state;
    char command[128];
    snprintf(command, sizeof command, "rm -r '%s'", f->folder);
    int failed = system(command);
    free(f);
    return failed;
}

static cp_status run(const fixture *f, const char *db, size_t jobs, cp_runner_summary *summary,
                     cp_error *error)
{
    cp_runner_options options = {
        .study_path = f->study, .db_path = db, .jobs = jobs, .worker_path = f->worker};
    return cp_runner_run(&options, summary, error);
}

static double number_of(const char *db, const char *sql)
{
    cp_store *store = NULL;
    cp_error error = {0};
    double value = NAN;
    assert_ok(cp_store_open(db, CP_STORE_READ, &store, &error), &error);
    assert_ok(cp_query_number(store, sql, &value, &error), &error);
    cp_store_close(store);
    return value;
}

// All that a study found, as text: every table but attempt, which holds times and pids.
static char *dump(const char *db)
{
    char command[2 * PATH_SIZE];
    size_t size = 0, room = 1 << 24;
    char *text = calloc(1, room);
    assert_non_null(text);
    snprintf(
        command, sizeof command,
        "for t in study scenario variant vehicle_model replication crash crash_vehicle "
        "contact sumo_collision pulse sweep_value; do echo \"$t\"; sqlite3 -cmd '.mode quote' '%s' "
        "\"SELECT * FROM $t ORDER BY 1, 2\"; done",
        db);
    FILE *shell = popen(command, "r");
    assert_non_null(shell);
    size = fread(text, 1, room - 1, shell);
    assert_true(size > 0 && size < room - 1);
    assert_int_equal(pclose(shell), 0);
    return text;
}

static void assert_same_databases(const char *db_1, const char *db_2)
{
    char *one = dump(db_1), *two = dump(db_2);
    if (strcmp(one, two) != 0)
        fail_msg("%s and %s differ", db_1, db_2);
    free(one);
    free(two);
}

static void run_finds_crashes_and_says_when_finished(void **state)
{
    const fixture *f = *state;
    cp_runner_summary summary;
    cp_error error = {0};
    assert_ok(run(f, f->db, 2, &summary, &error), &error);
    assert_int_equal(summary.replications, 4);
    assert_int_equal(summary.done_now, 4);
    assert_int_equal(summary.failed, 0);
    assert_true(summary.crashes > 0);
    assert_true(number_of(f->db, "SELECT count(*) FROM replication WHERE status = 'done' AND "
                                 "vehicle_km > 1 AND vehicle_h > 0.01 AND departed > 10 AND "
                                 "simulated_s = 60") == 4);
    assert_true(number_of(f->db, "SELECT crashes FROM olc_by_variant WHERE variant = "
                                 "'baseline'") > 0);
    assert_true(number_of(f->db, "SELECT count(*) FROM crash_vehicle WHERE frontal = 1 AND "
                                 "olc_status = 'value' AND olc_g > 0") > 0);
    assert_true(number_of(f->db, "SELECT count(*) FROM crash_vehicle WHERE "
                                 "(sumo_type = 'van') <> (vehicle_model = 'van')") == 0);
    // Whatever was simulated has its pulse.
    assert_true(number_of(f->db, "SELECT count(*) FROM crash_vehicle AS v LEFT JOIN pulse AS p "
                                 "USING (crash_id, role) WHERE (v.delta_v_m_s IS NULL) <> "
                                 "(p.samples IS NULL)") == 0);
    assert_true(number_of(f->db, "SELECT avg(length(samples)) FROM pulse") <= 1024);
    // Every collision that SUMO itself reports is a crash or has a verdict.
    assert_true(number_of(f->db, "SELECT count(*) FROM sumo_collision") > 0);
    assert_true(number_of(f->db, "SELECT count(*) FROM sumo_collision WHERE found_as = "
                                 "'no_contact'") == 0);

    char *before = dump(f->db);
    assert_ok(run(f, f->db, 2, &summary, &error), &error);
    assert_int_equal(summary.done_before, 4);
    assert_int_equal(summary.done_now, 0);
    char *after = dump(f->db);
    assert_string_equal(before, after);
    assert_true(number_of(f->db, "SELECT count(*) FROM attempt") == 4);
    free(before);
    free(after);
}

static void number_of_jobs_changes_nothing(void **state)
{
    const fixture *f = *state;
    char other[PATH_SIZE];
    cp_runner_summary summary;
    cp_error error = {0};
    snprintf(other, sizeof other, "%s/other.db", f->folder);
    assert_ok(run(f, f->db, 1, &summary, &error), &error);
    assert_ok(run(f, other, 2, &summary, &error), &error);
    assert_true(number_of(f->db, "SELECT count(*) FROM crash") > 0);
    assert_same_databases(f->db, other);
}

// A warm-up leaves traffic as it is; what happens before its end is just not counted.
static void warmup_is_not_counted(void **state)
{
    const fixture *f = *state;
    char whole[PATH_SIZE];
    cp_runner_summary summary;
    cp_error error = {0};
    snprintf(whole, sizeof whole, "%s/whole.db", f->folder);
    assert_ok(run(f, whole, 2, &summary, &error), &error);
    write_study(f, f->sumocfg, "60\nwarmup_s: 30", "8");
    assert_ok(run(f, f->db, 2, &summary, &error), &error);

    double early = number_of(whole, "SELECT count(*) FROM crash WHERE time_s < 30");
    assert_true(early > 0);
    assert_true(number_of(f->db, "SELECT count(*) FROM contact WHERE verdict = 'warmup'") == early);
    assert_true(number_of(f->db, "SELECT count(*) FROM crash") ==
                number_of(whole, "SELECT count(*) FROM crash WHERE time_s >= 30"));
    assert_true(number_of(f->db, "SELECT min(time_s) FROM crash") >= 30);
    assert_true(number_of(f->db, "SELECT count(*) FROM replication WHERE simulated_s = 30") == 4);

    // Exposure of the second half: some, and less than the whole.
    double whole_km = number_of(whole, "SELECT sum(vehicle_km) FROM replication");
    double half_km = number_of(f->db, "SELECT sum(vehicle_km) FROM replication");
    assert_true(half_km > 0.3 * whole_km && half_km < 0.9 * whole_km);
}

static void changed_study_is_refused_by_name(void **state)
{
    const fixture *f = *state;
    cp_runner_summary summary;
    cp_error error = {0};
    write_study(f, f->sumocfg, "10", "8");
    assert_ok(run(f, f->db, 2, &summary, &error), &error);
    char *before = dump(f->db);
    write_study(f, f->sumocfg, "10", "7");
    assert_int_equal(run(f, f->db, 2, &summary, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "variant aeb: functions was"));
    write_study(f, f->sumocfg, "11", "8");
    assert_int_equal(run(f, f->db, 2, &summary, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "duration_s was '10.0', is now '11.0'"));
    char *after = dump(f->db);
    assert_string_equal(before, after);
    free(before);
    free(after);
}

static void assert_refused(const fixture *f, const char *message)
{
    cp_runner_summary summary;
    cp_error error = {0};
    cp_status status = run(f, f->db, 2, &summary, &error);
    if (status != CP_BAD_INPUT || strstr(error.text, message) == NULL)
        fail_msg("expected '%s', got %s '%s'", message, cp_status_text(status), error.text);
    assert_int_equal(access(f->db, F_OK), -1);
}

static void bad_input_leaves_no_database(void **state)
{
    fixture *f = *state;
    char path[PATH_SIZE];
    write_text(f->folder, "study.yaml", "study: [broken\n");
    assert_refused(f, "study.yaml:");
    write_text(f->folder, "study.yaml", "study: x\nseeds: 5\n");
    assert_refused(f, "study.yaml:2: Unexpected key: seeds");

    write_study(f, "no.sumocfg", "10", "8");
    assert_refused(f, "no.sumocfg");

    // SUMO's own words about a network that is not there.
    snprintf(path, sizeof path, "%s/broken.sumocfg", f->folder);
    write_text(f->folder, "broken.sumocfg",
               "<configuration><input><net-file value=\"gone.net.xml\"/></input></configuration>");
    write_study(f, path, "10", "8");
    assert_refused(f, "gone.net.xml");

    write_study(f, f->sumocfg, "10", "8");
    write_text(f->folder, "car.yaml",
               "vehicle: car\nparameters:\n"
               "  - {name: mass_kg, value: -1}\n");
    assert_refused(f, "car.yaml:3:");
    snprintf(f->study, PATH_SIZE, "%s/none.yaml", f->folder);
    assert_refused(f, "none.yaml");
}

// A worker that dies takes its replication with it, not the study; its last words are kept.
static void dying_workers_are_recorded(void **state)
{
    fixture *f = *state;
    char script[4 * PATH_SIZE];
    cp_runner_summary summary;
    cp_error error = {0};
    write_study(f, f->sumocfg, "10", "8");
    // Real for the probe; for replications it speaks and aborts.
    snprintf(script, sizeof script,
             "#!/bin/sh\ncase \"$*\" in *--probe*) exec '%s' \"$@\";; esac\n"
             "echo 'Assertion in lane 7 failed' >&2\nkill -ABRT $$\n",
             f->worker);
    char real[PATH_SIZE];
    snprintf(real, sizeof real, "%s", f->worker);
    write_text(f->folder, "worker.sh", script);
    snprintf(f->worker, PATH_SIZE, "%s/worker.sh", f->folder);
    char command[2 * PATH_SIZE];
    // The script finds its parent changed by no more than exec.
    snprintf(command, sizeof command, "chmod +x '%s'", f->worker);
    assert_int_equal(system(command), 0);
    assert_int_equal(run(f, f->db, 2, &summary, &error), CP_RUN_FAILED);
    assert_int_equal(summary.failed, 4);
    assert_non_null(strstr(error.text, "Assertion in lane 7 failed"));
    assert_true(number_of(f->db, "SELECT count(*) FROM replication WHERE status = 'failed'") == 4);
    assert_true(number_of(f->db, "SELECT count(*) FROM attempt WHERE outcome = 'failed' AND "
                                 "message LIKE '%signal 6%Assertion in lane 7 failed%'") == 4);

    // The next run tries again, and with a sound worker completes the study.
    snprintf(f->worker, PATH_SIZE, "%s", real);
    assert_ok(run(f, f->db, 2, &summary, &error), &error);
    assert_int_equal(summary.done_now, 4);
}

// Wait until the database says so; the worker that is to be disturbed is at work then.
static void wait_for(const char *db, const char *sql)
{
    for (int k = 0; k < 3000; k++) {
        cp_store *store = NULL;
        double value = 0.0;
        if (cp_store_open(db, CP_STORE_READ, &store, NULL) == CP_OK &&
            cp_query_number(store, sql, &value, NULL) != CP_OK)
            value = 0.0;
        cp_store_close(store);
        if (value > 0.0)
            return;
        usleep(10000);
    }
    fail_msg("nothing happened: %s", sql);
}

static void disturbed(const fixture *f, int signal_number, int expected_exit)
{
    cp_runner_summary summary;
    cp_error error = {0};
    int wait_status = 0;
    char undisturbed[PATH_SIZE];
    snprintf(undisturbed, sizeof undisturbed, "%s/undisturbed.db", f->folder);
    write_study(f, f->sumocfg, "100", "8"); // long enough to be disturbed in
    pid_t pid = fork();
    assert_true(pid >= 0);
    if (pid == 0)
        _exit(cp_status_exit_code(run(f, f->db, 1, &summary, &error)));
    wait_for(f->db, "SELECT count(*) FROM attempt WHERE outcome = 'running'");
    cp_owner worker;
    assert_ok(cp_owner_self(&worker, &error), &error); // for the host
    worker.pid = (int64_t)number_of(f->db, "SELECT pid FROM attempt WHERE outcome = 'running'");
    worker.process_start =
        (int64_t)number_of(f->db, "SELECT process_start FROM attempt WHERE outcome = 'running'");
    assert_int_equal(kill(pid, signal_number), 0);
    assert_int_equal(waitpid(pid, &wait_status, 0), pid);
    if (expected_exit >= 0)
        assert_int_equal(WEXITSTATUS(wait_status), expected_exit);

    // No worker survives its runner.
    for (int k = 0; cp_owner_is_alive(&worker) && k < 1000; k++)
        usleep(10000);
    assert_false(cp_owner_is_alive(&worker));
    assert_true(number_of(f->db, "SELECT count(*) FROM attempt WHERE outcome = 'done'") == 0);

    assert_ok(run(f, f->db, 2, &summary, &error), &error);
    assert_int_equal(summary.done_before + summary.done_now, 4);
    assert_ok(run(f, undisturbed, 2, &summary, &error), &error);
    assert_same_databases(f->db, undisturbed);
}

static void interrupted_study_is_completed(void **state)
{
    disturbed(*state, SIGINT, 1);
}

static void killed_study_is_completed(void **state)
{
    disturbed(*state, SIGKILL, -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(run_finds_crashes_and_says_when_finished, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(number_of_jobs_changes_nothing, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(warmup_is_not_counted, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(changed_study_is_refused_by_name, fixture_begin,
                                        fixture_end),
        cmocka_unit_test_setup_teardown(bad_input_leaves_no_database, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(dying_workers_are_recorded, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(interrupted_study_is_completed, fixture_begin, fixture_end),
        cmocka_unit_test_setup_teardown(killed_study_is_completed, fixture_begin, fixture_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
