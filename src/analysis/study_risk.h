/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_STUDY_RISK_H
#define ANALYSIS_STUDY_RISK_H

#include "stats/risk_function.h"

/* The JSON columns of table risk_function. */

/* Add the terms of a text like [{"name": "age 70+", "of": "age", "add": 2.2, "share": 0.06}]; share
 * is needed of everything but the crash type. Error: CP_BAD_INPUT with the term and what is wrong.
 */
CP_MUST_CHECK cp_status cp_study_risk_terms(cp_risk_function *function, const char *text,
                                            cp_error *error);

/* Set the covariance of a text like [v00, v10, v11], after the terms; freedom NAN: many. Error:
 * CP_BAD_INPUT. */
CP_MUST_CHECK cp_status cp_study_risk_covariance(cp_risk_function *function, const char *text,
                                                 double freedom, cp_error *error);

#endif
