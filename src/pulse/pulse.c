/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pulse/pulse.h"

#include "pulse/cfc_filter.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

const char *const CP_PULSE_COLUMN[CP_CHANNEL_COUNT] = {
#define CP_PULSE_COLUMN_ROW(name, column) [name] = column,
    CP_PULSE_CHANNELS(CP_PULSE_COLUMN_ROW)
#undef CP_PULSE_COLUMN_ROW
};

cp_status cp_pulse_create(cp_pulse *pulse, size_t sample_count, double sample_interval_s,
                          cp_error *error)
{
    *pulse = (cp_pulse){.sample_count = sample_count, .sample_interval_s = sample_interval_s};

    // One block for all channels; the first channel holds it.
    size_t room = sample_count > 0 ? sample_count : 1;
    double *block = calloc(room, CP_CHANNEL_COUNT * sizeof *block);
    if (block == NULL) {
        *pulse = (cp_pulse){0};
        return cp_fail_memory(error, "crash pulse");
    }
    for (size_t k = 0; k < CP_CHANNEL_COUNT; k++)
        pulse->channel[k] = block + k * room;
    return CP_OK;
}

void cp_pulse_destroy(cp_pulse *pulse)
{
    free(pulse->channel[0]);
    *pulse = (cp_pulse){0};
}

cp_status cp_pulse_filtered(const cp_pulse *pulse, double cfc, cp_pulse *filtered, cp_error *error)
{
    static const cp_pulse_channel ACCELERATION[] = {CP_CHANNEL_AX, CP_CHANNEL_AY,
                                                    CP_CHANNEL_YAW_ACC};
    cp_status status =
        cp_pulse_create(filtered, pulse->sample_count, pulse->sample_interval_s, error);
    if (status != CP_OK)
        return status;
    for (size_t k = 0; k < CP_CHANNEL_COUNT; k++)
        memcpy(filtered->channel[k], pulse->channel[k],
               pulse->sample_count * sizeof *pulse->channel[k]);

    for (size_t k = 0; k < sizeof ACCELERATION / sizeof ACCELERATION[0] && status == CP_OK; k++)
        status = cp_cfc_filter(filtered->channel[ACCELERATION[k]], filtered->sample_count,
                               filtered->sample_interval_s, cfc, error);
    if (status != CP_OK)
        cp_pulse_destroy(filtered);
    return status;
}

cp_status cp_pulse_write_csv(const cp_pulse *pulse, const char *role, FILE *file, cp_error *error)
{
    int failed = 0;
    for (size_t k = 0; k < pulse->sample_count && !failed; k++) {
        failed |= fprintf(file, "%s,%.10g", role, (double)k * pulse->sample_interval_s) < 0;
        for (size_t c = 0; c < CP_CHANNEL_COUNT; c++)
            failed |= fprintf(file, ",%.10g", pulse->channel[c][k]) < 0;
        failed |= fputc('\n', file) == EOF;
    }
    if (failed)
        return cp_fail(error, CP_IO_FAILED, "pulse of vehicle %s cannot be written: %s", role,
                       strerror(errno));
    return CP_OK;
}
