/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pulses in the formats of other programs, and where a network lies. */
#include "fuzz.h"

#include "exchange/ev5_pulse.h"
#include "exchange/iso_mme.h"
#include "exchange/lsdyna.h"
#include "exchange/network_projection.h"
#include "exchange/pulse_csv.h"
#include "exchange/pulse_file.h"
#include "pulse/severity.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// What is read is a pulse: finite, of one length, with a severity.
static void judge_record(cp_status status, const cp_error *error, cp_pulse_record *record)
{
    fuzz_judge(status, error);
    if (status != CP_OK)
        return;
    const cp_pulse *pulse = &record->pulse;
    fuzz_must(pulse->sample_count >= 2 && pulse->sample_interval_s > 0.0, "a pulse of nothing");
    fuzz_must(record->known[CP_CHANNEL_AX] && record->known[CP_CHANNEL_VX], "no motion");
    for (size_t k = 0; k < pulse->sample_count; k++)
        fuzz_must(fabs(pulse->channel[CP_CHANNEL_VX][k]) <= 150.0, "a speed out of range");
    cp_severity severity;
    cp_error told = {0};
    double separation_s = isfinite(record->separation_s) ? record->separation_s : 0.0;
    fuzz_judge(cp_severity_of_pulse(pulse, separation_s, 1, &severity, &told), &told);
    cp_pulse_record_destroy(record);
}

// With the speed and the units said, so that little is refused for want of them.
static cp_pulse_request request_of(const char *path)
{
    cp_pulse_request request = cp_pulse_request_default(path);
    request.speed_m_s = 15.0;
    request.units = "m-s-kg";
    request.may_gain = true;
    return request;
}

// The test, then its first channel.
void fuzz_iso_mme(const uint8_t *data, size_t size)
{
    size_t test_size = 0, channel_size = 0;
    const uint8_t *test = fuzz_part(data, size, 0, &test_size);
    const uint8_t *channel = fuzz_part(data, size, 1, &channel_size);
    cp_pulse_request request = request_of("t1.mme");
    cp_pulse_record record = {0};
    cp_error error = {0};
    fuzz_write("t1.mme", test, test_size);
    fuzz_write("t1.001", channel, channel_size);
    cp_status status = cp_iso_mme_read(&request, &record, &error);
    judge_record(status, &error, &record);
}

void fuzz_lsdyna(const uint8_t *data, size_t size)
{
    cp_pulse_request request = request_of("input.k");
    cp_pulse_record record = {0};
    cp_error error = {0};
    fuzz_write("input.k", data, size);
    cp_status status = cp_pulse_file_read(&request, &record, &error);
    judge_record(status, &error, &record);
}

// Any of the formats that are one file.
void fuzz_pulse_file(const uint8_t *data, size_t size)
{
    cp_pulse_request request = request_of("input.txt");
    cp_pulse_record record = {0};
    cp_error error = {0};
    fuzz_write("input.txt", data, size);
    cp_status status = cp_pulse_file_read(&request, &record, &error);
    judge_record(status, &error, &record);
}

void fuzz_location(const uint8_t *data, size_t size)
{
    cp_network_projection *projection = NULL;
    cp_error error = {0}, told = {0};
    fuzz_write("input.net.xml", data, size);
    cp_status status = cp_network_projection_read("input.net.xml", &projection, &error);
    fuzz_judge(status, &error);
    fuzz_must(status == CP_OK || projection == NULL, "a projection beside an error");
    if (projection != NULL) {
        cp_vec2 degrees = {0};
        cp_status one =
            cp_network_projection_degrees(projection, (cp_vec2){100.0, 200.0}, &degrees, &told);
        fuzz_judge(one, &told);
        fuzz_must(one != CP_OK || isfinite(degrees.x + degrees.y), "a place that is none");
    }
    cp_network_projection_destroy(projection);
}
