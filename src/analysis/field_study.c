/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/field_study.h"

#include "analysis/study_places.h"
#include "core/units.h"
#include "store/query.h"

#include <math.h>
#include <stdlib.h>

static const char VEHICLES[] = CP_STUDY_PLACES
    "SELECT c.place, w.role = 'b', w.pdof_rad,"
    " CASE WHEN w.contact_side <> 'front' THEN NULL WHEN w.role = 'a' THEN c.overlap_1"
    " WHEN abs(c.angle_rad) < 0.5236 THEN min(1.0, c.overlap_1 * o.width_m / w.width_m) END"
    " FROM crash_vehicle AS w JOIN c ON c.id = w.crash_id"
    " JOIN crash_vehicle AS o ON o.crash_id = w.crash_id AND o.role <> w.role";

typedef struct reader {
    const cp_study_data *data;
    cp_field_study *study;
} reader;

static cp_status take(void *context, const cp_row *row, cp_error *error)
{
    reader *r = context;
    size_t vehicle = 2 * (size_t)row->cell[0].integer + (size_t)row->cell[1].integer;
    if (vehicle >= r->data->vehicle_count)
        return cp_fail(error, CP_STORE_FAILED, "the database changed while it was read");
    const cp_study_vehicle *v = &r->data->vehicle[vehicle];
    double **value = r->study->value;
    value[CP_FIELD_VALUE_DELTA_V][vehicle] = 3.6 * v->predictor[CP_PREDICTOR_DELTA_V_COMMON];
    value[CP_FIELD_VALUE_PDOF][vehicle] = fabs(row->cell[2].real) * 180.0 / CP_PI;
    value[CP_FIELD_VALUE_OVERLAP][vehicle] = row->cell[3].real;
    return CP_OK;
}

cp_status cp_field_study_read(cp_store *store, const cp_study_data *data, cp_field_study *study,
                              cp_error *error)
{
    *study = (cp_field_study){{NULL}};
    for (int v = 0; v < CP_FIELD_VALUE_COUNT; v++) {
        study->value[v] = calloc(data->vehicle_count + 1, sizeof *study->value[v]);
        if (!study->value[v])
            return cp_fail_memory(error, "the vehicles of a study");
        for (size_t k = 0; k < data->vehicle_count; k++)
            study->value[v][k] = NAN;
    }
    reader r = {data, study};
    cp_query_handler handler = {.row = take, .context = &r};
    return cp_query(store, VEHICLES, NULL, 0, &handler, error);
}

void cp_field_study_destroy(cp_field_study *study)
{
    for (int v = 0; v < CP_FIELD_VALUE_COUNT; v++)
        free(study->value[v]);
    *study = (cp_field_study){{NULL}};
}
