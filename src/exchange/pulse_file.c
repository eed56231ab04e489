/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/pulse_file.h"

#include "core/file.h"
#include "exchange/ev5_pulse.h"
#include "exchange/iso_mme.h"
#include "exchange/lsdyna.h"
#include "exchange/pulse_csv.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

static bool ends_with(const char *name, const char *suffix)
{
    size_t length = strlen(name), own = strlen(suffix);
    return length > own && strcasecmp(name + length - own, suffix) == 0;
}

bool cp_pulse_file_is_database(const char *path)
{
    static const char BEGIN[] = "SQLite format 3";
    char begin[sizeof BEGIN] = "";
    struct stat entry;
    if (stat(path, &entry) != 0 || !S_ISREG(entry.st_mode))
        return false;
    FILE *file = fopen(path, "rb");
    if (file == NULL)
        return false;
    size_t size = fread(begin, 1, sizeof begin, file);
    fclose(file);
    return size == sizeof begin && memcmp(begin, BEGIN, sizeof begin) == 0;
}

static cp_status read_folder(const cp_pulse_request *request, cp_pulse_record *record,
                             cp_error *error)
{
    bool has_ev5 = false, has_mme = false;
    DIR *directory = opendir(request->path);
    if (directory == NULL)
        return cp_fail(error, CP_BAD_INPUT, "%s: cannot be read: %s", request->path,
                       strerror(errno));
    for (struct dirent *entry = readdir(directory); entry != NULL; entry = readdir(directory)) {
        has_ev5 |= ends_with(entry->d_name, ".ev5");
        has_mme |= ends_with(entry->d_name, ".mme");
    }
    closedir(directory);
    if (has_ev5 == has_mme)
        return cp_fail(error, CP_BAD_INPUT, "%s: is a folder with %s: name the file of the test",
                       request->path,
                       has_ev5 ? "both an .EV5 and an .mme file"
                               : "neither an .EV5 nor an .mme file");
    return has_ev5 ? cp_ev5_pulse_read(request, record, error)
                   : cp_iso_mme_read(request, record, error);
}

static bool is_keyword_file(const char *content)
{
    for (const char *line = content; line != NULL; line = strchr(line, '\n')) {
        line += *line == '\n';
        if (*line != '$' && *line != '\r' && *line != '\n' && *line != '\0')
            return *line == '*';
    }
    return false;
}

// The first line of an ISO-MME channel file is "name:value".
static bool is_channel_file(const char *content)
{
    const char *end = content + strcspn(content, "\r\n");
    const char *colon = memchr(content, ':', (size_t)(end - content));
    return colon != NULL && memchr(content, ',', (size_t)(end - content)) == NULL &&
           strstr(content, "Channel code") != NULL;
}

cp_status cp_pulse_file_read(const cp_pulse_request *request, cp_pulse_record *record,
                             cp_error *error)
{
    char *content = NULL;
    size_t size = 0;
    struct stat entry;
    *record = (cp_pulse_record){0};
    if (stat(request->path, &entry) == 0 && S_ISDIR(entry.st_mode))
        return read_folder(request, record, error);
    if (ends_with(request->path, ".ev5"))
        return cp_ev5_pulse_read(request, record, error);
    if (ends_with(request->path, ".mme"))
        return cp_iso_mme_read(request, record, error);
    if (cp_pulse_file_is_database(request->path))
        return cp_fail(error, CP_BAD_INPUT, "%s: is a database: which crash of it? (--crash ID)",
                       request->path);
    cp_status status = cp_file_read_text(request->path, &content, &size, error);
    if (status != CP_OK)
        return status;
    if (is_keyword_file(content))
        status = cp_lsdyna_parse(request, content, record, error);
    else if (is_channel_file(content))
        status = cp_iso_mme_read(request, record, error);
    else
        status = cp_pulse_csv_parse(request, content, record, error);
    free(content);
    return status;
}
