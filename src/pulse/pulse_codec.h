/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PULSE_PULSE_CODEC_H
#define PULSE_PULSE_CODEC_H

#include "pulse/pulse_resolution.h"

#include <stddef.h>
#include <stdint.h>

/* Pulses as small blobs. A pulse is brought to about 1 kHz, every channel is rounded to its
 * resolution and predicted (pulse_prediction.h), and the differences are packed as variable-length
 * integers and compressed with zstd. Decoding gives the rounded values back exactly. Codec 1
 * predicts from the last samples; codec 2 follows velocities, displacements and yaw as unrounded
 * integrals, which leaves little more than the accelerations to pack. Resolutions are the same.
 *
 * A blob of codec 2 explains itself: byte 0xc2, number of samples, sample interval in ns (0: its
 * eight bytes as IEEE double follow, lowest first), both as variable-length integers, then the zstd
 * frame, made with the dictionary db/pulse.zdict and with zstd's checksum of its content (frames of
 * before have none and are read as well). Of codec 1 it is a frame alone, without dictionary. */

#define CP_PULSE_CODEC 2 /* what is written; both are read. Column pulse.codec */
#define CP_PULSE_CODEC_INTERVAL_S 1e-3
#define CP_PULSE_CODEC_SAMPLES_MAX 100000

/* The record worth keeping of a simulated pulse: accelerations through CFC180 (so that thinning
 * out folds nothing back), then every n-th sample with n the largest that keeps the interval at or
 * below 1 ms. The caller destroys it. */
CP_MUST_CHECK cp_status cp_pulse_codec_record(const cp_pulse *raw, cp_pulse *record,
                                              cp_error *error);

/* Pack pulse as it is. *blob is the caller's to free. Errors: CP_NO_MEMORY, CP_BAD_INPUT for a
 * value that is not finite or beyond 32 bits of its resolution, CP_STORE_FAILED from zstd. */
CP_MUST_CHECK cp_status cp_pulse_encode(const cp_pulse *pulse, void **blob, size_t *size,
                                        cp_error *error);

/* Unpack. codec, sample_count and sample_interval_s stand beside the blob in the database and must
 * agree with what it says of itself. The caller destroys the pulse. Errors: CP_BAD_INPUT for
 * anything that no encoder wrote. */
CP_MUST_CHECK cp_status cp_pulse_decode(int codec, const void *blob, size_t size,
                                        int64_t sample_count, double sample_interval_s,
                                        cp_pulse *pulse, cp_error *error);

/* Unpack a blob that explains itself (codec 2). Errors as above; CP_BAD_INPUT for codec 1. */
CP_MUST_CHECK cp_status cp_pulse_decode_blob(const void *blob, size_t size, cp_pulse *pulse,
                                             cp_error *error);

#endif
