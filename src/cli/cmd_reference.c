/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "calibrate/fit_schema.h"
#include "calibrate/suite_schema.h"
#include "cli/args.h"
#include "cli/commands.h"
#include "cli/key_descriptions.h"
#include "control/control.h"
#include "core/yaml_keys.h"
#include "crash/vehicle_model.h"
#include "crash/vehicle_schema.h"
#include "store/assessment_items.h"
#include "study/study_schema.h"

#include <stdio.h>
#include <string.h>

/* The reference page: schemas and tables of the program as Markdown. */

typedef struct description {
    const char *path, *values, *what;
} description;

#define DESCRIBED(path, values, what) {path, values, what},
static const description STUDY[] = {CP_STUDY_KEYS(DESCRIBED)};
static const description VEHICLE[] = {CP_VEHICLE_KEYS(DESCRIBED)};
static const description FIT[] = {CP_FIT_KEYS(DESCRIBED)};
static const description SUITE[] = {CP_SUITE_KEYS(DESCRIBED)};
static const description ASSESSMENT[] = {
#define ITEM(name, key, title, says) {"assessment." key, "", says},
    CP_ASSESSMENT_ITEMS(ITEM)
#undef ITEM
};

typedef struct key_file {
    const char *title;
    const cyaml_schema_value_t *schema;
    const description *described[2]; /* the second may be NULL */
    size_t count[2];
} key_file;

#define COUNT(list) (sizeof(list) / sizeof *(list))
static const key_file FILES[] = {
    {"Study files (`crashpulse run`)",
     &CP_RAW_STUDY,
     {STUDY, ASSESSMENT},
     {COUNT(STUDY), COUNT(ASSESSMENT)}},
    {"Vehicle files (`crashpulse crash`)", &CP_VEHICLE_SCHEMA, {VEHICLE}, {COUNT(VEHICLE)}},
    {"Fit files (`crashpulse calibrate`)", &CP_YAML_FIT_VALUE, {FIT}, {COUNT(FIT)}},
    {"Suite files (`crashpulse validate --suite`)", &CP_SUITE_YAML_VALUE, {SUITE}, {COUNT(SUITE)}},
};

static error_t parse(int key, char *argument, struct argp_state *state)
{
    const char **word = state->input;
    if (key != ARGP_KEY_ARG)
        return ARGP_ERR_UNKNOWN;
    if (*word != NULL)
        argp_error(state, "one word at a time, found '%s' too", argument);
    *word = argument;
    return 0;
}

static const struct argp ARGP = {
    .parser = parse,
    .args_doc = "[WORD]",
    .doc = "Print what every key of study, vehicle, fit and suite files means, and every parameter "
           "of driver errors, functions and vehicles, with default and range, as Markdown. With "
           "WORD: only lines that have it."
           "\v"
           "Examples:\n"
           "  crashpulse reference background\n"
           "  crashpulse reference > reference.md\n",
};

// ---- lines ---------------------------------------------------------------------------------

typedef struct page {
    const char *word; /* NULL: everything */
    const key_file *file;
    size_t printed;
} page;

static void print_line(page *p, const char *line)
{
    if (p->word != NULL && strstr(line, p->word) == NULL)
        return;
    fputs(line, stdout);
    p->printed++;
}

// Titles and heads of tables stand on the whole page only.
static void print_title(const page *p, const char *title)
{
    if (p->word == NULL)
        printf("%s\n", title);
}

static const description *find_description(const key_file *file, const char *path)
{
    for (size_t list = 0; list < 2; list++)
        for (size_t k = 0; k < file->count[list]; k++)
            if (strcmp(file->described[list][k].path, path) == 0)
                return &file->described[list][k];
    return NULL;
}

static cp_status print_key(void *context, const cp_yaml_key *key, cp_error *error)
{
    static const description NONE = {"", "", "(no description)"};
    page *p = context;
    char line[1024];
    (void)error;
    const description *found = find_description(p->file, key->path);
    if (found == NULL)
        found = &NONE;
    // That a value is a text or a number goes without saying.
    const char *kind = strncmp(key->kind, "text", 4) == 0 ? "" : key->kind;
    const char *between = kind[0] != '\0' && found->values[0] != '\0' ? "; " : "";
    snprintf(line, sizeof line, "| `%s` | %s | %s%s%s | %s |\n", key->path,
             key->is_required ? "yes" : "", kind, between, found->values, found->what);
    print_line(p, line);
    return CP_OK;
}

static void print_control(page *p, const cp_control_type *type)
{
    char line[1024];
    for (size_t k = 0; k < type->parameter_count; k++) {
        const cp_control_parameter *parameter = &type->parameters[k];
        snprintf(line, sizeof line, "| `%s` | `%s` | %g | %g to %g | %s |\n", type->name,
                 parameter->name, parameter->standard, parameter->smallest, parameter->largest,
                 parameter->what);
        print_line(p, line);
    }
}

static void print_controls(page *p, cp_control_kind kind, const char *title)
{
    char line[1024];
    print_title(p, title);
    for (size_t k = 0; k < CP_CONTROL_TYPE_COUNT; k++) {
        if (CP_CONTROL_TYPE[k]->kind != kind)
            continue;
        snprintf(line, sizeof line, "* `%s`: %s\n", CP_CONTROL_TYPE[k]->name,
                 CP_CONTROL_TYPE[k]->what);
        print_line(p, line);
    }
    print_title(p, "\n| of | parameter | default | range | what |\n|---|---|---|---|---|");
    for (size_t k = 0; k < CP_CONTROL_TYPE_COUNT; k++)
        if (CP_CONTROL_TYPE[k]->kind == kind)
            print_control(p, CP_CONTROL_TYPE[k]);
}

static void print_vehicle_parameters(page *p)
{
    char line[1024];
    print_title(p, "\n## Parameters of vehicles\n\n| parameter | unit | default | range | what "
                   "|\n|---|---|---|---|---|");
    for (size_t k = 0; k < CP_VEHICLE_PARAMETER_COUNT; k++) {
        const cp_vehicle_parameter *parameter = &CP_VEHICLE_PARAMETER[k];
        snprintf(line, sizeof line, "| `%s` | %s | %g | %g to %g | %s |\n", parameter->name,
                 parameter->unit, parameter->standard, parameter->smallest, parameter->largest,
                 parameter->what);
        print_line(p, line);
    }
}

cp_status cmd_reference(int argc, char **argv, cp_error *error)
{
    page p = {0};
    cp_args_parse(&ARGP, argc, argv, &p.word);
    print_title(&p, "# Reference of the input files\n\nMade by `crashpulse reference` (`cmake "
                    "--build build --target reference`).");
    cp_status status = CP_OK;
    for (size_t k = 0; status == CP_OK && k < COUNT(FILES); k++) {
        p.file = &FILES[k];
        if (p.word == NULL)
            printf("\n## %s\n\n| key | needed | values | what |\n|---|---|---|---|\n",
                   FILES[k].title);
        status = cp_yaml_keys_visit(FILES[k].schema, print_key, &p, error);
    }
    print_controls(&p, CP_CONTROL_DRIVER_ERROR, "\n## Driver errors\n");
    print_controls(&p, CP_CONTROL_FUNCTION, "\n## Functions\n");
    print_vehicle_parameters(&p);
    if (status == CP_OK && p.word != NULL && p.printed == 0)
        return cp_fail(error, CP_BAD_INPUT, "nothing in the reference has '%s'", p.word);
    return status;
}
