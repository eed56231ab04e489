/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Packed pulses. Byte 0 says how the rest is taken: as a blob, or as what a frame of zstd holds,
 * which no change at random would get through its checksum. */
#include "fuzz.h"

#include "pulse/pulse_codec.h"
#include "pulse/severity.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zstd.h>

// What was unpacked is a pulse, and packs and unpacks to itself.
static void check_pulse(const cp_pulse *pulse)
{
    void *blob = NULL;
    size_t size = 0;
    cp_pulse again = {0};
    cp_error error = {0};
    fuzz_must(pulse->sample_count > 0 && pulse->sample_count <= CP_PULSE_CODEC_SAMPLES_MAX &&
                  pulse->sample_interval_s > 0.0 && isfinite(pulse->sample_interval_s),
              "a count or interval out of range");
    for (int c = 0; c < CP_CHANNEL_COUNT; c++)
        for (size_t k = 0; k < pulse->sample_count; k++)
            fuzz_must(fabs(pulse->channel[c][k]) <= 2147483647.0 * CP_PULSE_RESOLUTION[c],
                      "a sample out of range");
    cp_status status = cp_pulse_encode(pulse, &blob, &size, &error);
    fuzz_must(status == CP_OK, error.text);
    status = cp_pulse_decode_blob(blob, size, &again, &error);
    fuzz_must(status == CP_OK, error.text);
    fuzz_must(again.sample_count == pulse->sample_count &&
                  again.sample_interval_s == pulse->sample_interval_s,
              "another count or interval");
    for (int c = 0; c < CP_CHANNEL_COUNT; c++)
        fuzz_must(
            memcmp(again.channel[c], pulse->channel[c], pulse->sample_count * sizeof(double)) == 0,
            "other samples");
    cp_pulse_destroy(&again);
    free(blob);
}

// A header as it stands in the input, then the rest of it packed.
static uint8_t *pack(const uint8_t *data, size_t size, size_t header, size_t *packed)
{
    size_t room = ZSTD_compressBound(size);
    uint8_t *blob = malloc(header + room + 1);
    fuzz_must(blob != NULL, "no memory");
    memcpy(blob, data, header);
    size_t used = ZSTD_compress(blob + header, room, data + header, size - header, 1);
    fuzz_must(!ZSTD_isError(used), "zstd");
    *packed = header + used;
    return blob;
}

void fuzz_codec(const uint8_t *data, size_t size)
{
    enum { FIRST = 18 }; /* mode, codec, count, interval */
    cp_pulse pulse = {0};
    cp_error error = {0};
    cp_status status;
    int64_t count;
    double interval_s;
    uint8_t *blob = NULL;
    size_t packed = 0;
    if (size < FIRST)
        return;
    memcpy(&count, data + 2, sizeof count);
    memcpy(&interval_s, data + 10, sizeof interval_s);
    const uint8_t *rest = data + FIRST;
    size_t rest_size = size - FIRST;
    switch (data[0] % 4) {
    case 0:
        status = cp_pulse_decode_blob(rest, rest_size, &pulse, &error);
        break;
    case 1:
        status = cp_pulse_decode(data[1], rest, rest_size, count, interval_s, &pulse, &error);
        break;
    case 2:
        blob = pack(rest, rest_size, 0, &packed);
        status = cp_pulse_decode(1, blob, packed, count, interval_s, &pulse, &error);
        break;
    default:
        if (rest_size < data[1] % 16u)
            return;
        blob = pack(rest, rest_size, data[1] % 16u, &packed);
        status = cp_pulse_decode_blob(blob, packed, &pulse, &error);
        break;
    }
    free(blob);
    fuzz_judge(status, &error);
    if (status == CP_OK)
        check_pulse(&pulse);
    cp_pulse_destroy(&pulse);
}
