/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef REPORT_ANSWER_H
#define REPORT_ANSWER_H

#include "analysis/figures.h"

/* A comparison in a few sentences. First a sentence (ended by a new line) for each treatment, its
 * intervals before the estimates; then, behind an empty line, the conditions, each once: what was
 * compared and what could not be, what the intervals trust, what the validated range and the crash
 * model leave open, how many crashes it rests on and the driver errors the rates are conditional
 * on. UTF-8; the caller frees. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_comparison_answer(const cp_study_data *data,
                                             const cp_comparison *comparison, char **answer,
                                             cp_error *error);

/* An estimate as text: "18.2", "<1.9", "n/a". digits after the point. Returns text. */
#define CP_ESTIMATE_TEXT_SIZE 32
const char *cp_estimate_text(cp_estimate estimate, int digits, char text[CP_ESTIMATE_TEXT_SIZE]);

/* A p-value as text: "0.012", "<0.001", "n/a". Returns text. */
const char *cp_p_text(double p, char text[CP_ESTIMATE_TEXT_SIZE]);

#endif
