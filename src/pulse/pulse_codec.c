/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pulse/pulse_codec.h"

#include "pulse/pulse_prediction.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#define ZSTD_STATIC_LINKING_ONLY // memory of our own
#include <zstd.h>

#define ZSTD_LEVEL 19
#define CFC_OF_RECORD 180.0
#define VARINT_BYTES_MAX 10
#define MARK_OF_CODEC_2 0xc2
#define HEADER_BYTES_MAX (1 + 2 * VARINT_BYTES_MAX + 8)

// db/pulse.zdict, embedded: what the differences of most pulses look like.
extern const unsigned char cp_pulse_dictionary[];
extern const size_t cp_pulse_dictionary_size;

// Signed differences as unsigned numbers, small ones small: 0, -1, 1, -2, ... and back.
static uint64_t fold(int64_t value)
{
    return ((uint64_t)value << 1) ^ (value < 0 ? UINT64_MAX : 0);
}

static int64_t unfold(uint64_t value)
{
    return (int64_t)(value >> 1) ^ -(int64_t)(value & 1);
}

static size_t write_number(uint64_t value, unsigned char *bytes)
{
    size_t used = 0;
    while (value >= 0x80) {
        bytes[used++] = (unsigned char)(value | 0x80);
        value >>= 7;
    }
    bytes[used++] = (unsigned char)value;
    return used;
}

static bool read_number(const unsigned char *bytes, size_t size, size_t *place, uint64_t *value)
{
    *value = 0;
    for (int shift = 0; shift < 63 && *place < size; shift += 7) {
        unsigned char byte = bytes[(*place)++];
        *value |= (uint64_t)(byte & 0x7f) << shift;
        if (byte < 0x80)
            return true;
    }
    return false;
}

// ---- encoding ------------------------------------------------------------------------------

static cp_status quantise(const cp_pulse *pulse, int64_t *const steps[CP_CHANNEL_COUNT],
                          cp_error *error)
{
    for (int c = 0; c < CP_CHANNEL_COUNT; c++) {
        for (size_t k = 0; k < pulse->sample_count; k++) {
            double step = pulse->channel[c][k] / CP_PULSE_RESOLUTION[c];
            if (!(fabs(step) < (double)INT32_MAX))
                return cp_fail(error, CP_BAD_INPUT, "pulse: %s of sample %zu cannot be stored: %g",
                               CP_PULSE_COLUMN[c], k, pulse->channel[c][k]);
            steps[c][k] = llround(step);
        }
    }
    return CP_OK;
}

static size_t write_differences(int64_t *const steps[CP_CHANNEL_COUNT], size_t count,
                                double interval_s, unsigned char *bytes)
{
    size_t used = 0;
    for (size_t place = 0; place < CP_CHANNEL_COUNT; place++) {
        cp_prediction prediction = cp_prediction_begin(CP_PULSE_CODEC, place, steps, interval_s);
        for (size_t k = 0; k < count; k++) {
            int64_t difference = steps[prediction.channel][k] - cp_prediction_next(&prediction, k);
            used += write_number(fold(difference), bytes + used);
        }
    }
    return used;
}

static cp_status check_size(int64_t sample_count, double interval_s, cp_error *error)
{
    if (sample_count < 1 || sample_count > CP_PULSE_CODEC_SAMPLES_MAX)
        return cp_fail(error, CP_BAD_INPUT, "pulse: between 1 and %d samples allowed, found %lld",
                       CP_PULSE_CODEC_SAMPLES_MAX, (long long)sample_count);
    if (!(interval_s > 0.0 && interval_s <= 1.0))
        return cp_fail(error, CP_BAD_INPUT, "pulse: sample interval must be in (0, 1] s, found %g",
                       interval_s);
    return CP_OK;
}

// One allocation for the steps of all channels; freed through the first.
static cp_status allocate_steps(size_t count, int64_t *steps[CP_CHANNEL_COUNT], cp_error *error)
{
    steps[0] = calloc(count * CP_CHANNEL_COUNT, sizeof *steps[0]);
    if (steps[0] == NULL)
        return cp_fail_memory(error, "pulse");
    for (size_t c = 1; c < CP_CHANNEL_COUNT; c++)
        steps[c] = steps[0] + c * count;
    return CP_OK;
}

// What a blob says of itself. Intervals are whole nanoseconds as a rule.
static size_t write_header(size_t count, double interval_s, unsigned char header[HEADER_BYTES_MAX])
{
    size_t used = 0;
    uint64_t bits = 0, interval_ns = (uint64_t)llround(interval_s * 1e9);
    bool whole = interval_ns > 0 && (double)interval_ns / 1e9 == interval_s;
    header[used++] = MARK_OF_CODEC_2;
    used += write_number(count, header + used);
    used += write_number(whole ? interval_ns : 0, header + used);
    memcpy(&bits, &interval_s, sizeof bits);
    for (int k = 0; !whole && k < 8; k++)
        header[used++] = (unsigned char)(bits >> (8 * k));
    return used;
}

// Memory of one compression. zstd makes its tables of the dictionary on the way, and writes through
// what it is given where there is no memory for them: the first requests, these among them, are
// served from one block that is there before.
typedef struct zstd_block {
    unsigned char *bytes;
    size_t used;
} zstd_block;

enum { ZSTD_BLOCK_BYTES = 1 << 19 };

static void *take_of_block(void *opaque, size_t size)
{
    zstd_block *block = opaque;
    size_t rounded = (size + 63) & ~(size_t)63; // as aligned as malloc's, and more
    if (rounded < size || rounded > ZSTD_BLOCK_BYTES - block->used)
        return malloc(size);
    block->used += rounded;
    return block->bytes + block->used - rounded;
}

static void give_to_block(void *opaque, void *memory)
{
    const zstd_block *block = opaque;
    uintptr_t begin = (uintptr_t)block->bytes, place = (uintptr_t)memory;
    if (place < begin || place >= begin + ZSTD_BLOCK_BYTES)
        free(memory);
}

// One frame with a checksum of its content; a zstd error code where that fails.
static size_t compress_checked(ZSTD_CCtx *context, void *room, size_t room_size, const void *bytes,
                               size_t size)
{
    size_t result = ZSTD_CCtx_setParameter(context, ZSTD_c_compressionLevel, ZSTD_LEVEL);
    if (!ZSTD_isError(result))
        result = ZSTD_CCtx_setParameter(context, ZSTD_c_checksumFlag, 1);
    if (!ZSTD_isError(result))
        result = ZSTD_CCtx_loadDictionary(context, cp_pulse_dictionary, cp_pulse_dictionary_size);
    if (!ZSTD_isError(result))
        result = ZSTD_compress2(context, room, room_size, bytes, size);
    return result;
}

cp_status cp_pulse_encode(const cp_pulse *pulse, void **blob, size_t *size, cp_error *error)
{
    size_t count = pulse->sample_count;
    int64_t *steps[CP_CHANNEL_COUNT] = {NULL};
    unsigned char *bytes = NULL;
    unsigned char *packed = NULL;
    ZSTD_CCtx *context = NULL;
    zstd_block block = {0};
    cp_status status = check_size((int64_t)count, pulse->sample_interval_s, error);
    if (status == CP_OK)
        status = allocate_steps(count, steps, error);
    if (status == CP_OK)
        status = quantise(pulse, steps, error);
    if (status != CP_OK)
        goto done;

    bytes = malloc(count * CP_CHANNEL_COUNT * VARINT_BYTES_MAX);
    if (bytes == NULL) {
        status = cp_fail_memory(error, "pulse");
        goto done;
    }
    size_t used = write_differences(steps, count, pulse->sample_interval_s, bytes);
    size_t room = ZSTD_compressBound(used);
    packed = malloc(HEADER_BYTES_MAX + room);
    if (packed == NULL) {
        status = cp_fail_memory(error, "pulse");
        goto done;
    }
    block.bytes = malloc(ZSTD_BLOCK_BYTES);
    if (block.bytes != NULL)
        context = ZSTD_createCCtx_advanced(
            (ZSTD_customMem){.customAlloc = take_of_block, .customFree = give_to_block, &block});
    if (context == NULL) {
        status = cp_fail_memory(error, "pulse");
        goto done;
    }
    size_t header = write_header(count, pulse->sample_interval_s, packed);
    size_t result = compress_checked(context, packed + header, room, bytes, used);
    if (ZSTD_isError(result)) {
        status = cp_fail(error, CP_STORE_FAILED, "pulse: zstd: %s", ZSTD_getErrorName(result));
        goto done;
    }
    *blob = packed;
    *size = header + result;
    packed = NULL;
done:
    ZSTD_freeCCtx(context);
    free(block.bytes);
    free(packed);
    free(bytes);
    free(steps[0]);
    return status;
}

// ---- decoding ------------------------------------------------------------------------------

static cp_status fail_damaged(cp_error *error, const char *what)
{
    return cp_fail(error, CP_BAD_INPUT, "pulse: damaged: %s", what);
}

static cp_status read_differences(int codec, const unsigned char *bytes, size_t size,
                                  int64_t *const steps[CP_CHANNEL_COUNT], size_t count,
                                  double interval_s, cp_error *error)
{
    size_t at = 0;
    for (size_t place = 0; place < CP_CHANNEL_COUNT; place++) {
        cp_prediction prediction = cp_prediction_begin(codec, place, steps, interval_s);
        for (size_t k = 0; k < count; k++) {
            uint64_t folded = 0;
            if (!read_number(bytes, size, &at, &folded))
                return fail_damaged(error, "ends too early");
            int64_t difference = unfold(folded);
            // The encoder writes 32-bit steps only; anything larger would soon overflow.
            if (llabs(difference) > 8 * (int64_t)INT32_MAX)
                return fail_damaged(error, "a value is out of range");
            int64_t value = cp_prediction_next(&prediction, k) + difference;
            if (llabs(value) > INT32_MAX)
                return fail_damaged(error, "a value is out of range");
            steps[prediction.channel][k] = value;
        }
    }
    return at == size ? CP_OK : fail_damaged(error, "bytes are left over");
}

// Decompress into memory no larger than an encoder of so many samples could have needed.
static cp_status decompress(int codec, const void *blob, size_t size, size_t count,
                            unsigned char **bytes, size_t *used, cp_error *error)
{
    size_t room = count * CP_CHANNEL_COUNT * VARINT_BYTES_MAX;
    unsigned long long content = ZSTD_getFrameContentSize(blob, size);
    if (content == ZSTD_CONTENTSIZE_ERROR || content == ZSTD_CONTENTSIZE_UNKNOWN || content > room)
        return fail_damaged(error, "not a zstd frame of the right size");
    *bytes = malloc((size_t)content + 1);
    ZSTD_DCtx *context = ZSTD_createDCtx();
    if (*bytes == NULL || context == NULL) {
        ZSTD_freeDCtx(context);
        return cp_fail_memory(error, "pulse");
    }
    *used = ZSTD_decompress_usingDict(context, *bytes, (size_t)content, blob, size,
                                      codec == 1 ? NULL : cp_pulse_dictionary,
                                      codec == 1 ? 0 : cp_pulse_dictionary_size);
    ZSTD_freeDCtx(context);
    return ZSTD_isError(*used) ? fail_damaged(error, ZSTD_getErrorName(*used)) : CP_OK;
}

// Number of samples and interval that a blob of codec 2 tells of, and where its frame begins.
static cp_status read_header(const unsigned char *blob, size_t size, int64_t *sample_count,
                             double *interval_s, size_t *frame, cp_error *error)
{
    uint64_t count = 0, interval_ns = 0, bits = 0;
    size_t at = 1;
    if (size == 0 || blob[0] != MARK_OF_CODEC_2)
        return fail_damaged(error, "does not begin like a pulse of codec 2");
    if (!read_number(blob, size, &at, &count) || !read_number(blob, size, &at, &interval_ns) ||
        (interval_ns == 0 && size - at < 8))
        return fail_damaged(error, "ends too early");
    *interval_s = (double)interval_ns / 1e9;
    if (interval_ns == 0) {
        for (int k = 0; k < 8; k++)
            bits |= (uint64_t)blob[at++] << (8 * k);
        memcpy(interval_s, &bits, sizeof bits);
    }
    *sample_count = count <= CP_PULSE_CODEC_SAMPLES_MAX ? (int64_t)count : -1;
    *frame = at;
    return check_size(*sample_count, *interval_s, error);
}

static cp_status decode_frame(int codec, const unsigned char *frame, size_t size, size_t count,
                              double interval_s, cp_pulse *pulse, cp_error *error)
{
    int64_t *steps[CP_CHANNEL_COUNT] = {NULL};
    unsigned char *bytes = NULL;
    size_t used = 0;
    cp_status status = allocate_steps(count, steps, error);
    if (status == CP_OK)
        status = decompress(codec, frame, size, count, &bytes, &used, error);
    if (status == CP_OK)
        status = read_differences(codec, bytes, used, steps, count, interval_s, error);
    if (status == CP_OK)
        status = cp_pulse_create(pulse, count, interval_s, error);
    for (int c = 0; status == CP_OK && c < CP_CHANNEL_COUNT; c++)
        for (size_t k = 0; k < count; k++)
            pulse->channel[c][k] = (double)steps[c][k] * CP_PULSE_RESOLUTION[c];
    free(bytes);
    free(steps[0]);
    return status;
}

cp_status cp_pulse_decode_blob(const void *blob, size_t size, cp_pulse *pulse, cp_error *error)
{
    const unsigned char *bytes = blob;
    int64_t count = 0;
    double interval_s = 0.0;
    size_t frame = 0;
    *pulse = (cp_pulse){0};
    cp_status status = read_header(bytes, size, &count, &interval_s, &frame, error);
    if (status == CP_OK)
        status =
            decode_frame(2, bytes + frame, size - frame, (size_t)count, interval_s, pulse, error);
    return status;
}

cp_status cp_pulse_decode(int codec, const void *blob, size_t size, int64_t sample_count,
                          double sample_interval_s, cp_pulse *pulse, cp_error *error)
{
    *pulse = (cp_pulse){0};
    if (codec < 1 || codec > CP_PULSE_CODEC)
        return cp_fail(error, CP_BAD_INPUT, "pulse: codec %d is unknown to this program", codec);
    cp_status status = check_size(sample_count, sample_interval_s, error);
    if (status != CP_OK)
        return status;
    if (codec == 1)
        return decode_frame(1, blob, size, (size_t)sample_count, sample_interval_s, pulse, error);
    status = cp_pulse_decode_blob(blob, size, pulse, error);
    if (status == CP_OK && (pulse->sample_count != (size_t)sample_count ||
                            pulse->sample_interval_s != sample_interval_s)) {
        cp_pulse_destroy(pulse);
        status = fail_damaged(error, "does not agree with sample_count and sample_interval_s");
    }
    return status;
}

// ---- the record worth keeping --------------------------------------------------------------

cp_status cp_pulse_codec_record(const cp_pulse *raw, cp_pulse *record, cp_error *error)
{
    *record = (cp_pulse){0};
    cp_pulse filtered = {0};
    cp_status status = cp_pulse_filtered(raw, CFC_OF_RECORD, &filtered, error);
    if (status != CP_OK)
        return status;

    // Every n-th sample; the small allowance is for intervals like 0.0005 that are not exact.
    double ratio = CP_PULSE_CODEC_INTERVAL_S / raw->sample_interval_s;
    size_t every = ratio >= 1.0 ? (size_t)floor(ratio * (1.0 + 1e-9)) : 1;
    size_t count = raw->sample_count > 0 ? (raw->sample_count - 1) / every + 1 : 0;
    status = cp_pulse_create(record, count, raw->sample_interval_s * (double)every, error);
    for (int c = 0; status == CP_OK && c < CP_CHANNEL_COUNT; c++)
        for (size_t k = 0; k < count; k++)
            record->channel[c][k] = filtered.channel[c][k * every];
    cp_pulse_destroy(&filtered);
    return status;
}
