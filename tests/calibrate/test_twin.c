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
#include "core/rng.h"
#include "core/units.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Twin experiment: pulses of a car with known parameters plus noise; a fit by the objective
 * `pulse`, from another car, must come as near to them as the noise lets, and predict the OLC of
 * configurations it has not seen. Called with --full it takes all 96 configurations of the
 * reference study and twelve unknowns (target twin_experiment). */

// Noise of every sample, of the largest magnitude of its channel in the pulse.
static const double NOISE_1 = 0.02;

// A parameter of the known car and what the fit may make of it.
typedef struct secret {
    const char *name;
    double truth;
    double min;
    double max;
} secret;

typedef struct experiment {
    const secret *secrets;
    size_t secret_count;
    const char *budget; /* lines of the fit file */
    size_t case_count;
    cp_reference_case *cases; /* to fit */
    size_t held_out_count;
    cp_reference_case *held_out;
    char folder[64];
} experiment;

// ---- the pulses ------------------------------------------------------------------------------

static cp_vehicle_model known_car(const experiment *twin)
{
    cp_vehicle_model truth = cp_vehicle_model_default();
    for (size_t k = 0; k < twin->secret_count; k++)
        cp_vehicle_model_set(&truth, cp_vehicle_parameter_index(twin->secrets[k].name),
                             twin->secrets[k].truth);
    return truth;
}

static void add_noise(cp_pulse *pulse, size_t number)
{
    cp_rng_key key = cp_rng_key_number(cp_rng_key_seed(20180), number);
    for (size_t c = 0; c <= CP_CHANNEL_VY; c++) {
        double largest = 0.0;
        for (size_t k = 0; k < pulse->sample_count; k++)
            largest = fmax(largest, fabs(pulse->channel[c][k]));
        for (size_t k = 0; k < pulse->sample_count; k++)
            pulse->channel[c][k] += NOISE_1 * largest * cp_rng_normal(cp_rng_key_number(key, c), k);
    }
}

static FILE *open_file(const experiment *twin, const char *name)
{
    char path[256];
    snprintf(path, sizeof path, "%s/%s", twin->folder, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    return file;
}

// One pulse as `crashpulse crash --pulse` writes it, with noise.
static void write_pulse(const experiment *twin, const cp_vehicle_model *truth, size_t number)
{
    cp_reference_pulse wanted = {.condition = twin->cases[number], .until_s = 0.15};
    cp_crash_result result;
    cp_pulse pulse;
    cp_error error = {0};
    if (cp_reference_pulse_simulate(truth, &wanted, 0.0005, &result, &error) != CP_OK ||
        cp_pulse_filtered(&result.pulse[0], 60.0, &pulse, &error) != CP_OK)
        fail_msg("%s", error.text);
    add_noise(&pulse, number);
    char name[32];
    snprintf(name, sizeof name, "pulse_%zu.csv", number);
    FILE *file = open_file(twin, name);
    fputs("vehicle,time_s", file);
    for (size_t c = 0; c < CP_CHANNEL_COUNT; c++)
        fprintf(file, ",%s", CP_PULSE_COLUMN[c]);
    fputc('\n', file);
    assert_int_equal(cp_pulse_write_csv(&pulse, "a", file, &error), CP_OK);
    assert_int_equal(fclose(file), 0);
    cp_pulse_destroy(&pulse);
    cp_crash_result_destroy(&result);
}

static void write_fit(const experiment *twin)
{
    FILE *file = open_file(twin, "base.yaml");
    fputs("vehicle: base\nparameters: []\n", file);
    assert_int_equal(fclose(file), 0);
    file = open_file(twin, "twin.fit.yaml");
    fprintf(file, "fit: twin\nbase: base.yaml\nobjective: pulse\noutput: twin.yaml\n%s",
            twin->budget);
    fputs("unknowns:\n", file);
    for (size_t k = 0; k < twin->secret_count; k++)
        fprintf(file, "  - {name: %s, min: %g, max: %g}\n", twin->secrets[k].name,
                twin->secrets[k].min, twin->secrets[k].max);
    fputs("pulses:\n", file);
    for (size_t k = 0; k < twin->case_count; k++)
        fprintf(file,
                "  - {file: pulse_%zu.csv, speed_km_h: %.17g, offset_mm: %.17g, angle_deg: %.17g, "
                "until_s: 0.15}\n",
                k, twin->cases[k].speed_km_h, twin->cases[k].offset_mm, twin->cases[k].angle_deg);
    assert_int_equal(fclose(file), 0);
}

static void remove_files(const experiment *twin)
{
    char path[256];
    static const char *const NAMES[] = {"base.yaml", "twin.fit.yaml", "twin.yaml.start1.fit.state"};
    for (size_t k = 0; k < sizeof NAMES / sizeof *NAMES; k++) {
        snprintf(path, sizeof path, "%s/%s", twin->folder, NAMES[k]);
        unlink(path);
    }
    for (size_t k = 0; k < twin->case_count; k++) {
        snprintf(path, sizeof path, "%s/pulse_%zu.csv", twin->folder, k);
        unlink(path);
    }
    assert_int_equal(rmdir(twin->folder), 0);
}

// ---- the fit ---------------------------------------------------------------------------------

// Total error of a car against the noisy pulses: of the known one, the noise floor.
static double total_error(const cp_fit *fit, const cp_vehicle_model *model)
{
    cp_pulse_error *errors = calloc(fit->pulse_count, sizeof *errors);
    assert_non_null(errors);
    cp_error error = {0};
    assert_int_equal(cp_objective_pulse(model, fit->pulses, fit->pulse_count,
                                        fit->local_time_step_s, fit->threads, errors, NULL, &error),
                     CP_OK);
    double mean = cp_objective_pulse_mean(fit->pulses, errors, fit->pulse_count, NULL, INFINITY);
    free(errors);
    return mean;
}

// Differences of OLC between two cars in the configurations held out.
static void compare_held_out(const experiment *twin, const cp_vehicle_model *truth,
                             const cp_vehicle_model *found, double *mean_g, double *largest_g)
{
    double *olc_g = calloc(2 * twin->held_out_count, sizeof *olc_g);
    assert_non_null(olc_g);
    const cp_vehicle_model *cars[2] = {truth, found};
    for (size_t c = 0; c < 2; c++) {
        cp_error error = {0};
        assert_int_equal(cp_objective_olc(cars[c], twin->held_out, twin->held_out_count, NULL,
                                          0.0005, 1, olc_g + c * twin->held_out_count, &error),
                         CP_OK);
    }
    *mean_g = *largest_g = 0.0;
    for (size_t k = 0; k < twin->held_out_count; k++) {
        double apart_g = fabs(olc_g[k] - olc_g[twin->held_out_count + k]);
        assert_true(olc_g[k] > 1.0);
        *mean_g += apart_g / (double)twin->held_out_count;
        *largest_g = fmax(*largest_g, apart_g);
    }
    free(olc_g);
}

static void run_experiment(experiment *twin)
{
    strcpy(twin->folder, "/tmp/twin_XXXXXX");
    assert_non_null(mkdtemp(twin->folder));
    cp_vehicle_model truth = known_car(twin), start = cp_vehicle_model_default();
    for (size_t k = 0; k < twin->case_count; k++)
        write_pulse(twin, &truth, k);
    write_fit(twin);
    char path[256];
    snprintf(path, sizeof path, "%s/twin.fit.yaml", twin->folder);
    cp_fit fit;
    cp_calibration calibration;
    cp_error error = {0};
    if (cp_fit_load(path, NULL, &fit, &error) != CP_OK ||
        cp_calibration_run(&fit, &calibration, &error) != CP_OK)
        fail_msg("%s", error.text);

    double floor_error = total_error(&fit, &truth), start_error = total_error(&fit, &start);
    double mean_g = 0.0, largest_g = 0.0, before_g = 0.0, before_largest_g = 0.0;
    compare_held_out(twin, &truth, &start, &before_g, &before_largest_g);
    compare_held_out(twin, &truth, &calibration.model, &mean_g, &largest_g);
    print_message("%zu pulses, %zu unknowns: total error %.4f at the start, %.4f fitted, %.4f the "
                  "noise floor\n",
                  twin->case_count, twin->secret_count, start_error, calibration.objective,
                  floor_error);
    print_message("OLC held out, %zu configurations: off by %.3f g at the start, fitted by %.4f g, "
                  "at most %.4f g\n",
                  twin->held_out_count, before_g, mean_g, largest_g);
    for (size_t k = 0; k < twin->secret_count; k++)
        print_message("  %-32s known %8.4g, found %8.4g\n", twin->secrets[k].name,
                      twin->secrets[k].truth,
                      cp_unknown_get(&calibration.model, twin->secrets[k].name));

    // A start worth leaving, an end within a hundredth of the floor, every OLC to 0.1 g.
    assert_true(start_error > 1.5 * floor_error);
    assert_true(calibration.objective < 1.01 * floor_error);
    assert_true(before_g > 0.5);
    assert_true(largest_g < 0.1);
    cp_calibration_destroy(&calibration);
    cp_fit_destroy(&fit);
    remove_files(twin);
}

// ---- two sizes of it -------------------------------------------------------------------------

static void a_small_twin_is_found_through_noise(void **state)
{
    (void)state;
    static const secret SECRETS[] = {{"longitudinal_collapse_begin_kn", 105, 60, 250},
                                     {"longitudinal_collapse_end_kn", 190, 100, 400},
                                     {"crash_box_collapse_end_kn", 80, 40, 180}};
    cp_reference_case cases[] = {{35, 0, 0, 0}, {56, 0, 0, 0}, {50, 350, 10, 0}, {56, -350, 20, 0}};
    cp_reference_case held_out[] = {{45, 0, 10, 0}, {56, 350, 0, 0}, {30, -350, 5, 0}};
    experiment twin = {.secrets = SECRETS,
                       .secret_count = 3,
                       .budget = "seed: 3\nalgorithm: de\npopulation: 12\ngenerations: 8\n"
                                 "local_evaluations: 180\n",
                       .case_count = 4,
                       .cases = cases,
                       .held_out_count = 3,
                       .held_out = held_out};
    run_experiment(&twin);
}

// Configurations drawn from the whole range of the study, none of them among its own.
static void draw_held_out(cp_reference_case *held_out, size_t count)
{
    cp_rng_key key = cp_rng_key_text(cp_rng_key_seed(2018), "held out");
    for (size_t k = 0; k < count; k++)
        held_out[k] = (cp_reference_case){
            .speed_km_h = 25.0 + 31.0 * cp_rng_uniform(cp_rng_key_text(key, "speed"), k),
            .offset_mm = -1050.0 + 2100.0 * cp_rng_uniform(cp_rng_key_text(key, "offset"), k),
            .angle_deg = 30.0 * cp_rng_uniform(cp_rng_key_text(key, "angle"), k)};
}

static void the_study_s_twin_is_found_through_noise(void **state)
{
    (void)state;
    static const secret SECRETS[] = {{"longitudinal_collapse_begin_kn", 105, 60, 250},
                                     {"longitudinal_collapse_end_kn", 190, 100, 400},
                                     {"longitudinal_collapse_end_m", 0.45, 0.3, 0.6},
                                     {"longitudinal_bending_kn_m", 35, 5, 80},
                                     {"crash_box_collapse_begin_kn", 45, 20, 150},
                                     {"crash_box_collapse_end_kn", 80, 40, 180},
                                     {"engine_gap_front_m", 0.27, 0.15, 0.45},
                                     {"engine_mount_yield_kn", 45, 5, 100},
                                     {"corner_gap_m", 0.38, 0.1, 0.6},
                                     {"corner_collapse_end_kn", 130, 20, 300},
                                     {"friction_1", 0.3, 0.05, 0.8},
                                     {"cross_member_bending_kn_m", 12, 1, 40}};
    char path[4096];
    const char *source = getenv("CRASHPULSE_SOURCE");
    snprintf(path, sizeof path, "%s/db/reference/olc_accord_2014.csv", source ? source : ".");
    cp_reference study;
    cp_error error = {0};
    if (cp_reference_load(path, &study, &error) != CP_OK)
        fail_msg("%s", error.text);
    enum { HELD_OUT = 30 };
    cp_reference_case held_out[HELD_OUT];
    draw_held_out(held_out, HELD_OUT);
    experiment twin = {.secrets = SECRETS,
                       .secret_count = sizeof SECRETS / sizeof *SECRETS,
                       .budget = "seed: 96\nalgorithm: cmaes\npopulation: 20\ngenerations: 4\n"
                                 "slope_evaluations: 250\nlocal_evaluations: 200\nthreads: 2\n",
                       .case_count = study.count,
                       .cases = study.cases,
                       .held_out_count = HELD_OUT,
                       .held_out = held_out};
    run_experiment(&twin);
    cp_reference_destroy(&study);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest small[] = {cmocka_unit_test(a_small_twin_is_found_through_noise)};
    const struct CMUnitTest full[] = {cmocka_unit_test(the_study_s_twin_is_found_through_noise)};
    if (argc > 1 && strcmp(argv[1], "--full") == 0)
        return cmocka_run_group_tests(full, crash_library_begin, crash_library_end);
    return cmocka_run_group_tests(small, crash_library_begin, crash_library_end);
}
