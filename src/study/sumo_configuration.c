/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/sumo_configuration.h"

#include "core/array.h"
#include "core/log.h"
#include "core/xml_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BLANKS " \t\r\n\a"

// ---- reading -------------------------------------------------------------------------------

// The element that began last and the text behind it, as SUMO's own reader keeps them.
typedef struct reading {
    cp_sumo_configuration *configuration;
    char name[256];
    size_t line;
    char *text;
    size_t text_size;
} reading;

static char *trimmed(const char *text, size_t size)
{
    while (size > 0 && strchr(BLANKS, text[0]) != NULL)
        text++, size--;
    while (size > 0 && strchr(BLANKS, text[size - 1]) != NULL)
        size--;
    return strndup(text, size);
}

static cp_sumo_setting *add(cp_sumo_configuration *configuration, const char *name, size_t size,
                            const char *value)
{
    cp_sumo_setting *setting = cp_array_add(configuration->setting, configuration->count);
    if (setting == NULL)
        return NULL;
    *setting =
        (cp_sumo_setting){.name = strndup(name, size), .value = trimmed(value, strlen(value))};
    if (setting->name == NULL || setting->value == NULL) {
        free(setting->name);
        free(setting->value);
        configuration->count--;
        return NULL;
    }
    setting->option = cp_sumo_option_find(setting->name);
    return setting;
}

static cp_status add_element(reading *r, const char *value, cp_error *error)
{
    if (strspn(value, BLANKS) == strlen(value))
        return CP_OK;
    cp_sumo_setting *setting = add(r->configuration, r->name, strlen(r->name), value);
    if (setting == NULL)
        return cp_fail_memory(error, r->configuration->path);
    setting->line = r->line;
    return CP_OK;
}

static cp_status begin_element(void *context, const cp_xml_element *element, cp_error *error)
{
    reading *r = context;
    snprintf(r->name, sizeof r->name, "%s", element->name);
    r->line = element->line;
    r->text_size = 0;
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && element->attribute[k] != NULL; k += 2)
        if (strcmp(element->attribute[k], "value") == 0 || strcmp(element->attribute[k], "v") == 0)
            status = add_element(r, element->attribute[k + 1], error);
    return status;
}

static cp_status take_text(void *context, const char *text, size_t size, cp_error *error)
{
    reading *r = context;
    char *more = realloc(r->text, r->text_size + size + 1);
    if (more == NULL)
        return cp_fail_memory(error, r->configuration->path);
    r->text = more;
    memcpy(more + r->text_size, text, size);
    r->text_size += size;
    more[r->text_size] = '\0';
    return CP_OK;
}

static cp_status end_element(void *context, const char *name, cp_error *error)
{
    reading *r = context;
    (void)name;
    cp_status status = CP_OK;
    if (r->name[0] != '\0' && r->text_size > 0)
        status = add_element(r, r->text, error);
    r->name[0] = '\0';
    r->text_size = 0;
    return status;
}

// Options may stand in no other file: nobody would look at them.
static cp_status refuse_outside(void *context, const char *name, cp_error *error)
{
    const reading *r = context;
    return cp_fail(error, CP_BAD_INPUT,
                   "%s: must not take its text from other files (document type, entities), found "
                   "'%s'",
                   r->configuration->path, name);
}

static cp_status read_file(cp_sumo_configuration *configuration, cp_error *error)
{
    static const cp_xml_visitor VISITOR = {begin_element, take_text, end_element, refuse_outside};
    reading r = {.configuration = configuration};
    cp_status status = cp_xml_read_all(configuration->path, NULL, &VISITOR, &r, error);
    free(r.text);
    return status;
}

// "--name value", "--name=value", "-n value"; a switch needs no value.
static cp_status read_words(cp_sumo_configuration *configuration, char *const *words, size_t count,
                            cp_error *error)
{
    for (size_t k = 0; k < count;) {
        const char *name = words[k] + strspn(words[k], "-");
        size_t length = strcspn(name, "=");
        // -v is an option, -vl two of them.
        bool is_short = words[k][0] == '-' && words[k][1] != '-';
        bool is_option = words[k][0] == '-' && length > 0 && (!is_short || length == 1);
        const char *value = name[length] == '=' ? name + length + 1 : NULL;
        bool takes_next =
            value == NULL && k + 1 < count &&
            (words[k + 1][0] != '-' || strchr("0123456789.", words[k + 1][1]) != NULL);
        if (takes_next)
            value = words[k + 1];
        if (!is_option)
            return cp_fail(
                error, CP_BAD_INPUT,
                "sumo_options: must be options of SUMO with their values, found '%s' where "
                "an option begins (--name or -n)",
                words[k]);
        cp_sumo_setting *setting = add(configuration, name, length, value != NULL ? value : "true");
        if (setting == NULL)
            return cp_fail_memory(error, "SUMO's options");
        setting->word = k;
        setting->word_count = takes_next ? 2 : 1;
        k += setting->word_count;
    }
    return CP_OK;
}

cp_status cp_sumo_configuration_read(const char *sumocfg_path, char *const *words,
                                     size_t word_count, cp_sumo_configuration *configuration,
                                     cp_error *error)
{
    *configuration = (cp_sumo_configuration){.path = strdup(sumocfg_path)};
    if (configuration->path == NULL)
        return cp_fail_memory(error, sumocfg_path);
    cp_status status = read_words(configuration, words, word_count, error);
    return status == CP_OK ? read_file(configuration, error) : status;
}

void cp_sumo_configuration_destroy(cp_sumo_configuration *configuration)
{
    for (size_t k = 0; k < configuration->count; k++) {
        free(configuration->setting[k].name);
        free(configuration->setting[k].value);
    }
    free(configuration->setting);
    free(configuration->path);
    *configuration = (cp_sumo_configuration){0};
}

// ---- rules ---------------------------------------------------------------------------------

const cp_sumo_setting *cp_sumo_configuration_find(const cp_sumo_configuration *configuration,
                                                  const char *option)
{
    for (size_t k = 0; k < configuration->count; k++) {
        const cp_sumo_setting *setting = &configuration->setting[k];
        if (setting->option != NULL && strcmp(setting->option->name, option) == 0)
            return setting;
    }
    return NULL;
}

// Seconds, or [days:]hours:minutes:seconds.
static double time_of(const cp_sumo_setting *setting, double otherwise_s)
{
    static const double UNIT_S[] = {1.0, 60.0, 3600.0, 86400.0};
    double part[4], time_s = 0.0;
    int parts = 0;
    const char *c = setting != NULL ? setting->value : "";
    while (*c != '\0' && parts < 4) {
        char *end = NULL;
        part[parts++] = strtod(c, &end);
        if (end == c || (*end != '\0' && *end != ':'))
            return otherwise_s;
        c = *end == ':' ? end + 1 : end;
    }
    for (int k = 0; k < parts; k++)
        time_s += part[k] * UNIT_S[parts - 1 - k];
    return parts > 0 ? time_s : otherwise_s;
}

double cp_sumo_configuration_length_s(const cp_sumo_configuration *configuration)
{
    double begin_s = time_of(cp_sumo_configuration_find(configuration, "begin"), 0.0);
    double end_s = time_of(cp_sumo_configuration_find(configuration, "end"), -1.0);
    return end_s < 0.0 ? INFINITY : end_s - begin_s;
}

void cp_sumo_setting_place(const cp_sumo_configuration *configuration,
                           const cp_sumo_setting *setting, char *place, size_t size)
{
    if (setting->line > 0)
        snprintf(place, size, "%s:%zu: %s", configuration->path, setting->line, setting->name);
    else
        snprintf(place, size, "sumo_options: %s", setting->name);
}

static cp_status check_setting(const cp_sumo_configuration *configuration,
                               const cp_sumo_setting *setting, double duration_s, cp_error *error)
{
    char place[1024];
    const cp_sumo_rule *rule =
        setting->option != NULL ? cp_sumo_rule_find(setting->option->name) : NULL;
    if (rule == NULL)
        return CP_OK;
    cp_sumo_setting_place(configuration, setting, place, sizeof place);
    bool is_off = setting->option->kind == CP_SUMO_SWITCH && !cp_sumo_value_is_true(setting->value);
    if (rule->treatment == CP_SUMO_REFUSED && !is_off)
        return cp_fail(error, CP_BAD_INPUT, "%s must not be set, found '%s': %s", place,
                       setting->value, rule->why);
    if (rule->treatment == CP_SUMO_COMPUTED && setting->line == 0)
        return cp_fail(error, CP_BAD_INPUT, "%s must not be set, found '%s': %s", place,
                       setting->value, rule->why);
    double length_s = cp_sumo_configuration_length_s(configuration);
    if (rule->treatment == CP_SUMO_BOUNDED && length_s < duration_s - 1e-6)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s must not come before the end of what is simulated, %g s after the "
                       "beginning, found '%s', after %g s: %s",
                       place, duration_s, setting->value, length_s, rule->why);
    return CP_OK;
}

cp_status cp_sumo_configuration_check(const cp_sumo_configuration *configuration, double duration_s,
                                      cp_error *error)
{
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < configuration->count; k++)
        status = check_setting(configuration, &configuration->setting[k], duration_s, error);
    return status;
}

void cp_sumo_configuration_tell(const cp_sumo_configuration *configuration)
{
    for (size_t k = 0; k < configuration->count; k++) {
        char place[1024];
        const cp_sumo_setting *setting = &configuration->setting[k];
        cp_sumo_setting_place(configuration, setting, place, sizeof place);
        if (setting->option == NULL) {
            cp_log_warning(
                "%s is no option of SUMO 1.15 that crashpulse knows; it is left as it is", place);
            continue;
        }
        const cp_sumo_rule *rule = cp_sumo_rule_find(setting->option->name);
        if (rule != NULL && rule->treatment == CP_SUMO_REPLACED && rule->why != NULL &&
            !cp_sumo_values_agree(setting->option, setting->value, rule->value))
            cp_log_warning("%s is set to %s instead of '%s': %s", place, rule->value,
                           setting->value, rule->why);
        const char *slash = strrchr(setting->value, '/');
        if (rule != NULL && rule->treatment == CP_SUMO_JOINED && slash != NULL)
            cp_log_warning("%s: '%s' follows the name of the replication, without the folder of "
                           "'%s': %s",
                           place, slash + 1, setting->value, rule->why);
    }
}
