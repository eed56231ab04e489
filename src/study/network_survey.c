/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/network_survey.h"

#include "core/xml_file.h"
#include "study/scenario_walk.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct surveying {
    cp_network_survey *survey;
    json_t *roads; /* {"from\tto": number of edges} */
} surveying;

static bool is(const cp_xml_element *element, const char *name)
{
    return strcmp(element->name, name) == 0;
}

// ---- networks ------------------------------------------------------------------------------

// An edge between junctions; the way back may come before or after.
static cp_status count_road(surveying *s, const cp_xml_element *element, cp_error *error)
{
    const char *from = cp_xml_attribute(element, "from"), *to = cp_xml_attribute(element, "to");
    const char *function = cp_xml_attribute(element, "function");
    char way[1024], back[1024];
    if (from == NULL || to == NULL || (function != NULL && strcmp(function, "normal") != 0))
        return CP_OK;
    snprintf(way, sizeof way, "%s\t%s", from, to);
    snprintf(back, sizeof back, "%s\t%s", to, from);
    json_int_t there = json_integer_value(json_object_get(s->roads, way));
    json_int_t opposite = json_integer_value(json_object_get(s->roads, back));
    s->survey->edges++;
    // The first of this direction makes those back two-way roads as well.
    if (opposite > 0)
        s->survey->two_way += 1 + (there == 0 ? (size_t)opposite : 0);
    return json_object_set_new(s->roads, way, json_integer(there + 1)) == 0
               ? CP_OK
               : cp_fail_memory(error, "roads");
}

// States of connections (SUMO): m minor, w and s stop signs, = equal rank.
static void count_connection(cp_network_survey *survey, const cp_xml_element *element)
{
    const char *state = cp_xml_attribute(element, "state");
    const char *from = cp_xml_attribute(element, "from");
    bool inside = from != NULL && from[0] == ':';
    if (state != NULL && !inside && strlen(state) == 1 && strchr("mws=", state[0]) != NULL)
        survey->yielding++;
}

static void measure(cp_network_survey *survey, const cp_xml_element *element)
{
    const char *box = cp_xml_attribute(element, "convBoundary");
    double corner[4] = {0.0}; // x0,y0,x1,y1
    size_t read = 0;
    while (box != NULL && read < 4) {
        char *end = NULL;
        corner[read] = strtod(box, &end);
        read += end != box;
        box = end != box && *end == ',' ? end + 1 : NULL;
    }
    if (read == 4)
        survey->diagonal_m =
            fmax(survey->diagonal_m, hypot(corner[2] - corner[0], corner[3] - corner[1]));
}

// ---- demand --------------------------------------------------------------------------------

// A departure as a word ("triggered", "now") counts as none that is known.
static void note_time(cp_network_survey *survey, const cp_xml_element *element,
                      const char *attribute)
{
    double time_s = 0.0;
    cp_error unknown = {0};
    if (cp_xml_attribute(element, attribute) != NULL &&
        cp_xml_time(element, attribute, &time_s, &unknown) == CP_OK)
        survey->last_departure_s = fmax(survey->last_departure_s, time_s);
}

static cp_status note_type(cp_network_survey *survey, const cp_xml_element *element,
                           cp_error *error)
{
    const char *id = cp_xml_attribute(element, "id");
    const char *class = cp_xml_attribute(element, "vClass");
    if (id == NULL)
        return CP_OK;
    return json_object_set_new(survey->types, id,
                               json_string(class != NULL ? class : "passenger")) == 0
               ? CP_OK
               : cp_fail_memory(error, "vehicle types");
}

static cp_status visit_element(void *context, const cp_xml_element *element, cp_error *error)
{
    surveying *s = context;
    cp_network_survey *survey = s->survey;
    if (is(element, "edge"))
        return count_road(s, element, error);
    if (is(element, "vType"))
        return note_type(survey, element, error);
    if (is(element, "tlLogic")) {
        survey->lights++;
    } else if (is(element, "neigh")) {
        survey->may_overtake++;
    } else if (is(element, "connection")) {
        count_connection(survey, element);
    } else if (is(element, "location")) {
        measure(survey, element);
    } else if (is(element, "lane")) {
        const char *speed = cp_xml_attribute(element, "speed");
        survey->speed_max_m_s =
            fmax(survey->speed_max_m_s, speed != NULL ? strtod(speed, NULL) : 0.0);
    } else if (is(element, "vehicle") || is(element, "trip")) {
        survey->departures++;
        note_time(survey, element, "depart");
    } else if (is(element, "flow")) {
        survey->flows++;
        note_time(survey, element, "end");
    }
    return CP_OK;
}

// ---- public --------------------------------------------------------------------------------

static cp_status visit_file(const cp_input_file *file, const char *name, void *context,
                            cp_error *error)
{
    cp_error of_file = {0};
    (void)name;
    cp_status status = cp_xml_read(file->path, NULL, visit_element, context, &of_file);
    // What is no XML is for SUMO to complain of.
    if (status != CP_NO_MEMORY)
        return CP_OK;
    *error = of_file;
    return status;
}

cp_status cp_network_survey_make(const cp_sumo_configuration *configuration,
                                 cp_network_survey *survey, cp_error *error)
{
    const cp_input_search nothing = {0};
    *survey = (cp_network_survey){.last_departure_s = -INFINITY, .types = json_object()};
    surveying s = {.survey = survey, .roads = json_object()};
    cp_status status = survey->types != NULL && s.roads != NULL
                           ? cp_scenario_walk(configuration, &nothing, visit_file, &s, error)
                           : cp_fail_memory(error, "a survey");
    json_decref(s.roads);
    return status;
}

void cp_network_survey_destroy(cp_network_survey *survey)
{
    json_decref(survey->types);
    *survey = (cp_network_survey){0};
}
