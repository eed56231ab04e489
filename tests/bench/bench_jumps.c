/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bench_jumps [--cases N] [--seed S] [--vehicle NAME|FILE]... [--database STUDY.db] [--threads T]
 *             [--at-most SHARE] [--at-most-small SHARE] [--list FILE.csv]
 *
 * How often a crash's OLC jumps: crashes front against front, drawn uniformly (5 to 60 km/h each,
 * every offset of either side, up to 30 degrees either way), or those of a study's database with
 * the shipped vehicles of today, are simulated again with 1 cm more offset, 0.5 degrees more angle
 * and 0.5 km/h more speed of the first car, each in turn. A crash jumps where the OLC of one of its
 * frontally struck cars moves by more than 2 g. Small overlap: below 0.2 of the narrower front,
 * fronts alone, not flanks of turned cars. Drawn crashes of less than 0.1 are held against the full
 * overlap at the same speeds too. Exit code 1 where a share of the drawn crashes exceeds --at-most
 * (all) or
 * --at-most-small (small overlap). --list: the crashes that jump, a row a change. */
#include "calibrate/parallel.h"
#include "calibrate/suite_case.h"
#include "core/progress.h"
#include "core/rng.h"
#include "core/units.h"
#include "crash/shipped_vehicle.h"
#include "store/query.h"
#include "store/stored_crash.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double JUMP_G = 2.0;
static const double SMALL_1 = 0.2;
static const double TOUCH_1 = 0.1;

enum { CHANGES = 3, VEHICLES_MAX = 16 };
static const char *const CHANGE_TEXT[CHANGES] = {"1 cm of offset", "0.5 degrees", "0.5 km/h"};

typedef struct arguments {
    long cases;
    long seed;
    long threads;
    const char *vehicle[VEHICLES_MAX];
    size_t vehicle_count;
    const char *database;
    const char *list;
    double at_most_1; /* NAN: no limit */
    double at_most_small_1;
} arguments;

// One crash and what became of it.
typedef struct jump_case {
    const cp_vehicle_model *model[2]; /* [1] NULL: a barrier, which is left out */
    cp_crash_configuration configuration;
    double overlap_1;         /* NAN: not front against front */
    double olc_g[2];          /* NAN: not struck in front; 0: left-censored */
    double change_g[CHANGES]; /* largest of its cars */
    double changed_olc_g[CHANGES][2];
    double full_olc_g; /* at full overlap, where the overlap is a touch; else NAN */
    bool failed;
} jump_case;

typedef struct jump_run {
    jump_case *one;
    size_t count;
} jump_run;

static void stop(const char *message)
{
    fprintf(stderr, "bench_jumps: %s\n", message);
    exit(2);
}

// ---- configurations ----------------------------------------------------------------------------

// Share of the narrower front that the two fronts have in common, across the first car.
static double front_overlap(const jump_case *one)
{
    const cp_body_state *a = &one->configuration.vehicle[0], *b = &one->configuration.vehicle[1];
    const cp_vehicle_model *own = one->model[0], *other = one->model[1];
    if (one->configuration.side[0] != CP_SIDE_FRONT || one->configuration.side[1] != CP_SIDE_FRONT)
        return NAN;
    cp_vec2 middle =
        cp_vec2_add(b->cog_m, cp_vec2_scale(cp_vec2_heading(b->yaw_rad), other->cg_to_front_m));
    double y_m = cp_pose_to_local((cp_pose){a->cog_m, a->yaw_rad}, middle).y;
    double half_m = 0.5 * other->width_m * fabs(cos(b->yaw_rad - a->yaw_rad));
    double common_m =
        fmin(0.5 * own->width_m, y_m + half_m) - fmax(-0.5 * own->width_m, y_m - half_m);
    return fmax(0.0, common_m) / fmin(own->width_m, 2.0 * half_m);
}

// The configuration changed a little: the second car to the side, turned about the middle of its
// front, or the first one faster.
static cp_crash_configuration changed(const jump_case *one, int change)
{
    cp_crash_configuration configuration = one->configuration;
    cp_body_state *a = &configuration.vehicle[0], *b = &configuration.vehicle[1];
    if (change == 0) {
        cp_vec2 left = cp_vec2_heading(a->yaw_rad + 0.5 * CP_PI);
        b->cog_m = cp_vec2_add(b->cog_m, cp_vec2_scale(left, 0.01));
    } else if (change == 1) {
        double turn_rad = cp_rad_from_deg(0.5), arm_m = one->model[1]->cg_to_front_m;
        cp_vec2 front = cp_vec2_add(b->cog_m, cp_vec2_scale(cp_vec2_heading(b->yaw_rad), arm_m));
        b->yaw_rad = cp_wrap_angle(b->yaw_rad + turn_rad);
        b->cog_m = cp_vec2_sub(front, cp_vec2_scale(cp_vec2_heading(b->yaw_rad), arm_m));
        b->velocity_m_s = cp_vec2_rotate(b->velocity_m_s, turn_rad);
    } else {
        cp_vec2 more = cp_vec2_scale(cp_vec2_heading(a->yaw_rad), cp_m_s_from_km_h(0.5));
        a->velocity_m_s = cp_vec2_add(a->velocity_m_s, more);
    }
    return configuration;
}

// OLC of both cars; false when it could not be simulated.
static bool simulate(const jump_case *one, const cp_crash_configuration *configuration,
                     double olc_g[2])
{
    cp_crash_options options = cp_crash_options_default();
    options.until_olc = true;
    cp_crash_result result;
    cp_error error = {0};
    cp_status status =
        cp_crash_simulate(one->model[0], one->model[1], configuration, &options, &result, &error);
    for (int c = 0; status == CP_OK && c < 2; c++) {
        const cp_olc *olc = &result.severity[c].olc;
        bool front = one->configuration.side[c] == CP_SIDE_FRONT;
        olc_g[c] = !front ? NAN : olc->status == CP_OLC_VALUE ? olc->olc_g : 0.0;
    }
    cp_crash_result_destroy(&result);
    return status == CP_OK;
}

// The first car's OLC at full overlap and the same speeds.
static double full_overlap_g(const jump_case *one)
{
    const cp_body_state *state = one->configuration.vehicle;
    cp_crash_configuration full;
    cp_error error = {0};
    double olc_g[2];
    if (cp_crash_configuration_from_description(
            one->model[0], one->model[1], NULL, cp_vec2_length(state[0].velocity_m_s),
            cp_vec2_length(state[1].velocity_m_s), 0.0, 0.0, &full, &error) != CP_OK ||
        !simulate(one, &full, olc_g))
        return NAN;
    return olc_g[0];
}

static cp_status run_case(void *context, size_t k)
{
    jump_run *run = context;
    jump_case *one = &run->one[k];
    one->overlap_1 = front_overlap(one);
    one->full_olc_g = NAN;
    one->failed = !simulate(one, &one->configuration, one->olc_g);
    for (int change = 0; !one->failed && change < CHANGES; change++) {
        double *olc_g = one->changed_olc_g[change];
        cp_crash_configuration configuration = changed(one, change);
        one->failed = !simulate(one, &configuration, olc_g);
        one->change_g[change] = 0.0;
        for (int c = 0; !one->failed && c < 2; c++)
            one->change_g[change] = fmax(one->change_g[change], fabs(olc_g[c] - one->olc_g[c]));
    }
    if (!one->failed && one->overlap_1 < TOUCH_1)
        one->full_olc_g = full_overlap_g(one);
    return CP_OK;
}

// ---- drawn crashes -----------------------------------------------------------------------------

static double uniform(cp_rng_key key, const char *what, uint64_t draw, double low, double high)
{
    return low + (high - low) * cp_rng_uniform(cp_rng_key_text(key, what), draw);
}

// Crash number index: drawn again until the two meet front to front.
static void draw_case(const cp_vehicle_model *models, size_t count, cp_rng_key seed, uint64_t index,
                      jump_case *one)
{
    cp_rng_key key = cp_rng_key_number(seed, index);
    one->model[0] = &models[cp_rng_bits(cp_rng_key_text(key, "own"), 0) % count];
    one->model[1] = &models[cp_rng_bits(cp_rng_key_text(key, "opponent"), 0) % count];
    double widest_m = 0.5 * (one->model[0]->width_m + one->model[1]->width_m);
    for (uint64_t draw = 0; draw < 10000; draw++) {
        double speed_a_km_h = uniform(key, "speed a", draw, 5.0, 60.0);
        double speed_b_km_h = uniform(key, "speed b", draw, 5.0, 60.0);
        cp_error error = {0};
        cp_status status = cp_crash_configuration_from_description(
            one->model[0], one->model[1], NULL, cp_m_s_from_km_h(speed_a_km_h),
            cp_m_s_from_km_h(speed_b_km_h), uniform(key, "offset", draw, -widest_m, widest_m),
            cp_rad_from_deg(uniform(key, "angle", draw, -30.0, 30.0)), &one->configuration, &error);
        if (status == CP_OK && one->configuration.side[0] == CP_SIDE_FRONT &&
            one->configuration.side[1] == CP_SIDE_FRONT)
            return;
    }
    stop("10000 draws and no crash front against front");
}

static void draw_cases(const arguments *a, const cp_vehicle_model *models, size_t count,
                       jump_run *run)
{
    run->count = (size_t)a->cases;
    run->one = calloc(run->count + 1, sizeof *run->one);
    if (run->one == NULL)
        stop("out of memory");
    cp_rng_key key = cp_rng_key_text(cp_rng_key_seed((uint64_t)a->seed), "bench_jumps");
    for (size_t k = 0; k < run->count; k++)
        draw_case(models, count, key, k, &run->one[k]);
}

// ---- crashes of a study ------------------------------------------------------------------------

typedef struct id_list {
    int64_t *id;
    size_t count;
} id_list;

static cp_status take_id(void *context, const cp_row *row, cp_error *error)
{
    id_list *ids = context;
    int64_t *longer = realloc(ids->id, (ids->count + 1) * sizeof *ids->id);
    if (longer == NULL)
        return cp_fail_memory(error, "crashes");
    ids->id = longer;
    ids->id[ids->count++] = row->cell[0].integer;
    return CP_OK;
}

// The shipped vehicle of that name as it is today, with the outline that the study gave it.
static void renew_model(cp_vehicle_model *model)
{
    cp_vehicle_model today;
    cp_error error = {0};
    cp_shipped_vehicle shipped;
    if (!cp_shipped_vehicle_find(model->name, &shipped))
        return;
    if (cp_suite_vehicle(NULL, model->name, &today, &error) != CP_OK)
        stop(error.text);
    *model = cp_vehicle_model_cover(&today, model->length_m, model->width_m);
}

// Frontal crashes of two cars; models receives a copy of the cars of each.
static void load_cases(const char *path, cp_vehicle_model **models, jump_run *run)
{
    cp_store *store = NULL;
    cp_error error = {0};
    id_list ids = {0};
    const cp_query_handler handler = {.row = take_id, .context = &ids};
    if (cp_store_open(path, CP_STORE_READ, &store, &error) != CP_OK ||
        cp_query(store,
                 "SELECT DISTINCT crash_id FROM crash_vehicle WHERE contact_side = 'front' "
                 "ORDER BY crash_id",
                 NULL, 0, &handler, &error) != CP_OK)
        stop(error.text);
    *models = calloc(2 * ids.count + 1, sizeof **models);
    run->one = calloc(ids.count + 1, sizeof *run->one);
    if (*models == NULL || run->one == NULL)
        stop("out of memory");
    for (size_t k = 0; k < ids.count; k++) {
        cp_stored_crash stored;
        if (cp_stored_crash_read(store, ids.id[k], NULL, &stored, &error) != CP_OK)
            stop(error.text);
        jump_case *one = &run->one[run->count];
        one->configuration = stored.configuration;
        for (int c = 0; c < 2; c++) {
            cp_vehicle_model *model = &(*models)[2 * run->count + (size_t)c];
            *model = stored.model[c];
            renew_model(model);
            one->model[c] = model;
        }
        run->count += !stored.configuration.against_barrier;
    }
    free(ids.id);
    cp_store_close(store);
}

// ---- what is printed ---------------------------------------------------------------------------

// Whether number change of a crash (CHANGES: any of them) jumps.
static bool jumps(const jump_case *one, int change)
{
    for (int k = 0; k < CHANGES; k++)
        if ((change == CHANGES || change == k) && one->change_g[k] > JUMP_G)
            return true;
    return false;
}

// Share of crashes that jump; small: those of small overlap only.
static double jump_share(const jump_run *run, int change, bool small)
{
    size_t of = 0, jumped = 0;
    for (size_t k = 0; k < run->count; k++) {
        const jump_case *one = &run->one[k];
        if (one->failed || (small && !(one->overlap_1 < SMALL_1)))
            continue;
        of++;
        jumped += jumps(one, change);
    }
    return of > 0 ? (double)jumped / (double)of : 0.0;
}

static double largest_change_g(const jump_run *run, int change)
{
    double largest_g = 0.0;
    for (size_t k = 0; k < run->count; k++)
        for (int c = 0; c < CHANGES && !run->one[k].failed; c++)
            if (change == CHANGES || change == c)
                largest_g = fmax(largest_g, run->one[k].change_g[c]);
    return largest_g;
}

static void print_touches(const jump_run *run)
{
    size_t touches = 0, worse = 0;
    double excess_g = 0.0;
    for (size_t k = 0; k < run->count; k++) {
        const jump_case *one = &run->one[k];
        if (one->failed || isnan(one->full_olc_g))
            continue;
        touches++;
        worse += one->olc_g[0] > one->full_olc_g;
        excess_g = fmax(excess_g, one->olc_g[0] - one->full_olc_g);
    }
    printf("overlap below %g: %zu crashes, %zu of them worse than full overlap at the same speeds, "
           "by %.2f g at most\n",
           TOUCH_1, touches, worse, excess_g);
}

// Print the figures; false when a share exceeds its limit.
static bool print_run(const char *what, const jump_run *run, double at_most_1,
                      double at_most_small_1)
{
    size_t failed = 0, small = 0;
    for (size_t k = 0; k < run->count; k++) {
        failed += run->one[k].failed;
        small += !run->one[k].failed && run->one[k].overlap_1 < SMALL_1;
    }
    printf("%s: %zu crashes (%zu could not be simulated), %zu with overlap below %g\n", what,
           run->count, failed, small, SMALL_1);
    printf("%-16s %18s %18s %12s\n", "change", "OLC moves > 2 g", "overlap < 0.2", "largest");
    for (int change = 0; change <= CHANGES; change++)
        printf("%-16s %16.2f %% %16.2f %% %10.2f g\n",
               change < CHANGES ? CHANGE_TEXT[change] : "any of them",
               100.0 * jump_share(run, change, false), 100.0 * jump_share(run, change, true),
               largest_change_g(run, change));
    print_touches(run);
    bool kept = failed == 0;
    if (!isnan(at_most_1) && jump_share(run, CHANGES, false) > at_most_1) {
        printf("more than %g %% of the crashes jump\n", 100.0 * at_most_1);
        kept = false;
    }
    if (!isnan(at_most_small_1) && jump_share(run, CHANGES, true) > at_most_small_1) {
        printf("more than %g %% of those of small overlap jump\n", 100.0 * at_most_small_1);
        kept = false;
    }
    return kept;
}

static void list_jumps(const char *path, const jump_run *run)
{
    FILE *file = fopen(path, "w");
    if (file == NULL)
        stop("the list cannot be written");
    fprintf(file, "crash,change,overlap_1,speed_a_km_h,speed_b_km_h,angle_deg,olc_a_g,olc_b_g,"
                  "changed_olc_a_g,changed_olc_b_g\n");
    for (size_t k = 0; k < run->count; k++) {
        const jump_case *one = &run->one[k];
        const cp_body_state *state = one->configuration.vehicle;
        for (int change = 0; change < CHANGES; change++)
            if (!one->failed && jumps(one, change))
                fprintf(file, "%zu,%s,%.3f,%.1f,%.1f,%.1f,%.2f,%.2f,%.2f,%.2f\n", k,
                        CHANGE_TEXT[change], one->overlap_1,
                        cp_km_h_from_m_s(cp_vec2_length(state[0].velocity_m_s)),
                        cp_km_h_from_m_s(cp_vec2_length(state[1].velocity_m_s)),
                        cp_deg_from_rad(cp_wrap_angle(state[1].yaw_rad - state[0].yaw_rad)),
                        one->olc_g[0], one->olc_g[1], one->changed_olc_g[change][0],
                        one->changed_olc_g[change][1]);
    }
    if (fclose(file) != 0)
        stop("the list cannot be written");
}

// ---- all of it ---------------------------------------------------------------------------------

static double number(const char *text, double smallest, double largest)
{
    char *end = NULL;
    double value = strtod(text, &end);
    char message[256];
    snprintf(message, sizeof message, "a number from %g to %g, please, not '%s'", smallest, largest,
             text);
    if (end == text || *end != '\0' || !(value >= smallest && value <= largest))
        stop(message);
    return value;
}

static arguments read_arguments(int argc, char **argv)
{
    arguments a = {
        .cases = 20000, .seed = 2014, .threads = 2, .at_most_1 = NAN, .at_most_small_1 = NAN};
    for (int k = 1; k < argc; k += 2) {
        const char *value = k + 1 < argc ? argv[k + 1] : "";
        if (strcmp(argv[k], "--cases") == 0)
            a.cases = (long)number(value, 0, 1e7);
        else if (strcmp(argv[k], "--seed") == 0)
            a.seed = (long)number(value, 0, 1e9);
        else if (strcmp(argv[k], "--threads") == 0)
            a.threads = (long)number(value, 1, 64);
        else if (strcmp(argv[k], "--at-most") == 0)
            a.at_most_1 = number(value, 0, 1);
        else if (strcmp(argv[k], "--at-most-small") == 0)
            a.at_most_small_1 = number(value, 0, 1);
        else if (strcmp(argv[k], "--database") == 0)
            a.database = value;
        else if (strcmp(argv[k], "--list") == 0)
            a.list = value;
        else if (strcmp(argv[k], "--vehicle") == 0 && a.vehicle_count < VEHICLES_MAX)
            a.vehicle[a.vehicle_count++] = value;
        else
            stop("usage: bench_jumps [--cases N] [--seed S] [--vehicle NAME|FILE]... "
                 "[--database STUDY.db] [--threads T] [--at-most SHARE] [--at-most-small SHARE] "
                 "[--list FILE.csv]");
    }
    if (a.vehicle_count == 0)
        a.vehicle[a.vehicle_count++] = "honda_accord_2014";
    return a;
}

static bool run_and_print(const arguments *a, const char *what, jump_run *run, bool limited)
{
    cp_error error = {0};
    double started_s = cp_clock_s();
    if (cp_parallel_simulate(run->count, (int)a->threads, run_case, run, &error) != CP_OK)
        stop(error.text);
    bool kept = print_run(what, run, limited ? a->at_most_1 : (double)NAN,
                          limited ? a->at_most_small_1 : (double)NAN);
    if (a->list != NULL)
        list_jumps(a->list, run);
    fprintf(stderr, "%.0f s\n", cp_clock_s() - started_s);
    free(run->one);
    return kept;
}

int main(int argc, char **argv)
{
    arguments a = read_arguments(argc, argv);
    cp_vehicle_model *models = calloc(VEHICLES_MAX, sizeof *models);
    cp_error error = {0};
    if (models == NULL || cp_crash_library_begin(&error) != CP_OK)
        stop("out of memory");
    char what[256];
    size_t used = (size_t)snprintf(what, sizeof what, "drawn, seed %ld,", a.seed);
    for (size_t k = 0; k < a.vehicle_count; k++) {
        if (cp_suite_vehicle(NULL, a.vehicle[k], &models[k], &error) != CP_OK)
            stop(error.text);
        if (used < sizeof what)
            used += (size_t)snprintf(what + used, sizeof what - used, " %s", models[k].name);
    }
    bool kept = true;
    if (a.database != NULL) {
        cp_vehicle_model *stored = NULL;
        jump_run run = {0};
        load_cases(a.database, &stored, &run);
        kept = run_and_print(&a, a.database, &run, false);
        free(stored);
    }
    if (a.cases > 0) {
        jump_run run = {0};
        draw_cases(&a, models, a.vehicle_count, &run);
        kept = run_and_print(&a, what, &run, true) && kept;
    }
    free(models);
    cp_crash_library_end();
    return kept ? 0 : 1;
}
