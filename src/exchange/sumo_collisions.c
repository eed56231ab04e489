/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/sumo_collisions.h"

#include "core/array.h"
#include "core/xml_file.h"

#include <math.h>
#include <search.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A pair of vehicles and where it stands in the list. */
typedef struct known_pair {
    size_t index;
    char text[]; /* "smaller id\1larger id" */
} known_pair;

typedef struct reading {
    cp_collision_list *list;
    void *pairs;   /* known_pairs, a binary tree */
    double time_s; /* of the row before; NAN: none */
} reading;

static int compare_pairs(const void *one, const void *other)
{
    return strcmp(((const known_pair *)one)->text, ((const known_pair *)other)->text);
}

// Where the pair stands in the list: behind its end when it is new, which it is not from now on.
static cp_status remember_pair(reading *self, const char *one, const char *other, size_t *index,
                               cp_error *error)
{
    bool in_order = strcmp(one, other) < 0;
    size_t size = strlen(one) + strlen(other) + 2;
    known_pair *pair = malloc(sizeof *pair + size);
    if (pair == NULL)
        return cp_fail_memory(error, "collisions");
    pair->index = self->list->count;
    snprintf(pair->text, size, "%s\1%s", in_order ? one : other, in_order ? other : one);
    known_pair **place = tsearch(pair, &self->pairs, compare_pairs);
    if (place == NULL || *place != pair)
        free(pair);
    if (place == NULL)
        return cp_fail_memory(error, "collisions");
    *index = (*place)->index;
    return CP_OK;
}

static cp_status append(cp_collision_list *list, const cp_listed_collision *collision,
                        cp_error *error)
{
    cp_listed_collision *added = cp_array_add(list->collision, list->count);
    if (added == NULL)
        return cp_fail_memory(error, "collisions");
    *added = *collision;
    return CP_OK;
}

static cp_status copy(const cp_xml_element *element, const char *name, char **text, cp_error *error)
{
    const char *value = NULL;
    cp_status status = cp_xml_text(element, name, &value, error);
    if (status != CP_OK)
        return status;
    *text = strdup(value);
    return *text != NULL ? CP_OK : cp_fail_memory(error, "collisions");
}

static void destroy_collision(cp_listed_collision *collision)
{
    for (int k = 0; k < 2; k++) {
        free(collision->id[k]);
        free(collision->type[k]);
    }
    free(collision->kind);
    free(collision->places);
}

// "x,y" or "x,y,z" in metres; true when the element has it.
static cp_status read_place(const cp_xml_element *element, const char *name, cp_vec2 *place_m,
                            bool *is_there, cp_error *error)
{
    const char *text = cp_xml_attribute(element, name);
    double value[3];
    *is_there = text != NULL;
    if (text == NULL)
        return CP_OK;
    const char *c = text;
    int count = 0;
    for (; count < 3; count++) {
        char *end = NULL;
        value[count] = strtod(c, &end);
        if (end == c || !(fabs(value[count]) <= 1e9) || (*end != ',' && *end != '\0'))
            break;
        c = end + 1;
        if (*end == '\0') {
            if (count == 0)
                break;
            *place_m = (cp_vec2){value[0], value[1]};
            return CP_OK;
        }
    }
    return cp_fail(error, CP_BAD_INPUT, "%s:%zu: %s of <%s> must be x,y in m, found '%s'",
                   element->path, element->line, name, element->name, text);
}

// Where both were, when the row says so.
static cp_status read_places(const cp_xml_element *element, const double speed_m_s[2],
                             cp_collision_places *places, bool *are_there, cp_error *error)
{
    static const char *const FRONT[] = {"colliderFront", "victimFront"};
    static const char *const BACK[] = {"colliderBack", "victimBack"};
    int count = 0;
    cp_status status = CP_OK;
    for (int role = 0; status == CP_OK && role < 2; role++) {
        bool has_front = false, has_back = false;
        status = read_place(element, FRONT[role], &places->front_m[role], &has_front, error);
        if (status == CP_OK)
            status = read_place(element, BACK[role], &places->back_m[role], &has_back, error);
        count += has_front + has_back;
        places->speed_m_s[role] = speed_m_s[role];
    }
    *are_there = count == 4 && !isnan(speed_m_s[0]) && !isnan(speed_m_s[1]);
    if (status == CP_OK && count > 0 && !*are_there)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s:%zu: <collision> must have all of colliderFront, colliderBack, "
                       "victimFront, victimBack, colliderSpeed, victimSpeed, or no place",
                       element->path, element->line);
    return status;
}

// In the order of the pair as it is listed.
static cp_status append_places(cp_listed_collision *listed, cp_collision_places places,
                               bool is_swapped, cp_error *error)
{
    cp_collision_places *added = cp_array_add(listed->places, listed->places_count);
    if (added == NULL)
        return cp_fail_memory(error, "collisions");
    *added = places;
    for (int role = 0; is_swapped && role < 2; role++) {
        added->front_m[role] = places.front_m[1 - role];
        added->back_m[role] = places.back_m[1 - role];
        added->speed_m_s[role] = places.speed_m_s[1 - role];
    }
    return CP_OK;
}

// Ids and what else the row tells in words; the types may be missing.
static cp_status read_words(const cp_xml_element *element, cp_listed_collision *collision,
                            cp_error *error)
{
    static const char *const ID[] = {"collider", "victim"};
    static const char *const TYPE[] = {"colliderType", "victimType"};
    cp_status status = CP_OK;
    for (int role = 0; status == CP_OK && role < 2; role++) {
        status = copy(element, ID[role], &collision->id[role], error);
        if (status == CP_OK && cp_xml_attribute(element, TYPE[role]) != NULL)
            status = copy(element, TYPE[role], &collision->type[role], error);
    }
    return status == CP_OK ? copy(element, "type", &collision->kind, error) : status;
}

static cp_status read_speeds(const cp_xml_element *element, double speed_m_s[2], cp_error *error)
{
    static const char *const SPEED[] = {"colliderSpeed", "victimSpeed"};
    cp_status status = CP_OK;
    for (int role = 0; status == CP_OK && role < 2; role++) {
        speed_m_s[role] = NAN;
        if (cp_xml_attribute(element, SPEED[role]) != NULL)
            status = cp_xml_number(element, SPEED[role], -1e3, 1e3, &speed_m_s[role], error);
    }
    return status;
}

// One report: a new pair's words and speeds become the list's, a known pair's last report moves on.
static cp_status take_report(reading *self, cp_listed_collision *collision,
                             const cp_collision_places *places, cp_error *error)
{
    cp_collision_list *list = self->list;
    size_t index = 0;
    list->reports++;
    if (collision->time_s > self->time_s)
        list->step_s = fmin(list->step_s, collision->time_s - self->time_s);
    self->time_s = collision->time_s;
    if (strcmp(collision->id[0], collision->id[1]) == 0) {
        list->with_themselves++;
        return CP_OK;
    }
    list->without_places += places == NULL;
    cp_status status = remember_pair(self, collision->id[0], collision->id[1], &index, error);
    if (status == CP_OK && index == list->count) {
        status = append(list, collision, error);
        if (status == CP_OK)
            *collision = (cp_listed_collision){0};
    } else if (status == CP_OK) {
        list->collision[index].last_s = collision->time_s;
    }
    if (status != CP_OK || places == NULL)
        return status;
    cp_listed_collision *listed = &list->collision[index];
    // SUMO may report a pair from both sides in one step.
    if (listed->places_count > 0 &&
        listed->places[listed->places_count - 1].time_s == places->time_s)
        return CP_OK;
    bool is_swapped = collision->id[0] != NULL && strcmp(collision->id[0], listed->id[0]) != 0;
    return append_places(listed, *places, is_swapped, error);
}

static cp_status visit(void *context, const cp_xml_element *element, cp_error *error)
{
    reading *self = context;
    if (strcmp(element->name, "collision") != 0)
        return CP_OK;
    const char *kind = cp_xml_attribute(element, "type");
    // junctionPedestrian, crossing, sharedLane: one of the two walks.
    if (kind != NULL && (strcmp(kind, "junctionPedestrian") == 0 || strcmp(kind, "crossing") == 0 ||
                         strcmp(kind, "sharedLane") == 0))
        return CP_OK;
    cp_listed_collision collision = {.line = element->line};
    cp_collision_places places = {0};
    bool has_places = false;
    cp_status status = cp_xml_time(element, "time", &collision.time_s, error);
    if (status == CP_OK)
        status = read_words(element, &collision, error);
    if (status == CP_OK)
        status = read_speeds(element, collision.speed_m_s, error);
    if (status == CP_OK)
        status = read_places(element, collision.speed_m_s, &places, &has_places, error);
    places.time_s = collision.last_s = collision.time_s;
    if (status == CP_OK)
        status = take_report(self, &collision, has_places ? &places : NULL, error);
    destroy_collision(&collision);
    return status;
}

cp_status cp_sumo_collisions_read(const char *path, cp_collision_list *list, cp_error *error)
{
    *list = (cp_collision_list){.step_s = INFINITY};
    reading self = {.list = list, .time_s = NAN};
    cp_status status = cp_xml_read(path, "collisions", visit, &self, error);
    while (self.pairs != NULL) {
        known_pair *pair = *(known_pair **)self.pairs;
        tdelete(pair, &self.pairs, compare_pairs);
        free(pair);
    }
    if (status != CP_OK)
        cp_collision_list_destroy(list);
    return status;
}

void cp_collision_list_destroy(cp_collision_list *list)
{
    for (size_t k = 0; k < list->count; k++)
        destroy_collision(&list->collision[k]);
    free(list->collision);
    *list = (cp_collision_list){0};
}
