/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"
#include "builders/crash_library.h"

#include "calibrate/calibration.h"
#include "calibrate/fit_file.h"
#include "calibrate/objective.h"
#include "core/file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// A folder of its own for a fit's files.
typedef struct workshop {
    char folder[64];
    char fit_path[128];
} workshop;

static void write_file(const char *folder, const char *name, const char *text)
{
    char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static cp_vehicle_model truth_vehicle(void)
{
    cp_vehicle_model truth = cp_vehicle_model_default();
    truth.longitudinal_collapse_begin_kn = 110.0;
    truth.longitudinal_collapse_end_kn = 190.0;
    return truth;
}

// Reference values made by a car with known parameters; the fit has to find them.
static workshop open_workshop(const char *fit_lines)
{
    workshop shop;
    strcpy(shop.folder, "/tmp/calibration_XXXXXX");
    assert_non_null(mkdtemp(shop.folder));
    snprintf(shop.fit_path, sizeof shop.fit_path, "%s/twin.fit.yaml", shop.folder);
    cp_vehicle_model truth = truth_vehicle();
    cp_reference_case cases[6];
    for (int k = 0; k < 6; k++)
        cases[k] = (cp_reference_case){k < 3 ? 35.0 : 56.0, 350.0 * (k % 3), 5.0 * (k % 2), 0.0};
    double olc_g[6];
    cp_error error = {0};
    assert_int_equal(cp_objective_olc(&truth, cases, 6, NULL, 0.0005, 1, olc_g, &error), CP_OK);
    char table[1024] = "speed_kmh,offset_mm,angle_deg,olc_g\n";
    for (int k = 0; k < 6; k++)
        snprintf(table + strlen(table), sizeof table - strlen(table), "%g,%g,%g,%.6f\n",
                 cases[k].speed_km_h, cases[k].offset_mm, cases[k].angle_deg, olc_g[k]);
    write_file(shop.folder, "twin.csv", table);
    write_file(shop.folder, "base.yaml", "vehicle: base\nparameters: []\n");
    char fit[4096];
    snprintf(fit, sizeof fit,
             "fit: twin\nbase: base.yaml\nreference: twin.csv\noutput: twin.yaml\nseed: 5\n%s",
             fit_lines);
    write_file(shop.folder, "twin.fit.yaml", fit);
    return shop;
}

static void close_workshop(const workshop *shop)
{
    static const char *const NAMES[] = {"twin.csv", "base.yaml", "twin.fit.yaml", "twin.yaml",
                                        "twin.yaml.fit.md"};
    for (size_t k = 0; k < sizeof NAMES / sizeof *NAMES; k++) {
        char path[256];
        snprintf(path, sizeof path, "%s/%s", shop->folder, NAMES[k]);
        unlink(path);
    }
    // Fails when a state file was left behind.
    assert_int_equal(rmdir(shop->folder), 0);
}

static void read_report(const workshop *shop, char *report, size_t size)
{
    char path[256];
    snprintf(path, sizeof path, "%s/twin.yaml.fit.md", shop->folder);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    size_t length = fread(report, 1, size - 1, file);
    assert_true(length > 0 && length < size - 1);
    report[length] = '\0';
    assert_int_equal(fclose(file), 0);
}

static void run_fit(const workshop *shop, cp_fit *fit, cp_calibration *calibration)
{
    cp_error error = {0};
    if (cp_fit_load(shop->fit_path, NULL, fit, &error) != CP_OK)
        fail_msg("%s", error.text);
    if (cp_calibration_run(fit, calibration, &error) != CP_OK)
        fail_msg("%s", error.text);
}

static const char TWO_UNKNOWNS[] = "unknowns:\n"
                                   "  - {name: longitudinal_collapse_begin_kn, min: 80, max: 200}\n"
                                   "  - {name: longitudinal_collapse_end_kn, min: 120, max: 320}\n";

static void a_twin_is_found_again(void **state)
{
    (void)state;
    char lines[512];
    snprintf(lines, sizeof lines,
             "population: 10\ngenerations: 6\nlocal_evaluations: 60\nfolds: 2\n%s", TWO_UNKNOWNS);
    workshop shop = open_workshop(lines);
    cp_fit fit;
    cp_calibration calibration;
    cp_error error = {0};
    run_fit(&shop, &fit, &calibration);
    assert_true(calibration.validation.mean_abs_error_g < 0.2);
    assert_int_equal(calibration.cross_count, 1);
    assert_int_equal(calibration.cross[0].part_count, 2);
    assert_true(calibration.cross[0].validation.mean_abs_error_g < 0.6);
    assert_near(calibration.model.longitudinal_collapse_begin_kn, 110.0, 15.0);

    // The file written is the model found.
    assert_int_equal(cp_calibration_write(&fit, &calibration, &error), CP_OK);
    char path[256];
    snprintf(path, sizeof path, "%s/twin.yaml", shop.folder);
    cp_vehicle_model read;
    if (cp_vehicle_model_load(path, &read, &error) != CP_OK)
        fail_msg("%s", error.text);
    for (size_t k = 0; k < CP_VEHICLE_PARAMETER_COUNT; k++)
        assert_near(cp_vehicle_model_get(&read, k), cp_vehicle_model_get(&calibration.model, k),
                    0.0);
    assert_near(read.calibrated_speed_min_m_s, 35.0 / 3.6, 1e-9);
    cp_calibration_destroy(&calibration);
    cp_fit_destroy(&fit);
    close_workshop(&shop);
}

static void threads_do_not_change_the_result(void **state)
{
    (void)state;
    cp_vehicle_model model = cp_vehicle_model_default();
    cp_reference_case cases[7];
    for (int k = 0; k < 7; k++)
        cases[k] = (cp_reference_case){30.0 + 4.0 * k, 150.0 * k, 3.0 * k, 0.0};
    double one[7], three[7];
    cp_error error = {0};
    assert_int_equal(cp_objective_olc(&model, cases, 7, NULL, 0.0005, 1, one, &error), CP_OK);
    assert_int_equal(cp_objective_olc(&model, cases, 7, NULL, 0.0005, 3, three, &error), CP_OK);
    assert_memory_equal(one, three, sizeof one);
}

// By the slopes alone the twin is found far closer than by chance, and a speed never fitted to is
// predicted.
static void slopes_lead_to_the_twin(void **state)
{
    (void)state;
    char lines[768];
    snprintf(lines, sizeof lines,
             "population: 8\ngenerations: 1\nstarts: 2\nslope_evaluations: 60\n"
             "local_evaluations: 0\nleave_out: [speed]\nneighbour_folds: 2\n%s",
             TWO_UNKNOWNS);
    workshop shop = open_workshop(lines);
    cp_fit fit;
    cp_calibration calibration;
    cp_error error = {0};
    run_fit(&shop, &fit, &calibration);
    assert_true(calibration.validation.mean_abs_error_g < 0.02);
    assert_near(calibration.model.longitudinal_collapse_begin_kn, 110.0, 2.0);
    assert_int_equal(calibration.cross_count, 2);
    assert_int_equal(calibration.cross[0].kind, CP_CROSS_SPEED);
    assert_int_equal(calibration.cross[0].part_count, 2);
    assert_true(calibration.cross[0].validation.mean_abs_error_g < 1.0);
    assert_int_equal(calibration.cross[1].kind, CP_CROSS_NEIGHBOURS);
    assert_int_equal(calibration.cross[1].part_count, 2);
    assert_true(calibration.cross[1].validation.mean_abs_error_g < 0.1);

    // The report says what was held out with what.
    assert_int_equal(cp_calibration_write(&fit, &calibration, &error), CP_OK);
    char report[16384];
    read_report(&shop, report, sizeof report);
    assert_non_null(strstr(report, "| part | held out: One speed left out at a time, g |"
                                   " part | held out: 2-fold cross-validation, neighbours apart, "
                                   "g |"));
    assert_non_null(strstr(report, "\n| 35 | 0 | 0 |"));
    cp_calibration_destroy(&calibration);
    cp_fit_destroy(&fit);
    close_workshop(&shop);
}

// Starts drawn around the base find it too, the same in one thread and in two, and the report says
// so.
static void drawn_starts_lead_to_the_twin(void **state)
{
    (void)state;
    cp_vehicle_model found[2];
    for (int k = 0; k < 2; k++) {
        char lines[768];
        snprintf(lines, sizeof lines,
                 "generations: 0\nstarts: 5\nslope_evaluations: 60\nlocal_evaluations: 0\n"
                 "threads: %d\n%s",
                 k + 1, TWO_UNKNOWNS);
        workshop shop = open_workshop(lines);
        cp_fit fit;
        cp_calibration calibration;
        cp_error error = {0};
        run_fit(&shop, &fit, &calibration);
        assert_true(calibration.validation.mean_abs_error_g < 0.02);
        found[k] = calibration.model;
        assert_int_equal(cp_calibration_write(&fit, &calibration, &error), CP_OK);
        char report[16384];
        read_report(&shop, report, sizeof report);
        assert_non_null(strstr(report, "5 starts, the base and vehicles drawn around it"));
        cp_calibration_destroy(&calibration);
        cp_fit_destroy(&fit);
        close_workshop(&shop);
    }
    for (size_t k = 0; k < CP_VEHICLE_PARAMETER_COUNT; k++)
        assert_near(cp_vehicle_model_get(&found[0], k), cp_vehicle_model_get(&found[1], k), 0.0);
}

// The journal of a search, cut after so many lines as if it had been killed there.
static void cut_journal(const workshop *shop, size_t lines)
{
    char path[256], *content = NULL;
    size_t size = 0;
    cp_error error = {0};
    snprintf(path, sizeof path, "%s/twin.yaml.start1.fit.state", shop->folder);
    assert_int_equal(cp_file_read(path, &content, &size, &error), CP_OK);
    size_t keep = 0;
    for (size_t k = 0; k < lines; k++)
        keep += strcspn(content + keep, "\n") + 1;
    assert_true(keep < size);
    assert_int_equal(cp_file_write(path, content, keep, &error), CP_OK);
    free(content);
}

// Offspring of drawn starts find the twin; killed after any number of descents the search goes on
// to the same bits; and a journal of another fit is refused, not followed.
static void offspring_lead_to_the_twin_whether_killed_or_not(void **state)
{
    (void)state;
    char lines[768];
    snprintf(lines, sizeof lines,
             "generations: 0\nstarts: 3\noffspring: 2\nslope_evaluations: 60\n"
             "local_evaluations: 0\n%s",
             TWO_UNKNOWNS);
    workshop shop = open_workshop(lines);
    cp_fit fit;
    cp_calibration first, again;
    cp_error error = {0};
    run_fit(&shop, &fit, &first);
    assert_true(first.validation.mean_abs_error_g < 0.02);
    for (size_t descents = 0; descents < 6; descents += 2) {
        cut_journal(&shop, descents);
        if (cp_calibration_run(&fit, &again, &error) != CP_OK)
            fail_msg("%s", error.text);
        for (size_t k = 0; k < CP_VEHICLE_PARAMETER_COUNT; k++)
            assert_near(cp_vehicle_model_get(&first.model, k),
                        cp_vehicle_model_get(&again.model, k), 0.0);
        cp_calibration_destroy(&again);
    }

    // Other reference values: every descent would begin with another error.
    cut_journal(&shop, 3);
    fit.reference.cases[0].olc_g += 1.0;
    assert_int_equal(cp_calibration_run(&fit, &again, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "twin.yaml.start1.fit.state:1: is of another fit"));
    fit.reference.cases[0].olc_g -= 1.0;

    // The report says how it was searched; then nothing is left of the search.
    assert_int_equal(cp_calibration_write(&fit, &first, &error), CP_OK);
    char report[16384];
    read_report(&shop, report, sizeof report);
    assert_non_null(strstr(report,
                           "3 starts, the base and vehicles drawn around it (seed 5), and 2 "
                           "offspring of the best"));
    char path[256];
    snprintf(path, sizeof path, "%s/twin.yaml.start1.fit.state", shop.folder);
    assert_int_equal(access(path, F_OK), -1);
    cp_calibration_destroy(&first);
    cp_fit_destroy(&fit);
    close_workshop(&shop);
}

// What is known of a car before the fit holds an unknown back as strongly as the fit file says.
static void what_is_known_holds_back(void **state)
{
    (void)state;
    static const struct {
        const char *prior_g;
        double begin_kn; /* the twin has 110, the base another */
        double within_kn;
    } CASES[] = {{"0", 110.0, 2.0}, {"0.001", 110.0, 2.0}, {"900", 0.0, 1.0}};
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        char lines[768];
        snprintf(lines, sizeof lines,
                 "population: 8\ngenerations: 1\nslope_evaluations: 60\nprior_g: %s\n"
                 "local_evaluations: 0\n%s",
                 CASES[k].prior_g, TWO_UNKNOWNS);
        workshop shop = open_workshop(lines);
        cp_fit fit;
        cp_calibration calibration;
        cp_error error = {0};
        if (cp_fit_load(shop.fit_path, NULL, &fit, &error) != CP_OK ||
            cp_calibration_run(&fit, &calibration, &error) != CP_OK)
            fail_msg("%s", error.text);
        double wanted_kn =
            CASES[k].begin_kn > 0.0 ? CASES[k].begin_kn : fit.base.longitudinal_collapse_begin_kn;
        assert_near(calibration.model.longitudinal_collapse_begin_kn, wanted_kn,
                    CASES[k].within_kn);

        // The objective reported is the misfit alone.
        assert_near(calibration.objective, calibration.validation.mean_abs_error_g, 1e-9);
        assert_int_equal(cp_calibration_write(&fit, &calibration, &error), CP_OK);

        // And the report says how it was held back, if at all.
        char path[4200], *report = NULL;
        size_t size = 0;
        snprintf(path, sizeof path, "%s.fit.md", fit.output_path);
        assert_int_equal(cp_file_read(path, &report, &size, &error), CP_OK);
        assert_int_equal(strstr(report, "Prior: ") != NULL, strcmp(CASES[k].prior_g, "0") != 0);
        assert_non_null(strstr(report, "an error above 0.3 g"));
        free(report);
        cp_calibration_destroy(&calibration);
        cp_fit_destroy(&fit);
        close_workshop(&shop);
    }
}

// Bounds the twin's own pulse does not keep pull the fit away from it.
static void bounds_of_the_pulse_count(void **state)
{
    (void)state;
    char lines[768];
    snprintf(lines, sizeof lines,
             "population: 8\ngenerations: 1\nslope_evaluations: 40\nlocal_evaluations: 0\n"
             "plausible:\n  speed_km_h: 56\n  crush_mm: {min: 340, max: 350}\n"
             "  source: \"a test\"\nunknowns:\n"
             "  - {name: longitudinal_collapse_middle_kn, min: 80, max: 400}\n"
             "  - {name: longitudinal_collapse_end_kn, min: 120, max: 400}\n");
    workshop shop = open_workshop(lines);
    cp_fit fit;
    cp_calibration calibration;
    cp_error error = {0};
    run_fit(&shop, &fit, &calibration);
    double excess_1[CP_MARK_COUNT];
    cp_plausibility_excess(&fit.plausible, calibration.mark, excess_1);
    double outside_1 = fabs(excess_1[CP_MARK_CRUSH]);
    assert_near(calibration.objective, calibration.validation.mean_abs_error_g + outside_1, 1e-9);

    // The twin itself is crushed far deeper.
    cp_vehicle_model truth = truth_vehicle();
    double mark[CP_MARK_COUNT];
    assert_int_equal(cp_plausibility_marks(&fit.plausible, &truth, 0.0005, mark, &error), CP_OK);
    assert_true(calibration.mark[CP_MARK_CRUSH] < mark[CP_MARK_CRUSH] - 0.02);
    assert_int_equal(cp_calibration_write(&fit, &calibration, &error), CP_OK);
    cp_calibration_destroy(&calibration);
    cp_fit_destroy(&fit);
    close_workshop(&shop);
}

// A corridor the twin does not keep pulls the fit away from it, by its weight; sets that fit about
// as well stand in the vehicle file, and are read again.
static void corridors_count_and_an_ensemble_is_kept(void **state)
{
    (void)state;
    char lines[1024];
    snprintf(lines, sizeof lines,
             "population: 8\ngenerations: 1\nslope_evaluations: 40\nlocal_evaluations: 0\n"
             "ensemble: 2\nensemble_within_1: 0.9\n"
             "targets:\n  - name: slow wall\n    source: a test\n    speed_km_h: 40\n"
             "    barrier: {width_m: 2.5, depth_m: 1, corner_radius_m: 0.05}\n    weight: 2\n"
             "    bounds: [{quantity: crush_mm, min: 100, max: 110}]\n%s",
             TWO_UNKNOWNS);
    workshop shop = open_workshop(lines);
    cp_fit fit;
    cp_calibration calibration;
    cp_error error = {0};
    run_fit(&shop, &fit, &calibration);
    assert_int_equal(fit.target_count, 1);
    double excess_1 = cp_target_excess(&fit.target[0].bound[0], calibration.target[0]);
    assert_true(excess_1 > 0.0);
    assert_near(calibration.objective, calibration.validation.mean_abs_error_g + 2.0 * excess_1,
                1e-9);
    assert_true(calibration.model.member_count > 0);
    for (size_t m = 0; m < calibration.model.member_count; m++)
        assert_true(calibration.ensemble.cost[m] <= 1.9 * calibration.ensemble.best_cost);

    cp_vehicle_model read;
    assert_int_equal(cp_calibration_write(&fit, &calibration, &error), CP_OK);
    if (cp_vehicle_model_load(fit.output_path, &read, &error) != CP_OK)
        fail_msg("%s", error.text);
    assert_int_equal(read.member_count, calibration.model.member_count);
    for (size_t m = 0; m < read.member_count; m++)
        for (size_t k = 0; k < CP_VEHICLE_PARAMETER_COUNT; k++)
            assert_near(read.member[m][k], calibration.model.member[m][k], 1e-12);
    cp_calibration_destroy(&calibration);
    cp_fit_destroy(&fit);
    close_workshop(&shop);
}

static void errors_name_line_and_field(void **state)
{
    (void)state;
    static const struct {
        const char *lines;
        const char *words;
    } CASES[] = {
        {"unknowns:\n  - {name: wheels, min: 1, max: 2}\n", ":7: unknowns[0].name 'wheels'"},
        {"unknowns:\n  - {name: mass_kg, min: 1500, max: 1400}\n", "must be above min = 1500"},
        {"algorithm: luck\nunknowns:\n  - {name: mass_kg, min: 1500, max: 1600}\n",
         ":6: algorithm"},
        {"population: 9.5\nunknowns:\n  - {name: mass_kg, min: 1500, max: 1600}\n",
         "must be a whole number"},
        {"leave_out: [speed, moon]\nunknowns:\n  - {name: mass_kg, min: 1500, max: 1600}\n",
         "leave_out[1] must be speed, offset or angle, found 'moon'"},
        {"plausible:\n  speed_km_h: 56\n  peak_g: {min: 40, max: 30}\n  source: x\n"
         "unknowns:\n  - {name: mass_kg, min: 1500, max: 1600}\n",
         ":8: plausible.peak_g.max must be above min = 40"},
        {"generations: 0\nstarts: 4\nslope_evaluations: 23\n"
         "unknowns:\n  - {name: mass_kg, min: 1500, max: 1600}\n",
         ":8: slope_evaluations must be at least 24 for 4 starts without generations, found 23"},
        {"offspring: 4\nstarts: 3\nunknowns:\n  - {name: mass_kg, min: 1500, max: 1600}\n",
         ":6: offspring goes with generations: 0 and at least 2 starts, found 150 generations and "
         "3 starts"},
        {"folds: 7\nunknowns:\n  - {name: mass_kg, min: 1500, max: 1600}\n",
         ":6: folds must be 0, or from 2 to the 6 configurations of the reference, found 7"},
        {"neighbour_folds: 1\nunknowns:\n  - {name: mass_kg, min: 1500, max: 1600}\n",
         ":6: neighbour_folds must be 0, or from 2 to the 6 configurations"},
        {"targets:\n  - {name: a, source: b, speed_km_h: 40, bounds: [{quantity: noise, min: 1, "
         "max: "
         "2}]}\nunknowns:\n  - {name: mass_kg, min: 1500, max: 1600}\n",
         ":7: targets[0].bounds[0].quantity must be olc_g"},
        {"targets:\n  - {name: a, source: b, speed_km_h: 40, bounds: [{quantity: loss_x_m_s, min: "
         "1, "
         "max: 2}]}\nunknowns:\n  - {name: mass_kg, min: 1500, max: 1600}\n",
         "loss_x_m_s is taken at an instant: give at_ms"},
        {"targets:\n  - {name: a, source: b, against: itself, speed_km_h: 40, barrier: {width_m: "
         "2, "
         "depth_m: 1, corner_radius_m: 0}, bounds: [{quantity: olc_g, min: 1, max: 2}]}\n"
         "unknowns:\n  - {name: mass_kg, min: 1500, max: 1600}\n",
         "targets[0].barrier goes with against: barrier"},
        {"ensemble: 11\nunknowns:\n  - {name: mass_kg, min: 1500, max: 1600}\n",
         ":6: ensemble must be between 0 and 10, found 11"},
        {"folds: some\nunknowns:\n  - {name: mass_kg, min: 1500, max: 1600}\n",
         ":6: folds must be a number from 0 to 50, found 'some'"},
    };
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        workshop shop = open_workshop(CASES[k].lines);
        cp_fit fit;
        cp_error error = {0};
        assert_int_equal(cp_fit_load(shop.fit_path, NULL, &fit, &error), CP_BAD_INPUT);
        if (strstr(error.text, CASES[k].words) == NULL)
            fail_msg("expected '%s' in: %s", CASES[k].words, error.text);
        close_workshop(&shop);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_twin_is_found_again),
        cmocka_unit_test(slopes_lead_to_the_twin),
        cmocka_unit_test(drawn_starts_lead_to_the_twin),
        cmocka_unit_test(offspring_lead_to_the_twin_whether_killed_or_not),
        cmocka_unit_test(what_is_known_holds_back),
        cmocka_unit_test(bounds_of_the_pulse_count),
        cmocka_unit_test(corridors_count_and_an_ensemble_is_kept),
        cmocka_unit_test(threads_do_not_change_the_result),
        cmocka_unit_test(errors_name_line_and_field),
    };
    return cmocka_run_group_tests(tests, crash_library_begin, crash_library_end);
}
