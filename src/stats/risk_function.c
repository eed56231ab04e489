/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/risk_function.h"

#include <gsl/gsl_cdf.h>

#include <math.h>
#include <string.h>

static const char *const FORM_TEXT[] = {
#define CP_RISK_TEXT(name, text, count) text,
    CP_RISK_FORMS(CP_RISK_TEXT)
#undef CP_RISK_TEXT
};

static const size_t FORM_COEFFICIENTS[] = {
#define CP_RISK_COUNT(name, text, count) count,
    CP_RISK_FORMS(CP_RISK_COUNT)
#undef CP_RISK_COUNT
};

/* A mile is 1609.344 m. */
static const struct {
    const char *text;
    double per_si;
} UNIT[] = {{"m/s", 1.0}, {"km/h", 3.6}, {"mph", 3600.0 / 1609.344},
            {"m", 1.0},   {"g", 1.0},    {"1", 1.0}};

const char *cp_risk_form_text(cp_risk_form form)
{
    return FORM_TEXT[form];
}

cp_status cp_risk_function_create(const char *form, const char *unit, const double *coefficient,
                                  size_t count, cp_risk_function *function, cp_error *error)
{
    *function = (cp_risk_function){.form = CP_RISK_FORM_COUNT, .unit_per_si = NAN};
    for (int k = 0; k < CP_RISK_FORM_COUNT; k++)
        if (strcmp(form, FORM_TEXT[k]) == 0)
            function->form = (cp_risk_form)k;
    if (function->form == CP_RISK_FORM_COUNT)
        return cp_fail(error, CP_BAD_INPUT,
                       "form must be logistic, log_logistic, probit or weibull, found '%s'", form);
    for (size_t k = 0; k < sizeof UNIT / sizeof *UNIT; k++)
        if (strcmp(unit, UNIT[k].text) == 0)
            function->unit_per_si = UNIT[k].per_si;
    if (isnan(function->unit_per_si))
        return cp_fail(error, CP_BAD_INPUT, "unit must be m/s, km/h, mph, m, g or 1, found '%s'",
                       unit);
    if (count != FORM_COEFFICIENTS[function->form])
        return cp_fail(error, CP_BAD_INPUT, "form %s has %zu coefficients, found %zu", form,
                       FORM_COEFFICIENTS[function->form], count);
    for (size_t k = 0; k < count; k++) {
        if (!isfinite(coefficient[k]))
            return cp_fail(error, CP_BAD_INPUT, "coefficient %zu is not finite", k);
        function->coefficient[k] = coefficient[k];
    }
    if (function->form == CP_RISK_WEIBULL && !(coefficient[0] > 0.0 && coefficient[1] > 0.0))
        return cp_fail(error, CP_BAD_INPUT, "coefficients of a weibull form must be > 0");
    return CP_OK;
}

double cp_risk_probability(const cp_risk_function *function, double predictor)
{
    double x = function->unit_per_si * predictor;
    const double *c = function->coefficient;
    if (isnan(x))
        return NAN;
    switch (function->form) {
    case CP_RISK_LOGISTIC:
        return 1.0 / (1.0 + exp(-(c[0] + c[1] * x)));
    case CP_RISK_LOG_LOGISTIC:
        return x > 0.0 ? 1.0 / (1.0 + exp(-(c[0] + c[1] * log(x)))) : 0.0;
    case CP_RISK_PROBIT:
        return gsl_cdf_ugaussian_P(c[0] + c[1] * x);
    case CP_RISK_WEIBULL:
        return x > 0.0 ? -expm1(-pow(x / c[0], c[1])) : 0.0;
    case CP_RISK_FORM_COUNT:
        break;
    }
    return NAN;
}
