/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sqlext/functions.h"

#include "sqlext/observations.h"

#include <math.h>
#include <stdbool.h>

SQLITE_EXTENSION_INIT3

/* median(x [, censored]), quantile(x, p [, censored]), cliffs_delta(x, treated [, censored]),
 * ks_distance(x, treated [, censored]). Rows with x NULL do not count, unless censored is true:
 * then the observation lies below every value, whatever x is. A result that depends on where below
 * is NULL, as one of nothing is. */

enum { MEDIAN, QUANTILE, CLIFFS_DELTA, KS_DISTANCE };

typedef struct aggregate_type {
    int kind;
    const char *name;
    int arguments; /* before censored */
} aggregate_type;

static const aggregate_type AGGREGATE[] = {{MEDIAN, "median", 1},
                                           {QUANTILE, "quantile", 2},
                                           {CLIFFS_DELTA, "cliffs_delta", 2},
                                           {KS_DISTANCE, "ks_distance", 2}};

// Of one group or window.
typedef struct aggregate {
    cp_observations sample[2]; /* [1]: treated */
    double p;
    bool has_p;
} aggregate;

static const aggregate_type *type_of(sqlite3_context *context)
{
    return sqlite3_user_data(context);
}

static void fail(sqlite3_context *context, const char *what)
{
    char *text = sqlite3_mprintf("%s: %s", type_of(context)->name, what);
    sqlite3_result_error(context, text != NULL ? text : "out of memory", -1);
    sqlite3_free(text);
}

// ---- rows ----------------------------------------------------------------------------------

// The observation of a row: whether it counts, and its value.
static bool read_observation(sqlite3_context *context, int count, sqlite3_value **values,
                             double *observation)
{
    int before = type_of(context)->arguments;
    int type = sqlite3_value_numeric_type(values[0]);
    if (count > before && sqlite3_value_int(values[before]) != 0) {
        *observation = -INFINITY;
        return true;
    }
    if (type == SQLITE_NULL)
        return false;
    *observation = sqlite3_value_double(values[0]);
    if (type == SQLITE_INTEGER || (type == SQLITE_FLOAT && !isnan(*observation)))
        return true;
    fail(context, "x must be a number");
    return false;
}

static bool read_p(sqlite3_context *context, aggregate *a, sqlite3_value *value)
{
    int type = sqlite3_value_numeric_type(value);
    double p = sqlite3_value_double(value);
    if ((type != SQLITE_INTEGER && type != SQLITE_FLOAT) || !(p >= 0.0 && p <= 1.0)) {
        fail(context, "p must be a number from 0 to 1");
        return false;
    }
    if (a->has_p && p != a->p) {
        fail(context, "p must be the same for all rows");
        return false;
    }
    a->p = p;
    a->has_p = true;
    return true;
}

// Which sample a row belongs to; -1: none.
static int read_sample(sqlite3_context *context, sqlite3_value **values)
{
    int kind = type_of(context)->kind;
    if (kind == MEDIAN || kind == QUANTILE)
        return 0;
    if (sqlite3_value_type(values[1]) == SQLITE_NULL)
        return -1;
    return sqlite3_value_int(values[1]) != 0;
}

static void step(sqlite3_context *context, int count, sqlite3_value **values)
{
    aggregate *a = sqlite3_aggregate_context(context, sizeof *a);
    double observation = 0.0;
    if (a == NULL) {
        sqlite3_result_error_nomem(context);
        return;
    }
    if (type_of(context)->kind == QUANTILE && !read_p(context, a, values[1]))
        return;
    int sample = read_sample(context, values);
    if (sample >= 0 && read_observation(context, count, values, &observation) &&
        !cp_observations_add(&a->sample[sample], observation))
        sqlite3_result_error_nomem(context);
}

// A row leaves the window; rows leave in the order they came.
static void inverse(sqlite3_context *context, int count, sqlite3_value **values)
{
    aggregate *a = sqlite3_aggregate_context(context, sizeof *a);
    double observation = 0.0;
    if (a != NULL && read_observation(context, count, values, &observation))
        cp_observations_drop_oldest(&a->sample[0]);
}

// ---- results -------------------------------------------------------------------------------

static double result_of(int kind, aggregate *a, const double *const sorted[2])
{
    size_t a_count = a->sample[0].count, b_count = a->sample[1].count;
    switch (kind) {
    case MEDIAN:
        return cp_sorted_quantile(sorted[0], a_count, 0.5);
    case QUANTILE:
        return cp_sorted_quantile(sorted[0], a_count, a->p);
    case CLIFFS_DELTA:
        return cp_sorted_cliffs_delta(sorted[0], a_count, sorted[1], b_count);
    default:
        return cp_sorted_ks_distance(sorted[0], a_count, sorted[1], b_count);
    }
}

static void value(sqlite3_context *context)
{
    aggregate *a = sqlite3_aggregate_context(context, 0);
    if (a == NULL)
        return;
    const double *sorted[2];
    for (int k = 0; k < 2; k++) {
        sorted[k] = cp_observations_sorted(&a->sample[k]);
        if (sorted[k] == NULL && a->sample[k].count > 0) {
            sqlite3_result_error_nomem(context);
            return;
        }
    }
    double result = result_of(type_of(context)->kind, a, sorted);
    if (isfinite(result))
        sqlite3_result_double(context, result);
    else
        sqlite3_result_null(context);
}

static void finish(sqlite3_context *context)
{
    aggregate *a = sqlite3_aggregate_context(context, 0);
    if (a == NULL)
        return;
    value(context);
    cp_observations_destroy(&a->sample[0]);
    cp_observations_destroy(&a->sample[1]);
}

// ---- registering ---------------------------------------------------------------------------

int cp_sqlext_register_aggregates(sqlite3 *db)
{
    const int flags = SQLITE_UTF8 | SQLITE_DETERMINISTIC | SQLITE_INNOCUOUS;
    int result = SQLITE_OK;
    for (size_t k = 0; k < sizeof AGGREGATE / sizeof *AGGREGATE; k++) {
        const aggregate_type *type = &AGGREGATE[k];
        bool window = type->kind == MEDIAN || type->kind == QUANTILE;
        char prefixed[64];
        sqlite3_snprintf(sizeof prefixed, prefixed, CP_SQLEXT_PREFIX "%s", type->name);
        const char *const names[] = {type->name, prefixed};
        for (int censored = 0; censored <= 1; censored++) {
            int first = cp_sqlext_has(db, type->name, type->arguments + censored) ? 1 : 0;
            for (int n = first; result == SQLITE_OK && n < 2; n++)
                result = sqlite3_create_window_function(
                    db, names[n], type->arguments + censored, flags, (void *)type, step, finish,
                    window ? value : NULL, window ? inverse : NULL, NULL);
        }
    }
    return result;
}
