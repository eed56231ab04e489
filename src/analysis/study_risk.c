/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/study_risk.h"

#include <jansson.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

// A JSON array of a column.
static cp_status load(const char *column, const char *text, json_t **array, cp_error *error)
{
    json_error_t place;
    *array = json_loads(text, 0, &place);
    if (json_is_array(*array))
        return CP_OK;
    json_decref(*array);
    *array = NULL;
    return cp_fail(error, CP_BAD_INPUT, "%s must be a JSON array, found '%.60s'", column, text);
}

static cp_status add_term(cp_risk_function *function, const json_t *from, size_t number,
                          cp_error *error)
{
    const char *name = json_string_value(json_object_get(from, "name"));
    const char *of = json_string_value(json_object_get(from, "of"));
    const json_t *add = json_object_get(from, "add"), *share = json_object_get(from, "share");
    cp_risk_term term = {.add = json_number_value(add), .share_1 = json_number_value(share)};
    if (!name || !of || !json_is_number(add) || strlen(name) >= sizeof term.name ||
        strlen(of) >= sizeof term.of)
        return cp_fail(error, CP_BAD_INPUT,
                       "terms[%zu] must have the texts name and of, of fewer than %d bytes, and "
                       "the number add",
                       number, CP_RISK_TEXT_SIZE);
    if (!json_is_number(share) && strcmp(of, CP_RISK_CRASH_TYPE) != 0)
        return cp_fail(error, CP_BAD_INPUT,
                       "terms[%zu], '%s': the number share is missing, which only terms of "
                       "crash_type do without",
                       number, name);
    snprintf(term.name, sizeof term.name, "%s", name);
    snprintf(term.of, sizeof term.of, "%s", of);
    return cp_risk_function_add_term(function, &term, error);
}

cp_status cp_study_risk_terms(cp_risk_function *function, const char *text, cp_error *error)
{
    json_t *array = NULL;
    cp_status status = load("terms", text, &array, error);
    for (size_t k = 0; status == CP_OK && k < json_array_size(array); k++)
        status = add_term(function, json_array_get(array, k), k, error);
    json_decref(array);
    return status;
}

cp_status cp_study_risk_covariance(cp_risk_function *function, const char *text, double freedom,
                                   cp_error *error)
{
    json_t *array = NULL;
    double triangle[CP_RISK_TRIANGLE_MAX] = {0.0};
    cp_status status = load("covariance", text, &array, error);
    size_t count = json_array_size(array);
    for (size_t k = 0; k < count && k < CP_RISK_TRIANGLE_MAX; k++) {
        const json_t *value = json_array_get(array, k);
        triangle[k] = json_is_number(value) ? json_number_value(value) : NAN;
    }
    if (status == CP_OK)
        status = cp_risk_function_set_covariance(function, triangle, count,
                                                 isnan(freedom) ? INFINITY : freedom, error);
    json_decref(array);
    return status;
}
