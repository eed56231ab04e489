/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/crash_again.h"

#include "core/log.h"
#include "crash/validity.h"

cp_status cp_crash_again_simulate(const char *db_path, int64_t crash_id, const char *treatment,
                                  cp_crash_film *film, cp_crash_again *again, cp_error *error)
{
    cp_store *store = NULL;
    cp_status status = cp_store_open(db_path, CP_STORE_READ, &store, error);
    if (status == CP_OK)
        status = cp_stored_crash_read(store, crash_id, treatment, &again->stored, error);
    if (status == CP_OK) {
        cp_crash_options options = again->stored.options;
        options.film = film;
        again->run.model[0] = &again->stored.model[0];
        again->run.model[1] = &again->stored.model[1];
        again->run.configuration = again->stored.configuration;
        again->run.description = again->stored.description;
        again->run.duration_s = options.duration_s;
        again->run.is_damaged = again->stored.is_secondary;
        status = cp_crash_simulate(again->run.model[0], again->run.model[1],
                                   &again->run.configuration, &options, &again->run.result, error);
    }
    if (status == CP_OK)
        status = cp_stored_crash_compare(store, &again->stored, &again->run.result, &again->match,
                                         error);
    cp_store_close(store);
    return status;
}

cp_status cp_crash_again_conclude(const cp_crash_again *again, cp_error *error)
{
    const cp_stored_crash *stored = &again->stored;
    cp_log_info("crash %lld of %s and %s at %.2f s%s%s, simulated by crashpulse %s",
                (long long)stored->id, stored->sumo_id[0], stored->sumo_id[1], stored->time_s,
                stored->is_treated ? " under " : "", stored->treatment, stored->crashpulse_version);
    if (!again->run.result.touched)
        cp_log_warning("crash of %s and %s at %.2f s cannot be simulated: %s", stored->sumo_id[0],
                       stored->sumo_id[1], stored->time_s, CP_NO_CONTACT_TEXT);
    switch (again->match) {
    case CP_STORED_SAME_BYTES:
        cp_log_info("the pulses are the stored ones, byte for byte");
        return CP_OK;
    case CP_STORED_SAME_SAMPLES:
        cp_log_info("the pulses are the stored ones, sample for sample (packed by another codec)");
        return CP_OK;
    case CP_STORED_NOTHING:
        cp_log_warning("no pulse is stored to compare with");
        return CP_OK;
    case CP_STORED_DIFFERENT:
        break;
    }
    return cp_fail(error, CP_RUN_FAILED,
                   "the pulses are not the stored ones, which crashpulse %s simulated",
                   stored->crashpulse_version);
}
