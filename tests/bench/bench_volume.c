/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How the database grows: 10^4, 10^5, 10^6 crashes in it, their pulses those of distinct surrogate
 * runs with noise of the sensor's resolution on each; bytes and time a crash, and the time of the
 * queries everybody asks. Usage: bench_volume DATABASE EXTENSION [CRASHES [RUNS [TABLE.md]]]. */
#include "builders/crash_builder.h"
#include "core/progress.h"
#include "core/rng.h"
#include "pulse/pulse_codec.h"
#include "store/claim.h"
#include "store/plan_rows.h"
#include "store/query.h"
#include "store/result_rows.h"

#include <inttypes.h>
#include <math.h>
#include <pthread.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

enum { SCENARIOS = 2, VARIANTS = 3, CRASHES_A_REPLICATION = 100, THREADS = 4 };
static const char CAR[] = "vehicle: car\nparameters: []\n";
static const cp_owner OWNER = {.host = "bench", .pid = 1, .process_start = 1};

static void check(cp_status status, const cp_error *error)
{
    if (status != CP_OK)
        crash_builder_stop(error);
}

// ---- surrogate runs ------------------------------------------------------------------------

// One distinct run: what it says, and its record as it would be stored.
typedef struct run {
    cp_crash_configuration configuration;
    cp_crash_description description;
    cp_severity severity[2];
    double crush_m[2];
    double separation_s, shift_m, t_common_s;
    cp_pulse record[2];
} run;

static void make_run(const cp_vehicle_model *car, uint64_t k, run *made)
{
    cp_error error = {0};
    cp_crash_options options = cp_crash_options_default();
    double speed_km_h = crash_builder_draw("speed", k, 12, 70);
    double other_km_h = crash_builder_draw("other speed", k, 5, 70);
    double offset_mm = crash_builder_draw("offset", k, -1100, 1100);
    double angle_deg = crash_builder_draw("angle", k, -40, 40);
    made->configuration =
        crash_builder_configuration(car, car, speed_km_h, other_km_h, offset_mm, angle_deg);
    cp_vec2 contact = cp_crash_contact_point(car, car, &made->configuration);
    made->description = cp_crash_describe(car, car, &made->configuration, contact);
    cp_crash_result result = crash_builder_simulate(car, car, &made->configuration, &options);
    for (int role = 0; role < 2; role++) {
        made->severity[role] = result.severity[role];
        made->crush_m[role] = result.crush_m[role];
        check(cp_pulse_codec_record(&result.pulse[role], &made->record[role], &error), &error);
    }
    made->separation_s = result.separation_s;
    made->shift_m = result.shift_m;
    made->t_common_s = result.t_common_s;
    cp_crash_result_destroy(&result);
}

// A copy with what an accelerometer of this resolution adds: each acceleration off by up to half a
// step, and the integrals off by the integrals of that.
static void add_noise(const cp_pulse *record, cp_rng_key key, cp_pulse *noisy)
{
    static const struct {
        cp_pulse_channel rate, velocity, place;
    } AXIS[] = {{CP_CHANNEL_AX, CP_CHANNEL_VX, CP_CHANNEL_X},
                {CP_CHANNEL_AY, CP_CHANNEL_VY, CP_CHANNEL_Y},
                {CP_CHANNEL_YAW_ACC, CP_CHANNEL_YAW_RATE, CP_CHANNEL_YAW}};
    for (size_t axis = 0; axis < 3; axis++) {
        double velocity = 0.0, place = 0.0, step = CP_PULSE_RESOLUTION[AXIS[axis].rate];
        for (size_t k = 0; k < record->sample_count; k++) {
            double noise = step * (cp_rng_uniform(key, 3 * k + axis) - 0.5);
            noisy->channel[AXIS[axis].rate][k] = record->channel[AXIS[axis].rate][k] + noise;
            noisy->channel[AXIS[axis].velocity][k] =
                record->channel[AXIS[axis].velocity][k] + velocity;
            noisy->channel[AXIS[axis].place][k] = record->channel[AXIS[axis].place][k] + place;
            place += velocity * record->sample_interval_s;
            velocity += noise * record->sample_interval_s;
        }
    }
}

// ---- rows ----------------------------------------------------------------------------------

typedef struct volume {
    const run *runs;
    size_t run_count;
    cp_plan_rows plan;
    size_t crashes;  /* so far */
    double commit_s; /* since the last measurement */
    double pack_s;
} volume;

static void pack(const run *from, int role, uint64_t number, cp_crash_vehicle_row *vehicle)
{
    cp_error error = {0};
    cp_pulse noisy;
    const cp_pulse *record = &from->record[role];
    cp_rng_key key = cp_rng_key_number(cp_rng_key_seed(6), 2 * number + (uint64_t)role);
    check(cp_pulse_create(&noisy, record->sample_count, record->sample_interval_s, &error), &error);
    add_noise(record, key, &noisy);
    check(cp_pulse_encode(&noisy, &vehicle->pulse, &vehicle->pulse_size, &error), &error);
    vehicle->sample_count = noisy.sample_count;
    vehicle->sample_interval_s = noisy.sample_interval_s;
    cp_pulse_destroy(&noisy);
}

static void fill_vehicle(const run *from, int role, uint64_t number, cp_crash_vehicle_row *vehicle)
{
    char id[32];
    snprintf(id, sizeof id, "flow_%d.%" PRIu64, role, number % 1000);
    vehicle->sumo_id = strdup(id);
    vehicle->sumo_type = strdup("passenger");
    vehicle->vehicle_model = strdup("car");
    vehicle->at_fault = role == 1;
    vehicle->body = from->configuration.vehicle[role];
    vehicle->body.cog_m.x += (double)(number % 1009);
    vehicle->speed_m_s = from->description.speed_m_s[role];
    vehicle->length_m = 4.86;
    vehicle->width_m = 1.85;
    vehicle->velocity_angle_rad = from->description.velocity_angle_rad[role];
    // Every third crash strikes a side.
    vehicle->side = role == 1 && number % 3 == 0 ? CP_SIDE_LEFT : CP_SIDE_FRONT;
    vehicle->severity = from->severity[role];
    vehicle->severity.olc.olc_g += 1e-3 * cp_rng_uniform(cp_rng_key_seed(9), number);
    if (vehicle->side != CP_SIDE_FRONT)
        vehicle->severity.olc.status = CP_OLC_NOT_FRONT_CONTACT;
    vehicle->crush_m = from->crush_m[role];
}

// Packing is most of the work: threads share the crashes of a replication.
typedef struct packing {
    const volume *v;
    cp_result_rows *rows;
    size_t first;
} packing;

static void *pack_some(void *argument)
{
    const packing *job = argument;
    for (size_t k = job->first; k < CRASHES_A_REPLICATION; k += THREADS) {
        uint64_t number = job->v->crashes + k;
        for (int role = 0; role < 2; role++)
            pack(&job->v->runs[number % job->v->run_count], role, number,
                 &job->rows->crash[k].vehicle[role]);
    }
    return NULL;
}

static void pack_all(const volume *v, cp_result_rows *rows)
{
    pthread_t thread[THREADS];
    packing job[THREADS];
    for (size_t t = 0; t < THREADS; t++) {
        job[t] = (packing){v, rows, t};
        if (pthread_create(&thread[t], NULL, pack_some, &job[t]) != 0)
            crash_builder_stop(&(cp_error){.text = "no thread"});
    }
    for (size_t t = 0; t < THREADS; t++)
        pthread_join(thread[t], NULL);
}

static void add_replication(cp_store *store, volume *v)
{
    cp_error error = {0};
    const cp_replication_row *replication =
        &v->plan.replication[v->crashes / CRASHES_A_REPLICATION];
    cp_result_rows rows = {.replication_id = replication->id,
                           .sumo_version = strdup("bench"),
                           .sumo_command_line = strdup("bench"),
                           .counters = strdup("{}"),
                           .simulated_s = 3600,
                           .vehicle_km = 5000,
                           .vehicle_h = 100};
    double started_s = cp_clock_s();
    for (int k = 0; k < CRASHES_A_REPLICATION; k++) {
        uint64_t number = v->crashes + (uint64_t)k;
        const run *from = &v->runs[number % v->run_count];
        cp_crash_row *crash = cp_result_rows_add_crash(&rows);
        crash->time_s = 10.0 * k;
        crash->contact_m = (cp_vec2){(double)(number % 1009), 1.5};
        crash->description = from->description;
        crash->separation_s = from->separation_s;
        crash->shift_m = from->shift_m;
        crash->t_common_s = from->t_common_s;
        for (int role = 0; role < 2; role++)
            fill_vehicle(from, role, number, &crash->vehicle[role]);
    }
    pack_all(v, &rows);
    v->pack_s += cp_clock_s() - started_s;

    started_s = cp_clock_s();
    check(cp_claim_take(store, rows.replication_id, replication->configuration_hash, &OWNER,
                        &rows.attempt, &error),
          &error);
    check(cp_result_rows_commit(store, &rows, &error), &error);
    v->commit_s += cp_clock_s() - started_s;
    v->crashes += CRASHES_A_REPLICATION;
    cp_result_rows_destroy(&rows);
}

static void make_plan(volume *v, size_t crashes, cp_scenario_row *scenario, cp_variant_row *variant,
                      cp_vehicle_model_row *model)
{
    static char *const SCENARIO[SCENARIOS] = {"left_turn", "head_on"};
    static char *const VARIANT[VARIANTS] = {"baseline", "aeb", "fcw"};
    for (int k = 0; k < SCENARIOS; k++)
        scenario[k] = (cp_scenario_row){SCENARIO[k], "x.sumocfg", "[]", "{}", "[]"};
    for (int k = 0; k < VARIANTS; k++)
        variant[k] = (cp_variant_row){VARIANT[k], k == 0, "[]"};
    *model = (cp_vehicle_model_row){.name = "car", .yaml = (char *)CAR};
    cp_hash_bytes(CAR, strlen(CAR), model->hash);
    size_t count = crashes / CRASHES_A_REPLICATION;
    v->plan = (cp_plan_rows){.study = {.name = "volume",
                                       .design = "paired_seeds",
                                       .replications = count / SCENARIOS / VARIANTS + 1,
                                       .duration_s = 3600,
                                       .step_length_s = 0.05,
                                       .vehicles = "{}",
                                       .yaml = "study: volume\n",
                                       .hash = "0"},
                             .scenario = scenario,
                             .scenario_count = SCENARIOS,
                             .variant = variant,
                             .variant_count = VARIANTS,
                             .vehicle_model = model,
                             .vehicle_model_count = 1,
                             .replication = calloc(count, sizeof *v->plan.replication),
                             .replication_count = count};
    for (size_t k = 0; k < count; k++) {
        cp_replication_row *row = &v->plan.replication[k];
        row->variant = k % VARIANTS;
        row->scenario = k / VARIANTS % SCENARIOS;
        row->number = k / VARIANTS / SCENARIOS;
        row->seed = row->number + 1;
        row->id =
            cp_replication_row_id(SCENARIO[row->scenario], VARIANT[row->variant], "", row->seed);
        snprintf(row->configuration_hash, sizeof row->configuration_hash, "volume");
    }
}

// ---- measuring -----------------------------------------------------------------------------

static cp_status count_row(void *context, const cp_row *row, cp_error *error)
{
    (void)row;
    (void)error;
    ++*(size_t *)context;
    return CP_OK;
}

// Processor time and time on the wall: on an idle machine they are the same, as one thread answers
// and nothing is read from the disk.
typedef struct taken {
    double cpu_s;
    double wall_s;
} taken;

static double cpu_now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// The best of three, as a warm cache gives it.
static taken time_of(cp_store *store, const char *sql)
{
    taken best = {INFINITY, INFINITY};
    for (int repeat = 0; repeat < 3; repeat++) {
        cp_error error = {0};
        size_t rows = 0;
        cp_query_handler handler = {.row = count_row, .context = &rows};
        double wall_s = cp_clock_s(), cpu_s = cpu_now_s();
        check(cp_query(store, sql, NULL, 0, &handler, &error), &error);
        best.cpu_s = fmin(best.cpu_s, cpu_now_s() - cpu_s);
        best.wall_s = fmin(best.wall_s, cp_clock_s() - wall_s);
    }
    return best;
}

static const struct {
    const char *what;
    const char *sql;
    double bar_s; /* at 10^6 crashes; NAN: none */
} QUERY[] = {
    {"one scan of crash_vehicle", "SELECT sum(olc_g) FROM crash_vehicle NOT INDEXED", NAN},
    {"counts and means by variant",
     "SELECT variant_id, count(*), avg(olc_g) FROM crash_vehicle WHERE olc_status IN ('value', "
     "'no_deceleration', 'beyond_0_5_s') GROUP BY variant_id",
     0.3},
    {"view olc_by_variant (plain SQL median)", "SELECT * FROM olc_by_variant", 3.0},
    {"quantile() by variant",
     "SELECT variant_id, quantile(olc_g, 0.9, olc_g IS NULL) FROM crash_vehicle WHERE olc_status "
     "IN "
     "('value', 'no_deceleration', 'beyond_0_5_s') GROUP BY variant_id",
     2.0},
    {"view olc_by_scenario", "SELECT * FROM olc_by_scenario", NAN},
    {"view crash_rate_by_variant", "SELECT * FROM crash_rate_by_variant", NAN},
    {"view crash_type_by_variant", "SELECT * FROM crash_type_by_variant", NAN},
    {"twenty worst",
     "SELECT crash_id, role, olc_g FROM crash_vehicle WHERE olc_status IN ('value', "
     "'no_deceleration', 'beyond_0_5_s') ORDER BY olc_g DESC LIMIT 20",
     NAN},
    {"pulse_samples of one crash", "SELECT * FROM pulse_samples((SELECT max(id) FROM crash), 'a')",
     NAN},
    {"whether the file is damaged (quick_check)", "PRAGMA quick_check(1)", NAN},
};
enum { QUERIES = sizeof QUERY / sizeof *QUERY, SIZES = 3 };

// What was seen at one size.
typedef struct measurement {
    size_t crashes;
    double file_mb;
    double commits_per_s; /* crashes a second, since the size before */
    double packs_per_s;
    taken query[QUERIES];
} measurement;

static double megabytes(const char *path)
{
    struct stat entry;
    return stat(path, &entry) == 0 ? (double)entry.st_size / 1e6 : 0.0;
}

static void measure(const char *path, const char *extension, volume *v, size_t before,
                    measurement *m)
{
    cp_error error = {0};
    cp_store *store = NULL;
    double added = (double)(v->crashes - before);
    // Closing the last connection has put the log into the file.
    check(cp_store_open(path, CP_STORE_READ, &store, &error), &error);
    check(cp_store_load_extension(store, extension, &error), &error);
    *m = (measurement){.crashes = v->crashes,
                       .file_mb = megabytes(path),
                       .commits_per_s = added / v->commit_s,
                       .packs_per_s = added / v->pack_s};
    v->commit_s = v->pack_s = 0.0;
    for (size_t k = 0; k < QUERIES; k++)
        m->query[k] = time_of(store, QUERY[k].sql);
    cp_store_close(store);
}

// ---- the table -----------------------------------------------------------------------------

static const double BAR_MB = 2500.0;

static void print_line(FILE *file, const char *what, const measurement *m, size_t count,
                       double (*value)(const measurement *), const char *format)
{
    fprintf(file, "| %s |", what);
    for (size_t k = 0; k < count; k++) {
        fputc(' ', file);
        fprintf(file, format, value(&m[k]));
        fputs(" |", file);
    }
}

static double crashes_of(const measurement *m)
{
    return (double)m->crashes;
}

static double megabytes_of(const measurement *m)
{
    return m->file_mb;
}

static double bytes_of(const measurement *m)
{
    return 1e6 * m->file_mb / (double)m->crashes;
}

static double commits_of(const measurement *m)
{
    return m->commits_per_s;
}

static double packs_of(const measurement *m)
{
    return m->packs_per_s;
}

// A bar holds at a million crashes; whether it was kept.
static bool print_bar(FILE *file, const measurement *last, double value, double bar,
                      const char *unit)
{
    if (isnan(bar)) {
        fputs(" |\n", file);
        return true;
    }
    bool full = last->crashes >= 1000000;
    fprintf(file, " %g %s: %s |\n", bar, unit,
            !full         ? "not reached"
            : value < bar ? "kept"
                          : "MISSED");
    return !full || value < bar;
}

static bool print_table(FILE *file, const measurement *m, size_t count, size_t runs)
{
    const measurement *last = &m[count - 1];
    bool good = true;
    fprintf(file,
            "# How the database grows\n\n"
            "Made by `cmake --build build --target bench_volume_million`: crashes whose pulses are "
            "those of %zu distinct\nsurrogate runs, with noise of the sensor's resolution on each, "
            "in replications of %d crashes. Queries:\nprocessor time, in brackets on the wall, the "
            "best of three; bars are for the time on the wall at\n10^6 crashes.\n\n",
            runs, CRASHES_A_REPLICATION);
    print_line(file, "crashes", m, count, crashes_of, "%.0f");
    fputs(" bar |\n|---|", file);
    for (size_t k = 0; k < count; k++)
        fputs("---:|", file);
    fputs("---|\n", file);
    print_line(file, "file, MB", m, count, megabytes_of, "%.0f");
    good &= print_bar(file, last, last->file_mb, BAR_MB, "MB");
    print_line(file, "bytes a crash", m, count, bytes_of, "%.0f");
    print_bar(file, last, 0, NAN, "");
    print_line(file, "crashes/s into the database, one writer", m, count, commits_of, "%.0f");
    print_bar(file, last, 0, NAN, "");
    print_line(file, "crashes/s packed, all processors", m, count, packs_of, "%.0f");
    print_bar(file, last, 0, NAN, "");
    for (size_t k = 0; k < QUERIES; k++) {
        fprintf(file, "| %s, s |", QUERY[k].what);
        for (size_t size = 0; size < count; size++)
            fprintf(file, " %.3f (%.3f) |", m[size].query[k].cpu_s, m[size].query[k].wall_s);
        good &= print_bar(file, last, last->query[k].wall_s, QUERY[k].bar_s, "s");
    }
    fflush(file);
    return good;
}

int main(int argc, char **argv)
{
    cp_error error = {0};
    if (argc < 3) {
        fprintf(stderr, "usage: bench_volume DATABASE EXTENSION [CRASHES [RUNS [TABLE.md]]]\n");
        return 2;
    }
    setvbuf(stdout, NULL, _IOLBF, 0);
    size_t crashes = argc > 3 ? strtoull(argv[3], NULL, 10) : 1000000;
    volume v = {.run_count = argc > 4 ? strtoull(argv[4], NULL, 10) : 10000};
    cp_vehicle_model car = cp_vehicle_model_default();
    check(cp_crash_library_begin(&error), &error);
    run *runs = calloc(v.run_count, sizeof *runs);
    double started_s = cp_clock_s();
    for (size_t k = 0; k < v.run_count; k++)
        make_run(&car, k, &runs[k]);
    printf("%zu surrogate runs in %.0f s\n", v.run_count, cp_clock_s() - started_s);
    v.runs = runs;

    cp_scenario_row scenario[SCENARIOS];
    cp_variant_row variant[VARIANTS];
    cp_vehicle_model_row model;
    make_plan(&v, crashes, scenario, variant, &model);
    cp_store *store = NULL;
    check(cp_store_open(argv[1], CP_STORE_CREATE, &store, &error), &error);
    check(cp_plan_rows_write(store, &v.plan, &error), &error);
    measurement seen[SIZES];
    size_t sizes = 0, before = 0;
    bool good = true;
    for (size_t next = crashes < 10000 ? crashes : 10000; v.crashes < crashes && sizes < SIZES;
         next *= 10) {
        while (v.crashes < next && v.crashes < crashes)
            add_replication(store, &v);
        cp_store_close(store);
        measure(argv[1], argv[2], &v, before, &seen[sizes++]);
        before = v.crashes;
        good = print_table(stdout, seen, sizes, v.run_count);
        check(cp_store_open(argv[1], CP_STORE_WRITE, &store, &error), &error);
    }
    FILE *table = argc > 5 ? fopen(argv[5], "w") : NULL;
    if (argc > 5 &&
        (table == NULL || (print_table(table, seen, sizes, v.run_count), fclose(table) != 0)))
        crash_builder_stop(&(cp_error){.text = "the table cannot be written"});
    cp_store_close(store);
    for (size_t k = 0; k < v.run_count; k++)
        for (int role = 0; role < 2; role++)
            cp_pulse_destroy(&runs[k].record[role]);
    free(runs);
    free(v.plan.replication);
    cp_crash_library_end();
    return good ? 0 : 1;
}
