/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/file.h"
#include "run/runner.h"
#include "store/query.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

/* What a counterfactual costs against re-running the replication it belongs to. The same traffic
 * three times: without pairs, with one treatment, with five. The difference of the last two is what
 * four more branches a crash cost; what the second costs more than the first is the checkpoints,
 * the null treatment and one treatment. Last, all that pairs cost, shared among the branches.
 * Processor time of the workers with all their checkpoints and branches, so that other work on the
 * machine counts little; the three by turns, of each the least of several runs where one is short,
 * so that it counts less. Names of scenarios choose some of them. */

static const char HEAD[] = "study: bench\n"
                           "design: %s\n"
                           "seed: 20261124\n"
                           "replications: 1\n"
                           "duration_s: %d\n"
                           "background: {duration_s: 0}\n"
                           "vehicles: {default: %s/db/vehicles/honda_accord_2014.yaml}\n"
                           "scenarios:\n"
                           "  - name: traffic\n"
                           "    sumocfg: %s/sumo_scenarios/%s/%s.sumocfg\n"
                           "    driver_errors:\n"
                           "%s"
                           "variants:\n"
                           "  - name: baseline\n";

typedef struct traffic {
    const char *scenario;
    int duration_s;
    int repeats;
    const char *errors;
} traffic;

static const traffic TRAFFIC[] = {
    {"left_turn", 900, 15, "      - {model: failed_to_see, parameters: {probability_1: 0.3}}\n"},
    {"head_on_overtaking", 900, 5,
     "      - {model: risky_overtaking, parameters: {probability_1: 0.5}}\n"},
    {"town", 450, 1,
     "      - {model: failed_to_see, parameters: {probability_1: 0.02}}\n"
     "      - {model: misjudged_gap, parameters: {probability_1: 0.02}}\n"
     "      - {model: late_braking, parameters: {rate_per_h: 10}}\n"},
};

typedef struct outcome {
    double cpu_s;
    double crashes;
    double branches;
} outcome;

static double number_of(const char *db, const char *sql)
{
    cp_store *store = NULL;
    cp_error error = {0};
    double value = 0.0;
    cp_status status = cp_store_open(db, CP_STORE_READ, &store, &error);
    if (status == CP_OK)
        status = cp_query_number(store, sql, &value, &error);
    cp_store_close(store);
    if (status != CP_OK) {
        fprintf(stderr, "%s\n", error.text);
        exit(1);
    }
    return value;
}

// Of all children that have ended, theirs included.
static double children_cpu_s(void)
{
    struct rusage usage;
    getrusage(RUSAGE_CHILDREN, &usage);
    return (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

// One replication of a scenario in a folder of its own.
static outcome run(const char *data, const char *worker, const traffic *what, int treatments)
{
    char folder[] = "/tmp/crashpulse-bench-XXXXXX", study[64], db[64], text[4096], command[128];
    cp_runner_summary summary;
    cp_error error = {0};
    if (mkdtemp(folder) == NULL)
        exit(1);
    snprintf(study, sizeof study, "%s/study.yaml", folder);
    snprintf(db, sizeof db, "%s/study.db", folder);
    int used =
        snprintf(text, sizeof text, HEAD, treatments > 0 ? "counterfactual" : "paired_seeds",
                 what->duration_s, data, data, what->scenario, what->scenario, what->errors);
    for (int k = 0; k < treatments; k++)
        used += snprintf(text + used, sizeof text - (size_t)used,
                         "  - {name: aeb%d, functions: [{function: aeb}]}\n", k);
    cp_runner_options options = {
        .study_path = study, .db_path = db, .jobs = 1, .worker_path = worker};
    cp_status status = cp_file_write(study, text, strlen(text), &error);
    double before_s = children_cpu_s();
    if (status == CP_OK)
        status = cp_runner_run(&options, &summary, &error);
    double cpu_s = children_cpu_s() - before_s;
    if (status != CP_OK) {
        fprintf(stderr, "%s\n", error.text);
        exit(1);
    }
    outcome found = {
        .cpu_s = cpu_s,
        .crashes = number_of(db, "SELECT count(*) FROM crash"),
        .branches = number_of(db, "SELECT (SELECT count(*) FROM counterfactual) + (SELECT count(*) "
                                  "FROM null_treatment)")};
    snprintf(command, sizeof command, "rm -r '%s'", folder);
    return system(command) == 0 ? found : (outcome){0};
}

// By turns without pairs, with one treatment and with five, several times.
static void run_least(const char *data, const char *worker, const traffic *what, outcome found[3])
{
    static const int TREATMENTS[] = {0, 1, 5};
    for (int repeat = 0; repeat < what->repeats; repeat++)
        for (int k = 0; k < 3; k++) {
            outcome now = run(data, worker, what, TREATMENTS[k]);
            if (repeat == 0 || now.cpu_s < found[k].cpu_s)
                found[k] = now;
        }
}

static bool is_wanted(const char *scenario, int count, char **names)
{
    for (int k = 0; k < count; k++)
        if (strcmp(names[k], scenario) == 0)
            return true;
    return count == 0;
}

int main(int argc, char **argv)
{
    if (argc < 3) {
        fprintf(stderr, "bench_counterfactual SOURCE_FOLDER WORKER [SCENARIO...]\n");
        return 2;
    }
    for (size_t k = 0; k < sizeof TRAFFIC / sizeof *TRAFFIC; k++) {
        const traffic *what = &TRAFFIC[k];
        if (!is_wanted(what->scenario, argc - 3, argv + 3))
            continue;
        outcome found[3];
        run_least(argv[1], argv[2], what, found);
        outcome plain = found[0], one = found[1], five = found[2];
        double branch_s = (five.cpu_s - one.cpu_s) / (five.branches - one.branches);
        printf("%s: replication %.2f s of processor time, %.0f crashes, the least of %d runs\n"
               "  a counterfactual: %.1f %% of re-running the replication (bar: 5 %%)\n"
               "  checkpoints: %.0f %% of the replication, whatever the number of branches\n"
               "  both, for each of the %.0f branches of one treatment: %.1f %%\n"
               "  both, for each of the %.0f branches of five treatments: %.1f %%\n",
               what->scenario, plain.cpu_s, plain.crashes, what->repeats,
               100.0 * branch_s / plain.cpu_s,
               100.0 * (one.cpu_s - plain.cpu_s - branch_s * one.branches) / plain.cpu_s,
               one.branches, 100.0 * (one.cpu_s - plain.cpu_s) / plain.cpu_s / one.branches,
               five.branches, 100.0 * (five.cpu_s - plain.cpu_s) / plain.cpu_s / five.branches);
        fflush(stdout);
    }
    return 0;
}
