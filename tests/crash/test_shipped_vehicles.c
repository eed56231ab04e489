/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/crash_library.h"

#include "builders/crash_builder.h"
#include "crash/evidence.h"
#include "crash/parameter_scatter.h"
#include "crash/validity.h"

#include <glob.h>
#include <string.h>

/* Every vehicle file that comes with the program. */

typedef void check_vehicle(const char *path, const cp_vehicle_model *model);

static void for_every_vehicle(check_vehicle *check)
{
    char pattern[4096];
    const char *source = getenv("CRASHPULSE_SOURCE");
    glob_t files;
    snprintf(pattern, sizeof pattern, "%s/db/vehicles/*.yaml", source ? source : ".");
    assert_int_equal(glob(pattern, 0, NULL, &files), 0);
    snprintf(pattern, sizeof pattern, "%s/db/vehicles/fleet/*.yaml", source ? source : ".");
    assert_int_equal(glob(pattern, GLOB_APPEND, NULL, &files), 0);
    int count = 0;
    for (size_t k = 0; k < files.gl_pathc; k++) {
        // Fit files describe a search for a vehicle.
        if (strstr(files.gl_pathv[k], ".fit.yaml") != NULL)
            continue;
        cp_vehicle_model model;
        cp_error error = {0};
        if (cp_vehicle_model_load(files.gl_pathv[k], &model, &error) != CP_OK)
            fail_msg("%s", error.text);
        check(files.gl_pathv[k], &model);
        count++;
    }
    globfree(&files);
    assert_true(count >= 20);
}

static void crash_it(const char *path, const cp_vehicle_model *model)
{
    // Against a wall, and against a mid-size car with offset: a heavy vehicle hardly feels that
    // one.
    bool heavy = model->mass_kg > CP_HEAVY_FROM_KG;
    cp_vehicle_model other = cp_vehicle_model_default();
    cp_crash_options options = cp_crash_options_default();
    for (int cars = 0; cars < 2; cars++) {
        const cp_vehicle_model *opponent = cars ? &other : NULL;
        cp_crash_configuration configuration =
            crash_builder_configuration(model, opponent, 50.0, 50.0, cars ? 400.0 : 0.0, 0.0);
        cp_crash_result result = crash_builder_simulate(model, opponent, &configuration, &options);
        double olc_g = result.severity[0].olc.olc_g;
        if (!(olc_g > (heavy && cars ? 0.2 : 8.0) && olc_g < 45.0))
            fail_msg("%s: OLC at 50 km/h is %g g", path, olc_g);
        if (!(result.crush_m[0] > (heavy ? 0.05 : 0.2) && result.crush_m[0] < (heavy ? 1.6 : 1.0)))
            fail_msg("%s: crush at 50 km/h is %g m", path, result.crush_m[0]);
        if (!(result.energy.highest_mechanical_j <= 1.01 * result.energy.start_j))
            fail_msg("%s: energy rose", path);
        cp_crash_result_destroy(&result);
    }
}

static void every_vehicle_can_be_crashed(void **state)
{
    (void)state;
    for_every_vehicle(crash_it);
}

// Two like cars whose fronts collapse against each other share the way among their blocks: with an
// eighth of the step the same OLC within 3 % in the mean.
static void compare_steps(const char *path, const cp_vehicle_model *model)
{
    if (strstr(path, ".base.yaml") != NULL || strstr(path, ".start.yaml") != NULL ||
        model->mass_kg > CP_HEAVY_FROM_KG)
        return;
    const int crashes = 6;
    cp_crash_options options = cp_crash_options_default(), fine = options;
    fine.time_step_s = options.time_step_s / 8.0;
    double moved_1 = 0.0;
    for (int k = 0; k < crashes; k++) {
        cp_crash_configuration configuration = crash_builder_configuration(
            model, model, 50.0, 40.0, -1000.0 + 350.0 * k, k % 2 == 0 ? 8.0 : -5.0);
        cp_crash_result one = crash_builder_simulate(model, model, &configuration, &options);
        cp_crash_result two = crash_builder_simulate(model, model, &configuration, &fine);
        for (int c = 0; c < 2; c++)
            moved_1 += fabs(one.severity[c].olc.olc_g / two.severity[c].olc.olc_g - 1.0);
        cp_crash_result_destroy(&one);
        cp_crash_result_destroy(&two);
    }
    moved_1 /= 2.0 * crashes;
    if (!(moved_1 < 0.03))
        fail_msg("%s: an eighth of the time step moves OLC by %.2g %%", path, 100.0 * moved_1);
}

static void olc_hangs_little_on_the_step(void **state)
{
    (void)state;
    for_every_vehicle(compare_steps);
}

static void expect_marked(const char *path, const cp_vehicle_model *model)
{
    cp_crash_configuration configuration =
        crash_builder_configuration(model, NULL, 50.0, 0.0, 0.0, 0.0);
    cp_vec2 contact_m = cp_crash_contact_point(model, NULL, &configuration);
    cp_crash_description description = cp_crash_describe(model, NULL, &configuration, contact_m);
    unsigned outside = cp_validity(model, NULL, &configuration, &description, 0, NULL);
    // One that the scorecard judges is known by the classes it keeps.
    bool calibrated = model->calibrated_speed_max_m_s > 0.0;
    if (cp_evidence_judges(model))
        return;
    if (((outside & CP_OUTSIDE_MODEL) != 0) == calibrated)
        fail_msg("%s: an uncalibrated model must be marked as one", path);
    if (!calibrated && strstr(model->description, "not calibrated") == NULL)
        fail_msg("%s: its description must say that it is not calibrated", path);
}

static void a_vehicle_never_calibrated_says_so(void **state)
{
    (void)state;
    for_every_vehicle(expect_marked);
}

static void draw_some(const char *path, const cp_vehicle_model *model)
{
    for (uint64_t k = 0; k < 50; k++) {
        cp_vehicle_model drawn;
        cp_error error = {0};
        if (cp_parameter_scatter_draw(model, cp_rng_key_seed(1), k, &drawn, NULL, &error) != CP_OK)
            fail_msg("%s: %s", path, error.text);
    }
}

static void scatter_of_every_vehicle_can_be_drawn(void **state)
{
    (void)state;
    for_every_vehicle(draw_some);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_vehicle_can_be_crashed),
        cmocka_unit_test(olc_hangs_little_on_the_step),
        cmocka_unit_test(a_vehicle_never_calibrated_says_so),
        cmocka_unit_test(scatter_of_every_vehicle_can_be_drawn),
    };
    return cmocka_run_group_tests(tests, crash_library_begin, crash_library_end);
}
