/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "matrix/matrix_study.h"

#include "core/file.h"
#include "matrix/tracks.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define AFTER_S 8.0 /* the run goes on after the two would have met */
#define HEAD                                                                                       \
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- Written by 'crashpulse matrix'. -->\n"

// ---- network -------------------------------------------------------------------------------

// Drivers keep to the limit, which is the speed of the cell.
static void write_lane(FILE *out, const char *edge, int index, const char *allow,
                       const cp_track_line *line)
{
    fprintf(out,
            "        <lane id=\"%s_%d\" index=\"%d\" allow=\"%s\" speed=\"%.15g\" "
            "length=\"%.6f\" shape=\"",
            edge, index, index, allow, line->speed_m_s > 0.0 ? line->speed_m_s : 1.0,
            CP_TRACK_LENGTH_M);
    for (size_t k = 0; k < line->count; k++)
        fprintf(out, "%s%.9f,%.9f", k > 0 ? " " : "", line->point_m[k].x, line->point_m[k].y);
    fputs("\"/>\n", out);
}

static void write_edge(FILE *out, const char *id, const char *from, const char *to)
{
    fprintf(out, "    <edge id=\"%s\" from=\"%s\" to=\"%s\" priority=\"1\">\n", id, from, to);
}

static void write_junction(FILE *out, const char *id, cp_vec2 at_m)
{
    fprintf(out,
            "    <junction id=\"%s\" type=\"dead_end\" x=\"%.6f\" y=\"%.6f\" incLanes=\"\" "
            "intLanes=\"\" shape=\"%.6f,%.6f\"/>\n",
            id, at_m.x, at_m.y, at_m.x, at_m.y);
}

static void write_track(FILE *out, size_t cell, const cp_cell_tracks *tracks)
{
    char own[32], back[32], from[32], to[32];
    snprintf(own, sizeof own, "c%zu", cell);
    snprintf(back, sizeof back, "c%zu_back", cell);
    snprintf(from, sizeof from, "c%zu_from", cell);
    snprintf(to, sizeof to, "c%zu_to", cell);
    write_edge(out, own, from, to);
    write_lane(out, own, 0, "passenger", &tracks->own);
    if (!tracks->is_opposite)
        write_lane(out, own, 1, "custom1", &tracks->target);
    fputs("    </edge>\n", out);
    if (!tracks->is_opposite)
        return;
    write_edge(out, back, to, from);
    write_lane(out, back, 0, "custom1", &tracks->target);
    fputs("    </edge>\n", out);
}

static void write_network(FILE *out, const cp_matrix *matrix)
{
    size_t cells = cp_matrix_cells(matrix);
    double top_m = CP_TRACK_APART_M * (double)cells;
    fputs(HEAD, out);
    fprintf(out,
            "<net version=\"1.9\" junctionCornerDetail=\"5\" limitTurnSpeed=\"-1\">\n"
            "    <location netOffset=\"0.00,0.00\" convBoundary=\"-1000.00,-1000.00,1000.00,%.2f\" "
            "origBoundary=\"-1000.00,-1000.00,1000.00,%.2f\" projParameter=\"!\"/>\n",
            top_m, top_m);
    cp_cell_tracks tracks;
    for (size_t k = 0; k < cells; k++) {
        cp_tracks_of(matrix, k, &tracks);
        write_track(out, k, &tracks);
    }
    for (size_t k = 0; k < cells; k++) {
        char id[32];
        cp_tracks_of(matrix, k, &tracks);
        snprintf(id, sizeof id, "c%zu_from", k);
        write_junction(out, id, tracks.own.point_m[0]);
        snprintf(id, sizeof id, "c%zu_to", k);
        write_junction(out, id, tracks.own.point_m[tracks.own.count - 1]);
    }
    fputs("</net>\n", out);
}

// ---- demand --------------------------------------------------------------------------------

// Targets that brake have a type each, for how hard they do.
static void target_type(const cp_matrix *matrix, size_t cell, char type[32])
{
    if (matrix->encounter == CP_ENCOUNTER_BRAKING)
        snprintf(type, 32, "target%zu", cell);
    else
        snprintf(type, 32, "target");
}

static size_t target_types(const cp_matrix *matrix)
{
    return matrix->encounter == CP_ENCOUNTER_BRAKING ? cp_matrix_cells(matrix) : 1;
}

// Drivers who keep their speed, and who do not gain speed again once a function has braked: as in a
// test, in which the car is let stand.
static void write_type(FILE *out, const cp_matrix *matrix, const char *id, const char *class,
                       double deceleration_m_s2)
{
    fprintf(out,
            "    <vType id=\"%s\" vClass=\"%s\" length=\"%.9g\" width=\"%.9g\" sigma=\"0\" "
            "speedFactor=\"1\" speedDev=\"0\" minGap=\"0\" tau=\"%.9g\" maxSpeed=\"60\" "
            "accel=\"0.001\" "
            "decel=\"%.9g\" emergencyDecel=\"9\"/>\n",
            id, class, matrix->length_m, matrix->width_m, matrix->step_length_s, deceleration_m_s2);
}

// A standing car stands.
static void write_car(FILE *out, size_t cell, const char *role, const char *type, const char *edge,
                      int lane, const cp_track_line *line)
{
    bool stands = !(line->speed_m_s > 0.0);
    double stop_m = stands ? line->start_m : line->stop_m;
    fprintf(out,
            "    <vehicle id=\"c%zu_%s\" type=\"%s\" depart=\"0\" departLane=\"%d\" "
            "departPos=\"%.9f\" departSpeed=\"%.15g\" insertionChecks=\"none\">"
            "<route edges=\"%s\"/>",
            cell, role, type, lane, line->start_m, line->speed_m_s, edge);
    if (stop_m < INFINITY)
        fprintf(out, "<stop lane=\"%s_%d\" startPos=\"%.9f\" endPos=\"%.9f\" duration=\"1000\"/>",
                edge, lane, stop_m - 0.1, stop_m);
    fputs("</vehicle>\n", out);
}

static void write_demand(FILE *out, const cp_matrix *matrix)
{
    fputs(HEAD "<routes>\n", out);
    write_type(out, matrix, "own", "passenger", 9.0);
    if (matrix->encounter != CP_ENCOUNTER_BRAKING)
        write_type(out, matrix, "target", "custom1", 9.0);
    for (size_t k = 0; k < cp_matrix_cells(matrix); k++) {
        cp_cell_tracks tracks;
        char own[32], target[32], type[32];
        cp_tracks_of(matrix, k, &tracks);
        snprintf(own, sizeof own, "c%zu", k);
        snprintf(target, sizeof target, "c%zu%s", k, tracks.is_opposite ? "_back" : "");
        target_type(matrix, k, type);
        if (matrix->encounter == CP_ENCOUNTER_BRAKING)
            write_type(out, matrix, type, "custom1", tracks.deceleration_m_s2);
        write_car(out, k, "own", "own", own, 0, &tracks.own);
        write_car(out, k, "target", type, target, tracks.is_opposite ? 0 : 1, &tracks.target);
    }
    fputs("</routes>\n", out);
}

static void write_configuration(FILE *out, const cp_matrix *matrix)
{
    (void)matrix;
    fputs(HEAD "<configuration>\n    <input>\n        <net-file value=\"tracks.net.xml\"/>\n"
               "        <route-files value=\"cars.rou.xml\"/>\n    </input>\n"
               "    <processing>\n        <time-to-teleport value=\"-1\"/>\n    </processing>\n"
               "</configuration>\n",
          out);
}

// ---- study ---------------------------------------------------------------------------------

// YAML text in double quotes.
static void write_text(FILE *out, const char *text)
{
    fputc('"', out);
    for (; *text != '\0'; text++) {
        if (*text == '"' || *text == '\\')
            fputc('\\', out);
        if (*text == '\n' || (unsigned char)*text < ' ')
            fputc(' ', out);
        else
            fputc(*text, out);
    }
    fputc('"', out);
}

static void write_library(FILE *out, const cp_library *library)
{
    char path[PATH_MAX];
    fputs("\n        library: ", out);
    write_text(out, realpath(library->path, path) != NULL ? path : library->path);
    fputs("\n        as: ", out);
    write_text(out, library->name);
    if (library->data == NULL)
        return;
    fputs("\n        data: ", out);
    write_text(out, realpath(library->data_path, path) != NULL ? path : library->data_path);
}

static void write_function(FILE *out, const cp_matrix *matrix, const cp_control_settings *function)
{
    const cp_control_type *type = function->type;
    fprintf(out, "      - function: %s", type->name);
    if (function->library != NULL)
        write_library(out, function->library);
    fputs("\n        parameters:\n", out);
    for (size_t k = 0; k < type->parameter_count; k++)
        fprintf(out, "          %s: %.17g\n", type->parameters[k].name, function->parameter[k]);
    for (size_t k = 0; function->library != NULL && k < function->library->given_count; k++) {
        fprintf(out, "          %s: ", function->library->given[k].name);
        write_text(out, function->library->given[k].text);
        fputc('\n', out);
    }
    // The target has none.
    fputs("        equipment:\n", out);
    for (size_t k = 0; k < target_types(matrix); k++) {
        char target[32];
        target_type(matrix, k, target);
        fprintf(out, "          - {type: %s, penetration_1: 0}\n", target);
    }
}

static void write_study(FILE *out, const cp_matrix *matrix)
{
    fprintf(out, "# Written by 'crashpulse matrix'.\nstudy: %s\nquestion: ", matrix->name);
    write_text(out, matrix->source);
    fprintf(out,
            "\ndesign: paired_seeds\nseed: 1\nreplications: 1\nduration_s: %.9g\n"
            "step_length_s: %.9g\nbackground: {duration_s: 0}\nscenarios:\n"
            "  - {name: %s, sumocfg: tracks.sumocfg}\nvariants:\n  - name: " CP_MATRIX_BASELINE
            "\n  - name: " CP_MATRIX_TREATED "\n",
            ceil(matrix->lead_s + AFTER_S), matrix->step_length_s, matrix->name);
    if (matrix->function_count > 0)
        fputs("    functions:\n", out);
    for (size_t k = 0; k < matrix->function_count; k++)
        write_function(out, matrix, &matrix->functions[k]);
    fputs("vehicles:\n  default: ", out);
    write_text(out, matrix->model);
    fputs("\n  types:\n", out);
    for (size_t k = 0; k < target_types(matrix); k++) {
        char target[32];
        target_type(matrix, k, target);
        fprintf(out, "    - {type: %s, model: %s}\n", target, matrix->model);
    }
}

// ---- public --------------------------------------------------------------------------------

static cp_status write_file(const char *folder, const char *name, const cp_matrix *matrix,
                            void (*write)(FILE *, const cp_matrix *), char **path, cp_error *error)
{
    char *text = NULL, *full = malloc(strlen(folder) + strlen(name) + 2);
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    cp_status status = out != NULL && full != NULL ? CP_OK : cp_fail_memory(error, name);
    if (status == CP_OK) {
        write(out, matrix);
        sprintf(full, "%s/%s", folder, name);
    }
    if (out != NULL && fclose(out) != 0 && status == CP_OK)
        status = cp_fail_memory(error, name);
    if (status == CP_OK)
        status = cp_file_write(full, text, size, error);
    free(text);
    if (status == CP_OK && path != NULL)
        *path = full;
    else
        free(full);
    return status;
}

// Both cars begin on their tracks, the own one with room behind it.
static cp_status check_tracks(const cp_matrix *matrix, cp_error *error)
{
    for (size_t k = 0; k < cp_matrix_cells(matrix); k++) {
        cp_cell_tracks tracks;
        cp_tracks_of(matrix, k, &tracks);
        double first_m = fmin(tracks.own.start_m, tracks.target.start_m);
        if (first_m < matrix->length_m)
            return cp_fail(error, CP_BAD_INPUT,
                           "%s: cell %zu begins %.0f m before its track, lead_s must be less than "
                           "%g",
                           matrix->name, k, matrix->length_m - first_m, matrix->lead_s);
    }
    return CP_OK;
}

cp_status cp_matrix_study_write(const cp_matrix *matrix, const char *folder, char **study_path,
                                cp_error *error)
{
    *study_path = NULL;
    cp_status status = check_tracks(matrix, error);
    if (status == CP_OK && mkdir(folder, 0777) != 0 && errno != EEXIST)
        status = cp_fail(error, CP_IO_FAILED, "%s: %s", folder, strerror(errno));
    if (status == CP_OK)
        status = write_file(folder, "tracks.net.xml", matrix, write_network, NULL, error);
    if (status == CP_OK)
        status = write_file(folder, "cars.rou.xml", matrix, write_demand, NULL, error);
    if (status == CP_OK)
        status = write_file(folder, "tracks.sumocfg", matrix, write_configuration, NULL, error);
    if (status == CP_OK)
        status = write_file(folder, "study.yaml", matrix, write_study, study_path, error);
    return status;
}
