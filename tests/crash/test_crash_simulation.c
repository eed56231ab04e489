/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// cmocka wants the four above first.
#include <cmocka.h>

#include "builders/assert_near.h"
#include "builders/crash_library.h"

#include "builders/crash_builder.h"

#include <pthread.h>
#include <string.h>

static const cp_crash_options STANDARD = {
    .time_step_s = 0.0005, .duration_s = 0.2, .longest_duration_s = 0.4, .coast_after_s = 0.01};

// Seeded random crash number index: a barrier or another car, within the reference range.
typedef struct random_crash {
    cp_vehicle_model own;
    cp_vehicle_model opponent;
    bool barrier;
    cp_crash_configuration configuration;
} random_crash;

static random_crash draw_crash(uint64_t index)
{
    random_crash crash = {.own = cp_vehicle_model_default(),
                          .opponent = cp_vehicle_model_default(),
                          .barrier = index % 2 == 0};
    crash.opponent.mass_kg = crash_builder_draw("mass", index, 1300.0, 2000.0);
    crash.own.corner_strips_1 = floor(crash_builder_draw("corner strips", index, 1.0, 5.0));
    crash.own.upper_strips_1 = floor(crash_builder_draw("upper strips", index, 1.0, 5.0));
    crash.configuration =
        crash_builder_configuration(&crash.own, crash.barrier ? NULL : &crash.opponent,
                                    crash_builder_draw("speed", index, 25.0, 56.0),
                                    crash_builder_draw("opponent speed", index, 0.0, 56.0),
                                    crash_builder_draw("offset", index, -1000.0, 1000.0),
                                    crash_builder_draw("angle", index, -25.0, 25.0));
    return crash;
}

static cp_crash_result simulate(const random_crash *crash, const cp_crash_options *options)
{
    return crash_builder_simulate(&crash->own, crash->barrier ? NULL : &crash->opponent,
                                  &crash->configuration, options);
}

static void energy_is_accounted_for(void **state)
{
    (void)state;
    for (uint64_t k = 0; k < 60; k++) {
        random_crash crash = draw_crash(k);
        cp_crash_result result = simulate(&crash, &STANDARD);
        const cp_crash_energy *e = &result.energy;
        double sum_j = e->kinetic_j + e->elastic_j + e->plastic_j + e->friction_j +
                       e->contact_damping_j + e->rate_j + e->mount_damping_j;
        assert_near(sum_j, e->start_j, 0.01 * e->start_j);
        assert_true(e->highest_mechanical_j <= 1.01 * e->start_j);
        assert_true(e->plastic_j >= 0.0 && e->friction_j >= 0.0 && e->rate_j >= 0.0 &&
                    e->mount_damping_j >= 0.0);
        cp_crash_result_destroy(&result);
    }
}

static void two_cars_keep_their_momentum(void **state)
{
    (void)state;
    for (uint64_t k = 1; k < 40; k += 2) {
        random_crash crash = draw_crash(k);
        cp_crash_result result = simulate(&crash, &STANDARD);
        double scale = sqrt(2.0 * result.energy.start_j * crash.own.mass_kg);
        assert_near(result.momentum_end.linear_kg_m_s.x, result.momentum_start.linear_kg_m_s.x,
                    1e-9 * scale);
        assert_near(result.momentum_end.linear_kg_m_s.y, result.momentum_start.linear_kg_m_s.y,
                    1e-9 * scale);
        assert_near(result.momentum_end.angular_kg_m2_s, result.momentum_start.angular_kg_m2_s,
                    1e-9 * scale);
        cp_crash_result_destroy(&result);
    }
}

static void a_mirrored_crash_gives_mirrored_pulses(void **state)
{
    (void)state;
    cp_vehicle_model car = cp_vehicle_model_default();
    for (uint64_t k = 0; k < 12; k++) {
        car.corner_strips_1 = 1.0 + (double)(k % 4);
        double speed = crash_builder_draw("mirror speed", k, 25.0, 56.0);
        double offset = crash_builder_draw("mirror offset", k, -900.0, 900.0);
        double angle = crash_builder_draw("mirror angle", k, -20.0, 20.0);
        const cp_vehicle_model *opponent = k % 2 == 0 ? NULL : &car;
        cp_crash_configuration left =
            crash_builder_configuration(&car, opponent, speed, speed, offset, angle);
        cp_crash_configuration right =
            crash_builder_configuration(&car, opponent, speed, speed, -offset, -angle);
        cp_crash_result one = crash_builder_simulate(&car, opponent, &left, &STANDARD);
        cp_crash_result other = crash_builder_simulate(&car, opponent, &right, &STANDARD);
        size_t samples = one.pulse[0].sample_count < other.pulse[0].sample_count
                             ? one.pulse[0].sample_count
                             : other.pulse[0].sample_count;
        for (size_t s = 0; s < samples; s++) {
            assert_near(one.pulse[0].channel[CP_CHANNEL_VX][s],
                        other.pulse[0].channel[CP_CHANNEL_VX][s], 1e-5);
            assert_near(one.pulse[0].channel[CP_CHANNEL_VY][s],
                        -other.pulse[0].channel[CP_CHANNEL_VY][s], 1e-5);
            assert_near(one.pulse[0].channel[CP_CHANNEL_YAW][s],
                        -other.pulse[0].channel[CP_CHANNEL_YAW][s], 1e-5);
        }
        cp_crash_result_destroy(&one);
        cp_crash_result_destroy(&other);
    }
}

static void equal_cars_meet_as_at_a_wall(void **state)
{
    (void)state;
    cp_vehicle_model car = cp_vehicle_model_default();
    cp_crash_configuration wall = crash_builder_configuration(&car, NULL, 56.0, 0.0, 0.0, 0.0);
    cp_crash_configuration cars = crash_builder_configuration(&car, &car, 56.0, 56.0, 0.0, 0.0);
    cp_crash_result at_wall = crash_builder_simulate(&car, NULL, &wall, &STANDARD);
    cp_crash_result at_car = crash_builder_simulate(&car, &car, &cars, &STANDARD);
    size_t rebound = (size_t)(at_wall.severity[0].t_v0_s / STANDARD.time_step_s);
    for (size_t s = 0; s <= rebound; s++)
        assert_near(at_car.pulse[0].channel[CP_CHANNEL_VX][s],
                    at_wall.pulse[0].channel[CP_CHANNEL_VX][s], 0.03 * 56.0 / 3.6);
    assert_near(at_car.t_common_s, at_wall.severity[0].t_v0_s, 0.002);
    cp_crash_result_destroy(&at_wall);
    cp_crash_result_destroy(&at_car);
}

static void a_common_velocity_changes_nothing_but_positions(void **state)
{
    (void)state;
    for (uint64_t k = 1; k < 12; k += 2) {
        random_crash crash = draw_crash(k);
        cp_crash_result still = simulate(&crash, &STANDARD);
        cp_vec2 common_m_s = {7.0, -3.0};
        for (int c = 0; c < 2; c++)
            crash.configuration.vehicle[c].velocity_m_s =
                cp_vec2_add(crash.configuration.vehicle[c].velocity_m_s, common_m_s);
        cp_crash_result moving = simulate(&crash, &STANDARD);
        for (size_t s = 0; s < 201; s++) {
            assert_near(moving.pulse[0].channel[CP_CHANNEL_AX][s],
                        still.pulse[0].channel[CP_CHANNEL_AX][s], 1e-6);
            assert_near(moving.pulse[1].channel[CP_CHANNEL_YAW][s],
                        still.pulse[1].channel[CP_CHANNEL_YAW][s], 1e-9);
            double shift_m = common_m_s.x * STANDARD.time_step_s * (double)s;
            assert_near(moving.pulse[0].channel[CP_CHANNEL_X][s],
                        still.pulse[0].channel[CP_CHANNEL_X][s] + shift_m, 1e-9);
        }
        assert_near(moving.severity[0].delta_v_m_s, still.severity[0].delta_v_m_s, 1e-9);
        assert_int_equal(moving.severity[0].olc.status, still.severity[0].olc.status);
        if (still.severity[0].olc.status == CP_OLC_VALUE)
            assert_near(moving.severity[0].olc.olc_g, still.severity[0].olc.olc_g, 1e-9);
        cp_crash_result_destroy(&still);
        cp_crash_result_destroy(&moving);
    }
}

static void the_lighter_car_changes_velocity_more(void **state)
{
    (void)state;
    cp_vehicle_model light = cp_vehicle_model_default(), heavy = light;
    heavy.mass_kg = 2200.0;
    heavy.yaw_inertia_kg_m2 = 3600.0;
    cp_crash_configuration meeting =
        crash_builder_configuration(&light, &heavy, 50.0, 50.0, 0.0, 0.0);
    cp_crash_result result = crash_builder_simulate(&light, &heavy, &meeting, &STANDARD);
    double ratio = result.severity[0].delta_v_m_s / result.severity[1].delta_v_m_s;
    assert_near(ratio, heavy.mass_kg / light.mass_kg, 1e-9);
    assert_true(result.severity[0].olc.olc_g > result.severity[1].olc.olc_g);
    cp_crash_result_destroy(&result);
}

// Delta-v is of whole cars: m dv is the same for both, whatever still swings, and what each
// absorbed adds up to what the crash took.
static void delta_v_is_by_momentum_and_energy_is_shared_out(void **state)
{
    (void)state;
    for (uint64_t k = 1; k < 30; k += 2) {
        random_crash crash = draw_crash(k);
        cp_crash_result result = simulate(&crash, &STANDARD);
        double momentum[2] = {crash.own.mass_kg * result.severity[0].delta_v_m_s,
                              crash.opponent.mass_kg * result.severity[1].delta_v_m_s};
        assert_near(momentum[0], momentum[1], 1e-9 * momentum[0]);
        double absorbed_j = 0.0;
        for (int c = 0; c < 2; c++) {
            const cp_crash_whole *whole = &result.whole[c];
            double mass_kg = c == 0 ? crash.own.mass_kg : crash.opponent.mass_kg;
            assert_near(whole->ees_m_s, sqrt(2.0 * whole->absorbed_j / mass_kg), 1e-9);
            assert_near(result.severity[c].delta_v_m_s, cp_vec2_length(whole->delta_v_m_s), 1e-12);
            absorbed_j += whole->absorbed_j;
        }
        const cp_crash_energy *e = &result.energy;
        assert_near(absorbed_j, e->start_j - e->kinetic_j - e->elastic_j, 0.01 * e->start_j);
        cp_crash_result_destroy(&result);
    }
}

static void half_the_step_moves_olc_little(void **state)
{
    (void)state;
    cp_crash_options fine = STANDARD;
    fine.time_step_s = 0.00025;
    double moved = 0.0;
    const int crashes = 24;
    for (uint64_t k = 0; k < (uint64_t)crashes; k++) {
        random_crash crash = draw_crash(k);
        cp_crash_result one = simulate(&crash, &STANDARD), two = simulate(&crash, &fine);
        assert_int_equal(one.severity[0].olc.status, two.severity[0].olc.status);
        if (one.severity[0].olc.status == CP_OLC_VALUE)
            moved += fabs(one.severity[0].olc.olc_g / two.severity[0].olc.olc_g - 1.0);
        cp_crash_result_destroy(&one);
        cp_crash_result_destroy(&two);
    }
    assert_true(moved / crashes < 0.01);
}

static void olc_from_the_samples_is_the_same(void **state)
{
    (void)state;
    for (uint64_t k = 0; k < 10; k++) {
        random_crash crash = draw_crash(k);
        cp_crash_result result = simulate(&crash, &STANDARD);
        // Integrate the exported acceleration by trapezoids and take OLC of that.
        const cp_pulse *pulse = &result.pulse[0];
        double *v = malloc(pulse->sample_count * sizeof *v);
        assert_non_null(v);
        v[0] = pulse->channel[CP_CHANNEL_VX][0];
        for (size_t s = 1; s < pulse->sample_count; s++)
            v[s] = v[s - 1] +
                   0.5 * pulse->sample_interval_s *
                       (pulse->channel[CP_CHANNEL_AX][s - 1] + pulse->channel[CP_CHANNEL_AX][s]);
        cp_olc again = cp_olc_from_velocity(v, pulse->sample_count, pulse->sample_interval_s);
        assert_int_equal(again.status, result.severity[0].olc.status);
        if (again.status == CP_OLC_VALUE)
            assert_near(again.olc_g, result.severity[0].olc.olc_g, 0.05);
        free(v);
        cp_crash_result_destroy(&result);
    }
}

// Simulate one crash in a thread of its own.
typedef struct thread_job {
    random_crash crash;
    cp_crash_result result;
} thread_job;

static void *simulate_in_thread(void *context)
{
    thread_job *job = context;
    cp_error error = {0};
    if (cp_crash_thread_begin(&error) != CP_OK)
        crash_builder_stop(&error);
    job->result = simulate(&job->crash, &STANDARD);
    cp_crash_thread_end();
    return NULL;
}

static void same_inputs_give_the_same_bits_on_any_thread(void **state)
{
    (void)state;
    for (uint64_t k = 0; k < 4; k++) {
        thread_job jobs[2] = {{.crash = draw_crash(k)}, {.crash = draw_crash(k)}};
        pthread_t threads[2];
        for (int t = 0; t < 2; t++)
            assert_int_equal(pthread_create(&threads[t], NULL, simulate_in_thread, &jobs[t]), 0);
        for (int t = 0; t < 2; t++)
            pthread_join(threads[t], NULL);
        cp_crash_result here = simulate(&jobs[0].crash, &STANDARD);
        for (int t = 0; t < 2; t++) {
            const cp_pulse *there = &jobs[t].result.pulse[0];
            assert_int_equal(there->sample_count, here.pulse[0].sample_count);
            for (int c = 0; c < CP_CHANNEL_COUNT; c++)
                assert_memory_equal(there->channel[c], here.pulse[0].channel[c],
                                    there->sample_count * sizeof(double));
            cp_crash_result_destroy(&jobs[t].result);
        }
        cp_crash_result_destroy(&here);
    }
}

static void nothing_explodes(void **state)
{
    (void)state;
    // Any offset and angle that touches, 0 to 130 km/h each.
    cp_vehicle_model car = cp_vehicle_model_default();
    for (uint64_t k = 0; k < 300; k++) {
        cp_crash_configuration configuration;
        cp_error error = {0};
        const cp_vehicle_model *opponent = k % 3 == 0 ? NULL : &car;
        if (cp_crash_configuration_from_description(
                &car, opponent, NULL, crash_builder_draw("wild a", k, 0.5, 36.0),
                crash_builder_draw("wild b", k, 0.0, 36.0),
                crash_builder_draw("wild offset", k, -2.5, 2.5),
                crash_builder_draw("wild angle", k, -CP_PI, CP_PI), &configuration,
                &error) != CP_OK)
            continue;
        cp_crash_result result;
        if (cp_crash_simulate(&car, opponent, &configuration, &STANDARD, &result, &error) != CP_OK)
            fail_msg("%s", error.text);
        assert_true(result.energy.highest_mechanical_j <= 1.01 * result.energy.start_j);
        assert_true(isfinite(result.severity[0].delta_v_m_s));
        cp_crash_result_destroy(&result);
    }
}

static void a_bad_step_is_refused(void **state)
{
    (void)state;
    random_crash crash = draw_crash(0);
    cp_crash_options options = STANDARD;
    options.time_step_s = 0.1;
    cp_crash_result result;
    cp_error error = {0};
    assert_int_equal(
        cp_crash_simulate(&crash.own, NULL, &crash.configuration, &options, &result, &error),
        CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "time_step_s"));
    cp_crash_result_destroy(&result);
}

static void coasting_goes_on_where_the_contact_ended(void **state)
{
    (void)state;
    // Slow enough that OLC is not decided when the record should end, so that it goes on longer.
    cp_vehicle_model car = cp_vehicle_model_default();
    cp_crash_configuration slow = crash_builder_configuration(&car, NULL, 5.0, 0.0, 900.0, 10.0);
    cp_crash_result result = crash_builder_simulate(&car, NULL, &slow, &STANDARD);
    const cp_pulse *pulse = &result.pulse[0];
    assert_int_equal(pulse->sample_count, 801);
    for (size_t s = 1; s < pulse->sample_count; s++) {
        double dt = pulse->sample_interval_s;
        double moved_m = pulse->channel[CP_CHANNEL_X][s] - pulse->channel[CP_CHANNEL_X][s - 1];
        double turned = pulse->channel[CP_CHANNEL_YAW][s] - pulse->channel[CP_CHANNEL_YAW][s - 1];
        double rate_rad_s = pulse->channel[CP_CHANNEL_YAW_RATE][s];
        assert_true(fabs(moved_m) <= 5.1 / 3.6 * dt);
        assert_near(turned, rate_rad_s * dt, 1e-9 + 0.001 * dt);
    }
    cp_crash_result_destroy(&result);
}

// Four parameters within their bounds that are together too stiff for the time step.
static void a_gain_of_energy_is_no_result(void **state)
{
    (void)state;
    cp_vehicle_model car = cp_vehicle_model_default();
    cp_crash_result result;
    cp_error error = {0};
    snprintf(car.name, sizeof car.name, "stiff one");
    car.engine_mass_kg = 50.0;
    car.engine_mount_kn_m = 20000.0;
    car.engine_mount_yield_kn = 300.0;
    car.engine_mount_damping_kn_s_m = 50.0;
    assert_int_equal(cp_vehicle_model_validate(&car, &error), CP_OK);
    cp_crash_configuration at_wall = crash_builder_configuration(&car, NULL, 56.0, 0.0, 0.0, 0.0);
    assert_int_equal(cp_crash_simulate(&car, NULL, &at_wall, &STANDARD, &result, &error),
                     CP_CRASH_FAILED);
    assert_non_null(strstr(error.text, "gained energy"));
    assert_non_null(strstr(error.text, "stiff one"));
    cp_crash_result_destroy(&result);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(energy_is_accounted_for),
        cmocka_unit_test(two_cars_keep_their_momentum),
        cmocka_unit_test(a_mirrored_crash_gives_mirrored_pulses),
        cmocka_unit_test(equal_cars_meet_as_at_a_wall),
        cmocka_unit_test(a_common_velocity_changes_nothing_but_positions),
        cmocka_unit_test(the_lighter_car_changes_velocity_more),
        cmocka_unit_test(delta_v_is_by_momentum_and_energy_is_shared_out),
        cmocka_unit_test(half_the_step_moves_olc_little),
        cmocka_unit_test(olc_from_the_samples_is_the_same),
        cmocka_unit_test(same_inputs_give_the_same_bits_on_any_thread),
        cmocka_unit_test(nothing_explodes),
        cmocka_unit_test(coasting_goes_on_where_the_contact_ended),
        cmocka_unit_test(a_bad_step_is_refused),
        cmocka_unit_test(a_gain_of_energy_is_no_result),
    };
    return cmocka_run_group_tests(tests, crash_library_begin, crash_library_end);
}
