/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"
#include "builders/crash_library.h"

#include "calibrate/pulse_objective.h"
#include "core/units.h"

#include <stdlib.h>
#include <unistd.h>

// What to add to a pulse before it becomes a reference.
typedef struct change {
    double ax_g, ay_g, vx_m_s, vy_m_s;
    double until_s;
    bool longitudinal_only;
} change;

// Reference pulse of a model: simulated, filtered, written as a file, changed, read.
static cp_reference_pulse reference_of(const cp_vehicle_model *model, double speed_km_h,
                                       double offset_mm, change add)
{
    cp_reference_pulse wanted = {
        .condition = {.speed_km_h = speed_km_h, .offset_mm = offset_mm, .angle_deg = 10.0},
        .until_s = 0.19};
    cp_crash_result result;
    cp_pulse filtered;
    cp_error error = {0};
    assert_int_equal(cp_reference_pulse_simulate(model, &wanted, 0.0005, &result, &error), CP_OK);
    assert_int_equal(cp_pulse_filtered(&result.pulse[0], 60.0, &filtered, &error), CP_OK);
    for (size_t k = 0; k < filtered.sample_count; k++) {
        filtered.channel[CP_CHANNEL_AX][k] += add.ax_g * CP_G0_M_S2;
        filtered.channel[CP_CHANNEL_AY][k] += add.ay_g * CP_G0_M_S2;
        filtered.channel[CP_CHANNEL_VX][k] += add.vx_m_s;
        filtered.channel[CP_CHANNEL_VY][k] += add.vy_m_s;
    }
    char path[] = "/tmp/objective_XXXXXX";
    FILE *file = fdopen(mkstemp(path), "w");
    assert_non_null(file);
    fprintf(file, "vehicle,time_s,ax_m_s2,%s,x_m,y_m,yaw_rad,yaw_rate_rad_s,yaw_acc_rad_s2\n",
            add.longitudinal_only ? "other_1,vx_m_s,other_2" : "ay_m_s2,vx_m_s,vy_m_s");
    assert_int_equal(cp_pulse_write_csv(&filtered, "a", file, &error), CP_OK);
    assert_int_equal(fclose(file), 0);
    cp_pulse_source source = {.path = path,
                              .speed_km_h = speed_km_h,
                              .offset_mm = offset_mm,
                              .angle_deg = 10.0,
                              .until_s = add.until_s > 0.0 ? add.until_s : 0.15,
                              .weight_1 = 1.0};
    cp_reference_pulse pulse;
    if (cp_reference_pulse_load(&source, &pulse, &error) != CP_OK)
        fail_msg("%s", error.text);
    unlink(path);
    cp_pulse_destroy(&filtered);
    cp_crash_result_destroy(&result);
    return pulse;
}

static cp_pulse_error error_of(const cp_vehicle_model *model, const cp_reference_pulse *pulse)
{
    cp_pulse_error found;
    cp_error error = {0};
    assert_int_equal(cp_objective_pulse(model, pulse, 1, 0.0005, 1, &found, NULL, &error), CP_OK);
    return found;
}

static void a_model_has_no_error_against_itself(void **state)
{
    (void)state;
    cp_vehicle_model model = cp_vehicle_model_default();
    cp_reference_pulse pulse = reference_of(&model, 45.0, 400.0, (change){0});
    cp_pulse_error found = error_of(&model, &pulse);
    assert_true(found.total < 1e-3);
    assert_near(found.model.olc_g, pulse.marks.olc_g, 0.01);
    assert_near(found.model.t_v0_s, pulse.marks.t_v0_s, 1e-6);
    assert_near(found.model.peak_g, pulse.marks.peak_g, 0.01);
    assert_near(found.model.crush_m, pulse.marks.crush_m, 1e-6);

    // Another car does have one, at another time step hardly more.
    model.longitudinal_collapse_begin_kn *= 0.5;
    assert_true(error_of(&model, &pulse).total > 1.0);
    cp_reference_pulse_destroy(&pulse);
}

static void the_total_is_the_sum_of_five(void **state)
{
    (void)state;
    cp_vehicle_model model = cp_vehicle_model_default();
    const change add = {.ax_g = 0.7, .ay_g = -0.3, .vx_m_s = 0.05, .vy_m_s = -0.02};
    cp_reference_pulse pulse = reference_of(&model, 45.0, 400.0, add);
    cp_pulse_error found = error_of(&model, &pulse);
    assert_near(found.ax_g, 0.7, 1e-3);
    assert_near(found.ay_g, 0.3, 1e-3);
    assert_near(found.vx_m_s, 0.05, 1e-6);
    assert_near(found.vy_m_s, 0.02, 1e-6);
    double later_s = fabs(pulse.marks.t_v0_s - found.model.t_v0_s);
    assert_true(later_s > 1e-5);
    assert_near(found.t_v0_s, later_s, 1e-12);
    assert_near(found.total, 0.7 + 0.3 + 10.0 * 0.07 + later_s, 2e-3);
    cp_reference_pulse_destroy(&pulse);

    // A longitudinal sensor says nothing of the lateral motion.
    change alone = add;
    alone.longitudinal_only = true;
    pulse = reference_of(&model, 45.0, 400.0, alone);
    found = error_of(&model, &pulse);
    assert_near(found.ay_g, 0.0, 0.0);
    assert_near(found.vy_m_s, 0.0, 0.0);
    assert_near(found.total, 0.7 + 10.0 * 0.05 + later_s, 2e-3);
    cp_reference_pulse_destroy(&pulse);
}

// Every stretch of every channel knows which way the model is off.
static void misfits_have_a_sign(void **state)
{
    (void)state;
    cp_vehicle_model model = cp_vehicle_model_default();
    change add = {.ax_g = 0.7, .ay_g = -0.3, .vx_m_s = 0.05, .vy_m_s = -0.02};
    cp_pulse_error found;
    double misfit[CP_PULSE_MISFITS];
    cp_error error = {0};
    for (int longitudinal_only = 0; longitudinal_only < 2; longitudinal_only++) {
        add.longitudinal_only = longitudinal_only == 1;
        cp_reference_pulse pulse = reference_of(&model, 45.0, 400.0, add);
        assert_int_equal(cp_objective_pulse(&model, &pulse, 1, 0.0005, 1, &found, misfit, &error),
                         CP_OK);
        for (size_t k = 0; k < CP_PULSE_STRETCHES; k++) {
            assert_near(misfit[k], -0.7, 1e-3);
            assert_near(misfit[CP_PULSE_STRETCHES + k], add.longitudinal_only ? 0.0 : 0.3, 1e-3);
            assert_near(misfit[2 * CP_PULSE_STRETCHES + k], -0.5, 1e-5);
            assert_near(misfit[3 * CP_PULSE_STRETCHES + k], add.longitudinal_only ? 0.0 : 0.2,
                        1e-5);
        }
        cp_reference_pulse_destroy(&pulse);
    }
}

static void who_does_not_stop_stops_at_the_end(void **state)
{
    (void)state;
    cp_vehicle_model model = cp_vehicle_model_default();
    cp_reference_pulse pulse = reference_of(&model, 45.0, 400.0, (change){.until_s = 0.1});
    pulse.marks.t_v0_s = NAN;
    cp_pulse_error found = error_of(&model, &pulse);
    assert_true(found.model.t_v0_s < 0.1);
    assert_near(found.t_v0_s, 0.1 - found.model.t_v0_s, 1e-12);
    cp_reference_pulse_destroy(&pulse);
}

static void threads_do_not_change_the_errors(void **state)
{
    (void)state;
    cp_vehicle_model model = cp_vehicle_model_default(), other = model;
    other.crash_box_collapse_begin_kn *= 1.3;
    cp_reference_pulse pulses[5];
    for (int k = 0; k < 5; k++)
        pulses[k] = reference_of(&other, 30.0 + 5.0 * k, 200.0 * k, (change){0});
    cp_pulse_error one[5], three[5];
    cp_error error = {0};
    assert_int_equal(cp_objective_pulse(&model, pulses, 5, 0.0005, 1, one, NULL, &error), CP_OK);
    assert_int_equal(cp_objective_pulse(&model, pulses, 5, 0.0005, 3, three, NULL, &error), CP_OK);
    assert_memory_equal(one, three, sizeof one);
    assert_int_equal(cp_objective_pulse(&model, pulses, 5, 0.0005, 0, one, NULL, &error),
                     CP_BAD_INPUT);
    for (int k = 0; k < 5; k++)
        cp_reference_pulse_destroy(&pulses[k]);
}

static void the_mean_is_weighted_and_punishes_failures(void **state)
{
    (void)state;
    const cp_reference_pulse pulses[3] = {{.weight_1 = 1.0}, {.weight_1 = 3.0}, {.weight_1 = 2.0}};
    cp_pulse_error errors[3] = {{.total = 4.0}, {.total = 8.0}, {.total = 5.0}};
    assert_near(cp_objective_pulse_mean(pulses, errors, 3, NULL, 100.0), 38.0 / 6.0, 1e-12);
    const bool use[3] = {true, true, false};
    assert_near(cp_objective_pulse_mean(pulses, errors, 3, use, 100.0), 7.0, 1e-12);
    errors[0].total = NAN;
    assert_near(cp_objective_pulse_mean(pulses, errors, 3, use, 100.0), 31.0, 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_model_has_no_error_against_itself),
        cmocka_unit_test(the_total_is_the_sum_of_five),
        cmocka_unit_test(misfits_have_a_sign),
        cmocka_unit_test(who_does_not_stop_stops_at_the_end),
        cmocka_unit_test(threads_do_not_change_the_errors),
        cmocka_unit_test(the_mean_is_weighted_and_punishes_failures),
    };
    return cmocka_run_group_tests(tests, crash_library_begin, crash_library_end);
}
