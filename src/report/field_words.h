/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef REPORT_FIELD_WORDS_H
#define REPORT_FIELD_WORDS_H

#include "analysis/field_figures.h"

/* What to know of it in words: how far the study is from the field, what either never has, what the
 * weights cost, the field's bias. UTF-8, one paragraph; the caller frees. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_field_words(const cp_comparison *comparison,
                                       const cp_field_request *request, char **words,
                                       cp_error *error);

#endif
