/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/counterfactual.h"

#include "builders/crossing_runs.h"

/* Counterfactual studies on real SUMO with real workers: the crossing of tests/run, with its cars
 * one by one in the route file, so that SUMO reads on in it during the whole run. */

// Long comments between the cars: the file is far longer than what SUMO reads in one go, 1 MiB.
static void write_routes(const crossing_runs *f)
{
    size_t room = 8 << 20, used = 0;
    char *text = malloc(room), filler[60001];
    assert_non_null(text);
    memset(filler, 'x', sizeof filler - 1);
    filler[sizeof filler - 1] = '\0';
    used += (size_t)snprintf(text, room,
                             "<routes><vType id=\"car\" length=\"4.5\" width=\"1.8\"/>"
                             "<vType id=\"van\" length=\"5.5\" width=\"2.0\"/>\n"
                             "<route id=\"through\" edges=\"west_in east_out\"/>\n"
                             "<route id=\"left\" edges=\"east_in south_out\"/>\n");
    int through = 0, left = 0;
    while (through < 60) {
        bool is_left = 0.4 + 4.3 * left < 3.1 * through;
        used += (size_t)snprintf(text + used, room - used,
                                 "<!-- %s -->\n<vehicle id=\"%s.%d\" type=\"%s\" route=\"%s\" "
                                 "depart=\"%.1f\" departSpeed=\"desired\"/>\n",
                                 filler, is_left ? "left" : "through", is_left ? left : through,
                                 is_left ? "van" : "car", is_left ? "left" : "through",
                                 is_left ? 0.4 + 4.3 * left : 3.1 * through);
        *(is_left ? &left : &through) += 1;
    }
    snprintf(text + used, room - used, "</routes>\n");
    crossing_write(f, "crossing.rou.xml", text);
    free(text);
}

static const char TREATMENTS[] = "  - name: nothing\n"
                                 "  - name: aeb\n"
                                 "    functions:\n"
                                 "      - function: aeb\n"
                                 "        parameters: {ttc_s: 1.4, deceleration_m_s2: 9}\n"
                                 "  - name: nobody\n"
                                 "    functions:\n"
                                 "      - function: aeb\n"
                                 "        parameters: {penetration_1: 0}\n";

// The same traffic without branches, with them, and with time series besides; the first two also
// write what SUMO can write.
static int runs_begin(void **state)
{
    crossing_runs *f = crossing_begin("<processing><route-steps value=\"10\"/></processing>");
    write_routes(f);
    static const char *const DESIGNS[][2] = {{"plain", "paired_seeds"},
                                             {"pairs", "counterfactual"}};
    for (int k = 0; k < 2; k++) {
        char options[CROSSING_PATH_SIZE];
        snprintf(options, sizeof options,
                 "--fcd-output, \"%s/%s.fcd.xml\", --tripinfo-output, \"%s/%s.trip.xml\"",
                 f->folder, DESIGNS[k][0], f->folder, DESIGNS[k][0]);
        crossing_write_study(f, DESIGNS[k][0], DESIGNS[k][1], "", options,
                             k == 0 ? "" : TREATMENTS);
        crossing_run(f, DESIGNS[k][0]);
    }
    crossing_write_study(f, "series", "counterfactual", "counterfactual: {time_series_s: 3}\n", "",
                         TREATMENTS);
    crossing_run(f, "series");
    *state = f;
    return 0;
}

static void null_treatment_reproduces_and_outcomes_add_up(void **state)
{
    const crossing_runs *f = *state;
    double crashes = crossing_number(f, "pairs", "SELECT count(*) FROM crash");
    assert_true(crashes >= 8);
    assert_true(crossing_number(f, "pairs", "SELECT count(*) FROM null_treatment") == crashes);
    double valid = crossing_number(
        f, "pairs", "SELECT count(*) FROM null_treatment WHERE status = 'reproduced'");
    assert_true(valid >= 6);
    assert_true(
        crossing_number(f, "pairs",
                        "SELECT count(*) FROM null_treatment WHERE status NOT IN ('reproduced', "
                        "'no_checkpoint', 'inserted_late')") == 0);
    assert_true(
        crossing_number(f, "pairs",
                        "SELECT count(*) FROM counterfactual_outcomes WHERE crashes <> invalid + "
                        "changed_opponent + avoided + mitigated + aggravated + unchanged") == 0);
    assert_true(crossing_number(f, "pairs", "SELECT count(*) FROM counterfactual") == 3 * crashes);
    // No function, or one that nobody has, changes nothing.
    assert_true(
        crossing_number(f, "pairs",
                        "SELECT count(*) FROM counterfactual_pair WHERE variant <> 'aeb' AND "
                        "outcome = 'unchanged' AND outcome_olc IN ('unchanged', 'no_olc') AND "
                        "treated_closing_speed_m_s = baseline_closing_speed_m_s AND "
                        "treated_time_s = baseline_time_s AND new_crashes = 0 AND "
                        "vanished_crashes = 0") == 2 * valid);
    // Braking helps in most pairs.
    double better =
        crossing_number(f, "pairs",
                        "SELECT count(*) FROM counterfactual_pair WHERE variant = 'aeb' AND "
                        "outcome IN ('avoided', 'mitigated')");
    assert_true(better > 0.5 * valid);
    // Invalid under one treatment, invalid under all, for the same reason.
    assert_true(
        crossing_number(f, "pairs",
                        "SELECT count(*) FROM counterfactual AS c JOIN null_treatment AS n USING "
                        "(crash_id) WHERE (c.outcome = 'invalid') <> (n.status <> 'reproduced') "
                        "OR c.reason <> n.status") == 0);
    assert_true(
        crossing_number(f, "pairs",
                        "SELECT min(c.time_s - n.checkpoint_s - n.lead_s) FROM null_treatment AS "
                        "n JOIN crash AS c ON c.id = n.crash_id") >= 0);
    assert_true(crossing_number(f, "pairs", "SELECT min(lead_s) FROM null_treatment") >= 3.999999);
}

static void assert_same_files(const crossing_runs *f, const char *one, const char *other)
{
    char path[CROSSING_PATH_SIZE], *text[2] = {NULL, NULL};
    size_t size[2];
    const char *names[2] = {one, other};
    cp_error error = {0};
    double seed = crossing_number(f, "plain", "SELECT seed FROM replication");
    for (int k = 0; k < 2; k++) {
        snprintf(path, sizeof path, "%s/crossing_baseline_%.0f_%s", f->folder, seed, names[k]);
        assert_ok(cp_file_read(path, &text[k], &size[k], &error), &error);
        // But for the command line in the comment at the beginning.
        char *body = strstr(text[k], "-->");
        assert_non_null(body);
        memmove(text[k], body, strlen(body) + 1);
    }
    assert_true(strlen(text[0]) > 10000);
    if (strcmp(text[0], text[1]) != 0)
        fail_msg("%s and %s differ", one, other);
    free(text[0]);
    free(text[1]);
}

// The result of a shell command on two databases.
static void assert_same_tables(const crossing_runs *f, const char *one, const char *other)
{
    char command[4 * CROSSING_PATH_SIZE];
    snprintf(command, sizeof command,
             "for d in %s %s; do for t in crash crash_vehicle contact sumo_collision pulse; do "
             "sqlite3 -cmd '.mode quote' %s/$d.db \"SELECT * FROM $t ORDER BY 1, 2\"; done > "
             "%s/$d.txt; done; cmp %s/%s.txt %s/%s.txt",
             one, other, f->folder, f->folder, f->folder, one, f->folder, other);
    assert_int_equal(system(command), 0);
}

static void branches_leave_the_baseline_and_its_outputs_alone(void **state)
{
    const crossing_runs *f = *state;
    assert_true(crossing_number(f, "pairs", "SELECT count(*) FROM counterfactual") > 0);
    assert_same_files(f, "plain.fcd.xml", "pairs.fcd.xml");
    assert_same_files(f, "plain.trip.xml", "pairs.trip.xml");
    assert_same_tables(f, "plain", "pairs");
}

static void time_series_on_demand(void **state)
{
    const crossing_runs *f = *state;
    assert_true(crossing_number(f, "pairs", "SELECT count(*) FROM counterfactual_sample") == 0);
    assert_same_tables(f, "plain", "series");
    assert_true(
        crossing_number(f, "series",
                        "SELECT count(*) FROM null_treatment AS n WHERE status = 'reproduced' "
                        "AND (SELECT count(*) FROM counterfactual_sample AS s JOIN variant AS v "
                        "ON v.id = s.variant_id WHERE s.crash_id = n.crash_id AND is_baseline "
                        "AND role = 'a') NOT BETWEEN 58 AND 61") == 0);
    // TTC falls to the contact, brakes are asked for by AEB only, and the cars slow down then.
    assert_true(
        crossing_number(f, "series",
                        "SELECT min(ttc_s) FROM counterfactual_sample AS s JOIN variant AS v ON "
                        "v.id = s.variant_id WHERE is_baseline") < 0.1);
    assert_true(
        crossing_number(f, "series",
                        "SELECT max(brake_request_m_s2) FROM counterfactual_sample AS s JOIN "
                        "variant AS v ON v.id = s.variant_id WHERE v.name <> 'aeb'") == 0);
    assert_true(
        crossing_number(f, "series",
                        "SELECT max(brake_request_m_s2) FROM counterfactual_sample AS s JOIN "
                        "variant AS v ON v.id = s.variant_id WHERE v.name = 'aeb'") > 8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(null_treatment_reproduces_and_outcomes_add_up),
        cmocka_unit_test(branches_leave_the_baseline_and_its_outputs_alone),
        cmocka_unit_test(time_series_on_demand),
    };
    return cmocka_run_group_tests(tests, runs_begin, crossing_end);
}
