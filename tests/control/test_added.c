/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/study_file.h"

#include "control/scripted_road.h"
#include "core/file.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

#include <unistd.h>

/* A function added the documented way, one file (added/honk.c) and one row of the table: a study
 * file configures it, cars are equipped with it, it acts beside the others. */

static const char STUDY[] = "study: added\n"
                            "design: paired_seeds\n"
                            "seed: 1\n"
                            "replications: 1\n"
                            "duration_s: 10\n"
                            "scenarios:\n"
                            "  - {name: any, sumocfg: a.sumocfg}\n"
                            "variants:\n"
                            "  - name: baseline\n"
                            "  - name: both\n"
                            "    functions:\n"
                            "      - function: honk\n"
                            "        parameters: {deceleration_m_s2: 2}\n"
                            "      - function: aeb\n"
                            "vehicles: {default: study.yaml}\n";

static void one_file_and_one_row(void **unused)
{
    (void)unused;
    char folder[] = "/tmp/crashpulse-test-XXXXXX", path[64];
    cp_study study;
    cp_error error = {0};
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/a.sumocfg", folder);
    assert_int_equal(cp_file_write(path, "<configuration/>", 16, &error), CP_OK);
    snprintf(path, sizeof path, "%s/study.yaml", folder);
    assert_int_equal(cp_file_write(path, STUDY, strlen(STUDY), &error), CP_OK);
    if (cp_study_load(path, &study, &error) != CP_OK)
        fail_msg("%s", error.text);
    assert_string_equal(study.variants[1].functions[0].type->name, "honk");

    cp_traffic *traffic = road_open(0.1);
    cp_controls *controls;
    road_add("one", 0.0, 0.0, 0.0, 20.0);
    assert_int_equal(
        cp_controls_create(study.variants[1].functions, 2, 1, 1, traffic, &controls, &error),
        CP_OK);
    for (int k = 0; k < 13; k++) {
        assert_int_equal(cp_traffic_step(traffic, &error), CP_OK);
        assert_int_equal(cp_controls_step(controls, &error), CP_OK);
    }
    // The first step puts the car there and decides at 0.1 s; 0.2 s later braking begins, by the
    // host's defaults, and rises with 40 m/s^3. What is commanded at the end of a step is driven in
    // the next.
    double since_s = 1.3 - 0.3;
    assert_true(fabs(road.cars[0].state.speed_m_s - (20.0 - 2.0 * (since_s - 0.5 * 2.0 / 40.0))) <
                1e-9);
    assert_true(cp_controls_brake_request_m_s2(controls, 0) == 2.0);
    cp_controls_destroy(controls);
    cp_traffic_destroy(traffic);
    cp_study_destroy(&study);
    unlink(path);
    snprintf(path, sizeof path, "%s/a.sumocfg", folder);
    unlink(path);
    rmdir(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(one_file_and_one_row)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
