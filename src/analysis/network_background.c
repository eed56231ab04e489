/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/network_background.h"

#include "core/array.h"
#include "core/memory_stream.h"
#include "core/safe_text.h"
#include "stats/rates.h"
#include "store/query.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Up to this share of the baseline's crashes is no matter.
#define NEGLIGIBLE_1 0.05

// Columns of what is read.
enum {
    SCENARIO,
    RUNS,
    CRASHES,
    OTHER,
    REASONS,
    HOURS,
    KM,
    EXPECTED,
    EXPECTED_FRONTAL,
    BASELINE,
    BASELINE_FRONTAL,
    FRONTAL,
    SCALE,
    COLUMNS
};

static const char SQL[] =
    "SELECT scenario, runs, crashes, other_contacts, "
    "(SELECT group_concat(reason || ' ' || contacts, ', ') FROM (SELECT reason, sum(contacts) AS "
    "contacts FROM background_by_reason AS r WHERE r.scenario_id = b.scenario_id AND reason <> "
    "'crash' GROUP BY reason ORDER BY contacts DESC, reason)), "
    "vehicle_h, vehicle_km, expected_crashes, expected_frontal_crashes, baseline_crashes, "
    "baseline_frontal_crashes, frontal_crashes, scale_1 FROM background_by_scenario AS b WHERE ?1 "
    "IS "
    "NULL OR "
    "scenario = ?1";

static const char *plural(double count)
{
    return count == 1.0 ? "" : "s";
}

static char *text_of(const cp_cell *cell)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = cp_memory_stream(&text, &size);
    if (!out)
        return NULL;
    double crashes = cell[CRASHES].real, other = cell[OTHER].real;
    fprintf(out, "%.0f crash%s", crashes, crashes == 1.0 ? "" : "es");
    if (other > 0)
        fprintf(out, " and %.0f other contact%s (%s)", other, plural(other), cell[REASONS].text);
    // An earlier version did not keep the hours.
    if (cell[HOURS].type != CP_CELL_NULL)
        fprintf(out, " in %.1f vehicle-hours", cell[HOURS].real);
    else
        fprintf(out, " in %.1f vehicle-km", cell[KM].real);
    int failed = ferror(out);
    if (fclose(out) != 0 || failed) {
        free(text);
        return NULL;
    }
    return text;
}

/* Shares of the baseline's crashes. */
typedef struct judgement {
    double upper; /* crashes of the baseline's exposure that the networks' own doing may be */
    double upper_frontal; /* likewise */
    bool is_negligible;
    bool is_too_short; /* what was found would be little, but it may be more */
} judgement;

// Few crashes in few hours clear nobody: what counts is how many there may be, by the upper bound
// of the exact 95 % interval of a Poisson count.
static judgement judge(const cp_cell *cell)
{
    double crashes = cell[CRASHES].real, frontal = cell[FRONTAL].real;
    double baseline = cell[BASELINE].real, baseline_frontal = cell[BASELINE_FRONTAL].real;
    bool is_comparable = cell[SCALE].type != CP_CELL_NULL && baseline > 0.0;
    if (!is_comparable)
        return (judgement){.is_negligible = crashes == 0.0};
    judgement found = {.upper = cp_rate_garwood(crashes, 0.95).high * cell[SCALE].real,
                       .upper_frontal = cp_rate_garwood(frontal, 0.95).high * cell[SCALE].real};
    found.is_negligible =
        found.upper <= NEGLIGIBLE_1 * baseline &&
        (baseline_frontal == 0.0 || found.upper_frontal <= NEGLIGIBLE_1 * baseline_frontal);
    found.is_too_short = !found.is_negligible && cell[EXPECTED].real <= NEGLIGIBLE_1 * baseline &&
                         cell[EXPECTED_FRONTAL].real <= NEGLIGIBLE_1 * baseline_frontal;
    return found;
}

static char *warning_of(const cp_cell *cell, const judgement *judged)
{
    char text[640];
    double baseline = cell[BASELINE].real, frontal = cell[BASELINE_FRONTAL].real;
    if (cell[EXPECTED].type == CP_CELL_NULL || baseline == 0.0)
        snprintf(text, sizeof text, "in %.200s cars crash without any driver error",
                 cell[SCENARIO].text);
    else if (judged->is_too_short)
        snprintf(
            text, sizeof text,
            "in %.200s up to %.2g of the baseline's %.0f crash%s (frontal: %.2g of %.0f) may be "
            "the network's doing, not the drivers': what was simulated without driver errors is "
            "too short to tell (95 %%), some %.2g times as much without another crash would "
            "(background: duration_s)",
            cell[SCENARIO].text, fmin(judged->upper, baseline), baseline,
            baseline == 1.0 ? "" : "es", fmin(judged->upper_frontal, frontal), frontal,
            fmax(judged->upper / baseline, frontal > 0.0 ? judged->upper_frontal / frontal : 0.0) /
                NEGLIGIBLE_1);
    else
        snprintf(
            text, sizeof text,
            "in %.200s some %.2g of the baseline's %.0f crash%s (frontal: %.2g of %.0f) are the "
            "network's doing, not the drivers'",
            cell[SCENARIO].text, cell[EXPECTED].real, baseline, baseline == 1.0 ? "" : "es",
            cell[EXPECTED_FRONTAL].real, frontal);
    return strdup(text);
}

// A made text with what names brought along made plain. Takes text; NULL without memory.
static char *plain(char *text)
{
    char *copy = text != NULL ? cp_text_copy_plain(text) : NULL;
    free(text);
    return copy;
}

static cp_status read_row(void *context, const cp_row *row, cp_error *error)
{
    cp_network_backgrounds *backgrounds = context;
    const cp_cell *cell = row->cell;
    cp_network_background *added = cp_array_add(backgrounds->row, backgrounds->count);
    if (!added)
        return cp_fail_memory(error, "backgrounds");
    *added = (cp_network_background){.scenario = cp_text_copy_plain(cell[SCENARIO].text),
                                     .is_known = cell[RUNS].integer > 0};
    if (!added->scenario)
        return cp_fail_memory(error, "backgrounds");
    if (!added->is_known)
        return CP_OK;
    backgrounds->known++;
    judgement judged = judge(cell);
    added->is_negligible = judged.is_negligible;
    added->text = plain(text_of(cell));
    if (!added->is_negligible)
        added->warning = plain(warning_of(cell, &judged));
    bool good = added->text && (added->is_negligible || added->warning);
    return good ? CP_OK : cp_fail_memory(error, "backgrounds");
}

cp_status cp_network_backgrounds_read(cp_store *store, const char *scenario,
                                      cp_network_backgrounds *backgrounds, cp_error *error)
{
    double assessments = 0.0;
    *backgrounds = (cp_network_backgrounds){0};
    cp_cell parameter = scenario ? cp_cell_text(scenario) : (cp_cell){.type = CP_CELL_NULL};
    cp_query_handler handler = {.row = read_row, .context = backgrounds};
    cp_status status = cp_query_number(
        store, "SELECT count(*) FROM study WHERE design = 'assessment'", &assessments, error);
    backgrounds->is_assessment = assessments > 0.0;
    return status == CP_OK ? cp_query(store, SQL, &parameter, 1, &handler, error) : status;
}

void cp_network_backgrounds_destroy(cp_network_backgrounds *backgrounds)
{
    for (size_t k = 0; k < backgrounds->count; k++) {
        free(backgrounds->row[k].scenario);
        free(backgrounds->row[k].text);
        free(backgrounds->row[k].warning);
    }
    free(backgrounds->row);
    *backgrounds = (cp_network_backgrounds){0};
}

static void write_paragraph(const cp_network_backgrounds *backgrounds, FILE *out)
{
    if (backgrounds->is_assessment || backgrounds->count == 0)
        return;
    if (backgrounds->known == 0) {
        fputs("What crashes the networks give without any driver error is not known: no background "
              "was simulated.",
              out);
        return;
    }
    fputs("Without driver errors or functions the networks themselves gave: ", out);
    for (size_t k = 0; k < backgrounds->count; k++) {
        const cp_network_background *row = &backgrounds->row[k];
        fprintf(out, "%s%s %s", k ? "; " : "", row->scenario,
                row->is_known ? row->text : "not simulated yet");
    }
    fputc('.', out);
    for (size_t k = 0; k < backgrounds->count; k++)
        if (backgrounds->row[k].warning)
            fprintf(out, " Warning: %s.", backgrounds->row[k].warning);
}

cp_status cp_network_backgrounds_paragraph(const cp_network_backgrounds *backgrounds,
                                           char **paragraph, cp_error *error)
{
    size_t size = 0;
    *paragraph = NULL;
    FILE *out = cp_memory_stream(paragraph, &size);
    if (!out)
        return cp_fail_memory(error, "backgrounds");
    write_paragraph(backgrounds, out);
    int failed = ferror(out);
    if (fclose(out) == 0 && !failed)
        return CP_OK;
    free(*paragraph);
    *paragraph = NULL;
    return cp_fail_memory(error, "backgrounds");
}

json_t *cp_network_backgrounds_json(const cp_network_backgrounds *backgrounds)
{
    json_t *list = json_array();
    for (size_t k = 0; k < backgrounds->count && !backgrounds->is_assessment; k++) {
        const cp_network_background *row = &backgrounds->row[k];
        if (json_array_append_new(
                list, json_pack("{s:s, s:b, s:o, s:s?, s:s?}", "scenario", row->scenario,
                                "is_known", row->is_known, "is_negligible",
                                row->is_known ? json_boolean(row->is_negligible) : json_null(),
                                "text", row->text, "warning", row->warning)) != 0) {
            json_decref(list);
            return NULL;
        }
    }
    return list;
}
