/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stats/risk_function.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <string.h>

static cp_risk_function made(const char *form, const char *unit, double c0, double c1)
{
    cp_risk_function f;
    cp_error error = {0};
    if (cp_risk_function_create(form, unit, (double[]){c0, c1}, 2, &f, &error) != CP_OK)
        fail_msg("%s", error.text);
    return f;
}

static void add(cp_risk_function *f, const char *name, const char *of, double adds, double share)
{
    cp_risk_term term = {.add = adds, .share_1 = share};
    cp_error error = {0};
    strcpy(term.name, name);
    strcpy(term.of, of);
    if (cp_risk_function_add_term(f, &term, &error) != CP_OK)
        fail_msg("%s", error.text);
}

static cp_risk_function by_type_and_age(void)
{
    cp_risk_function f = made("logistic", "km/h", -6.9, 0.098);
    add(&f, "front-side", CP_RISK_CRASH_TYPE, -1.5, 0.0);
    add(&f, "age 35-54", "age", 1.0, 0.3);
    add(&f, "age 70+", "age", 2.2, 0.1);
    add(&f, "female", "sex", 0.4, 0.45);
    return f;
}

static double logistic(double eta)
{
    return 1.0 / (1.0 + exp(-eta));
}

// The crash type is known; of age and sex the risk is the mean over the six kinds of drivers.
static void risk_is_the_mean_over_what_is_not_known(void **state)
{
    (void)state;
    cp_risk_function f = by_type_and_age();
    const double age[] = {0.0, 1.0, 2.2}, of_age[] = {0.6, 0.3, 0.1};
    const double sex[] = {0.0, 0.4}, of_sex[] = {0.55, 0.45};
    for (int side = 0; side < 2; side++) {
        double mean = 0.0, eta = -6.9 + 0.098 * 45.0 - 1.5 * side;
        for (int a = 0; a < 3; a++)
            for (int s = 0; s < 2; s++)
                mean += of_age[a] * of_sex[s] * logistic(eta + age[a] + sex[s]);
        double found = cp_risk_probability(&f, 12.5, side ? "front-side" : "front-front");
        assert_true(fabs(found - mean) < 1e-14);
    }
    assert_true(cp_risk_probability(&f, 12.5, NULL) ==
                cp_risk_probability(&f, 12.5, "front-front"));
    assert_true(isnan(cp_risk_probability(&f, NAN, "front-side")));
}

// The gradient is what a small change of each parameter does.
static void gradient_is_the_derivative(void **state)
{
    (void)state;
    cp_risk_function cases[] = {by_type_and_age(), made("log_logistic", "km/h", -15.5, 3.47),
                                made("probit", "m/s", -2.0, 0.1),
                                made("weibull", "m/s", 20.0, 3.0)};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        cp_risk_function f = cases[c];
        double gradient[CP_RISK_PARAMETERS_MAX] = {0.0};
        double p = cp_risk_add(&f, 11.0, "front-side", 2.0, gradient);
        assert_true(p == cp_risk_probability(&f, 11.0, "front-side") && p > 0.0);
        for (size_t k = 0; k < cp_risk_parameters(&f); k++) {
            double *parameter = k < 2 ? &f.coefficient[k] : &f.term[k - 2].add;
            double before = *parameter, step = 1e-5;
            *parameter = before + step;
            double above = cp_risk_probability(&f, 11.0, "front-side");
            *parameter = before - step;
            double below = cp_risk_probability(&f, 11.0, "front-side");
            *parameter = before;
            if (fabs(gradient[k] - (above - below) / step) > 1e-6 * fmax(1.0, fabs(gradient[k])))
                fail_msg("case %zu, parameter %zu: %g", c, k, gradient[k]);
        }
    }
}

static void variance_is_the_quadratic_form(void **state)
{
    (void)state;
    cp_risk_function f = made("logistic", "km/h", -7.0, 0.1);
    cp_error error = {0};
    const double gradient[] = {2.0, 30.0};
    assert_true(cp_risk_variance(&f, gradient) == 0.0);
    assert_int_equal(
        cp_risk_function_set_covariance(&f, (double[]){0.08, -0.002, 6e-5}, 3, 15.0, &error),
        CP_OK);
    double wanted = 4.0 * 0.08 + 2.0 * 60.0 * -0.002 + 900.0 * 6e-5;
    assert_true(fabs(cp_risk_variance(&f, gradient) - wanted) < 1e-15);

    // Squares of distances on the logarithmic scale; t of 15 degrees is 2.13145.
    cp_interval i = cp_risk_widened(3.0, (cp_interval){CP_INTERVAL_VALUE, 2.0, 5.0}, 0.1, 15.0);
    double added = 2.1314495456 * 0.1;
    assert_true(fabs(i.low - 3.0 * exp(-sqrt(pow(log(1.5), 2) + added * added))) < 1e-9);
    assert_true(fabs(i.high - 3.0 * exp(sqrt(pow(log(5.0 / 3.0), 2) + added * added))) < 1e-9);
    i = cp_risk_widened(3.0, (cp_interval){CP_INTERVAL_TOO_FEW_CRASHES, NAN, NAN}, 0.1, 15.0);
    assert_int_equal(i.status, CP_INTERVAL_TOO_FEW_CRASHES);
}

static void wrong_ones_are_refused(void **state)
{
    (void)state;
    cp_risk_function f = by_type_and_age();
    cp_risk_term term = {"female", "sex", 0.1, 0.2};
    cp_error error = {0};
    assert_int_equal(cp_risk_function_add_term(&f, &term, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "twice"));
    term = (cp_risk_term){"age 55-69", "age", 0.1, 0.7};
    assert_int_equal(cp_risk_function_add_term(&f, &term, &error), CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "at most 1 together"));
    assert_int_equal(cp_risk_function_set_covariance(&f, (double[]){1.0}, 1, 15.0, &error),
                     CP_BAD_INPUT);
    assert_non_null(strstr(error.text, "must have 21 numbers"));
    f = made("logistic", "km/h", -7.0, 0.1);
    assert_int_equal(
        cp_risk_function_set_covariance(&f, (double[]){1.0, 2.0, 1.0}, 3, 15.0, &error),
        CP_BAD_INPUT);
    f = made("weibull", "km/h", 7.0, 0.1);
    term.share_1 = 0.1;
    assert_int_equal(cp_risk_function_add_term(&f, &term, &error), CP_BAD_INPUT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(risk_is_the_mean_over_what_is_not_known),
        cmocka_unit_test(gradient_is_the_derivative),
        cmocka_unit_test(variance_is_the_quadratic_form),
        cmocka_unit_test(wrong_ones_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
