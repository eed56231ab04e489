/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/crash_builder.h"
#include "builders/crash_library.h"

#include "calibrate/fit_search.h"
#include "calibrate/objective.h"
#include "calibrate/validation.h"

#include <math.h>
#include <stdlib.h>

/* What the shipped Honda Accord promises: the accuracy the project asks for against its 96
 * reference values, a plausible pulse, and that two of it meet as one meets the wall. */

static void path_of(const char *name, char path[4096])
{
    const char *source = getenv("CRASHPULSE_SOURCE");
    assert_non_null(source);
    snprintf(path, 4096, "%s/db/%s", source, name);
}

static cp_vehicle_model load_accord(void)
{
    char path[4096];
    cp_vehicle_model model;
    cp_error error = {0};
    path_of("vehicles/honda_accord_2014.yaml", path);
    if (cp_vehicle_model_load(path, &model, &error) != CP_OK)
        fail_msg("%s", error.text);
    return model;
}

static void the_accord_is_as_close_as_asked(void **state)
{
    (void)state;
    cp_vehicle_model model = load_accord();
    cp_reference reference;
    char path[4096];
    cp_error error = {0};
    path_of("reference/olc_accord_2014.csv", path);
    if (cp_reference_load(path, &reference, &error) != CP_OK)
        fail_msg("%s", error.text);
    assert_int_equal(reference.count, 96);
    double olc_g[96];
    cp_validation found;
    assert_int_equal(cp_objective_olc(&model, reference.cases, 96, NULL, 0.0005, 1, olc_g, &error),
                     CP_OK);
    if (cp_validate_olc(reference.cases, olc_g, 96, &found, &error) != CP_OK)
        fail_msg("%s", error.text);
    assert_true(found.mean_abs_error_g <= 0.60);
    assert_true(found.max_abs_error_g <= 3.0);
    static const double BAR_G[4] = {0.50, 0.40, 0.70, 0.90};
    assert_int_equal(found.group_count[0], 4);
    for (int k = 0; k < 4; k++)
        assert_true(found.group[0][k].mean_abs_error_g <= BAR_G[k]);
    cp_reference_destroy(&reference);
}

static void the_accords_pulse_is_plausible(void **state)
{
    (void)state;
    cp_vehicle_model model = load_accord();
    cp_fit fit;
    char path[4096];
    cp_error error = {0};
    path_of("vehicles/honda_accord_2014.fit.yaml", path);
    if (cp_fit_load(path, NULL, &fit, &error) != CP_OK)
        fail_msg("%s", error.text);
    assert_true(fit.plausible.given);
    double mark[CP_MARK_COUNT], excess_1[CP_MARK_COUNT];
    assert_int_equal(cp_plausibility_marks(&fit.plausible, &model, 0.0005, mark, &error), CP_OK);
    cp_plausibility_excess(&fit.plausible, mark, excess_1);
    for (int k = 0; k < CP_MARK_COUNT; k++) {
        assert_true(fit.plausible.bounded[k]);
        if (excess_1[k] != 0.0)
            fail_msg("%s = %g is outside of its bounds", CP_MARK_KIND[k].key,
                     mark[k] / CP_MARK_KIND[k].si_per_unit);
    }
    cp_fit_destroy(&fit);
}

static void two_accords_meet_as_one_meets_the_wall(void **state)
{
    (void)state;
    cp_vehicle_model model = load_accord();
    cp_barrier wide = model.barrier;
    wide.width_m = 4.0;
    wide.corner_radius_m = 0.05;
    cp_crash_options options = cp_crash_options_default();
    cp_crash_configuration wall, cars;
    cp_error error = {0};
    double v = cp_m_s_from_km_h(56.0);
    assert_int_equal(
        cp_crash_configuration_from_description(&model, NULL, &wide, v, 0, 0, 0, &wall, &error),
        CP_OK);
    assert_int_equal(
        cp_crash_configuration_from_description(&model, &model, NULL, v, v, 0, 0, &cars, &error),
        CP_OK);
    cp_crash_result one = crash_builder_simulate(&model, NULL, &wall, &options);
    cp_crash_result two = crash_builder_simulate(&model, &model, &cars, &options);
    size_t until = (size_t)(one.severity[0].t_v0_s / options.time_step_s);
    assert_true(until > 100);
    for (size_t k = 0; k < until; k++) {
        double apart =
            two.pulse[0].channel[CP_CHANNEL_VX][k] - one.pulse[0].channel[CP_CHANNEL_VX][k];
        assert_true(fabs(apart) <= 0.03 * v);
    }
    cp_crash_result_destroy(&one);
    cp_crash_result_destroy(&two);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_accord_is_as_close_as_asked),
        cmocka_unit_test(the_accords_pulse_is_plausible),
        cmocka_unit_test(two_accords_meet_as_one_meets_the_wall),
    };
    return cmocka_run_group_tests(tests, crash_library_begin, crash_library_end);
}
