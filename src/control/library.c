/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/library.h"

#include "control/acting.h"

#include <dlfcn.h>
#include <fenv.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ENTRY "crashpulse_function_entry"
#define CAR_SIZE_MAX (1u << 20)

// ---- what the study says -------------------------------------------------------------------

static bool copy_text(const char *from, char **to)
{
    *to = from != NULL ? strdup(from) : NULL;
    return from == NULL || *to != NULL;
}

cp_library *cp_library_copy(const cp_library *library)
{
    cp_library *copy = malloc(sizeof *copy);
    if (copy == NULL)
        return NULL;
    *copy = *library;
    copy->given_count = 0;
    copy->given = calloc(library->given_count + 1, sizeof *copy->given);
    bool good = copy_text(library->name, &copy->name);
    good = copy_text(library->written, &copy->written) && good;
    good = copy_text(library->path, &copy->path) && good;
    good = copy_text(library->data, &copy->data) && good;
    good = copy_text(library->data_path, &copy->data_path) && good && copy->given != NULL;
    for (size_t k = 0; good && k < library->given_count; k++) {
        cp_library_parameter *given = &copy->given[copy->given_count++];
        *given = (cp_library_parameter){.number = library->given[k].number};
        good = copy_text(library->given[k].name, &given->name);
        good = copy_text(library->given[k].text, &given->text) && good;
    }
    if (good)
        return copy;
    cp_library_destroy(copy);
    return NULL;
}

void cp_library_destroy(cp_library *library)
{
    if (library == NULL)
        return;
    for (size_t k = 0; library->given != NULL && k < library->given_count; k++) {
        free(library->given[k].name);
        free(library->given[k].text);
    }
    free(library->given);
    free(library->name);
    free(library->written);
    free(library->path);
    free(library->data);
    free(library->data_path);
    free(library);
}

// ---- loading -------------------------------------------------------------------------------

static cp_status check_table(const cp_library *library, const crashpulse_function *function,
                             cp_error *error)
{
    for (size_t k = 0; k < function->parameter_count; k++) {
        const crashpulse_parameter *row = &function->parameters[k];
        if (row->name == NULL || !(row->smallest <= row->standard && row->standard <= row->largest))
            return cp_fail(error, CP_RUN_FAILED,
                           "%s: parameter %zu of its table must have a name and a default in its "
                           "range",
                           library->written, k + 1);
    }
    for (size_t k = 0; k < function->counter_count; k++)
        if (function->counter_names[k] == NULL)
            return cp_fail(error, CP_RUN_FAILED, "%s: counter %zu has no name", library->written,
                           k + 1);
    return CP_OK;
}

static cp_status check(const cp_library *library, const crashpulse_function *function,
                       cp_error *error)
{
    if (function == NULL)
        return cp_fail(error, CP_RUN_FAILED, "%s: " ENTRY " gives no function", library->written);
    if (function->abi != CRASHPULSE_FUNCTION_ABI)
        return cp_fail(error, CP_RUN_FAILED,
                       "%s: is built for version %u of crashpulse/function.h, this crashpulse has "
                       "version %u",
                       library->written, function->abi, CRASHPULSE_FUNCTION_ABI);
    if (function->step == NULL || function->parameter_count > CRASHPULSE_PARAMETERS_MAX ||
        function->counter_count > CRASHPULSE_COUNTERS_MAX || function->car_size > CAR_SIZE_MAX ||
        (function->parameter_count > 0 && function->parameters == NULL) ||
        (function->counter_count > 0 && function->counter_names == NULL))
        return cp_fail(error, CP_RUN_FAILED,
                       "%s: must have a step, at most %d parameters, %d counters and %u bytes a "
                       "car",
                       library->written, CRASHPULSE_PARAMETERS_MAX, CRASHPULSE_COUNTERS_MAX,
                       CAR_SIZE_MAX);
    return check_table(library, function, error);
}

cp_status cp_library_load(const cp_library *library, const crashpulse_function **function,
                          cp_error *error)
{
    typedef const crashpulse_function *(*entry_type)(void);
    fenv_t arithmetic;
    void *symbol = NULL;
    char path[4096];
    *function = NULL;
    // What runs as it is loaded may crash too, and may change how numbers are rounded.
    fegetenv(&arithmetic);
    cp_acting_enter(library->name, library->written, "while it was loaded", NAN);
    // A name without a slash would be looked for elsewhere.
    bool is_bare = strchr(library->path, '/') == NULL;
    snprintf(path, sizeof path, "%s%s", is_bare ? "./" : "", library->path);
    void *handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (handle != NULL)
        symbol = dlsym(handle, ENTRY);
    if (symbol != NULL) {
        entry_type entry;
        memcpy(&entry, &symbol, sizeof entry); // ISO C has no cast for it
        *function = entry();
    }
    cp_acting_leave();
    fesetenv(&arithmetic);
    if (handle == NULL)
        return cp_fail(error, CP_RUN_FAILED, "%s: cannot be loaded: %s", library->written,
                       dlerror());
    if (symbol == NULL)
        return cp_fail(error, CP_RUN_FAILED, "%s: has no " ENTRY " (crashpulse/function.h)",
                       library->written);
    return check(library, *function, error);
}
