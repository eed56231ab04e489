/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STUDY_CONTROLS_TEXT_H
#define STUDY_CONTROLS_TEXT_H

#include "study/study.h"

#include <stdio.h>

/* What a study really runs, in words: every driver error of every scenario and every function of
 * every variant with all its parameters, given or default, so that nobody runs a default
 * unknowingly. One line each:
 *
 *     scenario left_turn: driver errors failed_to_see (probability_1 0.25)
 *     variant aeb: functions aeb (ttc_s 1.5, deceleration_m_s2 8; equipment van 0.5) */

/* Write one line, without its end, to out: the controls of scenario or variant number k. */
void cp_controls_text_scenario(const cp_study *study, size_t k, FILE *out);
void cp_controls_text_variant(const cp_study *study, size_t k, FILE *out);
/* All lines, each begun with prefix and ended. */
void cp_controls_text_study(const cp_study *study, const char *prefix, FILE *out);

#endif
