/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/sumo_collisions.h"

#include "core/xml_file.h"

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
    void *pairs; /* known_pairs, a binary tree */
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
    // Room doubles whenever the count is a power of two.
    if ((list->count & (list->count - 1)) == 0) {
        size_t room = list->count == 0 ? 1 : 2 * list->count;
        cp_listed_collision *larger = realloc(list->collision, room * sizeof *larger);
        if (larger == NULL)
            return cp_fail_memory(error, "collisions");
        list->collision = larger;
    }
    list->collision[list->count++] = *collision;
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
    self->list->reports++;
    cp_listed_collision collision = {.line = element->line};
    size_t index = 0;
    cp_status status = cp_xml_time(element, "time", &collision.time_s, error);
    if (status == CP_OK)
        status = copy(element, "collider", &collision.id[0], error);
    if (status == CP_OK)
        status = copy(element, "victim", &collision.id[1], error);
    if (status == CP_OK)
        status = copy(element, "colliderType", &collision.type[0], error);
    if (status == CP_OK)
        status = copy(element, "victimType", &collision.type[1], error);
    if (status == CP_OK)
        status = copy(element, "type", &collision.kind, error);
    bool is_itself = status == CP_OK && strcmp(collision.id[0], collision.id[1]) == 0;
    self->list->with_themselves += is_itself;
    if (status == CP_OK && !is_itself)
        status = remember_pair(self, collision.id[0], collision.id[1], &index, error);
    bool is_new = status == CP_OK && !is_itself && index == self->list->count;
    collision.last_s = collision.time_s;
    if (is_new)
        status = append(self->list, &collision, error);
    else if (status == CP_OK && !is_itself)
        self->list->collision[index].last_s = collision.time_s;
    if (status != CP_OK || !is_new)
        destroy_collision(&collision);
    return status;
}

cp_status cp_sumo_collisions_read(const char *path, cp_collision_list *list, cp_error *error)
{
    *list = (cp_collision_list){0};
    reading self = {.list = list};
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
