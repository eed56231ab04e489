/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/crash_selection.h"

#include "core/memory_stream.h"
#include "pulse/pulse_codec.h"
#include "store/query.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// X(name): what a row tells, in this order; text until AT_FAULT, then numbers.
#define COLUMNS(X)                                                                                 \
    X(SCENARIO, "s.name")                                                                          \
    X(VARIANT, "v.name")                                                                           \
    X(CRASH_TYPE, "c.crash_type")                                                                  \
    X(CRASH_VALIDITY, "c.validity")                                                                \
    X(ROLE, "cv.role")                                                                             \
    X(SUMO_ID, "cv.sumo_id")                                                                       \
    X(SUMO_TYPE, "cv.sumo_type")                                                                   \
    X(VEHICLE_MODEL, "cv.vehicle_model")                                                           \
    X(CONTACT_SIDE, "cv.contact_side")                                                             \
    X(VALIDITY, "cv.validity")                                                                     \
    X(OLC_STATUS, "cv.olc_status")                                                                 \
    X(AT_FAULT, "cv.at_fault")                                                                     \
    X(CRASH_ID, "b.id")                                                                            \
    X(REPLICATION, "r.number")                                                                     \
    X(TIME, "c.time_s")                                                                            \
    X(CONTACT_X, "c.x_m")                                                                          \
    X(CONTACT_Y, "c.y_m")                                                                          \
    X(CLOSING_SPEED, "c.closing_speed_m_s")                                                        \
    X(LATERAL_OFFSET, "c.lateral_offset_m")                                                        \
    X(ANGLE, "c.angle_rad")                                                                        \
    X(OVERLAP, "c.overlap_1")                                                                      \
    X(SEPARATION, "c.separation_s")                                                                \
    X(SPEED, "cv.speed_m_s")                                                                       \
    X(MASS, "cv.mass_kg")                                                                          \
    X(OLC, "cv.olc_g")                                                                             \
    X(DELTA_V, "cv.delta_v_m_s")                                                                   \
    X(CODEC, "p.codec")                                                                            \
    X(SAMPLE_COUNT, "p.sample_count")                                                              \
    X(SAMPLE_INTERVAL, "p.sample_interval_s")                                                      \
    X(SAMPLES, "p.samples")

enum {
#define COLUMN_NUMBER(name, sql) name,
    COLUMNS(COLUMN_NUMBER)
#undef COLUMN_NUMBER
        COLUMN_COUNT
};
enum { TEXT_COUNT = AT_FAULT };

static const char *const COLUMN_SQL[] = {
#define COLUMN_TEXT(name, sql) sql,
    COLUMNS(COLUMN_TEXT)
#undef COLUMN_TEXT
};

// Crash b is the baseline's, c what is told of: itself, or what it became under variant v. The
// tables are joined in the order that gives the rows in the order of the ids, without sorting.
static const char OF_CRASHES[] =
    " FROM crash AS b CROSS JOIN crash AS c ON c.id = b.id CROSS JOIN replication AS r ON r.id = "
    "b.replication_id CROSS JOIN scenario AS s ON s.id = r.scenario_id CROSS JOIN variant AS v ON "
    "v.id = r.variant_id CROSS JOIN crash_vehicle AS cv ON cv.crash_id = b.id ";
static const char OF_TREATED[] =
    " FROM crash AS b CROSS JOIN variant AS v ON v.name = ?1 CROSS JOIN counterfactual AS c ON "
    "c.crash_id = b.id AND c.variant_id = v.id AND c.time_s IS NOT NULL CROSS JOIN replication AS "
    "r ON r.id = b.replication_id CROSS JOIN scenario AS s ON s.id = r.scenario_id CROSS JOIN "
    "counterfactual_vehicle AS cv ON cv.crash_id = b.id AND cv.variant_id = v.id ";
static const char PULSE_OF_CRASH[] =
    "LEFT JOIN pulse AS p ON p.crash_id = cv.crash_id AND p.role = cv.role ";
static const char PULSE_OF_TREATED[] =
    "LEFT JOIN counterfactual_pulse AS p ON p.crash_id = cv.crash_id AND p.variant_id = "
    "cv.variant_id AND p.role = cv.role ";

typedef struct visiting {
    const cp_crash_selection *selection;
    cp_crash_visit visit;
    void *context;
    cp_selected_crash crash;
    bool has[2];               // of its vehicles
    char *text[2][TEXT_COUNT]; // owned
} visiting;

// ---- the question --------------------------------------------------------------------------

static char *make_sql(const cp_crash_selection *selection, bool counts)
{
    char *sql = NULL;
    size_t size = 0;
    bool treated = selection->treatment != NULL, pulses = selection->with_pulses && !counts;
    FILE *file = cp_memory_stream(&sql, &size);
    if (file == NULL)
        return NULL;
    fputs(counts ? "SELECT count(DISTINCT b.id)" : "SELECT ", file);
    for (int c = 0; !counts && c < COLUMN_COUNT; c++)
        fprintf(file, "%s%s", c > 0 ? ", " : "", c < CODEC || pulses ? COLUMN_SQL[c] : "NULL");
    fputs(treated ? OF_TREATED : OF_CRASHES, file);
    if (pulses)
        fputs(treated ? PULSE_OF_TREATED : PULSE_OF_CRASH, file);
    fputs("WHERE ?1 IS ?1 AND (?2 IS NULL OR b.id = ?2) AND (?3 IS NULL OR s.name = ?3)", file);
    // What the user wrote ends on a line of its own: a comment in it hides nothing of ours.
    if (selection->where != NULL)
        fprintf(file, " AND b.id IN (SELECT crash_id FROM crash_vehicle_list WHERE (\n%s\n))",
                selection->where);
    if (!counts)
        fputs(" ORDER BY b.id, cv.role", file);
    return fclose(file) == 0 ? sql : NULL;
}

static cp_status ask(cp_store *store, const cp_crash_selection *selection, bool counts,
                     const cp_query_handler *handler, cp_error *error)
{
    const cp_cell parameters[] = {cp_cell_text(selection->treatment),
                                  selection->crash_id >= 0 ? cp_cell_integer(selection->crash_id)
                                                           : cp_cell_text(NULL),
                                  cp_cell_text(selection->scenario)};
    char *sql = make_sql(selection, counts);
    if (sql == NULL)
        return cp_fail_memory(error, "a selection of crashes");
    cp_status status = cp_query(store, sql, parameters, 3, handler, error);
    free(sql);
    return status;
}

// ---- what there is -------------------------------------------------------------------------

static cp_status take_count(void *context, const cp_row *row, cp_error *error)
{
    (void)error;
    *(size_t *)context = (size_t)row->cell[0].integer;
    return CP_OK;
}

// A scenario or a variant of the database.
static cp_status check_name(cp_store *store, const char *table, const char *sql, const char *name,
                            cp_error *error)
{
    size_t found = 0;
    cp_cell parameter = cp_cell_text(name);
    cp_query_handler handler = {.row = take_count, .context = &found};
    if (name == NULL)
        return CP_OK;
    cp_status status = cp_query(store, sql, &parameter, 1, &handler, error);
    if (status == CP_OK && found == 0)
        status =
            cp_fail(error, CP_BAD_INPUT, "%s: has no %s '%s'", cp_store_path(store), table, name);
    return status;
}

cp_status cp_crash_selection_count(cp_store *store, const cp_crash_selection *selection,
                                   size_t *count, cp_error *error)
{
    *count = 0;
    cp_query_handler handler = {.row = take_count, .context = count};
    cp_status status = check_name(store, "variant", "SELECT count(*) FROM variant WHERE name = ?1",
                                  selection->treatment, error);
    if (status == CP_OK)
        status = check_name(store, "scenario", "SELECT count(*) FROM scenario WHERE name = ?1",
                            selection->scenario, error);
    return status == CP_OK ? ask(store, selection, true, &handler, error) : status;
}

// ---- one crash -----------------------------------------------------------------------------

static void forget(visiting *self)
{
    for (int v = 0; v < 2; v++) {
        cp_pulse_record_destroy(&self->crash.vehicle[v].record);
        for (int c = 0; c < TEXT_COUNT; c++) {
            free(self->text[v][c]);
            self->text[v][c] = NULL;
        }
        self->has[v] = false;
    }
}

static cp_status deliver(visiting *self, cp_error *error)
{
    cp_status status = CP_OK;
    if (self->has[0] && self->has[1])
        status = self->visit(self->context, &self->crash, error);
    forget(self);
    return status;
}

static cp_status take_pulse(const visiting *self, const cp_row *row, int v,
                            cp_selected_vehicle *vehicle, cp_error *error)
{
    cp_pulse_record *record = &vehicle->record;
    *record = (cp_pulse_record){.separation_s = row->cell[SEPARATION].real,
                                .mass_kg = row->cell[MASS].real,
                                .against_car = true};
    snprintf(record->source, sizeof record->source, "crash %lld",
             (long long)row->cell[CRASH_ID].integer);
    snprintf(record->vehicle, sizeof record->vehicle, "%c", "ab"[v]);
    cp_pulse_record_take_side(record, vehicle->contact_side);
    vehicle->has_pulse = self->selection->with_pulses && row->cell[SAMPLES].type == CP_CELL_BLOB;
    if (!vehicle->has_pulse)
        return CP_OK;
    cp_status status = cp_pulse_decode((int)row->cell[CODEC].integer, row->cell[SAMPLES].text,
                                       row->cell[SAMPLES].size, row->cell[SAMPLE_COUNT].integer,
                                       row->cell[SAMPLE_INTERVAL].real, &record->pulse, error);
    if (status != CP_OK) {
        cp_error_prefix(error, "pulse of vehicle %c of crash %lld: ", "ab"[v],
                        (long long)row -> cell[CRASH_ID].integer);
        return status;
    }
    for (int c = 0; c < CP_CHANNEL_COUNT; c++)
        record->known[c] = true;
    return CP_OK;
}

static cp_status take_vehicle(visiting *self, const cp_row *row, int v, cp_error *error)
{
    cp_selected_vehicle *vehicle = &self->crash.vehicle[v];
    char **text = self->text[v];
    for (int c = 0; c < TEXT_COUNT; c++) {
        text[c] = strdup(row->cell[c].text);
        if (text[c] == NULL)
            return cp_fail_memory(error, "a crash");
    }
    *vehicle = (cp_selected_vehicle){.sumo_id = text[SUMO_ID],
                                     .sumo_type = text[SUMO_TYPE],
                                     .vehicle_model = text[VEHICLE_MODEL],
                                     .contact_side = text[CONTACT_SIDE],
                                     .validity = text[VALIDITY],
                                     .olc_status = text[OLC_STATUS],
                                     .at_fault = row->cell[AT_FAULT].integer != 0,
                                     .speed_m_s = row->cell[SPEED].real,
                                     .olc_g = row->cell[OLC].real,
                                     .delta_v_m_s = row->cell[DELTA_V].real};
    self->has[v] = true;
    return take_pulse(self, row, v, vehicle, error);
}

static void take_crash(visiting *self, const cp_row *row, int v)
{
    cp_selected_crash *crash = &self->crash;
    crash->id = row->cell[CRASH_ID].integer;
    crash->treatment = self->selection->treatment != NULL ? self->selection->treatment : "";
    crash->scenario = self->text[v][SCENARIO];
    crash->variant = self->text[v][VARIANT];
    crash->crash_type = self->text[v][CRASH_TYPE];
    crash->validity = self->text[v][CRASH_VALIDITY];
    crash->replication = row->cell[REPLICATION].integer;
    crash->time_s = row->cell[TIME].real;
    crash->x_m = row->cell[CONTACT_X].real;
    crash->y_m = row->cell[CONTACT_Y].real;
    crash->closing_speed_m_s = row->cell[CLOSING_SPEED].real;
    crash->lateral_offset_m = row->cell[LATERAL_OFFSET].real;
    crash->angle_rad = row->cell[ANGLE].real;
    crash->overlap_1 = row->cell[OVERLAP].real;
}

// Rows of a crash follow each other, a before b.
static cp_status take_row(void *context, const cp_row *row, cp_error *error)
{
    visiting *self = context;
    bool is_next = (self->has[0] || self->has[1]) && row->cell[CRASH_ID].integer != self->crash.id;
    cp_status status = is_next ? deliver(self, error) : CP_OK;
    int v = strcmp(row->cell[ROLE].text, "b") == 0;
    if (status != CP_OK || self->has[v])
        return status;
    status = take_vehicle(self, row, v, error);
    if (status == CP_OK)
        take_crash(self, row, v);
    return status;
}

cp_status cp_crash_selection_visit(cp_store *store, const cp_crash_selection *selection,
                                   cp_crash_visit visit, void *context, cp_error *error)
{
    visiting self = {.selection = selection, .visit = visit, .context = context};
    cp_query_handler handler = {.row = take_row, .context = &self};
    cp_status status = ask(store, selection, false, &handler, error);
    if (status == CP_OK)
        status = deliver(&self, error);
    forget(&self);
    return status;
}
