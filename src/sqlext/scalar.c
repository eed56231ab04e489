/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sqlext/functions.h"

#include "pulse/cfc_filter.h"
#include "pulse/pulse_codec.h"
#include "pulse/severity.h"
#include "sqlext/blob.h"

#include <math.h>
#include <stdlib.h>

SQLITE_EXTENSION_INIT3

// ---- arguments and results -----------------------------------------------------------------

void cp_sqlext_fail(sqlite3_context *context, const char *function, const cp_error *error)
{
    if (error->status == CP_NO_MEMORY) {
        sqlite3_result_error_nomem(context);
        return;
    }
    char *text = sqlite3_mprintf("%s: %s", function, error->text);
    sqlite3_result_error(context, text != NULL ? text : "out of memory", -1);
    sqlite3_free(text);
}

cp_status cp_sqlext_decode(int count, sqlite3_value **values, cp_pulse *pulse, cp_error *error)
{
    *pulse = (cp_pulse){0};
    for (int k = 0; k < count; k++) {
        int wanted = k == 0 ? SQLITE_BLOB : k == 2 ? SQLITE_FLOAT : SQLITE_INTEGER;
        int found = sqlite3_value_type(values[k]);
        if (found != wanted && !(wanted == SQLITE_FLOAT && found == SQLITE_INTEGER))
            return cp_fail(error, CP_BAD_INPUT,
                           k == 0 ? "the first argument must be a pulse, column samples of table "
                                    "pulse"
                                  : "the arguments must be samples, codec, sample_interval_s and "
                                    "sample_count of table pulse");
    }
    const void *blob = sqlite3_value_blob(values[0]);
    size_t size = (size_t)sqlite3_value_bytes(values[0]);
    if (count == 1)
        return cp_pulse_decode_blob(blob, size, pulse, error);
    return cp_pulse_decode(sqlite3_value_int(values[1]), blob, size, sqlite3_value_int64(values[3]),
                           sqlite3_value_double(values[2]), pulse, error);
}

static void result_number(sqlite3_context *context, double value)
{
    if (isnan(value))
        sqlite3_result_null(context);
    else
        sqlite3_result_double(context, value);
}

// ---- functions -----------------------------------------------------------------------------

// olc(samples): in g; NULL when there is none (olc_status tells why).
// olc_status(samples): value, no_deceleration, beyond_0_5_s. As for front contact.
static void olc(sqlite3_context *context, int count, sqlite3_value **values)
{
    const char *name = sqlite3_user_data(context);
    cp_error error = {0};
    cp_pulse pulse;
    if (sqlite3_value_type(values[0]) == SQLITE_NULL)
        return;
    if (cp_sqlext_decode(count, values, &pulse, &error) != CP_OK) {
        cp_sqlext_fail(context, name, &error);
        return;
    }
    cp_olc found = {.status = CP_OLC_NO_DECELERATION, .olc_g = NAN};
    if (pulse.sample_count >= 2)
        found = cp_olc_from_velocity(pulse.channel[CP_CHANNEL_VX], pulse.sample_count,
                                     pulse.sample_interval_s);
    if (name[3] == '_')
        sqlite3_result_text(context, cp_olc_status_text(found.status), -1, SQLITE_STATIC);
    else
        result_number(context, found.status == CP_OLC_VALUE ? found.olc_g : NAN);
    cp_pulse_destroy(&pulse);
}

// delta_v(samples[, separation_s]): magnitude of the change of velocity in the ground frame, m/s,
// at separation or, if later (or not given), at its largest.
// peak(samples): largest deceleration along x after CFC60, g.
static void severity(sqlite3_context *context, int count, sqlite3_value **values)
{
    const char *name = sqlite3_user_data(context);
    cp_error error = {0};
    cp_pulse pulse;
    cp_severity found;
    double separation_s = 0.0;
    if (sqlite3_value_type(values[0]) == SQLITE_NULL)
        return;
    if (count == 2) {
        int type = sqlite3_value_type(values[1]);
        separation_s = type == SQLITE_NULL ? 0.0 : sqlite3_value_double(values[1]);
        if (type == SQLITE_TEXT || type == SQLITE_BLOB || !isfinite(separation_s)) {
            cp_fail(&error, CP_BAD_INPUT, "separation_s must be a number of seconds");
            cp_sqlext_fail(context, name, &error);
            return;
        }
    }
    cp_status status = cp_sqlext_decode(1, values, &pulse, &error);
    if (status == CP_OK)
        status = cp_severity_of_pulse(&pulse, separation_s, 0, &found, &error);
    cp_pulse_destroy(&pulse);
    if (status != CP_OK)
        cp_sqlext_fail(context, name, &error);
    else
        result_number(context, name[0] == 'd' ? found.delta_v_m_s : found.peak_g);
}

// cfc(samples, class): the pulse with its accelerations through the filter of that class, as a blob
// for the other functions.
static void cfc(sqlite3_context *context, int count, sqlite3_value **values)
{
    cp_error error = {0};
    cp_pulse pulse = {0}, filtered = {0};
    void *blob = NULL;
    size_t size = 0;
    (void)count;
    if (sqlite3_value_type(values[0]) == SQLITE_NULL)
        return;
    int type = sqlite3_value_type(values[1]);
    double cfc_class = sqlite3_value_double(values[1]);
    cp_status status = CP_OK;
    if ((type != SQLITE_INTEGER && type != SQLITE_FLOAT) || !(cfc_class >= 1 && cfc_class <= 1000))
        status = cp_fail(&error, CP_BAD_INPUT,
                         "the class must be a number from 1 to 1000, as a rule 60");
    if (status == CP_OK)
        status = cp_sqlext_decode(1, values, &pulse, &error);
    if (status == CP_OK)
        status = cp_pulse_filtered(&pulse, cfc_class, &filtered, &error);
    if (status == CP_OK)
        status = cp_pulse_encode(&filtered, &blob, &size, &error);
    if (status == CP_OK)
        sqlite3_result_blob64(context, blob, size, free);
    else
        cp_sqlext_fail(context, "cfc", &error);
    cp_pulse_destroy(&filtered);
    cp_pulse_destroy(&pulse);
}

// ---- registering ---------------------------------------------------------------------------

int cp_sqlext_register_scalars(sqlite3 *db)
{
    // olc takes the neighbouring columns too: for pulses of codec 1, which do not explain
    // themselves.
    static const struct {
        const char *name;
        int count;
        void (*function)(sqlite3_context *, int, sqlite3_value **);
    } SCALARS[] = {{"olc", 1, olc},        {"olc", 4, olc},          {"olc_status", 1, olc},
                   {"olc_status", 4, olc}, {"delta_v", 1, severity}, {"delta_v", 2, severity},
                   {"peak", 1, severity},  {"cfc", 2, cfc}};
    const int flags = SQLITE_UTF8 | SQLITE_DETERMINISTIC | SQLITE_INNOCUOUS;
    int result = SQLITE_OK;
    for (size_t k = 0; result == SQLITE_OK && k < sizeof SCALARS / sizeof *SCALARS; k++) {
        char prefixed[64];
        sqlite3_snprintf(sizeof prefixed, prefixed, CP_SQLEXT_PREFIX "%s", SCALARS[k].name);
        const char *const names[] = {SCALARS[k].name, prefixed};
        int first = cp_sqlext_has(db, SCALARS[k].name, SCALARS[k].count) ? 1 : 0;
        for (int n = first; result == SQLITE_OK && n < 2; n++)
            result = sqlite3_create_function_v2(db, names[n], SCALARS[k].count, flags,
                                                (void *)SCALARS[k].name, SCALARS[k].function, NULL,
                                                NULL, NULL);
    }
    return result;
}
