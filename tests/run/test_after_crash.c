/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "builders/crossing_runs.h"

/* What comes after a crash and what came before it, on real SUMO with real workers: the crossing of
 * tests/run, its through cars in platoons of three, 0.9 s apart and slow to brake, so that those
 * behind a crash run into it. */

static void write_routes(const crossing_runs *f)
{
    char text[16384];
    size_t used = (size_t)snprintf(
        text, sizeof text,
        "<routes><vType id=\"car\" length=\"4.5\" width=\"1.8\" tau=\"0.5\" minGap=\"1\" "
        "decel=\"3\" emergencyDecel=\"3\" sigma=\"0\" speedFactor=\"1\"/><vType id=\"van\"/>\n"
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
    crossing_write(f, "crossing.rou.xml", text);
}

// head: further lines of the study's.
static void run(const crossing_runs *f, const char *name, const char *design, const char *head)
{
    const char *variants = strcmp(design, "counterfactual") == 0 ? "  - name: nothing\n" : "";
    crossing_write_study(f, name, design, head, "", variants);
    crossing_run(f, name);
}

static int runs_begin(void **state)
{
    crossing_runs *f = crossing_begin("");
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

static void assert_same_tables(const crossing_runs *f, const char *one, const char *other)
{
    char command[4 * CROSSING_PATH_SIZE];
    snprintf(command, sizeof command,
             "for d in %s %s; do for t in crash crash_vehicle contact sumo_collision pulse "
             "pre_crash_sample; do sqlite3 -cmd '.mode quote' %s/$d.db \"SELECT * FROM $t ORDER "
             "BY 1, 2, 3\"; done > %s/$d.txt; done; test -s %s/%s.txt && cmp %s/%s.txt %s/%s.txt",
             one, other, f->folder, f->folder, f->folder, one, f->folder, one, f->folder, other);
    assert_int_equal(system(command), 0);
}

static void crashed_cars_leave_at_once_unless_the_study_says_otherwise(void **state)
{
    const crossing_runs *f = *state;
    assert_true(crossing_number(f, "removed", "SELECT count(*) FROM crash") >= 3);
    assert_true(crossing_number(f, "removed", "SELECT sum(is_secondary) FROM crash") == 0);
    assert_true(crossing_number(f, "removed", "SELECT stay_s FROM study") == 0);
    // No vehicle has two.
    assert_true(crossing_number(f, "removed",
                                "SELECT count(*) - count(DISTINCT sumo_id) FROM "
                                "crash_vehicle") == 0);
}

static void who_runs_into_standing_cars_has_a_secondary_crash(void **state)
{
    const crossing_runs *f = *state;
    assert_true(crossing_number(f, "stays", "SELECT stay_s FROM study") == 5);
    assert_true(crossing_number(f, "stays", "SELECT count(*) FROM secondary_crash") >= 3);

    // It names a crash that one of the two had, at most as long before as they stay, and the car
    // that stood is at rest, where it crashed, and not at fault.
    assert_true(crossing_number(
                    f, "stays",
                    "SELECT count(*) FROM crash AS c WHERE is_secondary AND NOT EXISTS (SELECT 1 "
                    "FROM crash AS o JOIN crash_vehicle AS was ON was.crash_id = o.id JOIN "
                    "crash_vehicle AS is_now ON is_now.crash_id = c.id AND is_now.sumo_id = "
                    "was.sumo_id WHERE o.id = c.follows_crash_id AND c.time_s - o.time_s BETWEEN 0 "
                    "AND 5.05 AND is_now.speed_m_s = 0 AND is_now.velocity_x_m_s = 0 AND "
                    "is_now.at_fault = 0 AND abs(is_now.cog_x_m - was.cog_x_m) + "
                    "abs(is_now.cog_y_m - was.cog_y_m) < 1.5)") == 0);
    assert_true(crossing_number(f, "stays",
                                "SELECT count(*) FROM crash WHERE is_secondary <> "
                                "(validity LIKE '%damaged%')") == 0);
    // The first crash is the same as where nobody stays: everything before it is.
    assert_true(crossing_number(f, "stays", "SELECT time_s FROM crash WHERE number = 0") ==
                crossing_number(f, "removed", "SELECT time_s FROM crash WHERE number = 0"));
}

static void a_crash_of_the_warm_up_is_no_row_to_name(void **state)
{
    const crossing_runs *f = *state;
    // A crash at 37.1 s, run into at 37.9 s.
    assert_true(
        crossing_number(f, "late", "SELECT count(*) FROM contact WHERE verdict = 'warmup'") > 0);
    assert_true(crossing_number(f, "late",
                                "SELECT count(*) FROM crash WHERE follows_crash_id IS NULL "
                                "AND is_secondary AND time_s < 39") > 0);
}

static void checkpoints_and_branches_hold_standing_cars(void **state)
{
    const crossing_runs *f = *state;
    assert_same_tables(f, "stays", "pairs");
    assert_true(crossing_number(f, "pairs",
                                "SELECT count(*) FROM null_treatment JOIN crash ON id = "
                                "crash_id WHERE is_secondary AND status = 'reproduced'") >= 2);
    assert_true(crossing_number(f, "pairs",
                                "SELECT count(*) FROM null_treatment WHERE status NOT IN "
                                "('reproduced', 'inserted_late', 'no_checkpoint')") == 0);
    assert_true(crossing_number(f, "pairs",
                                "SELECT count(*) FROM counterfactual WHERE outcome NOT IN "
                                "('unchanged', 'invalid')") == 0);
}

static void history_ends_at_the_contact_and_changes_nothing(void **state)
{
    const crossing_runs *f = *state;
    assert_true(crossing_number(f, "removed", "SELECT count(*) FROM pre_crash_sample") == 0);
    assert_true(crossing_number(f, "history", "SELECT count(*) FROM crash") ==
                crossing_number(f, "removed", "SELECT count(*) FROM crash"));
    assert_true(
        crossing_number(f, "history", "SELECT sum(time_s * closing_speed_m_s) FROM crash") ==
        crossing_number(f, "removed", "SELECT sum(time_s * closing_speed_m_s) FROM crash"));

    // Two seconds of steps of 0.05 s for both cars, the last within a step before contact.
    assert_true(crossing_number(f, "history", "SELECT count(*) FROM crash_vehicle") ==
                crossing_number(f, "history",
                                "SELECT count(*) FROM (SELECT 1 FROM pre_crash GROUP BY "
                                "crash_id, role HAVING count(*) = 40 AND max(number) = 39 "
                                "AND max(from_contact_s) BETWEEN -0.05 AND 0 AND "
                                "min(from_contact_s) >= -2)"));
    // It leads to the configuration at contact: front of the car, heading and speed of its last
    // step, carried on.
    assert_true(
        crossing_number(f, "history",
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
    return cmocka_run_group_tests(tests, runs_begin, crossing_end);
}
