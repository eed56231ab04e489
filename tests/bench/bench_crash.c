/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How long one crash takes, and how far its OLC is from that of a very fine time step: the study
 * the standard step was chosen by. */
#include "builders/crash_builder.h"
#include "calibrate/objective.h"
#include "core/progress.h"

#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics.h>

enum { CASES = 24, REPEATS = 15 };
static const double PAPER_MS = 400.0; /* the multibody model of the paper, 200 ms on one CPU */

// Case number k: speeds, offsets and angles of the reference study; odd ones against an equal car
// when cars is set.
static cp_crash_configuration bench_case(const cp_vehicle_model *model, bool cars, int k)
{
    static const double SPEED_KM_H[4] = {25.0, 35.0, 45.0, 56.0};
    static const double OFFSET_MM[6] = {0.0, 350.0, -350.0, 700.0, -700.0, 1050.0};
    double angle_deg = 10.0 * (k % 3);
    return crash_builder_configuration(model, cars ? model : NULL, SPEED_KM_H[k % 4],
                                       SPEED_KM_H[k % 4], OFFSET_MM[k % 6], angle_deg);
}

// Case number k of an equal car's front into a standing side or rear.
static cp_crash_configuration struck_case(const cp_vehicle_model *model, cp_contact_side side,
                                          int k)
{
    cp_error error = {0};
    cp_crash_configuration configuration;
    double at_m = side == CP_SIDE_REAR ? 0.15 * (k % 6) : 0.4 * (k % 6) - 1.4;
    if (cp_crash_configuration_struck(model, model, side, at_m, cp_rad_from_deg(10.0 * (k % 3)),
                                      0.0, cp_m_s_from_km_h(25.0 + 10.0 * (k % 4)), &configuration,
                                      &error) != CP_OK)
        crash_builder_stop(&error);
    return configuration;
}

static double median(double *values, size_t count)
{
    gsl_sort(values, 1, count);
    return gsl_stats_median_from_sorted_data(values, 1, count);
}

typedef enum what_is_met { BARRIER, CAR, SIDE_OF_CAR, REAR_OF_CAR, WHAT_COUNT } what_is_met;

static cp_crash_configuration case_of(const cp_vehicle_model *model, what_is_met what, int k)
{
    return what == SIDE_OF_CAR   ? struck_case(model, CP_SIDE_LEFT, k)
           : what == REAR_OF_CAR ? struck_case(model, CP_SIDE_REAR, k)
                                 : bench_case(model, what == CAR, k);
}

static void print_speed(const cp_vehicle_model *model, what_is_met what)
{
    static const char *const NAME[WHAT_COUNT] = {"against barrier", "car to car", "into a side",
                                                 "into a rear"};
    cp_crash_options options = cp_crash_options_default();
    double ms[CASES * REPEATS];
    size_t count = 0;
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        for (int k = 0; k < CASES; k++) {
            cp_crash_configuration configuration = case_of(model, what, k);
            double started_s = cp_clock_s();
            cp_crash_result result = crash_builder_simulate(model, what == BARRIER ? NULL : model,
                                                            &configuration, &options);
            ms[count++] = 1e3 * (cp_clock_s() - started_s);
            cp_crash_result_destroy(&result);
        }
    }
    double middle_ms = median(ms, count);
    printf("%-18s median %6.2f ms a run, p90 %6.2f ms, %6.0f runs/s on one core, paper/ours %.0f\n",
           NAME[what], middle_ms, ms[count * 9 / 10], 1e3 / middle_ms, PAPER_MS / middle_ms);
}

// One evaluation of a fit: every configuration of the reference study, on one core.
static void print_evaluation(const cp_vehicle_model *model, const cp_reference *reference)
{
    double seconds[REPEATS], *olc_g = calloc(reference->count, sizeof *olc_g);
    if (olc_g == NULL)
        abort();
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        cp_error error = {0};
        double started_s = cp_clock_s();
        if (cp_objective_olc(model, reference->cases, reference->count, NULL,
                             cp_crash_options_default().time_step_s, 1, olc_g, &error) != CP_OK)
            crash_builder_stop(&error);
        seconds[repeat] = cp_clock_s() - started_s;
    }
    free(olc_g);
    printf("OLC of %zu configurations: median %.3f s on one core\n", reference->count,
           median(seconds, REPEATS));
}

static double olc_at_step(const cp_vehicle_model *model, bool cars, int k, double time_step_s)
{
    cp_crash_options options = cp_crash_options_default();
    options.time_step_s = time_step_s;
    cp_crash_configuration configuration = bench_case(model, cars, k);
    cp_crash_result result =
        crash_builder_simulate(model, cars ? model : NULL, &configuration, &options);
    double olc_g = result.severity[0].olc.olc_g;
    cp_crash_result_destroy(&result);
    return olc_g;
}

static void print_convergence(const cp_vehicle_model *model, bool cars)
{
    static const double STEP_S[] = {0.0005, 0.00025, 0.000125};
    const double finest_s = 0.00003125;
    double finest_g[CASES];
    for (int k = 0; k < CASES; k++)
        finest_g[k] = olc_at_step(model, cars, k, finest_s);
    for (size_t s = 0; s < sizeof STEP_S / sizeof *STEP_S; s++) {
        double off[CASES];
        size_t count = 0;
        for (int k = 0; k < CASES; k++) {
            double olc_g = olc_at_step(model, cars, k, STEP_S[s]);
            if (isfinite(olc_g) && isfinite(finest_g[k]))
                off[count++] = 100.0 * fabs(olc_g / finest_g[k] - 1.0);
        }
        double mean = gsl_stats_mean(off, 1, count), largest = gsl_stats_max(off, 1, count);
        printf("%-18s step %8.5f ms: OLC off the one at %g ms by %5.2f %% in the median, %5.2f %% "
               "in the mean, %5.2f %% at most\n",
               cars ? "car to car" : "against barrier", 1e3 * STEP_S[s], 1e3 * finest_s,
               median(off, count), mean, largest);
    }
}

int main(int argc, char **argv)
{
    cp_error error = {0};
    cp_vehicle_model model = cp_vehicle_model_default();
    if (argc > 1 && cp_vehicle_model_load(argv[1], &model, &error) != CP_OK)
        crash_builder_stop(&error);
    if (cp_crash_library_begin(&error) != CP_OK)
        crash_builder_stop(&error);
    printf("vehicle %s\n", model.name);
    for (what_is_met what = BARRIER; what < WHAT_COUNT; what++)
        print_speed(&model, what);
    if (argc > 2) {
        cp_reference reference;
        if (cp_reference_load(argv[2], &reference, &error) != CP_OK)
            crash_builder_stop(&error);
        print_evaluation(&model, &reference);
        cp_reference_destroy(&reference);
    }
    for (int cars = 0; cars < 2; cars++)
        print_convergence(&model, cars);
    cp_crash_library_end();
    return 0;
}
