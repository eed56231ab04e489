/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/study_data.h"

#include "analysis/query_json.h"
#include "analysis/study_places.h"
#include "analysis/study_risk.h"
#include "core/array.h"
#include "core/safe_text.h"
#include "store/query.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char ROWS[] = "the rows of a study";

static cp_status copy_text(const char *text, char **copy, cp_error *error)
{
    *copy = cp_text_copy_plain(text); // a name of several lines would break the words around it
    return *copy ? CP_OK : cp_fail_memory(error, "a name");
}

static cp_status copy_json(const char *text, json_t **value, cp_error *error)
{
    json_error_t place;
    *value = json_loads(text, JSON_DECODE_ANY, &place);
    return *value ? CP_OK : cp_fail(error, CP_STORE_FAILED, "stored JSON: %s", place.text);
}

static cp_status read_scenario(void *context, const cp_row *row, cp_error *error)
{
    cp_study_data *data = context;
    cp_study_scenario *scenario = cp_array_add(data->scenario, data->scenario_count);
    if (!scenario)
        return cp_fail_memory(error, ROWS);
    cp_status status = copy_text(row->cell[0].text, &scenario->name, error);
    return status == CP_OK ? copy_json(row->cell[1].text, &scenario->driver_errors, error) : status;
}

static cp_status read_variant(void *context, const cp_row *row, cp_error *error)
{
    cp_study_data *data = context;
    cp_study_variant *variant = cp_array_add(data->variant, data->variant_count);
    if (!variant)
        return cp_fail_memory(error, ROWS);
    variant->is_baseline = row->cell[1].integer != 0;
    cp_status status = copy_text(row->cell[0].text, &variant->name, error);
    return status == CP_OK ? copy_json(row->cell[2].text, &variant->functions, error) : status;
}

static cp_status read_replication(void *context, const cp_row *row, cp_error *error)
{
    cp_study_data *data = context;
    cp_study_replication *replication = cp_array_add(data->replication, data->replication_count);
    if (!replication)
        return cp_fail_memory(error, ROWS);
    *replication = (cp_study_replication){
        .scenario = (size_t)row->cell[0].integer,
        .variant = (size_t)row->cell[1].integer,
        .number = row->cell[2].integer,
        .seed = row->cell[3].integer,
        .vehicle_km = row->cell[4].real,
        .vehicle_h = row->cell[5].real,
    };
    return CP_OK;
}

static cp_status read_text(const cp_row *row, char ***texts, size_t *count, cp_error *error)
{
    char **text = cp_array_add(*texts, *count);
    return text ? copy_text(row->cell[0].text, text, error) : cp_fail_memory(error, ROWS);
}

static cp_status read_crash_type(void *context, const cp_row *row, cp_error *error)
{
    cp_study_data *data = context;
    return read_text(row, &data->crash_type, &data->crash_type_count, error);
}

static cp_status read_validity(void *context, const cp_row *row, cp_error *error)
{
    cp_study_data *data = context;
    return read_text(row, &data->validity, &data->validity_count, error);
}

static cp_status read_crash(void *context, const cp_row *row, cp_error *error)
{
    cp_study_data *data = context;
    cp_study_crash *crash = cp_array_add(data->crash, data->crash_count);
    if (!crash)
        return cp_fail_memory(error, ROWS);
    *crash = (cp_study_crash){
        .replication = (size_t)row->cell[0].integer,
        .crash_type = (size_t)row->cell[1].integer,
        .frontal = row->cell[2].integer != 0,
        .inside = row->cell[3].integer != 0,
        .id = row->cell[4].integer,
        .time_s = row->cell[5].real,
        .x_m = row->cell[6].real,
        .y_m = row->cell[7].real,
    };
    return CP_OK;
}

// A vehicle from the first cells of a row, of a crash as it happened or a treated one.
static cp_study_vehicle vehicle_of(const cp_row *row)
{
    cp_study_vehicle vehicle = {
        .crash = (size_t)row->cell[0].integer,
        .role = row->cell[1].text[0],
        .olc = (cp_olc_known)row->cell[2].integer,
        .olc_g = row->cell[3].real,
        .delta_v_m_s = row->cell[4].real,
        .closing_speed_m_s = row->cell[5].real,
        .lateral_offset_m = row->cell[6].real,
        .angle_rad = row->cell[7].real,
        .validity = (size_t)row->cell[8].integer,
        .frontal = row->cell[9].integer != 0,
    };
    for (int k = 0; k < CP_PREDICTOR_COUNT; k++)
        vehicle.predictor[k] = row->cell[10 + k].real;
    return vehicle;
}

static cp_status read_evidence(void *context, const cp_row *row, cp_error *error)
{
    cp_study_data *data = context;
    return read_text(row, &data->evidence, &data->evidence_count, error);
}

static cp_status read_vehicle(void *context, const cp_row *row, cp_error *error)
{
    cp_study_data *data = context;
    cp_study_vehicle *vehicle = cp_array_add(data->vehicle, data->vehicle_count);
    if (!vehicle)
        return cp_fail_memory(error, ROWS);
    *vehicle = vehicle_of(row);
    const cp_cell *evidence = &row->cell[10 + CP_PREDICTOR_COUNT];
    vehicle->class_error_g = evidence[1].real;
    while (evidence->type == CP_CELL_TEXT && vehicle->evidence + 1 < data->evidence_count &&
           strcmp(data->evidence[vehicle->evidence], evidence->text) != 0)
        vehicle->evidence++;
    data->frontal_vehicle_count += vehicle->frontal;
    return CP_OK;
}

static cp_status read_treated(void *context, const cp_row *row, cp_error *error)
{
    cp_study_data *data = context;
    cp_study_treated *treated = cp_array_add(data->treated, data->treated_count);
    if (!treated)
        return cp_fail_memory(error, ROWS);
    treated->vehicle = vehicle_of(row);
    treated->variant = (size_t)row->cell[10 + CP_PREDICTOR_COUNT].integer;
    treated->x_m = row->cell[11 + CP_PREDICTOR_COUNT].real;
    treated->y_m = row->cell[12 + CP_PREDICTOR_COUNT].real;
    return CP_OK;
}

static const char *const PREDICTOR_COLUMN[] = {
#define CP_PREDICTOR_COLUMN(name, column) column,
    CP_PREDICTORS(CP_PREDICTOR_COLUMN)
#undef CP_PREDICTOR_COLUMN
};

bool cp_predictor_is_speed(cp_predictor predictor)
{
    return strstr(PREDICTOR_COLUMN[predictor], "_m_s") != NULL;
}

static cp_status read_risk(void *context, const cp_row *row, cp_error *error)
{
    cp_study_data *data = context;
    cp_study_risk *risk = cp_array_add(data->risk, data->risk_count);
    if (!risk)
        return cp_fail_memory(error, ROWS);
    cp_status status = CP_OK;
    char **const text[] = {&risk->name, &risk->level, &risk->source, &risk->note};
    for (size_t k = 0; k < 4 && status == CP_OK; k++)
        status = copy_text(row->cell[k].text, text[k], error);
    if (status != CP_OK)
        return status;
    risk->predictor = CP_PREDICTOR_COUNT;
    for (int k = 0; k < CP_PREDICTOR_COUNT; k++)
        if (strcmp(row->cell[4].text, PREDICTOR_COLUMN[k]) == 0)
            risk->predictor = (cp_predictor)k;
    risk->frontal_only = row->cell[9].integer != 0;
    double coefficient[2] = {row->cell[7].real, row->cell[8].real};
    if (risk->predictor == CP_PREDICTOR_COUNT)
        status = cp_fail(error, CP_BAD_INPUT, "unknown predictor '%s'", row->cell[4].text);
    else
        status = cp_risk_function_create(row->cell[6].text, row->cell[5].text, coefficient, 2,
                                         &risk->function, error);
    const char *covariance = row->cell[11].type == CP_CELL_TEXT ? row->cell[11].text : NULL;
    if (status == CP_OK)
        status = cp_study_risk_terms(&risk->function, row->cell[10].text, error);
    if (status == CP_OK && covariance)
        status = cp_study_risk_covariance(&risk->function, covariance, row->cell[12].real, error);
    return status == CP_OK
               ? CP_OK
               : cp_error_prefix(error, "table risk_function, %s %s: ", risk->name, risk->level);
}

// What kind of crash the sides of its two vehicles make it; nothing without a front.
static void take_type(const char *side_a, const char *side_b, char type[16])
{
    bool of_a = strcmp(side_a, "front") == 0, of_b = strcmp(side_b, "front") == 0;
    const char *other = of_a ? side_b : side_a;
    type[0] = '\0';
    if (of_a || of_b)
        snprintf(type, 16, "front-%s",
                 strcmp(other, "front") == 0 || strcmp(other, "rear") == 0 ? other : "side");
}

static size_t index_of(const char *text, const char *const *of, size_t count)
{
    size_t k = 0;
    while (k < count && strcmp(text, of[k]) != 0)
        k++;
    return k;
}

static cp_status read_pair(void *context, const cp_row *row, cp_error *error)
{
    static const char *const OUTCOME[] = {
#define CP_OUTCOME_TEXT(name, text) text,
        CP_OUTCOMES(CP_OUTCOME_TEXT)
#undef CP_OUTCOME_TEXT
    };
    static const char *const REASON[] = {
#define CP_REASON_TEXT(name, text) text,
        CP_NULL_STATUSES(CP_REASON_TEXT)
#undef CP_REASON_TEXT
    };
    cp_study_data *data = context;
    cp_study_pair *pair = cp_array_add(data->pair, data->pair_count);
    if (!pair)
        return cp_fail_memory(error, ROWS);
    *pair = (cp_study_pair){
        .crash = (size_t)row->cell[0].integer,
        .variant = (size_t)row->cell[1].integer,
        .outcome =
            (cp_outcome)index_of(row->cell[2].text, OUTCOME, sizeof OUTCOME / sizeof *OUTCOME),
        .outcome_olc =
            (cp_outcome)index_of(row->cell[3].text, OUTCOME, sizeof OUTCOME / sizeof *OUTCOME),
        .reason = index_of(row->cell[4].text, REASON, sizeof REASON / sizeof *REASON),
        .new_crashes = row->cell[5].real,
        .vanished_crashes = row->cell[14 + 2 * CP_PREDICTOR_COUNT].real,
        .olc_g = {row->cell[6].real, row->cell[7].real},
        .closing_speed_m_s = {row->cell[8].real, row->cell[9].real},
        .treated_inside = {row->cell[10].integer != 0, row->cell[11].integer != 0},
        .treated_frontal = {strcmp(row->cell[12].text, "front") == 0,
                            strcmp(row->cell[13].text, "front") == 0},
    };
    take_type(row->cell[12].text, row->cell[13].text, pair->treated_type);
    for (int role = 0; role < 2; role++)
        for (int k = 0; k < CP_PREDICTOR_COUNT; k++)
            pair->predictor[role][k] = row->cell[14 + CP_PREDICTOR_COUNT * role + k].real;
    return CP_OK;
}

// What vehicle_of() reads behind the crash, of a vehicle w and its delta-v without rebound e;
// crash: who knows both vehicles' speed.
#define VEHICLE_CELLS(crash)                                                                       \
    "w.role, CASE w.olc_status WHEN 'value' THEN 0 WHEN 'simulation_failed' THEN 2 ELSE 1 END,"    \
    " w.olc_g, w.delta_v_m_s, " crash ".closing_speed_m_s, " crash ".lateral_offset_m, " crash     \
    ".angle_rad, o.place, w.frontal, w.delta_v_m_s, w.delta_v_x_m_s, " crash                       \
    ".closing_speed_m_s, w.max_50ms_g, w.asi_1, e.delta_v_without_rebound_m_s"

static const char VEHICLES[] = CP_STUDY_PLACES "SELECT c.place, " VEHICLE_CELLS(
    "c") ", w.evidence_class, w.class_error_g FROM crash_vehicle AS w JOIN c ON c.id = w.crash_id "
         "JOIN delta_v_without_rebound AS e"
         " ON e.crash_id = w.crash_id AND e.role = w.role JOIN o ON o.validity = w.validity"
         " ORDER BY c.place, w.role";

static const char TREATED[] = CP_STUDY_PLACES "SELECT c.place, " VEHICLE_CELLS(
    "p") ", v.place, p.x_m, p.y_m"
         " FROM counterfactual_vehicle AS w JOIN counterfactual AS p"
         " ON p.crash_id = w.crash_id AND p.variant_id = w.variant_id"
         " JOIN counterfactual_delta_v_without_rebound AS e"
         " ON e.crash_id = w.crash_id AND e.variant_id = w.variant_id AND e.role = w.role"
         " JOIN c ON c.id = w.crash_id JOIN o ON o.validity = w.validity"
         " JOIN v ON v.id = w.variant_id AND v.sweep = '' ORDER BY c.place, v.place, w.role";

static const char PAIRS[] = CP_STUDY_PLACES
    "SELECT c.place, v.place, p.outcome, p.outcome_olc, coalesce(p.reason, 'reproduced'),"
    " p.new_crashes, p.baseline_olc_g, p.treated_olc_g, p.baseline_closing_speed_m_s,"
    " CASE p.outcome WHEN 'avoided' THEN 0.0 ELSE p.treated_closing_speed_m_s END,"
    " a.validity = 'inside', b.validity = 'inside', coalesce(a.contact_side, ''),"
    " coalesce(b.contact_side, ''),"
    /* predictors of both vehicles */
    " a.delta_v_m_s, a.delta_v_x_m_s, p.treated_closing_speed_m_s, a.max_50ms_g, a.asi_1,"
    " ea.delta_v_without_rebound_m_s, b.delta_v_m_s, b.delta_v_x_m_s, p.treated_closing_speed_m_s,"
    " b.max_50ms_g, b.asi_1, eb.delta_v_without_rebound_m_s, p.vanished_crashes"
    " FROM counterfactual_pair AS p JOIN c ON c.id = p.crash_id"
    " JOIN v ON v.id = p.variant_id AND v.sweep = ''"
    " LEFT JOIN counterfactual_vehicle AS a ON a.crash_id = p.crash_id"
    " AND a.variant_id = p.variant_id AND a.role = 'a'"
    " LEFT JOIN counterfactual_vehicle AS b ON b.crash_id = p.crash_id"
    " AND b.variant_id = p.variant_id AND b.role = 'b'"
    " LEFT JOIN counterfactual_delta_v_without_rebound AS ea ON ea.crash_id = p.crash_id"
    " AND ea.variant_id = p.variant_id AND ea.role = 'a'"
    " LEFT JOIN counterfactual_delta_v_without_rebound AS eb ON eb.crash_id = p.crash_id"
    " AND eb.variant_id = p.variant_id AND eb.role = 'b' ORDER BY c.place, v.place";

static cp_status read_rows(cp_store *store, cp_study_data *data, cp_error *error)
{
    const struct {
        const char *sql;
        cp_status (*row)(void *context, const cp_row *row, cp_error *error);
    } queries[] = {
        {CP_STUDY_PLACES "SELECT name, driver_errors FROM s ORDER BY place", read_scenario},
        {CP_STUDY_PLACES "SELECT name, is_baseline, functions FROM v ORDER BY place", read_variant},
        {CP_STUDY_PLACES "SELECT scenario, variant, number, seed, vehicle_km, vehicle_h FROM r"
                         " ORDER BY place",
         read_replication},
        {CP_STUDY_PLACES "SELECT crash_type FROM t ORDER BY place", read_crash_type},
        {CP_STUDY_PLACES "SELECT validity FROM o ORDER BY place", read_validity},
        {"SELECT DISTINCT evidence_class FROM crash_vehicle WHERE evidence_class IS NOT NULL"
         " ORDER BY evidence_class",
         read_evidence},
        {CP_STUDY_PLACES
         "SELECT replication, type, frontal, validity = 'inside', id, time_s, x_m, y_m"
         " FROM c ORDER BY place",
         read_crash},
        {VEHICLES, read_vehicle},
        {PAIRS, read_pair},
        {TREATED, read_treated},
        {"SELECT name, level, source, note, predictor, unit, form, coefficients ->> 0,"
         " coefficients ->> 1, drivers = 'frontal', terms, covariance, freedom FROM risk_function"
         " WHERE use_as = 'default' ORDER BY name, level",
         read_risk},
    };
    for (size_t k = 0; k < sizeof queries / sizeof *queries; k++) {
        cp_query_handler handler = {.row = queries[k].row, .context = data};
        cp_status status = cp_query(store, queries[k].sql, NULL, 0, &handler, error);
        if (status != CP_OK)
            return status;
    }
    return CP_OK;
}

// The study's own row and what the results were made with, as JSON for reports.
static cp_status read_about(cp_store *store, cp_study_data *data, cp_error *error)
{
    const struct {
        const char *name;
        const char *sql;
    } parts[] = {
        {"study", "SELECT * FROM study"},
        {"versions", "SELECT crashpulse_version, sumo_version, count(*) AS replications"
                     " FROM replication WHERE status = 'done' GROUP BY 1, 2 ORDER BY 1, 2"},
        {"vehicle_models",
         "SELECT name, hash FROM vehicle_model WHERE name IN (SELECT DISTINCT vehicle_model FROM "
         "crash_vehicle) ORDER BY name"},
        {"evidence",
         "SELECT v.name AS variant, coalesce(w.evidence_class, 'none') AS evidence_class,"
         " count(*) AS vehicles, avg(w.class_error_1) AS error_1, avg(w.class_error_g) AS error_g"
         " FROM crash_vehicle AS w JOIN variant AS v ON v.id = w.variant_id WHERE w.frontal = 1"
         " GROUP BY v.number, w.evidence_class ORDER BY v.number, vehicles DESC, 2"},
        {"scenarios", "SELECT name, sumocfg, sumo_options, driver_errors FROM scenario"
                      " ORDER BY number"},
        {"variants", "SELECT name, is_baseline, functions FROM variant ORDER BY number"},
        {"replications",
         "SELECT s.name AS scenario, v.name AS variant, r.sweep, r.number, r.seed, r.status,"
         " r.vehicle_km, r.vehicle_h, r.configuration_hash FROM replication AS r"
         " JOIN scenario AS s ON s.id = r.scenario_id JOIN variant AS v ON v.id = r.variant_id"
         " ORDER BY s.number, v.number, r.sweep, r.number"},
        {"sweep",
         "SELECT w.owner, coalesce(v.name, s.name) AS name, w.base, w.parameter, w.value"
         " FROM sweep_value AS w LEFT JOIN variant AS v ON w.owner = 'variant' AND v.id ="
         " w.owner_id LEFT JOIN scenario AS s ON w.owner = 'scenario' AND s.id = w.owner_id"
         " ORDER BY w.parameter, w.value, 2"},
        {"sumo_collision_check", "SELECT * FROM sumo_collision_check"},
    };
    data->about = json_object();
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
        json_t *rows = NULL;
        cp_status status = cp_query_json(store, parts[k].sql, &rows, error);
        if (status != CP_OK)
            return status;
        if (json_object_set_new(data->about, parts[k].name, rows) != 0)
            return cp_fail_memory(error, "the description of a study");
    }

    const json_t *study = json_array_get(json_object_get(data->about, "study"), 0);
    if (!study)
        return cp_fail(error, CP_BAD_INPUT, "the database holds no study yet");
    const char *design = json_string_value(json_object_get(study, "design"));
    data->paired = design && strcmp(design, "paired_seeds") == 0;
    data->counterfactual = design && strcmp(design, "counterfactual") == 0;
    data->seed = (uint64_t)json_integer_value(json_object_get(study, "seed"));
    return copy_text(json_string_value(json_object_get(study, "name")), &data->name, error);
}

cp_status cp_study_data_read(cp_store *store, cp_study_data *data, cp_error *error)
{
    *data = (cp_study_data){0};
    cp_status status = read_about(store, data, error);
    if (status == CP_OK)
        status = read_rows(store, data, error);
    double unfinished = 0.0;
    if (status == CP_OK)
        status = cp_query_number(store, "SELECT count(*) FROM replication WHERE status <> 'done'",
                                 &unfinished, error);
    data->unfinished = (size_t)unfinished;
    return status == CP_OK ? CP_OK : cp_error_prefix(error, "%s: ", cp_store_path(store));
}

void cp_study_data_destroy(cp_study_data *data)
{
    json_decref(data->about);
    free(data->name);
    for (size_t k = 0; k < data->scenario_count; k++) {
        free(data->scenario[k].name);
        json_decref(data->scenario[k].driver_errors);
    }
    for (size_t k = 0; k < data->variant_count; k++) {
        free(data->variant[k].name);
        json_decref(data->variant[k].functions);
    }
    for (size_t k = 0; k < data->crash_type_count; k++)
        free(data->crash_type[k]);
    for (size_t k = 0; k < data->validity_count; k++)
        free(data->validity[k]);
    for (size_t k = 0; k < data->evidence_count; k++)
        free(data->evidence[k]);
    free(data->evidence);
    for (size_t k = 0; k < data->risk_count; k++) {
        free(data->risk[k].name);
        free(data->risk[k].level);
        free(data->risk[k].source);
        free(data->risk[k].note);
    }
    free(data->risk);
    free(data->pair);
    free(data->treated);
    free(data->scenario);
    free(data->variant);
    free(data->replication);
    free(data->crash_type);
    free(data->crash);
    free(data->vehicle);
    free(data->validity);
    *data = (cp_study_data){0};
}

cp_status cp_study_data_variant(const cp_study_data *data, const char *name, size_t *variant,
                                cp_error *error)
{
    for (size_t k = 0; k < data->variant_count; k++) {
        if (name ? strcmp(name, data->variant[k].name) == 0 : data->variant[k].is_baseline) {
            *variant = k;
            return CP_OK;
        }
    }

    // Say what there is to choose from.
    char names[512] = "";
    size_t used = 0;
    for (size_t k = 0; k < data->variant_count && used + 1 < sizeof names; k++) {
        int more = snprintf(names + used, sizeof names - used, "%s%s", k ? ", " : "",
                            data->variant[k].name);
        used += more > 0 ? (size_t)more : 0;
    }
    if (name)
        return cp_fail(error, CP_BAD_INPUT, "there is no variant '%s'; the study has: %s", name,
                       names);
    return cp_fail(error, CP_BAD_INPUT,
                   "no variant is marked as the baseline; name one with --baseline: %s", names);
}
