/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/risk_function.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_randist.h>

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

// ---- making one ------------------------------------------------------------------------------

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

static bool is_known(const cp_risk_term *term)
{
    return strcmp(term->of, CP_RISK_CRASH_TYPE) == 0;
}

bool cp_risk_has_crash_type(const cp_risk_function *function)
{
    for (size_t k = 0; k < function->term_count; k++)
        if (is_known(&function->term[k]))
            return true;
    return false;
}

cp_status cp_risk_function_add_term(cp_risk_function *function, const cp_risk_term *term,
                                    cp_error *error)
{
    if (function->term_count == CP_RISK_TERMS_MAX)
        return cp_fail(error, CP_BAD_INPUT, "terms must be at most %d", CP_RISK_TERMS_MAX);
    if (function->form == CP_RISK_WEIBULL)
        return cp_fail(error, CP_BAD_INPUT, "a weibull form has no terms, found '%s'", term->name);
    if (!isfinite(term->add))
        return cp_fail(error, CP_BAD_INPUT, "term '%s': add is not finite", term->name);
    double shares = 0.0;
    for (size_t k = 0; k < function->term_count; k++) {
        if (strcmp(function->term[k].name, term->name) == 0)
            return cp_fail(error, CP_BAD_INPUT, "term '%s' is there twice", term->name);
        shares += strcmp(function->term[k].of, term->of) == 0 ? function->term[k].share_1 : 0.0;
    }
    if (!is_known(term) && !(term->share_1 >= 0.0 && shares + term->share_1 <= 1.0 + 1e-9))
        return cp_fail(error, CP_BAD_INPUT,
                       "term '%s': share must be 0 to 1, and those of '%s' at most 1 together, "
                       "found %g",
                       term->name, term->of, term->share_1);
    function->term[function->term_count++] = *term;
    return CP_OK;
}

cp_status cp_risk_function_set_covariance(cp_risk_function *function, const double *triangle,
                                          size_t count, double freedom, cp_error *error)
{
    size_t size = cp_risk_parameters(function), at = 0;
    if (count != size * (size + 1) / 2)
        return cp_fail(error, CP_BAD_INPUT,
                       "covariance of %zu parameters must have %zu numbers (lower triangle), found "
                       "%zu",
                       size, size * (size + 1) / 2, count);
    if (!(freedom > 0.0))
        return cp_fail(error, CP_BAD_INPUT, "freedom must be > 0, found %g", freedom);
    for (size_t i = 0; i < size; i++)
        for (size_t j = 0; j <= i; j++, at++)
            function->covariance[i][j] = function->covariance[j][i] = triangle[at];
    for (size_t i = 0; i < size; i++)
        for (size_t j = 0; j <= i; j++) {
            double v = function->covariance[i][j];
            double most = sqrt(function->covariance[i][i] * function->covariance[j][j]);
            if (!(fabs(v) <= most * (1.0 + 1e-6)) || function->covariance[i][i] < 0.0)
                return cp_fail(error, CP_BAD_INPUT,
                               "covariance of parameters %zu and %zu must be a number of at most "
                               "the root of their variances, found %g",
                               i, j, v);
        }
    function->has_covariance = true;
    function->freedom = freedom;
    return CP_OK;
}

// ---- probability -----------------------------------------------------------------------------

/* A driver of whom some classes are chosen, others still open. */
typedef struct driver {
    const cp_risk_function *function;
    double x;      /* what c1 is multiplied with */
    double *slope; /* sum of shares times derivative by eta: [0] of c0, [1] of c1, then terms */
    const char *crash_type;
    bool chosen[CP_RISK_TERMS_MAX];
} driver;

// Distribution function of eta, and its density.
static double of_eta(cp_risk_form form, double eta, double *density)
{
    if (form == CP_RISK_PROBIT) {
        *density = gsl_ran_ugaussian_pdf(eta);
        return gsl_cdf_ugaussian_P(eta);
    }
    double p = 1.0 / (1.0 + exp(-eta));
    *density = p * (1.0 - p);
    return p;
}

static double at_eta(driver *d, double eta, double share)
{
    double density, p = of_eta(d->function->form, eta, &density);
    if (d->slope) {
        d->slope[0] += share * density;
        d->slope[1] += share * density * d->x;
        for (size_t k = 0; k < d->function->term_count; k++)
            d->slope[2 + k] += d->chosen[k] ? share * density : 0.0;
    }
    return share * p;
}

// Whether a term is the first of its thing.
static bool opens(const cp_risk_function *f, size_t term)
{
    for (size_t k = 0; k < term; k++)
        if (strcmp(f->term[k].of, f->term[term].of) == 0)
            return false;
    return true;
}

// Mean over the classes of every thing from term `from` on, things in the order of their first
// term.
static double mean_from(driver *d, size_t from, double eta, double share)
{
    const cp_risk_function *f = d->function;
    while (from < f->term_count && !opens(f, from))
        from++;
    if (from == f->term_count)
        return at_eta(d, eta, share);
    double sum = 0.0, rest = 1.0;
    bool known = is_known(&f->term[from]);
    for (size_t k = from; k < f->term_count; k++) {
        if (strcmp(f->term[k].of, f->term[from].of) != 0)
            continue;
        double own = !known ? f->term[k].share_1
                            : d->crash_type && strcmp(d->crash_type, f->term[k].name) == 0;
        rest -= own;
        if (own <= 0.0)
            continue;
        d->chosen[k] = true;
        sum += mean_from(d, from + 1, eta + f->term[k].add, share * own);
        d->chosen[k] = false;
    }
    return rest > 1e-12 ? sum + mean_from(d, from + 1, eta, share * rest) : sum;
}

// 1 - exp(-(x / c0)^c1), and its derivatives.
static double weibull(const double *c, double x, double slope[2])
{
    if (!(x > 0.0))
        return 0.0;
    double power = pow(x / c[0], c[1]), rest = exp(-power);
    slope[0] = -rest * power * c[1] / c[0];
    slope[1] = rest * power * log(x / c[0]);
    return -expm1(-power);
}

double cp_risk_add(const cp_risk_function *function, double predictor, const char *crash_type,
                   double times, double *gradient)
{
    double x = function->unit_per_si * predictor, slope[CP_RISK_PARAMETERS_MAX] = {0.0}, p;
    if (isnan(x))
        return NAN;
    if (function->form == CP_RISK_WEIBULL) {
        p = weibull(function->coefficient, x, slope);
    } else {
        bool logarithm = function->form == CP_RISK_LOG_LOGISTIC;
        if (logarithm && !(x > 0.0))
            return 0.0;
        driver d = {.function = function,
                    .x = logarithm ? log(x) : x,
                    .slope = gradient ? slope : NULL,
                    .crash_type = crash_type};
        p = mean_from(&d, 0, function->coefficient[0] + function->coefficient[1] * d.x, 1.0);
    }
    for (size_t k = 0; gradient && k < cp_risk_parameters(function); k++)
        gradient[k] += times * slope[k];
    return p;
}

double cp_risk_probability(const cp_risk_function *function, double predictor,
                           const char *crash_type)
{
    return cp_risk_add(function, predictor, crash_type, 1.0, NULL);
}

// ---- what the parameters leave open ----------------------------------------------------------

double cp_risk_variance(const cp_risk_function *function, const double *gradient)
{
    double variance = 0.0;
    for (size_t i = 0; function->has_covariance && i < cp_risk_parameters(function); i++)
        for (size_t j = 0; j < cp_risk_parameters(function); j++)
            variance += gradient[i] * function->covariance[i][j] * gradient[j];
    return fmax(0.0, variance);
}

cp_interval cp_risk_widened(double estimate, cp_interval interval, double relative_se,
                            double freedom)
{
    if (interval.status != CP_INTERVAL_VALUE || !(estimate > 0.0) || !(relative_se > 0.0))
        return interval;
    double t =
        isfinite(freedom) ? gsl_cdf_tdist_Pinv(0.975, freedom) : gsl_cdf_ugaussian_Pinv(0.975);
    double added = t * relative_se;
    if (interval.low > 0.0)
        interval.low = estimate * exp(-hypot(log(estimate / interval.low), added));
    interval.high = estimate * exp(hypot(log(interval.high / estimate), added));
    return interval;
}
