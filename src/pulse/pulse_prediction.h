/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PULSE_PULSE_PREDICTION_H
#define PULSE_PULSE_PREDICTION_H

#include "pulse/pulse.h"

#include <stdint.h>

/* What the samples of a pulse are expected to be, channel by channel, from the samples before and
 * from the channels packed earlier: what pulse_codec packs are the differences to it. Everything in
 * steps (whole multiples of the channel's resolution). Plain IEEE arithmetic and rounding only, so
 * that every machine predicts the same. */

/* Channels in the order they are packed: number place of codec (1 or 2). */
cp_pulse_channel cp_prediction_channel(int codec, size_t place);

/* Where the prediction of one channel stands. */
typedef struct cp_prediction {
    int codec;
    cp_pulse_channel channel;
    int64_t *const *steps; /* of all channels; those packed earlier are complete */
    double interval_s;
    double estimate;     /* codec 2, integrated channels: the unrounded value, in steps */
    double velocity[2];  /* codec 2, displacements: world velocity, m/s, */
    double direction[2]; /* and cosine and sine of the yaw */
} cp_prediction;

/* Begin with a channel. */
cp_prediction cp_prediction_begin(int codec, size_t place, int64_t *const *steps,
                                  double interval_s);
/* Sample k of the channel; the samples before it are in steps. In order of k, each once. */
int64_t cp_prediction_next(cp_prediction *prediction, size_t k);

#endif
