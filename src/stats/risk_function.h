/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STATS_RISK_FUNCTION_H
#define STATS_RISK_FUNCTION_H

#include "core/error.h"

#include <stddef.h>

/* Probability of an injury as a function of a severity measure. Which functions there are stands
 * in the table risk_function of the database, not here. */

/* X(name, text in the table, number of coefficients). x: predictor in the function's unit.
 * logistic: 1 / (1 + exp(-(c0 + c1 x)));  log_logistic: the same of ln x, 0 at x = 0;
 * probit: normal distribution function of c0 + c1 x;  weibull: 1 - exp(-(x / c0)^c1). */
#define CP_RISK_FORMS(X)                                                                           \
    X(CP_RISK_LOGISTIC, "logistic", 2)                                                             \
    X(CP_RISK_LOG_LOGISTIC, "log_logistic", 2)                                                     \
    X(CP_RISK_PROBIT, "probit", 2)                                                                 \
    X(CP_RISK_WEIBULL, "weibull", 2)

typedef enum cp_risk_form {
#define CP_RISK_NAME(name, text, count) name,
    CP_RISK_FORMS(CP_RISK_NAME)
#undef CP_RISK_NAME
        CP_RISK_FORM_COUNT
} cp_risk_form;

#define CP_RISK_COEFFICIENTS_MAX 2

typedef struct cp_risk_function {
    cp_risk_form form;
    double coefficient[CP_RISK_COEFFICIENTS_MAX];
    double unit_per_si; /* predictor in the function's unit = this times the SI value */
} cp_risk_function;

const char *cp_risk_form_text(cp_risk_form form);

/* Form from its text, unit of a predictor ("m/s", "km/h", "mph", "m", "g", "1"), and as many finite
 * coefficients as the form has. Error: CP_BAD_INPUT with what is allowed. */
CP_MUST_CHECK cp_status cp_risk_function_create(const char *form, const char *unit,
                                                const double *coefficient, size_t count,
                                                cp_risk_function *function, cp_error *error);

/* Probability at an SI value of the predictor, 0 ... 1; NAN of NAN. */
double cp_risk_probability(const cp_risk_function *function, double predictor);

#endif
