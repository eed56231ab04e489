/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/sweep_section.h"

#include "core/array.h"
#include "study/study_parts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define KEY_PATH_SIZE 512
#define VALUE_TEXT_SIZE 32
#define LIST_SIZE 1024
#define NAME_CHARACTERS "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-."

// ---- the section as libcyaml reads it ------------------------------------------------------

static const cyaml_schema_value_t VALUE = {
    CYAML_VALUE_STRING(CYAML_FLAG_POINTER, char *, 0, CYAML_UNLIMITED)};

#define SWEEP_TEXT(key, flag)                                                                      \
    CYAML_FIELD_STRING_PTR(#key, CYAML_FLAG_POINTER | (flag), cp_sweep_entry, key, 1,              \
                           CYAML_UNLIMITED)

static const cyaml_schema_field_t FIELDS[] = {
    SWEEP_TEXT(parameter, CYAML_FLAG_DEFAULT),
    CYAML_FIELD_SEQUENCE("values", CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, cp_sweep_entry, values,
                         &VALUE, 1, CYAML_UNLIMITED),
    SWEEP_TEXT(from, CYAML_FLAG_OPTIONAL),
    SWEEP_TEXT(to, CYAML_FLAG_OPTIONAL),
    SWEEP_TEXT(steps, CYAML_FLAG_OPTIONAL),
    CYAML_FIELD_END};

const cyaml_schema_value_t CP_SWEEP_ENTRY = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, cp_sweep_entry, FIELDS)};

// ---- one swept parameter -------------------------------------------------------------------

typedef struct axis {
    const cp_yaml_file *file;
    size_t entry;            /* place in the section */
    char key[KEY_PATH_SIZE]; /* of its parameter, for messages */
    bool of_scenario;
    size_t owner;                    /* index of the scenario or variant */
    const cp_control_settings *list; /* controls of the owner */
    size_t list_count;
    size_t control;                   /* which of them, */
    const cp_control_parameter *what; /* and which parameter of it; NULL: */
    size_t given;                     /* 1 + which parameter given to its library; 0: */
    size_t share;                     /* 1 + which entry of its equipment; 0: */
    char name[96];                    /* an option of SUMO, without the dashes; "equipment.TYPE" */
    double *values;
    size_t count;
} axis;

static const char *owner_name(const axis *a, const cp_study *study)
{
    return a->of_scenario ? study->scenarios[a->owner].base : study->variants[a->owner].base;
}

// Name of the parameter alone, and of whose it is.
static const char *short_name(const axis *a)
{
    return a->what != NULL ? a->what->name : a->name;
}

static const char *group_name(const axis *a)
{
    bool is_control = a->what != NULL || a->share > 0 || a->given > 0;
    return is_control ? cp_control_name(&a->list[a->control]) : "sumo_options";
}

static void append(char list[LIST_SIZE], const char *name)
{
    size_t used = strlen(list);
    snprintf(list + used, LIST_SIZE - used, "%s%s", used > 0 ? ", " : "", name);
}

// ---- whose parameter -----------------------------------------------------------------------

// The scenario or variant whose name the text begins with, the longest that fits (names may hold
// dots); its rest, behind the dot.
static const char *find_owner(axis *a, const cp_study *study, const char *text)
{
    const char *rest = NULL;
    size_t best = 0, count = a->of_scenario ? study->scenario_count : study->variant_count;
    for (size_t k = 0; k < count; k++) {
        const char *name = a->of_scenario ? study->scenarios[k].name : study->variants[k].name;
        size_t length = strlen(name);
        if (strncmp(text, name, length) == 0 && text[length] == '.' && length >= best) {
            best = length;
            a->owner = k;
            rest = text + length + 1;
        }
    }
    return rest;
}

static cp_status fail_owner(const axis *a, const cp_study *study, cp_error *error)
{
    char names[LIST_SIZE] = "";
    size_t count = a->of_scenario ? study->scenario_count : study->variant_count;
    for (size_t k = 0; k < count; k++)
        append(names, a->of_scenario ? study->scenarios[k].name : study->variants[k].name);
    return cp_yaml_fail(a->file, error, a->key,
                        "names no parameter of a %s of this study; they are %s",
                        a->of_scenario ? "scenario" : "variant", names);
}

// Whether control number c has the parameter; how many have is counted, their names are collected.
static void look_into_parameters(axis *a, size_t c, const char *name, char had[LIST_SIZE],
                                 size_t *found)
{
    const cp_control_type *type = a->list[c].type;
    for (size_t p = 0; p < type->parameter_count; p++) {
        char full[128];
        snprintf(full, sizeof full, "%s.%s", cp_control_name(&a->list[c]),
                 type->parameters[p].name);
        append(had, full);
        if (strcmp(type->parameters[p].name, name) != 0)
            continue;
        a->control = c;
        a->what = &type->parameters[p];
        ++*found;
    }
}

// The same for what the study gives to its library.
static void look_into_given(axis *a, size_t c, const char *name, char had[LIST_SIZE], size_t *found)
{
    const cp_library *library = a->list[c].library;
    for (size_t k = 0; library != NULL && k < library->given_count; k++) {
        char full[128];
        snprintf(full, sizeof full, "%s.%s", library->name, library->given[k].name);
        append(had, full);
        if (strcmp(library->given[k].name, name) != 0)
            continue;
        a->control = c;
        a->given = k + 1;
        snprintf(a->name, sizeof a->name, "%s", name);
        ++*found;
    }
}

// The same for its penetration among vehicles of a type, "equipment.TYPE".
static void look_into_equipment(axis *a, size_t c, const char *name, char had[LIST_SIZE],
                                size_t *found)
{
    for (size_t k = 0; k < a->list[c].share_count; k++) {
        char share[96], full[160];
        int length = snprintf(share, sizeof share, "equipment.%s", a->list[c].shares[k].type);
        snprintf(full, sizeof full, "%s.%s", cp_control_name(&a->list[c]), share);
        append(had, full);
        if (strcmp(share, name) != 0 || length >= (int)sizeof share)
            continue;
        a->control = c;
        a->share = k + 1;
        snprintf(a->name, sizeof a->name, "%s", share);
        ++*found;
    }
}

// A parameter of one of the owner's controls; text is "CONTROL.PARAMETER" or "PARAMETER".
static cp_status find_parameter(axis *a, const char *text, cp_error *error)
{
    char had[LIST_SIZE] = "";
    size_t found = 0;
    for (size_t c = 0; c < a->list_count; c++) {
        const char *control = cp_control_name(&a->list[c]);
        size_t length = strlen(control);
        bool named = strncmp(text, control, length) == 0 && text[length] == '.';
        look_into_parameters(a, c, named ? text + length + 1 : text, had, &found);
        look_into_given(a, c, named ? text + length + 1 : text, had, &found);
        look_into_equipment(a, c, named ? text + length + 1 : text, had, &found);
    }
    if (found == 1 && strspn(short_name(a), NAME_CHARACTERS) != strlen(short_name(a)))
        return cp_yaml_fail(a->file, error, a->key,
                            "names a vehicle type with other characters than letters, digits, '_', "
                            "'-' and '.': it cannot be part of a name");
    if (found == 1)
        return CP_OK;
    if (found > 1)
        return cp_yaml_fail(a->file, error, a->key,
                            "is a parameter of several; write %s.%s for the one meant",
                            cp_control_name(&a->list[0]), text);
    return cp_yaml_fail(a->file, error, a->key, "ends in no parameter, found '%s'; there %s %s",
                        text, had[0] != '\0' ? "are" : "is", had[0] != '\0' ? had : "none");
}

static cp_status find_option(axis *a, const char *text, cp_error *error)
{
    text += strspn(text, "-");
    size_t length = strspn(text, "abcdefghijklmnopqrstuvwxyz0123456789.-");
    if (length == 0 || text[length] != '\0' || length >= sizeof a->name)
        return cp_yaml_fail(a->file, error, a->key,
                            "must end in the long name of an option of SUMO, found '%s'", text);
    snprintf(a->name, sizeof a->name, "%s", text);
    return CP_OK;
}

static cp_status find_target(axis *a, const cp_study *study, const char *parameter, cp_error *error)
{
    static const char SCENARIOS[] = "scenarios.", VARIANTS[] = "variants.";
    static const char OPTIONS[] = "sumo_options.";
    a->of_scenario = strncmp(parameter, SCENARIOS, sizeof SCENARIOS - 1) == 0;
    if (!a->of_scenario && strncmp(parameter, VARIANTS, sizeof VARIANTS - 1) != 0)
        return cp_yaml_fail(a->file, error, a->key,
                            "must be variants.NAME.FUNCTION.PARAMETER, "
                            "scenarios.NAME.DRIVER_ERROR.PARAMETER or "
                            "scenarios.NAME.sumo_options.OPTION, found '%s'",
                            parameter);
    const char *text = parameter + (a->of_scenario ? sizeof SCENARIOS : sizeof VARIANTS) - 1;
    const char *rest = find_owner(a, study, text);
    if (rest == NULL)
        return fail_owner(a, study, error);
    if (!a->of_scenario && study->variants[a->owner].is_baseline)
        return cp_yaml_fail(a->file, error, a->key,
                            "belongs to the baseline, which all variants are compared with; sweep "
                            "another variant");
    if (a->of_scenario && strncmp(rest, OPTIONS, sizeof OPTIONS - 1) == 0)
        return find_option(a, rest + sizeof OPTIONS - 1, error);
    a->list = a->of_scenario ? study->scenarios[a->owner].driver_errors
                             : study->variants[a->owner].functions;
    a->list_count = a->of_scenario ? study->scenarios[a->owner].driver_error_count
                                   : study->variants[a->owner].function_count;
    return find_parameter(a, rest, error);
}

// ---- its values ----------------------------------------------------------------------------

// To 12 digits, so that 0.1 + 2 * 0.1 is 0.3 and a name tells the value exactly.
static double rounded(double value)
{
    char text[VALUE_TEXT_SIZE];
    snprintf(text, sizeof text, "%.12g", value);
    return strtod(text, NULL);
}

static cp_status read_value(const axis *a, const char *key, const char *text, double *value,
                            cp_error *error)
{
    double smallest = a->what != NULL ? a->what->smallest : a->share > 0 ? 0 : -1e12;
    double largest = a->what != NULL ? a->what->largest : a->share > 0 ? 1 : 1e12;
    char path[KEY_PATH_SIZE];
    snprintf(path, sizeof path, "sweep[%zu].%s", a->entry, key);
    cp_status status = cp_yaml_number(a->file, path, text, smallest, largest, value, error);
    *value = rounded(*value);
    return status;
}

static cp_status read_list(axis *a, const cp_sweep_entry *raw, cp_error *error)
{
    for (unsigned k = 0; k < raw->values_count; k++) {
        char key[64];
        snprintf(key, sizeof key, "values[%u]", k);
        cp_status status = read_value(a, key, raw->values[k], &a->values[k], error);
        for (unsigned other = 0; status == CP_OK && other < k; other++) {
            char path[KEY_PATH_SIZE];
            snprintf(path, sizeof path, "sweep[%zu].%s", a->entry, key);
            if (a->values[other] == a->values[k])
                status = cp_yaml_fail(a->file, error, path, "repeats %s", raw->values[k]);
        }
        if (status != CP_OK)
            return status;
    }
    return CP_OK;
}

static cp_status read_range(axis *a, const cp_sweep_entry *raw, cp_error *error)
{
    double from = 0.0, to = 0.0;
    cp_status status = read_value(a, "from", raw->from, &from, error);
    if (status == CP_OK)
        status = read_value(a, "to", raw->to, &to, error);
    if (status == CP_OK && from == to)
        status = cp_yaml_fail(a->file, error, a->key, "goes from %s to %s: nothing to sweep",
                              raw->from, raw->to);
    for (size_t k = 0; status == CP_OK && k < a->count; k++)
        a->values[k] = rounded(from + (to - from) * (double)k / (double)(a->count - 1));
    return status;
}

// How many values: of the list, or the steps of the range, both its ends included.
static cp_status count_values(axis *a, const cp_sweep_entry *raw, cp_error *error)
{
    char path[KEY_PATH_SIZE];
    double steps = 0.0;
    bool list = raw->values_count > 0;
    int range = (raw->from != NULL) + (raw->to != NULL) + (raw->steps != NULL);
    snprintf(path, sizeof path, "sweep[%zu]", a->entry);
    if (list ? range > 0 : range < 3)
        return cp_yaml_fail(a->file, error, path, "must have either values, or from, to and steps");
    snprintf(path, sizeof path, "sweep[%zu].steps", a->entry);
    cp_status status =
        cp_yaml_number(a->file, path, raw->steps, 2, CP_SWEEP_POINTS_MAX, &steps, error);
    if (status == CP_OK && steps != floor(steps))
        status = cp_yaml_fail(a->file, error, path, "must be a whole number, found %s", raw->steps);
    a->count = list ? raw->values_count : (size_t)steps;
    return status;
}

static cp_status read_axis(axis *a, const cp_sweep_entry *raw, const cp_study *study,
                           cp_error *error)
{
    snprintf(a->key, sizeof a->key, "sweep[%zu].parameter", a->entry);
    cp_status status = find_target(a, study, raw->parameter, error);
    if (status == CP_OK)
        status = count_values(a, raw, error);
    if (status != CP_OK)
        return status;
    a->values = calloc(a->count, sizeof *a->values);
    if (a->values == NULL)
        return cp_fail_memory(error, "sweep");
    return raw->values_count > 0 ? read_list(a, raw, error) : read_range(a, raw, error);
}

// ---- the axes together ---------------------------------------------------------------------

typedef struct sweep {
    axis *axes;
    size_t count;
} sweep;

static bool is_of(const axis *a, bool scenario, size_t owner)
{
    return a->of_scenario == scenario && a->owner == owner;
}

static cp_status check_axes(const sweep *s, const cp_study *study, cp_error *error)
{
    for (size_t k = 0; k < s->count; k++) {
        const axis *a = &s->axes[k];
        size_t points = 1;
        for (size_t other = 0; other <= k; other++) {
            const axis *b = &s->axes[other];
            if (!is_of(b, a->of_scenario, a->owner))
                continue;
            points *= b->count;
            if (other < k && strcmp(short_name(a), short_name(b)) == 0 &&
                strcmp(group_name(a), group_name(b)) == 0)
                return cp_yaml_fail(a->file, error, a->key, "is swept by sweep[%zu] already",
                                    b->entry);
        }
        if (points > CP_SWEEP_POINTS_MAX)
            return cp_yaml_fail(a->file, error, a->key,
                                "gives %s %zu combinations of values; at most %d are allowed",
                                owner_name(a, study), points, CP_SWEEP_POINTS_MAX);
    }
    return CP_OK;
}

static size_t points_of(const sweep *s, bool scenario, size_t owner)
{
    size_t points = 1;
    for (size_t k = 0; k < s->count; k++)
        if (is_of(&s->axes[k], scenario, owner))
            points *= s->axes[k].count;
    return points;
}

// Index of the axis' value at a point: the last axis of the owner counts fastest.
static size_t place_on(const sweep *s, size_t which, size_t point)
{
    for (size_t k = s->count - 1; k > which; k--)
        if (is_of(&s->axes[k], s->axes[which].of_scenario, s->axes[which].owner))
            point /= s->axes[k].count;
    return point % s->axes[which].count;
}

// Whether another axis of the same owner has a parameter of the same name.
static bool is_shared_name(const sweep *s, size_t which)
{
    const axis *a = &s->axes[which];
    for (size_t k = 0; k < s->count; k++)
        if (k != which && is_of(&s->axes[k], a->of_scenario, a->owner) &&
            strcmp(short_name(&s->axes[k]), short_name(a)) == 0)
            return true;
    return false;
}

// ---- one combination -----------------------------------------------------------------------

// What an axis changes in a scenario or variant.
typedef struct point {
    char **name;
    const char *base;
    cp_study_swept **swept;
    size_t *swept_count;
    cp_control_settings *controls;
} point;

static cp_status rename_point(const sweep *s, size_t which, double value, point *p, cp_error *error)
{
    const axis *a = &s->axes[which];
    char name[KEY_PATH_SIZE];
    bool shared = is_shared_name(s, which);
    int length = snprintf(name, sizeof name, "%s@%s%s%s=%.12g", *p->name,
                          shared ? group_name(a) : "", shared ? "." : "", short_name(a), value);
    if (length > CP_SWEEP_NAME_CHARACTERS)
        return cp_yaml_fail(a->file, error, a->key,
                            "makes the name '%s', longer than %d characters; give %s a shorter "
                            "name or sweep fewer parameters",
                            name, CP_SWEEP_NAME_CHARACTERS, p->base);
    char *renamed = strdup(name);
    if (renamed == NULL)
        return cp_fail_memory(error, "sweep");
    free(*p->name);
    *p->name = renamed;
    return CP_OK;
}

static cp_status note_value(const axis *a, double value, point *p, cp_error *error)
{
    char parameter[KEY_PATH_SIZE];
    cp_study_swept *swept = cp_array_add(*p->swept, *p->swept_count);
    if (swept == NULL)
        return cp_fail_memory(error, "sweep");
    snprintf(parameter, sizeof parameter, "%s.%s.%s.%s", a->of_scenario ? "scenarios" : "variants",
             p->base, group_name(a), short_name(a));
    *swept = (cp_study_swept){strdup(parameter), value};
    return swept->parameter != NULL ? CP_OK : cp_fail_memory(error, "sweep");
}

// Put "--option value" in place of what the scenario says of the option, or behind all options.
static cp_status set_option(const axis *a, double value, cp_study_scenario *scenario,
                            cp_error *error)
{
    char option[128], text[VALUE_TEXT_SIZE];
    snprintf(option, sizeof option, "--%s", a->name);
    snprintf(text, sizeof text, "%.12g", value);
    size_t length = strlen(option), kept = 0;
    char **words = scenario->sumo_options;
    for (size_t k = 0; k < scenario->sumo_option_count; k++) {
        bool alone = strcmp(words[k], option) == 0;
        bool joined = strncmp(words[k], option, length) == 0 && words[k][length] == '=';
        size_t gone = joined ? 1 : alone ? 2 : 0;
        if (gone == 0)
            words[kept++] = words[k];
        for (size_t g = 0; g < gone && k + g < scenario->sumo_option_count; g++)
            free(words[k + g]);
        k += gone == 2 ? 1 : 0;
    }
    scenario->sumo_option_count = kept;
    words = realloc(words, (kept + 2) * sizeof *words);
    if (words == NULL)
        return cp_fail_memory(error, "sumo_options");
    scenario->sumo_options = words;
    words[kept] = strdup(option);
    words[kept + 1] = strdup(text);
    scenario->sumo_option_count = kept + 2;
    return words[kept] != NULL && words[kept + 1] != NULL ? CP_OK
                                                          : cp_fail_memory(error, "sumo_options");
}

static cp_status give_value(cp_library_parameter *given, double value, cp_error *error)
{
    char text[32];
    snprintf(text, sizeof text, "%.12g", value);
    char *copy = strdup(text);
    if (copy == NULL)
        return cp_fail_memory(error, "sweep");
    free(given->text);
    given->text = copy;
    given->number = value;
    return CP_OK;
}

// Apply the values of a point; scenario is NULL for a variant.
static cp_status apply(const sweep *s, bool of_scenario, size_t owner, size_t at, point *p,
                       cp_study_scenario *scenario, cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < s->count; k++) {
        const axis *a = &s->axes[k];
        if (!is_of(a, of_scenario, owner))
            continue;
        double value = a->values[place_on(s, k, at)];
        status = rename_point(s, k, value, p, error);
        if (status == CP_OK)
            status = note_value(a, value, p, error);
        if (status != CP_OK)
            break;
        cp_control_settings *control =
            a->what != NULL || a->share > 0 || a->given > 0 ? &p->controls[a->control] : NULL;
        if (a->what != NULL)
            control->parameter[a->what - control->type->parameters] = value;
        else if (a->given > 0)
            status = give_value(&control->library->given[a->given - 1], value, error);
        else if (a->share > 0)
            control->shares[a->share - 1].penetration_1 = value;
        else if (scenario != NULL)
            status = set_option(a, value, scenario, error);
    }
    return status;
}

// ---- all of them ---------------------------------------------------------------------------

static cp_status expand_scenarios(const sweep *s, const cp_study *study, cp_study_scenario **list,
                                  size_t *count, cp_error *error)
{
    size_t total = 0;
    for (size_t k = 0; k < study->scenario_count; k++)
        total += points_of(s, true, k);
    *list = calloc(total, sizeof **list);
    if (*list == NULL)
        return cp_fail_memory(error, "scenarios");
    cp_status status = CP_OK;
    for (size_t k = 0; k < study->scenario_count; k++) {
        for (size_t at = 0; status == CP_OK && at < points_of(s, true, k); at++) {
            cp_study_scenario *made = &(*list)[(*count)++];
            status = cp_study_scenario_copy(&study->scenarios[k], made, error);
            point p = {&made->name, made->base, &made->swept, &made->swept_count,
                       made->driver_errors};
            if (status == CP_OK)
                status = apply(s, true, k, at, &p, made, error);
        }
    }
    return status;
}

static cp_status expand_variants(const sweep *s, const cp_study *study, cp_study_variant **list,
                                 size_t *count, cp_error *error)
{
    size_t total = 0;
    for (size_t k = 0; k < study->variant_count; k++)
        total += points_of(s, false, k);
    *list = calloc(total, sizeof **list);
    if (*list == NULL)
        return cp_fail_memory(error, "variants");
    cp_status status = CP_OK;
    for (size_t k = 0; k < study->variant_count; k++) {
        for (size_t at = 0; status == CP_OK && at < points_of(s, false, k); at++) {
            cp_study_variant *made = &(*list)[(*count)++];
            status = cp_study_variant_copy(&study->variants[k], made, error);
            point p = {&made->name, made->base, &made->swept, &made->swept_count, made->functions};
            if (status == CP_OK)
                status = apply(s, false, k, at, &p, NULL, error);
        }
    }
    return status;
}

// Both lists at once: the axes point into the study as it was.
static cp_status expand(const sweep *s, cp_study *study, cp_error *error)
{
    cp_study_scenario *scenarios = NULL;
    cp_study_variant *variants = NULL;
    size_t scenario_count = 0, variant_count = 0;
    cp_status status = expand_scenarios(s, study, &scenarios, &scenario_count, error);
    if (status == CP_OK)
        status = expand_variants(s, study, &variants, &variant_count, error);

    // What is not wanted, the old or the half-made, goes.
    cp_study unwanted = {.scenarios = scenarios,
                         .scenario_count = scenario_count,
                         .variants = variants,
                         .variant_count = variant_count};
    if (status == CP_OK) {
        unwanted.scenarios = study->scenarios;
        unwanted.scenario_count = study->scenario_count;
        unwanted.variants = study->variants;
        unwanted.variant_count = study->variant_count;
        study->scenarios = scenarios;
        study->scenario_count = scenario_count;
        study->variants = variants;
        study->variant_count = variant_count;
    }
    cp_study_destroy(&unwanted);
    return status;
}

cp_status cp_sweep_expand(const cp_yaml_file *file, const cp_sweep_entry *entries, size_t count,
                          cp_study *study, cp_error *error)
{
    if (count == 0)
        return CP_OK;
    sweep s = {.axes = calloc(count, sizeof *s.axes), .count = count};
    if (s.axes == NULL)
        return cp_fail_memory(error, "sweep");
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < count; k++) {
        s.axes[k].file = file;
        s.axes[k].entry = k;
        status = read_axis(&s.axes[k], &entries[k], study, error);
    }
    if (status == CP_OK)
        status = check_axes(&s, study, error);
    if (status == CP_OK)
        status = expand(&s, study, error);
    for (size_t k = 0; k < count; k++)
        free(s.axes[k].values);
    free(s.axes);
    return status;
}
