/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/caveats.h"

#include "core/array.h"
#include "core/memory_stream.h"
#include "core/safe_text.h"
#include "store/query.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Sentences of scenario ?1 or all: a row each.
static const char *const SQL[] = {
    "SELECT 'in ' || scenario || ' ' || group_concat(failed || ' of ' || replications || "
    "' replications of ' || variant, ', ') || ' failed and are in no figure: what SUMO ended "
    "itself "
    "is not missing at random, drivers and functions lead there' FROM failed_replications WHERE ?1 "
    "IS NULL OR scenario = ?1 GROUP BY scenario HAVING sum(failed) > 0",

    "SELECT 'in ' || s.name || ' the traffic of ' || count(*) || ' replication' || iif(count(*) = "
    "1, "
    "'', 's') || ' was over before duration_s, ' || printf('%.0f', min(r.simulated_s)) || ' of ' "
    "|| "
    "printf('%.0f', t.duration_s - t.warmup_s) || ' s in the shortest: the demand ends there' FROM "
    "replication AS r JOIN scenario AS s ON s.id = r.scenario_id JOIN study AS t WHERE r.status = "
    "'done' AND t.design <> 'assessment' AND r.simulated_s < 0.99 * (t.duration_s - t.warmup_s) "
    "AND "
    "(?1 IS NULL OR s.name = ?1) GROUP BY s.id ORDER BY s.number",

    "SELECT 'in ' || scenario || ' the driver error ' || driver_error || ' never acted in ' || "
    "printf('%.1f', vehicle_h) || ' vehicle-hours of the baseline: the network gives it no "
    "occasion, "
    "or hardly any' FROM driver_error_activity WHERE acted = 0.0 AND vehicle_h > 0.0 AND (?1 IS "
    "NULL "
    "OR scenario = ?1)",

    "WITH one AS (SELECT * FROM flagged_sites WHERE ?1 IS NULL OR scenario = ?1) "
    "SELECT 'in ' || f.scenario || ' there lie within 20 m of where the network crashes without "
    "driver errors ' || group_concat(f.crashes_at_flagged || ' of the ' || f.crashes || ' crashes "
    "of "
    "' || f.variant || CASE WHEN f.is_baseline OR coalesce(b.crashes_per_million_km, 0) = 0 THEN "
    "'' "
    "ELSE ' (' || printf('%.2f', f.crashes_per_million_km / b.crashes_per_million_km) || ' times "
    "the baseline''s rate, without these ' || iif(b.crashes_per_million_km_without > 0, "
    "printf('%.2f', f.crashes_per_million_km_without / b.crashes_per_million_km_without), 'not "
    "known') || ')' END, ', ') || ' (compare --where \"at_flagged_site = 0\")' FROM one AS f JOIN "
    "one AS b ON b.scenario_id = f.scenario_id AND b.is_baseline GROUP BY f.scenario_id HAVING "
    "sum(f.crashes_at_flagged) > 0",
};

static cp_status read_row(void *context, const cp_row *row, cp_error *error)
{
    cp_caveats *caveats = context;
    char **sentence = cp_array_add(caveats->sentence, caveats->count);
    if (sentence == NULL)
        return cp_fail_memory(error, "caveats");
    *sentence = cp_text_copy_plain(row->cell[0].text);
    return *sentence != NULL ? CP_OK : cp_fail_memory(error, "caveats");
}

cp_status cp_caveats_read(cp_store *store, const char *scenario, cp_caveats *caveats,
                          cp_error *error)
{
    *caveats = (cp_caveats){0};
    cp_cell parameter = scenario ? cp_cell_text(scenario) : (cp_cell){.type = CP_CELL_NULL};
    cp_query_handler handler = {.row = read_row, .context = caveats};
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < sizeof SQL / sizeof *SQL; k++)
        status = cp_query(store, SQL[k], &parameter, 1, &handler, error);
    return status;
}

void cp_caveats_destroy(cp_caveats *caveats)
{
    for (size_t k = 0; k < caveats->count; k++)
        free(caveats->sentence[k]);
    free(caveats->sentence);
    *caveats = (cp_caveats){0};
}

char *cp_caveats_paragraph(const cp_caveats *caveats)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = cp_memory_stream(&text, &size);
    if (out == NULL)
        return NULL;
    for (size_t k = 0; k < caveats->count; k++)
        fprintf(out, "%s%s", k == 0 ? "Mind: " : "; ", caveats->sentence[k]);
    if (caveats->count > 0)
        fputc('.', out);
    int failed = ferror(out);
    if (fclose(out) == 0 && !failed)
        return text;
    free(text);
    return NULL;
}

json_t *cp_caveats_json(const cp_caveats *caveats)
{
    json_t *list = json_array();
    for (size_t k = 0; k < caveats->count; k++)
        if (json_array_append_new(list, json_string(caveats->sentence[k])) != 0) {
            json_decref(list);
            return NULL;
        }
    return list;
}
