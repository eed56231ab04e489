/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE // memfd_create
#include "unit.h"

#include "package.h"

#include <dlfcn.h>
#include <expat.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

// ---- description ---------------------------------------------------------------------------

/* The XML being read. */
typedef struct reading {
    fmu_unit *unit;
    fmu_variable at; /* of version 2: the variable whose type is to come */
    bool is_bad;     /* memory is gone */
} reading;

static const char *attribute(const char **attributes, const char *name)
{
    for (; *attributes != NULL; attributes += 2)
        if (strcmp(attributes[0], name) == 0)
            return attributes[1];
    return NULL;
}

static void take_text(reading *r, char **to, const char *text)
{
    if (text == NULL || *to != NULL)
        return;
    *to = strdup(text);
    r->is_bad |= *to == NULL;
}

static void add_variable(reading *r, const char *name, const char *reference, const char *causality)
{
    fmu_unit *unit = r->unit;
    fmu_variable *more = realloc(unit->variable, (unit->variable_count + 1) * sizeof *more);
    if (more == NULL || name == NULL || reference == NULL) {
        unit->variable = more != NULL ? more : unit->variable;
        r->is_bad |= more == NULL;
        return;
    }
    unit->variable = more;
    fmu_variable *added = &more[unit->variable_count];
    *added = (fmu_variable){.name = strdup(name),
                            .reference = (fmi_reference)strtoul(reference, NULL, 10)};
    snprintf(added->causality, sizeof added->causality, "%s",
             causality != NULL ? causality : "local");
    r->is_bad |= added->name == NULL;
    unit->variable_count += added->name != NULL;
}

static void begin_element(void *context, const char *element, const char **a)
{
    reading *r = context;
    if (strcmp(element, "fmiModelDescription") == 0) {
        const char *version = attribute(a, "fmiVersion");
        r->unit->version = version != NULL ? atoi(version) : 0;
        take_text(r, &r->unit->token, attribute(a, "guid"));
        take_text(r, &r->unit->token, attribute(a, "instantiationToken"));
    } else if (strcmp(element, "CoSimulation") == 0) {
        const char *once = attribute(a, "canBeInstantiatedOnlyOncePerProcess");
        take_text(r, &r->unit->identifier, attribute(a, "modelIdentifier"));
        r->unit->only_once = once != NULL && (strcmp(once, "true") == 0 || strcmp(once, "1") == 0);
    } else if (strcmp(element, "ScalarVariable") == 0) {
        free(r->at.name);
        r->at = (fmu_variable){0};
        take_text(r, &r->at.name, attribute(a, "name"));
        const char *reference = attribute(a, "valueReference");
        const char *causality = attribute(a, "causality");
        r->at.reference = (fmi_reference)strtoul(reference != NULL ? reference : "0", NULL, 10);
        snprintf(r->at.causality, sizeof r->at.causality, "%s",
                 causality != NULL ? causality : "local");
    } else if (strcmp(element, "Real") == 0 && r->at.name != NULL) {
        char reference[16];
        snprintf(reference, sizeof reference, "%u", r->at.reference);
        add_variable(r, r->at.name, reference, r->at.causality);
    } else if (strcmp(element, "Float64") == 0) {
        add_variable(r, attribute(a, "name"), attribute(a, "valueReference"),
                     attribute(a, "causality"));
    }
}

static const char *read_description(const unsigned char *text, size_t size, fmu_unit *unit)
{
    reading r = {.unit = unit};
    XML_Parser parser = XML_ParserCreate(NULL);
    if (parser == NULL)
        return "out of memory";
    XML_SetUserData(parser, &r);
    XML_SetStartElementHandler(parser, begin_element);
    bool is_read = XML_Parse(parser, (const char *)text, (int)size, 1) == XML_STATUS_OK;
    XML_ParserFree(parser);
    free(r.at.name);
    if (r.is_bad)
        return "out of memory";
    if (!is_read)
        return "its modelDescription.xml is no XML";
    if (unit->version != 2 && unit->version != 3)
        return "it is not of FMI 2 or 3";
    if (unit->identifier == NULL || unit->token == NULL)
        return "it is no unit for co-simulation";
    return unit->only_once ? "it allows one instance a process; there is one for each car" : NULL;
}

const fmu_variable *fmu_find(const fmu_unit *unit, const char *name, const char *causality)
{
    for (size_t k = 0; k < unit->variable_count; k++)
        if (strcmp(unit->variable[k].name, name) == 0 &&
            strcmp(unit->variable[k].causality, causality) == 0)
            return &unit->variable[k];
    return NULL;
}

// ---- binary --------------------------------------------------------------------------------

/* A function of the binary and where it goes. */
typedef struct symbol {
    const char *name;
    void *to;
} symbol;

static const char *load(const char *path, fmu_unit *unit)
{
    fmi2_calls *two = &unit->fmi2;
    fmi3_calls *three = &unit->fmi3;
    const symbol all[2][9] = {{{"fmi2Instantiate", &two->instantiate},
                               {"fmi2SetupExperiment", &two->set_up},
                               {"fmi2EnterInitializationMode", &two->enter_initialization},
                               {"fmi2ExitInitializationMode", &two->exit_initialization},
                               {"fmi2SetReal", &two->set},
                               {"fmi2GetReal", &two->get},
                               {"fmi2DoStep", &two->step},
                               {"fmi2Terminate", &two->terminate},
                               {"fmi2FreeInstance", &two->release}},
                              {{"fmi3InstantiateCoSimulation", &three->instantiate},
                               {"fmi3EnterInitializationMode", &three->enter_initialization},
                               {"fmi3ExitInitializationMode", &three->exit_initialization},
                               {"fmi3SetFloat64", &three->set},
                               {"fmi3GetFloat64", &three->get},
                               {"fmi3DoStep", &three->step},
                               {"fmi3Terminate", &three->terminate},
                               {"fmi3FreeInstance", &three->release}}};
    void *handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (handle == NULL)
        return dlerror();
    for (const symbol *s = all[unit->version - 2]; s < all[unit->version - 2] + 9 && s->name; s++) {
        void *found = dlsym(handle, s->name);
        if (found == NULL)
            return dlerror();
        memcpy(s->to, &found, sizeof found);
    }
    return NULL;
}

// From memory: the worker process may write nowhere.
static const char *load_bytes(const unsigned char *bytes, size_t size, fmu_unit *unit)
{
    char path[64];
    int file = memfd_create("fmu", MFD_CLOEXEC);
    size_t written = 0;
    while (file >= 0 && written < size) {
        ssize_t now = write(file, bytes + written, size - written);
        if (now <= 0)
            break;
        written += (size_t)now;
    }
    if (written < size)
        return "its binary cannot be kept in memory";
    snprintf(path, sizeof path, "/proc/self/fd/%d", file);
    const char *wrong = load(path, unit);
    close(file);
    return wrong;
}

// Folders of a binary, in the order they are looked for.
static const char *const FOLDER[] = {"binaries/linux64", "binaries/x86_64-linux",
                                     "binaries/aarch64-linux"};
#define FOLDERS (sizeof FOLDER / sizeof *FOLDER)

static const char *open_package(unsigned char *bytes, size_t size, fmu_unit *unit)
{
    fmu_package package;
    const char *wrong = fmu_package_open(bytes, size, &package);
    if (wrong != NULL)
        return wrong;
    unsigned char *text = fmu_package_read(&package, "modelDescription.xml", &size);
    wrong = text != NULL ? read_description(text, size, unit) : "it has no modelDescription.xml";
    free(text);
    if (wrong == NULL && fmu_package_has(&package, "resources/"))
        wrong = "it has resources: unpack it, and name its modelDescription.xml";
    if (wrong != NULL)
        return wrong;
    unsigned char *binary = NULL;
    for (size_t k = 0; k < FOLDERS && binary == NULL; k++) {
        char name[512];
        snprintf(name, sizeof name, "%s/%s.so", FOLDER[k], unit->identifier);
        binary = fmu_package_read(&package, name, &size);
    }
    wrong = binary != NULL ? load_bytes(binary, size, unit) : "it has no binary for this system";
    free(binary);
    return wrong;
}

static const char *open_unpacked(const char *path, unsigned char *text, size_t size, fmu_unit *unit)
{
    const char *wrong = read_description(text, size, unit);
    const char *slash = strrchr(path, '/');
    char folder[PATH_MAX], name[PATH_MAX + 600], whole[PATH_MAX];
    snprintf(folder, sizeof folder, "%.*s", slash != NULL ? (int)(slash - path) : 1,
             slash != NULL ? path : ".");
    if (wrong == NULL && realpath(folder, whole) == NULL)
        wrong = "its folder has no path";
    if (wrong != NULL)
        return wrong;
    snprintf(name, sizeof name, "%s%s/resources", unit->version == 2 ? "file://" : "", whole);
    unit->resources = strdup(name);
    for (size_t k = 0; k < FOLDERS; k++) {
        snprintf(name, sizeof name, "%s/%s/%s.so", whole, FOLDER[k], unit->identifier);
        if (access(name, R_OK) == 0)
            return load(name, unit);
    }
    return "it has no binary for this system";
}

const char *fmu_open(const char *path, fmu_unit *unit)
{
    *unit = (fmu_unit){0};
    FILE *file = fopen(path, "rb");
    unsigned char *bytes = NULL;
    long size = -1;
    if (file != NULL && fseek(file, 0, SEEK_END) == 0 && (size = ftell(file)) >= 0)
        bytes = malloc((size_t)size + 1);
    if (bytes != NULL)
        rewind(file);
    bool is_read = bytes != NULL && fread(bytes, 1, (size_t)size, file) == (size_t)size;
    if (file != NULL)
        fclose(file);
    const char *wrong = "it cannot be read";
    bool is_zip = is_read && size > 4 && memcmp(bytes, "PK", 2) == 0;
    if (is_zip)
        wrong = open_package(bytes, (size_t)size, unit);
    else if (is_read)
        wrong = open_unpacked(path, bytes, (size_t)size, unit);
    free(bytes);
    return wrong;
}

void fmu_close(fmu_unit *unit)
{
    for (size_t k = 0; k < unit->variable_count; k++)
        free(unit->variable[k].name);
    free(unit->variable);
    free(unit->identifier);
    free(unit->token);
    free(unit->resources);
    *unit = (fmu_unit){0};
}

// ---- instances -----------------------------------------------------------------------------

static void log_two(void *environment, const char *instance, int status, const char *category,
                    const char *message, ...)
{
    (void)environment;
    (void)category;
    if (status > FMI_WARNING)
        fprintf(stderr, "%s: %s\n", instance, message);
}

static void log_three(void *environment, int status, const char *category, const char *message)
{
    (void)environment;
    (void)category;
    if (status > FMI_WARNING)
        fprintf(stderr, "fmu: %s\n", message);
}

static const fmi2_callbacks CALLBACKS = {log_two, calloc, free, NULL, NULL};

fmi_component fmu_create(const fmu_unit *unit, const char *name)
{
    const char *resources = unit->resources != NULL ? unit->resources : "";
    if (unit->version == 2)
        return unit->fmi2.instantiate(name, FMI2_CO_SIMULATION, unit->token, resources, &CALLBACKS,
                                      0, 0);
    return unit->fmi3.instantiate(name, unit->token, unit->resources, false, false, false, false,
                                  NULL, 0, NULL, log_three, NULL);
}

bool fmu_begin(const fmu_unit *unit, fmi_component instance, double start_s)
{
    if (unit->version == 3)
        return unit->fmi3.enter_initialization(instance, false, 0.0, start_s, false, 0.0) <=
               FMI_WARNING;
    return unit->fmi2.set_up(instance, 0, 0.0, start_s, 0, 0.0) <= FMI_WARNING &&
           unit->fmi2.enter_initialization(instance) <= FMI_WARNING;
}

bool fmu_started(const fmu_unit *unit, fmi_component instance)
{
    int status = unit->version == 2 ? unit->fmi2.exit_initialization(instance)
                                    : unit->fmi3.exit_initialization(instance);
    return status <= FMI_WARNING;
}

bool fmu_set(const fmu_unit *unit, fmi_component instance, fmi_reference variable, double value)
{
    int status = unit->version == 2 ? unit->fmi2.set(instance, &variable, 1, &value)
                                    : unit->fmi3.set(instance, &variable, 1, &value, 1);
    return status <= FMI_WARNING;
}

bool fmu_get(const fmu_unit *unit, fmi_component instance, fmi_reference variable, double *value)
{
    int status = unit->version == 2 ? unit->fmi2.get(instance, &variable, 1, value)
                                    : unit->fmi3.get(instance, &variable, 1, value, 1);
    return status <= FMI_WARNING;
}

bool fmu_step(const fmu_unit *unit, fmi_component instance, double at_s, double step_s)
{
    bool event = false, terminate = false, early = false;
    double reached_s = at_s + step_s;
    if (unit->version == 2)
        return unit->fmi2.step(instance, at_s, step_s, 1) <= FMI_WARNING;
    return unit->fmi3.step(instance, at_s, step_s, true, &event, &terminate, &early, &reached_s) <=
               FMI_WARNING &&
           !terminate && !early;
}

void fmu_destroy(const fmu_unit *unit, fmi_component instance)
{
    if (unit->version == 2) {
        (void)unit->fmi2.terminate(instance);
        unit->fmi2.release(instance);
    } else {
        (void)unit->fmi3.terminate(instance);
        unit->fmi3.release(instance);
    }
}
