/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/network.h"

#include "core/file.h"
#include "store/query.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define POINTS_MAX 20000

// Value of an attribute of the tag that starts at tag and ends at end; NULL when it has none.
static const char *attribute(const char *tag, const char *end, const char *name, size_t *length)
{
    size_t size = strlen(name);
    for (const char *c = tag; c + size + 2 < end; c++) {
        if ((c[0] == ' ' || c[0] == '\n' || c[0] == '\t') && strncmp(c + 1, name, size) == 0 &&
            c[1 + size] == '=' && c[2 + size] == '"') {
            const char *value = c + size + 3, *close = memchr(value, '"', (size_t)(end - value));
            if (!close)
                return NULL;
            *length = (size_t)(close - value);
            return value;
        }
    }
    return NULL;
}

static bool attribute_is(const char *tag, const char *end, const char *name, const char *text)
{
    size_t length = 0;
    const char *value = attribute(tag, end, name, &length);
    return value && length == strlen(text) && strncmp(value, text, length) == 0;
}

// "x,y x,y,z …" as [x, y, x, y, …], heights left out.
static json_t *shape_json(const char *text, size_t length)
{
    json_t *points = json_array();
    const char *end = text + length;
    while (text < end) {
        char *rest;
        double x = strtod(text, &rest);
        if (rest == text || *rest != ',')
            break;
        double y = strtod(rest + 1, &rest);
        json_array_append_new(points, json_real(round(x * 10.0) / 10.0));
        json_array_append_new(points, json_real(round(y * 10.0) / 10.0));
        while (rest < end && *rest != ' ')
            rest++;
        text = rest + (rest < end);
    }
    return points;
}

/* Which lanes are taken. */
typedef enum selection { EVERY_LANE, NO_INTERNAL, FIRST_OF_EDGE, SELECTIONS } selection;

static json_t *lanes_of(const char *net_xml, selection which, size_t *points)
{
    json_t *lanes = json_array();
    bool internal = false;
    *points = 0;
    for (const char *tag = strchr(net_xml, '<'); tag; tag = strchr(tag + 1, '<')) {
        const char *end = strchr(tag, '>');
        if (!end)
            break;
        if (strncmp(tag, "<!--", 4) == 0) {
            tag = strstr(tag, "-->");
            if (!tag)
                break;
            continue;
        }
        if (strncmp(tag, "<edge ", 6) == 0)
            internal = attribute_is(tag, end, "function", "internal") ||
                       attribute_is(tag, end, "function", "crossing") ||
                       attribute_is(tag, end, "function", "walkingarea");
        if (strncmp(tag, "<lane ", 6) != 0 || (which >= NO_INTERNAL && internal) ||
            (which == FIRST_OF_EDGE && !attribute_is(tag, end, "index", "0")))
            continue;
        size_t length = 0;
        const char *shape = attribute(tag, end, "shape", &length);
        if (!shape)
            continue;
        json_t *line = shape_json(shape, length);
        *points += json_array_size(line) / 2;
        json_array_append_new(lanes, line);
    }
    return lanes;
}

json_t *cp_network_lanes(const char *net_xml, size_t points_max)
{
    json_t *lanes = NULL;
    for (int which = EVERY_LANE; which < SELECTIONS; which++) {
        size_t points = 0;
        json_decref(lanes);
        lanes = lanes_of(net_xml, (selection)which, &points);
        if (points <= points_max)
            break;
    }
    return lanes;
}

/* Path of the sumocfg a replication of the scenario was run with. */
static cp_status take_path(void *context, const cp_row *row, cp_error *error)
{
    char **path = context;
    const char *begin = strstr(row->cell[0].text, " -c ");
    if (!begin)
        return CP_OK;
    begin += 4;
    bool quoted = *begin == '\'';
    size_t length = strcspn(begin + quoted, quoted ? "'" : " ");
    *path = strndup(begin + quoted, length);
    return *path ? CP_OK : cp_fail_memory(error, "a network");
}

static json_t *missing(const char *why)
{
    return json_pack("{s:s}", "missing", why);
}

// The file that the attribute value of <net-file> names, beside the sumocfg.
static char *net_path(const char *sumocfg_path, const char *sumocfg)
{
    const char *tag = strstr(sumocfg, "<net-file"), *end = tag ? strchr(tag, '>') : NULL;
    size_t length = 0;
    const char *value = end ? attribute(tag, end, "value", &length) : NULL;
    if (!value)
        return NULL;
    const char *slash = strrchr(sumocfg_path, '/');
    size_t folder = slash && value[0] != '/' ? (size_t)(slash - sumocfg_path) + 1 : 0;
    char *path = malloc(folder + length + 1);
    if (path) {
        memcpy(path, sumocfg_path, folder);
        memcpy(path + folder, value, length);
        path[folder + length] = '\0';
    }
    return path;
}

static json_t *read_network(const char *sumocfg_path)
{
    cp_error ignored = {0};
    char *sumocfg = NULL, *net = NULL, *path = NULL;
    size_t size = 0;
    json_t *network = NULL;
    if (cp_file_read(sumocfg_path, &sumocfg, &size, &ignored) != CP_OK)
        network = missing("the sumocfg is not where the study was run from");
    if (!network && !(path = net_path(sumocfg_path, sumocfg)))
        network = missing("the sumocfg names no network file");
    if (!network && cp_file_read(path, &net, &size, &ignored) != CP_OK)
        network = missing("the network file is not where the sumocfg says");
    if (!network && !strstr(net, "<net"))
        network = missing("the network file is not plain XML");
    if (!network) {
        const char *slash = strrchr(path, '/');
        network = json_pack("{s:s, s:o}", "file", slash ? slash + 1 : path, "lanes",
                            cp_network_lanes(net, POINTS_MAX));
    }
    free(sumocfg);
    free(net);
    free(path);
    return network;
}

cp_status cp_network_json(cp_store *store, const char *scenario, json_t **network, cp_error *error)
{
    char *path = NULL;
    cp_query_handler handler = {.row = take_path, .context = &path};
    cp_cell name = cp_cell_text(scenario);
    cp_status status =
        cp_query(store,
                 "SELECT r.sumo_command_line FROM replication AS r JOIN scenario AS s"
                 " ON s.id = r.scenario_id WHERE s.name = ?1 AND r.sumo_command_line IS NOT NULL"
                 " ORDER BY r.number LIMIT 1",
                 &name, 1, &handler, error);
    if (status != CP_OK)
        return status;
    *network = path ? read_network(path) : missing("no replication says which sumocfg it ran");
    free(path);
    return *network ? CP_OK : cp_fail_memory(error, "a network");
}
