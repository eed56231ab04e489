/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STATS_RISK_FUNCTION_H
#define STATS_RISK_FUNCTION_H

#include "core/error.h"
#include "stats/bootstrap.h"

#include <stdbool.h>
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

enum {
    CP_RISK_COEFFICIENTS_MAX = 2,
    CP_RISK_TERMS_MAX = 10,
    CP_RISK_PARAMETERS_MAX = CP_RISK_COEFFICIENTS_MAX + CP_RISK_TERMS_MAX,
    CP_RISK_TRIANGLE_MAX = CP_RISK_PARAMETERS_MAX * (CP_RISK_PARAMETERS_MAX + 1) / 2,
    CP_RISK_TEXT_SIZE = 48
};

/* The thing whose class is known of every crash; of any other the risk is a mean over classes. */
#define CP_RISK_CRASH_TYPE "crash_type"

/* What is added to c0 where a class applies. Of the classes of one thing at most one does. */
typedef struct cp_risk_term {
    char name[CP_RISK_TEXT_SIZE]; /* class: "front-side", "age 70+" */
    char of[CP_RISK_TEXT_SIZE];   /* thing: CP_RISK_CRASH_TYPE, "age" */
    double add;                   /* finite */
    double share_1;               /* of the drivers, 0 ... 1; of no effect for the crash type */
} cp_risk_term;

typedef struct cp_risk_function {
    cp_risk_form form;
    double coefficient[CP_RISK_COEFFICIENTS_MAX];
    double unit_per_si; /* predictor in the function's unit = this times the SI value */
    size_t term_count;
    cp_risk_term term[CP_RISK_TERMS_MAX];
    bool has_covariance;
    double covariance[CP_RISK_PARAMETERS_MAX][CP_RISK_PARAMETERS_MAX]; /* of coefficients, terms */
    double freedom; /* degrees, of the covariance; INFINITY: many */
} cp_risk_function;

const char *cp_risk_form_text(cp_risk_form form);

/* Form from its text, unit of a predictor ("m/s", "km/h", "mph", "m", "g", "1"), and as many finite
 * coefficients as the form has; no terms, no covariance. Error: CP_BAD_INPUT with what is allowed.
 */
CP_MUST_CHECK cp_status cp_risk_function_create(const char *form, const char *unit,
                                                const double *coefficient, size_t count,
                                                cp_risk_function *function, cp_error *error);

/* Add a term. Errors: CP_BAD_INPUT for too many, one of a weibull form, a number that is not finite
 * or a share outside 0 ... 1, shares of one thing above 1. */
CP_MUST_CHECK cp_status cp_risk_function_add_term(cp_risk_function *function,
                                                  const cp_risk_term *term, cp_error *error);

/* Covariance of the coefficients and terms, lower triangle row by row, count numbers; after the
 * terms. freedom > 0, INFINITY: many. Errors: CP_BAD_INPUT for another count, a number that is not
 * finite, a negative variance, a correlation beyond 1. */
CP_MUST_CHECK cp_status cp_risk_function_set_covariance(cp_risk_function *function,
                                                        const double *triangle, size_t count,
                                                        double freedom, cp_error *error);

static inline size_t cp_risk_parameters(const cp_risk_function *function)
{
    return CP_RISK_COEFFICIENTS_MAX + function->term_count;
}

/* Whether the risk depends on the crash type. */
bool cp_risk_has_crash_type(const cp_risk_function *function);

/* Probability at an SI value of the predictor, 0 ... 1; NAN of NAN. Of the class of the crash type,
 * NULL or one without a term: c0 alone. */
double cp_risk_probability(const cp_risk_function *function, double predictor,
                           const char *crash_type);

/* The same; times the derivative by each parameter is added to gradient (cp_risk_parameters of
 * them), unless the result is NAN. */
double cp_risk_add(const cp_risk_function *function, double predictor, const char *crash_type,
                   double times, double *gradient);

/* Variance that the parameters leave to a sum of probabilities with this gradient; 0 without a
 * covariance. */
double cp_risk_variance(const cp_risk_function *function, const double *gradient);

/* An interval of a positive estimate at 95 %, widened by the relative standard error that the
 * parameters add, independent of what the interval comes from: on the logarithmic scale the
 * distance of each limit from the estimate and t standard errors are added as squares (Zou and
 * Donner 2008, "Construction of confidence limits about effect measures"). A limit at 0 stays. */
cp_interval cp_risk_widened(double estimate, cp_interval interval, double relative_se,
                            double freedom);

#endif
