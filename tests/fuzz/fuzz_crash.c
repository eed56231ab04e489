/* SPDX-License-Identifier: GPL-3.0-or-later */
/* fuzz_crash [--hostile] [--cases N] [--seed S] [--first K] FOLDER: random crashes of all vehicle
 * files of a folder and the standard car, against the barrier and each other, 0 to 130 km/h each,
 * any offset and angle at which they touch. --hostile: of cars whose every parameter is drawn anew,
 * anywhere within its bounds or on one of them, as far as the model takes them together; and each
 * parameter in turn beyond its bounds, which must be refused by its name. Counts and reports what
 * must not happen: an error, a number that is not finite, energy more than 1 % above that at first
 * contact. Case K alone can be repeated with --first K --cases 1, as long as the folder holds the
 * same vehicles. The last line sums up; exit code 1 after any failure. */
#include "core/progress.h"
#include "core/rng.h"
#include "core/units.h"
#include "crash/crash_simulation.h"

#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VEHICLES_MAX = 64 };
static const double ENERGY_MAX_1 = 1.01;
static const double ROUNDING_J = 10.0; /* of hostile cars, that may weigh next to nothing */
static const double SPEED_MAX_KM_H = 130.0;

typedef struct fleet {
    cp_vehicle_model model[VEHICLES_MAX];
    size_t count;
} fleet;

// One case as drawn.
typedef struct fuzz_case {
    const cp_vehicle_model *own;
    const cp_vehicle_model *opponent; /* NULL: the barrier */
    double speed_km_h[2];
    double offset_m;
    double angle_rad;
    cp_crash_configuration configuration;
} fuzz_case;

typedef struct tally {
    size_t cases;
    size_t refused;       /* parameters beyond their bounds */
    size_t not_simulated; /* of hostile cars: told that it cannot be */
    size_t failures;
    size_t brushed; /* passed each other by a corner's rounding */
    double highest_energy_1;
    uint64_t highest_case;
    size_t contact_sides[2][4];
    double longest_ms;
} tally;

static void load_fleet(const char *folder, fleet *all)
{
    char pattern[4096];
    cp_error error = {0};
    glob_t files;
    all->model[all->count++] = cp_vehicle_model_default();
    all->model[all->count] = cp_vehicle_model_default();
    all->model[all->count].corner_strips_1 = 4.0;
    all->model[all->count++].upper_strips_1 = 3.0;
    snprintf(pattern, sizeof pattern, "%s/*.yaml", folder);
    if (glob(pattern, 0, NULL, &files) != 0) {
        fprintf(stderr, "no vehicle files in %s\n", folder);
        exit(2);
    }
    for (size_t k = 0; k < files.gl_pathc && all->count < VEHICLES_MAX; k++) {
        if (strstr(files.gl_pathv[k], ".fit.yaml") != NULL)
            continue;
        if (cp_vehicle_model_load(files.gl_pathv[k], &all->model[all->count], &error) != CP_OK) {
            fprintf(stderr, "%s\n", error.text);
            exit(2);
        }
        all->count++;
    }
    globfree(&files);
}

static double uniform(cp_rng_key key, const char *what, uint64_t draw, double low, double high)
{
    return low + (high - low) * cp_rng_uniform(cp_rng_key_text(key, what), draw);
}

static const cp_vehicle_model *pick(const fleet *all, cp_rng_key key, const char *what)
{
    return &all->model[cp_rng_bits(cp_rng_key_text(key, what), 0) % all->count];
}

// ---- hostile cars --------------------------------------------------------------------------

// Any value that the table of parameters allows; bounds as often as what lies between.
static double draw_value(const cp_vehicle_parameter *parameter, cp_rng_key key)
{
    double share = cp_rng_uniform(key, 0);
    double low = parameter->smallest, high = parameter->largest;
    if (share < 0.15)
        return low;
    if (share > 0.85)
        return high;
    double place = cp_rng_uniform(key, 1);
    if (strstr(parameter->name, "_strips_1") != NULL)
        return floor(low + place * (high - low) + 0.5);
    // Small ones as often as large ones.
    return low > 0.0 && share < 0.6 ? low * pow(high / low, place) : low + place * (high - low);
}

// A walk through the table from the car as it is: a value that the model does not take beside the
// others is drawn again some times, then left.
static void draw_car(cp_vehicle_model *model, cp_rng_key key)
{
    enum { ROUNDS = 3, TRIES = 4 };
    cp_error error = {0};
    *model = cp_vehicle_model_default();
    for (uint64_t draw = 0; draw < ROUNDS * TRIES * CP_VEHICLE_PARAMETER_TOTAL; draw++) {
        cp_rng_key one = cp_rng_key_number(key, draw);
        size_t index = cp_rng_bits(one, 7) % CP_VEHICLE_PARAMETER_TOTAL;
        double before = cp_vehicle_model_get(model, index);
        cp_vehicle_model_set(model, index, draw_value(&CP_VEHICLE_PARAMETER[index], one));
        if (cp_vehicle_model_validate(model, &error) != CP_OK)
            cp_vehicle_model_set(model, index, before);
    }
    snprintf(model->name, sizeof model->name, "hostile");
}

// Every parameter beyond its bounds: told by name, whatever the others are.
static void try_beyond(const cp_vehicle_model *car, tally *t)
{
    for (size_t k = 0; k < CP_VEHICLE_PARAMETER_TOTAL; k++) {
        const cp_vehicle_parameter *parameter = &CP_VEHICLE_PARAMETER[k];
        const double beyond[] = {nextafter(parameter->smallest, -INFINITY),
                                 nextafter(parameter->largest, INFINITY),
                                 NAN,
                                 INFINITY,
                                 -INFINITY,
                                 -1e308};
        for (size_t v = 0; v < sizeof beyond / sizeof *beyond; v++) {
            cp_vehicle_model model = *car;
            cp_error error = {0};
            cp_vehicle_model_set(&model, k, beyond[v]);
            t->refused++;
            if (cp_vehicle_model_validate(&model, &error) == CP_BAD_INPUT &&
                strncmp(error.text, parameter->name, strlen(parameter->name)) == 0)
                continue;
            printf("%s = %g: '%s'\n", parameter->name, beyond[v], error.text);
            t->failures++;
        }
    }
}

static void draw_hostile_fleet(fleet *all, cp_rng_key seed, uint64_t index, tally *t)
{
    cp_rng_key key = cp_rng_key_text(cp_rng_key_number(seed, index), "hostile");
    all->count = 2;
    for (size_t k = 0; k < all->count; k++)
        draw_car(&all->model[k], cp_rng_key_number(key, k));
    if (index % 16 == 0)
        try_beyond(&all->model[0], t);
}

// ---- cases ---------------------------------------------------------------------------------

// Case number index: draws speeds, offset and angle again until the two meet.
static fuzz_case draw_case(const fleet *all, cp_rng_key seed, uint64_t index)
{
    cp_rng_key key = cp_rng_key_number(seed, index);
    fuzz_case drawn = {.own = pick(all, key, "own"), .opponent = pick(all, key, "opponent")};
    if (cp_rng_uniform(cp_rng_key_text(key, "barrier"), 0) < 0.25)
        drawn.opponent = NULL;
    // Every second case deep in the front, the others anywhere.
    double widest_m = index % 2 == 0 ? 2.0 : 6.0;
    for (uint64_t draw = 0; draw < 10000; draw++) {
        cp_error miss = {0};
        for (int c = 0; c < 2; c++)
            drawn.speed_km_h[c] =
                uniform(key, c == 0 ? "speed a" : "speed b", draw, 0.0, SPEED_MAX_KM_H);
        drawn.offset_m = uniform(key, "offset", draw, -widest_m, widest_m);
        drawn.angle_rad = uniform(key, "angle", draw, -CP_PI, CP_PI);
        if (cp_crash_configuration_from_description(
                drawn.own, drawn.opponent, NULL, cp_m_s_from_km_h(drawn.speed_km_h[0]),
                drawn.opponent ? cp_m_s_from_km_h(drawn.speed_km_h[1]) : 0.0, drawn.offset_m,
                drawn.angle_rad, &drawn.configuration, &miss) == CP_OK)
            return drawn;
    }
    fprintf(stderr, "case %llu: 10000 draws and never a touch\n", (unsigned long long)index);
    exit(2);
}

static bool all_finite(const cp_crash_result *result)
{
    for (int c = 0; c < result->vehicle_count; c++)
        for (int channel = 0; channel < CP_CHANNEL_COUNT; channel++)
            for (size_t k = 0; k < result->pulse[c].sample_count; k++)
                if (!isfinite(result->pulse[c].channel[channel][k]))
                    return false;
    const cp_crash_energy *e = &result->energy;
    return isfinite(e->kinetic_j + e->elastic_j + e->plastic_j + e->friction_j +
                    e->contact_damping_j + e->rate_j + e->mount_damping_j) &&
           isfinite(e->highest_mechanical_j) && e->highest_mechanical_j > 0.0;
}

static void report(const fuzz_case *one, uint64_t index, const char *what)
{
    printf("case %llu: %s: %s at %.3f km/h against %s at %.3f km/h, offset %.4f m, angle %.3f "
           "deg, struck on its %s\n",
           (unsigned long long)index, what, one->own->name, one->speed_km_h[0],
           one->opponent ? one->opponent->name : "barrier",
           one->opponent ? one->speed_km_h[1] : 0.0, one->offset_m, cp_deg_from_rad(one->angle_rad),
           cp_contact_side_text(one->configuration.side[0]));
}

static void run_case(const fuzz_case *one, uint64_t index, tally *t)
{
    cp_crash_options options = cp_crash_options_default();
    cp_crash_result result;
    cp_error error = {0};
    char what[5000] = "";
    double started_s = cp_clock_s();
    cp_status status =
        cp_crash_simulate(one->own, one->opponent, &one->configuration, &options, &result, &error);
    bool hostile = strcmp(one->own->name, "hostile") == 0;
    if (status != CP_OK && hostile && error.text[0] != '\0' &&
        (status == CP_BAD_INPUT || status == CP_CRASH_FAILED)) {
        t->not_simulated++; // in words, and no number
    } else if (status != CP_OK) {
        snprintf(what, sizeof what, "error (%s)", error.text);
    } else {
        double energy_1 = result.energy.highest_mechanical_j / result.energy.start_j;
        if (energy_1 > t->highest_energy_1) {
            t->highest_energy_1 = energy_1;
            t->highest_case = index;
        }
        if (!all_finite(&result))
            snprintf(what, sizeof what, "not finite");
        else if (!(result.energy.highest_mechanical_j <=
                   ENERGY_MAX_1 * result.energy.start_j + (hostile ? ROUNDING_J : 0.0)))
            snprintf(what, sizeof what, "energy %.4f of the start's %.0f J", energy_1,
                     result.energy.start_j);
        // Rectangles may touch at corners that the rounded outlines of the bodies do not have.
        t->brushed += !result.touched;
    }
    cp_crash_result_destroy(&result);
    t->longest_ms = fmax(t->longest_ms, 1e3 * (cp_clock_s() - started_s));
    for (int c = 0; c < (one->opponent ? 2 : 1); c++)
        t->contact_sides[c][one->configuration.side[c]]++;
    t->cases++;
    if (what[0] == '\0')
        return;
    t->failures++;
    report(one, index, what);
}

static uint64_t number(const char *text)
{
    char *end = NULL;
    uint64_t value = strtoull(text, &end, 10);
    if (end == text || *end != '\0') {
        fprintf(stderr, "a whole number, please, not '%s'\n", text);
        exit(2);
    }
    return value;
}

static void print_tally(const tally *t, uint64_t seed, double took_s)
{
    for (int c = 0; c < 2; c++)
        printf("%s struck on front %zu, left %zu, right %zu, rear %zu\n", c == 0 ? "a" : "b",
               t->contact_sides[c][CP_SIDE_FRONT], t->contact_sides[c][CP_SIDE_LEFT],
               t->contact_sides[c][CP_SIDE_RIGHT], t->contact_sides[c][CP_SIDE_REAR]);
    printf("%zu cases, seed %llu: %zu failures; %zu brushed past each other; highest energy "
           "%.5f of the start's (case %llu); longest case %.0f ms; %.0f s\n",
           t->cases, (unsigned long long)seed, t->failures, t->brushed, t->highest_energy_1,
           (unsigned long long)t->highest_case, t->longest_ms, took_s);
    if (t->refused > 0)
        printf(
            "%zu values beyond their bounds tried; %zu cases told that they cannot be simulated\n",
            t->refused, t->not_simulated);
}

int main(int argc, char **argv)
{
    uint64_t cases = 10000, seed = 2014, first = 0;
    const char *folder = NULL;
    bool hostile = false;
    for (int k = 1; k < argc; k++) {
        bool more = k + 1 < argc;
        if (strcmp(argv[k], "--hostile") == 0)
            hostile = true;
        else if (more && strcmp(argv[k], "--cases") == 0)
            cases = number(argv[++k]);
        else if (more && strcmp(argv[k], "--seed") == 0)
            seed = number(argv[++k]);
        else if (more && strcmp(argv[k], "--first") == 0)
            first = number(argv[++k]);
        else
            folder = argv[k];
    }
    if (folder == NULL) {
        fprintf(stderr,
                "usage: fuzz_crash [--hostile] [--cases N] [--seed S] [--first K] FOLDER\n");
        return 2;
    }
    cp_error error = {0};
    fleet *all = calloc(1, sizeof *all);
    if (all == NULL || cp_crash_library_begin(&error) != CP_OK) {
        fprintf(stderr, "%s\n", all ? error.text : "out of memory");
        free(all);
        return 2;
    }
    load_fleet(folder, all);

    tally counts = {0};
    double started_s = cp_clock_s();
    cp_rng_key key = cp_rng_key_text(cp_rng_key_seed(seed), "fuzz_crash");
    for (uint64_t k = first; k < first + cases; k++) {
        if (hostile)
            draw_hostile_fleet(all, key, k, &counts);
        fuzz_case one = draw_case(all, key, k);
        run_case(&one, k, &counts);
    }
    print_tally(&counts, seed, cp_clock_s() - started_s);
    cp_crash_library_end();
    free(all);
    return counts.failures > 0 ? 1 : 0;
}
