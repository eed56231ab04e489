/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/crash_samples.h"

#include "cli/crash_output.h"
#include "core/units.h"
#include "crash/parameter_scatter.h"
#include "stats/describe.h"

#include <math.h>
#include <stdlib.h>

static const char *const QUANTITY[CP_SAMPLED_COUNT] = {
#define CP_SAMPLED_TEXT(name, text, label) text,
    CP_SAMPLED_QUANTITIES(CP_SAMPLED_TEXT)
#undef CP_SAMPLED_TEXT
};
static const char *const LABEL[CP_SAMPLED_COUNT] = {
#define CP_SAMPLED_LABEL(name, text, label) label,
    CP_SAMPLED_QUANTITIES(CP_SAMPLED_LABEL)
#undef CP_SAMPLED_LABEL
};
static const char *const ROLE[2] = {"a", "b"};

// Value of a run: finite, -INFINITY when left-censored, NAN when it does not exist.
static double quantity_of(const cp_crash_run *run, int role, cp_sampled_quantity quantity)
{
    const cp_severity *severity = &run->result.severity[role];
    if (quantity == CP_SAMPLED_DELTA_V)
        return cp_km_h_from_m_s(severity->delta_v_m_s);
    if (quantity == CP_SAMPLED_PEAK)
        return severity->peak_g;
    if (run->configuration.side[role] != CP_SIDE_FRONT)
        return NAN;
    return severity->olc.status == CP_OLC_VALUE ? severity->olc.olc_g : -(double)INFINITY;
}

// ---- drawing -----------------------------------------------------------------------------------

static cp_status expect_scatter(const cp_crash_run *nominal, const char *const path[2],
                                cp_error *error)
{
    for (int c = 0; c < nominal->result.vehicle_count; c++)
        if (cp_parameter_scatter_count(nominal->model[c]) > 0)
            return CP_OK;
    return cp_fail(error, CP_BAD_INPUT,
                   "%s%s%s: no parameter has scatter, so all samples would be the same crash; give "
                   "some a relative standard deviation, as in "
                   "'- {name: mass_kg, value: %g, scatter: 0.03}'",
                   path[0], nominal->model[1] ? " and " : "", nominal->model[1] ? path[1] : "",
                   nominal->model[0]->mass_kg);
}

static cp_status allocate(cp_crash_samples *samples, int vehicle_count, cp_error *error)
{
    for (int c = 0; c < vehicle_count; c++) {
        for (int q = 0; q < CP_SAMPLED_COUNT; q++) {
            samples->value[c][q] = calloc(samples->asked_for, sizeof(double));
            if (samples->value[c][q] == NULL)
                return cp_fail_memory(error, "crash samples");
        }
    }
    return CP_OK;
}

static void keep(cp_crash_samples *samples, const cp_crash_run *run)
{
    for (int c = 0; c < run->result.vehicle_count; c++) {
        for (int q = 0; q < CP_SAMPLED_COUNT; q++) {
            double value = quantity_of(run, c, (cp_sampled_quantity)q);
            if (!isnan(value))
                samples->value[c][q][samples->count[c][q]++] = value;
        }
    }
}

// Sample number k: both cars drawn, the configuration made anew for their outlines.
static cp_status crash_sample(const cp_crash_request *request, const cp_crash_run *nominal,
                              uint64_t k, cp_crash_samples *samples, cp_error *error)
{
    cp_vehicle_model drawn[2];
    cp_crash_run run = {.model = {&drawn[0], nominal->model[1] ? &drawn[1] : NULL}};
    cp_rng_key key = cp_rng_key_text(cp_rng_key_seed(samples->seed), "parameter_scatter");
    for (int c = 0; c < nominal->result.vehicle_count; c++) {
        size_t redrawn = 0;
        cp_status status = cp_parameter_scatter_draw(
            nominal->model[c], cp_rng_key_text(key, ROLE[c]), k, &drawn[c], &redrawn, error);
        if (status != CP_OK)
            return status;
        samples->redrawn += redrawn;
    }

    // Near the edge of what touches, narrow cars may pass each other.
    cp_error passed = {0};
    cp_status status = cp_crash_run_simulate(request, &run, NULL, &passed);
    if (status == CP_OK)
        keep(samples, &run);
    else if (run.missed)
        samples->missed++;
    cp_crash_result_destroy(&run.result);
    if (status == CP_OK || run.missed)
        return CP_OK;
    return cp_fail(error, status, "sample %llu: %s", (unsigned long long)k, passed.text);
}

cp_status cp_crash_samples_run(const cp_crash_request *request, const cp_crash_run *nominal,
                               const char *const path[2], size_t count, uint64_t seed,
                               cp_crash_samples *samples, cp_error *error)
{
    *samples = (cp_crash_samples){.asked_for = count, .seed = seed};
    cp_status status = expect_scatter(nominal, path, error);
    if (status == CP_OK)
        status = allocate(samples, nominal->result.vehicle_count, error);
    for (uint64_t k = 0; status == CP_OK && k < count; k++)
        status = crash_sample(request, nominal, k, samples, error);
    return status;
}

void cp_crash_samples_destroy(cp_crash_samples *samples)
{
    for (int c = 0; c < 2; c++)
        for (int q = 0; q < CP_SAMPLED_COUNT; q++)
            free(samples->value[c][q]);
    *samples = (cp_crash_samples){0};
}

// ---- printing ----------------------------------------------------------------------------------

// One quantity of one vehicle.
typedef struct summary {
    double nominal; /* as quantity_of gives it */
    size_t count;
    size_t censored;
    cp_estimate low; /* 5 % */
    cp_estimate median;
    cp_estimate high; /* 95 % */
} summary;

static cp_status summarise(const cp_crash_samples *samples, const cp_crash_run *nominal, int role,
                           cp_sampled_quantity quantity, summary *s, cp_error *error)
{
    size_t count = samples->count[role][quantity];
    size_t *cluster = calloc(count + 1, sizeof *cluster);
    if (cluster == NULL)
        return cp_fail_memory(error, "crash samples");
    cp_sample sample = {0};
    cp_status status =
        cp_sample_create(samples->value[role][quantity], cluster, count, 1, &sample, error);
    if (status == CP_OK) {
        s->nominal = quantity_of(nominal, role, quantity);
        s->count = count;
        s->censored = cp_sample_censored(&sample);
        s->low = cp_describe_quantile(&sample, 0.05);
        s->median = cp_describe_quantile(&sample, 0.5);
        s->high = cp_describe_quantile(&sample, 0.95);
    }
    cp_sample_destroy(&sample);
    free(cluster);
    return status;
}

static const char *relation_text(cp_relation relation)
{
    return relation == CP_LESS_THAN ? "<" : relation == CP_MORE_THAN ? ">" : "=";
}

static json_t *estimate_json(cp_estimate estimate)
{
    if (estimate.relation == CP_NO_VALUE)
        return json_null();
    return json_pack("{s:s, s:f}", "relation", relation_text(estimate.relation), "value",
                     estimate.value);
}

static json_t *quantity_json(const summary *s)
{
    double censored_1 = s->count > 0 ? (double)s->censored / (double)s->count : 0.0;
    return json_pack("{s:o, s:I, s:I, s:f, s:o, s:o, s:o}", "nominal",
                     isfinite(s->nominal) ? json_real(s->nominal) : json_null(), "count",
                     (json_int_t)s->count, "censored", (json_int_t)s->censored, "censored_1",
                     censored_1, "q05", estimate_json(s->low), "median", estimate_json(s->median),
                     "q95", estimate_json(s->high));
}

static json_t *scatter_json(const cp_vehicle_model *model)
{
    json_t *scatter = json_object();
    for (size_t k = 0; k < CP_VEHICLE_PARAMETER_COUNT; k++)
        if (model->scatter_1[k] > 0.0)
            json_object_set_new(scatter, CP_VEHICLE_PARAMETER[k].name,
                                json_real(model->scatter_1[k]));
    return scatter;
}

static cp_status print_json(const cp_crash_samples *samples, const cp_crash_run *nominal,
                            FILE *file, cp_error *error)
{
    json_t *vehicles = json_array();
    cp_status status = CP_OK;
    for (int c = 0; status == CP_OK && c < nominal->result.vehicle_count; c++) {
        json_t *quantities = json_object();
        for (int q = 0; status == CP_OK && q < CP_SAMPLED_COUNT; q++) {
            summary s;
            status = summarise(samples, nominal, c, (cp_sampled_quantity)q, &s, error);
            if (status == CP_OK)
                json_object_set_new(quantities, QUANTITY[q], quantity_json(&s));
        }
        json_array_append_new(vehicles,
                              json_pack("{s:s, s:s, s:o, s:o}", "role", ROLE[c], "name",
                                        nominal->model[c]->name, "scatter",
                                        scatter_json(nominal->model[c]), "quantities", quantities));
    }
    if (status != CP_OK) {
        json_decref(vehicles);
        return status;
    }
    json_t *all = json_pack(
        "{s:o, s:I, s:I, s:I, s:I, s:o}", "configuration", cp_crash_configuration_json(nominal),
        "samples", (json_int_t)samples->asked_for, "seed", (json_int_t)samples->seed, "missed",
        (json_int_t)samples->missed, "redrawn", (json_int_t)samples->redrawn, "vehicles", vehicles);
    return cp_json_print(all, file, error);
}

static void estimate_cells(cp_table *table, cp_estimate estimate)
{
    cp_table_text(table, estimate.relation == CP_NO_VALUE ? "" : relation_text(estimate.relation));
    cp_table_real(table, estimate.value);
}

static cp_status print_csv(const cp_crash_samples *samples, const cp_crash_run *nominal, FILE *file,
                           cp_error *error)
{
    static const char *const COLUMN[] = {
        "role",         "name", "quantity",        "nominal", "count",        "censored",
        "q05_relation", "q05",  "median_relation", "median",  "q95_relation", "q95"};
    cp_table table;
    cp_table_begin(&table, COLUMN, sizeof COLUMN / sizeof *COLUMN);
    cp_status status = CP_OK;
    for (int c = 0; c < nominal->result.vehicle_count; c++) {
        for (int q = 0; status == CP_OK && q < CP_SAMPLED_COUNT; q++) {
            summary s = {0};
            status = summarise(samples, nominal, c, (cp_sampled_quantity)q, &s, error);
            cp_table_text(&table, ROLE[c]);
            cp_table_text(&table, nominal->model[c]->name);
            cp_table_text(&table, QUANTITY[q]);
            cp_table_real(&table, s.nominal);
            cp_table_integer(&table, (int64_t)s.count);
            cp_table_integer(&table, (int64_t)s.censored);
            estimate_cells(&table, s.low);
            estimate_cells(&table, s.median);
            estimate_cells(&table, s.high);
        }
    }
    if (status == CP_OK)
        status = cp_table_print(&table, CP_FORMAT_CSV, file, error);
    cp_table_destroy(&table);
    return status;
}

static void estimate_text(cp_table *table, cp_estimate estimate)
{
    char text[48];
    const char *sign = estimate.relation == CP_EXACTLY ? "" : relation_text(estimate.relation);
    snprintf(text, sizeof text, "%s%.2f", sign, estimate.value);
    cp_table_text(table, estimate.relation == CP_NO_VALUE ? "-" : text);
}

static void table_row(cp_table *table, const cp_crash_run *nominal, int role,
                      cp_sampled_quantity quantity, const summary *s)
{
    char text[96];
    snprintf(text, sizeof text, "%s (%s)", ROLE[role], nominal->model[role]->name);
    cp_table_text(table, text);
    cp_table_text(table, LABEL[quantity]);
    snprintf(text, sizeof text, "%.2f", s->nominal);
    cp_table_text(table, isfinite(s->nominal) ? text : "-");
    estimate_text(table, s->low);
    estimate_text(table, s->median);
    estimate_text(table, s->high);
    snprintf(text, sizeof text, "%.1f %%", 100.0 * (double)s->censored / (double)s->count);
    cp_table_text(table, s->count > 0 ? text : "-");
}

static cp_status print_table(const cp_crash_samples *samples, const cp_crash_run *nominal,
                             FILE *file, cp_error *error)
{
    static const char *const COLUMN[] = {"vehicle", "quantity", "nominal", "5 %",
                                         "median",  "95 %",     "censored"};
    cp_crash_print_configuration(nominal, file);
    fprintf(file, "%zu samples, seed %llu; parameters with scatter: ", samples->asked_for,
            (unsigned long long)samples->seed);
    for (int c = 0; c < nominal->result.vehicle_count; c++)
        fprintf(file, "%s%zu of %s", c > 0 ? ", " : "",
                cp_parameter_scatter_count(nominal->model[c]), ROLE[c]);
    fputs("\n\n", file);

    cp_table table;
    cp_table_begin(&table, COLUMN, sizeof COLUMN / sizeof *COLUMN);
    table.right_from = 2;
    cp_status status = CP_OK;
    for (int c = 0; c < nominal->result.vehicle_count; c++) {
        for (int q = 0; status == CP_OK && q < CP_SAMPLED_COUNT; q++) {
            summary s = {0};
            status = summarise(samples, nominal, c, (cp_sampled_quantity)q, &s, error);
            table_row(&table, nominal, c, (cp_sampled_quantity)q, &s);
        }
    }
    if (status == CP_OK)
        status = cp_table_print(&table, CP_FORMAT_TABLE, file, error);
    cp_table_destroy(&table);
    if (status == CP_OK && samples->missed > 0)
        fprintf(file, "\n%zu samples missed each other and are not counted.\n", samples->missed);
    return status;
}

cp_status cp_crash_samples_print(const cp_crash_samples *samples, const cp_crash_run *nominal,
                                 cp_format format, FILE *file, cp_error *error)
{
    if (format == CP_FORMAT_JSON)
        return print_json(samples, nominal, file, error);
    return format == CP_FORMAT_CSV ? print_csv(samples, nominal, file, error)
                                   : print_table(samples, nominal, file, error);
}
