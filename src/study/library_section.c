/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/library_section.h"

#include "core/file.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define KEY_PATH_SIZE 560
#define NAME_CHARACTERS_MAX 64

// What the library's file is called, without "lib" and ".so"; the caller frees it.
static char *file_name(const char *library)
{
    const char *slash = strrchr(library, '/');
    const char *begin = slash != NULL ? slash + 1 : library;
    if (strncmp(begin, "lib", 3) == 0 && strlen(begin) > strlen("lib.so"))
        begin += 3;
    size_t length = strlen(begin);
    if (length > 3 && strcmp(begin + length - 3, ".so") == 0)
        length -= 3;
    return strndup(begin, length);
}

// Letters, digits, '_', '-' or '.': it stands in front of counters and beside the names of ours.
static bool is_name(const char *name)
{
    size_t length = strlen(name);
    bool good = length > 0 && length <= NAME_CHARACTERS_MAX;
    for (const char *c = name; good && *c != '\0'; c++)
        good = isalnum((unsigned char)*c) || strchr("_-.", *c) != NULL;
    return good;
}

static cp_status check_name(const cp_yaml_file *file, const char *entry_path, const char *key,
                            const char *name, cp_error *error)
{
    char path[KEY_PATH_SIZE];
    if (is_name(name))
        return CP_OK;
    snprintf(path, sizeof path, "%s.%s", entry_path, key);
    return cp_yaml_fail(file, error, path,
                        "makes the name '%s'; it must be 1 to %d letters, digits, '_', '-' or '.' "
                        "(the key 'as' gives another)",
                        name, NAME_CHARACTERS_MAX);
}

// A file named in the study: its path as seen from here, and its hash.
static cp_status take_file(const cp_yaml_file *file, const char *entry_path, const char *key,
                           const char *text, char **path, char hash[CP_HASH_TEXT_SIZE],
                           cp_error *error)
{
    char key_path[KEY_PATH_SIZE];
    snprintf(key_path, sizeof key_path, "%s.%s", entry_path, key);
    *path = cp_file_beside(file->path, text);
    if (*path == NULL)
        return cp_fail_memory(error, key_path);
    if (access(*path, R_OK) != 0)
        return cp_yaml_fail(file, error, key_path, "must be a readable file, found '%s' (%s)", text,
                            *path);
    return cp_hash_file(*path, hash, error);
}

cp_status cp_library_section_read(const cp_yaml_file *file, const char *entry_path,
                                  const char *function, const char *library, const char *as,
                                  const char *data, cp_control_settings *settings, cp_error *error)
{
    char path[KEY_PATH_SIZE];
    cp_library *own = settings->library;
    if (own == NULL && library == NULL && as == NULL && data == NULL)
        return CP_OK;
    snprintf(path, sizeof path, "%s.%s", entry_path,
             library != NULL ? "library"
             : as != NULL    ? "as"
                             : "data");
    if (own == NULL)
        return cp_yaml_fail(file, error, path, "belongs to 'function: plugin', found '%s'",
                            function);
    if (library == NULL)
        return cp_yaml_fail(file, error, entry_path,
                            "must have a library: the file of the function");
    own->written = strdup(library);
    own->name = as != NULL ? strdup(as) : file_name(library);
    own->data = data != NULL ? strdup(data) : NULL;
    if (own->written == NULL || own->name == NULL || (data != NULL && own->data == NULL))
        return cp_fail_memory(error, path);
    cp_status status =
        check_name(file, entry_path, as != NULL ? "as" : "library", own->name, error);
    if (status == CP_OK)
        status = take_file(file, entry_path, "library", library, &own->path, own->hash, error);
    if (status == CP_OK && data != NULL)
        status = take_file(file, entry_path, "data", data, &own->data_path, own->data_hash, error);
    return status;
}

cp_status cp_library_from_file(const char *path, cp_library **library, cp_error *error)
{
    cp_library *own = calloc(1, sizeof *own);
    *library = NULL;
    if (own == NULL)
        return cp_fail_memory(error, path);
    own->written = strdup(path);
    own->path = strdup(path);
    own->name = file_name(path);
    cp_status status = cp_hash_file(path, own->hash, error);
    if (own->written == NULL || own->path == NULL || own->name == NULL)
        status = cp_fail_memory(error, path);
    else if (status == CP_OK && !is_name(own->name))
        status = cp_fail(error, CP_BAD_INPUT, "%s: makes the name '%s' of a function", path,
                         own->name);
    if (status == CP_OK)
        *library = own;
    else
        cp_library_destroy(own);
    return status;
}

const cp_library *cp_study_library(const cp_study *study, size_t k,
                                   const cp_study_variant **variant)
{
    const cp_library *seen[64];
    size_t count = 0;
    for (size_t v = 0; v < study->variant_count; v++) {
        for (size_t f = 0; f < study->variants[v].function_count; f++) {
            const cp_library *library = study->variants[v].functions[f].library;
            size_t known = 0;
            while (library != NULL && known < count &&
                   strcmp(seen[known]->path, library->path) != 0)
                known++;
            if (library == NULL || known < count || count == sizeof seen / sizeof *seen)
                continue;
            *variant = &study->variants[v];
            if (count == k)
                return library;
            seen[count++] = library;
        }
    }
    return NULL;
}
