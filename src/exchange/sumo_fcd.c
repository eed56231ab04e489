/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/sumo_fcd.h"

#include "core/array.h"
#include "core/log.h"
#include "core/units.h"
#include "core/xml_file.h"

#include <math.h>
#include <search.h>
#include <stdlib.h>
#include <string.h>

// Times are written with two or three digits.
#define TIME_ROUNDING_S 0.0051

// One vehicle of one collision, to be found by its id.
typedef struct wanted {
    const char *id;
    size_t collision;
    int role;
} wanted;

typedef struct reading {
    const cp_collision_list *list;
    double before_s, after_s;
    cp_fcd_record *record;
    wanted *wanted; /* by id */
    size_t wanted_count;
    void *seen; /* ids of all vehicles, a binary tree */
    size_t steps;
    double first_s, time_s;
} reading;

static int compare_wanted(const void *one, const void *other)
{
    const wanted *a = one, *b = other;
    int order = strcmp(a->id, b->id);
    if (order == 0)
        order = a->collision < b->collision ? -1 : a->collision > b->collision;
    return order;
}

static int compare_texts(const void *one, const void *other)
{
    return strcmp(one, other);
}

static cp_status count_vehicle(reading *self, const char *id, cp_error *error)
{
    if (tfind(id, &self->seen, compare_texts) != NULL)
        return CP_OK;
    char *own = strdup(id);
    if (own == NULL || tsearch(own, &self->seen, compare_texts) == NULL) {
        free(own);
        return cp_fail_memory(error, "vehicles");
    }
    self->record->departed++;
    return CP_OK;
}

cp_status cp_fcd_track_append(cp_fcd_track *track, cp_fcd_sample sample, cp_error *error)
{
    cp_fcd_sample *added = cp_array_add(track->sample, track->count);
    if (added == NULL)
        return cp_fail_memory(error, "ways of vehicles");
    *added = sample;
    return CP_OK;
}

// Number of a lane by its name.
static cp_status number_lane(cp_fcd_record *record, const char *name, size_t *number,
                             cp_error *error)
{
    for (*number = 0; *number < record->lane_count; ++*number)
        if (strcmp(record->lanes[*number], name) == 0)
            return CP_OK;
    char **lane = cp_array_add(record->lanes, record->lane_count);
    if (lane == NULL)
        return cp_fail_memory(error, "lanes");
    *lane = strdup(name);
    return *lane != NULL ? CP_OK : cp_fail_memory(error, "lanes");
}

static cp_status take_step(reading *self, const cp_xml_element *element, cp_error *error)
{
    double before_s = self->time_s;
    cp_status status = cp_xml_time(element, "time", &self->time_s, error);
    if (status != CP_OK)
        return status;
    double step_s = self->time_s - before_s;
    if (self->steps == 0)
        self->first_s = self->time_s;
    else if (!(step_s > 0.0))
        return cp_fail(error, CP_BAD_INPUT,
                       "%s:%zu: time of <timestep> must rise, found %g after %g", element->path,
                       element->line, self->time_s, before_s);
    else if (self->steps == 1)
        self->record->step_length_s = step_s;
    // Steps without vehicles may be left out (--fcd-output.skip-empty of later versions).
    double skipped = self->steps > 1 ? round(step_s / self->record->step_length_s) - 1.0 : 0.0;
    if (self->steps > 1 &&
        (skipped < 0.0 || fabs(step_s - (skipped + 1.0) * self->record->step_length_s) >
                              TIME_ROUNDING_S * (skipped + 1.0)))
        return cp_fail(error, CP_BAD_INPUT,
                       "%s:%zu: <timestep> must follow the one before after %g s as the first ones "
                       "do, or a multiple of it, found %g s",
                       element->path, element->line, self->record->step_length_s, step_s);
    self->steps += (size_t)skipped;
    self->steps++;
    return CP_OK;
}

// From degrees clockwise from north; in (-pi, pi], and 0 exactly for due east.
static double yaw_of(double angle_deg)
{
    double yaw_deg = remainder(90.0 - angle_deg, 360.0);
    return cp_rad_from_deg(yaw_deg <= -180.0 ? 180.0 : yaw_deg);
}

// The list of collisions does not say what the vehicle is.
static cp_status take_type(const cp_xml_element *element, cp_fcd_track *track, cp_error *error)
{
    const char *type = NULL;
    cp_status status = cp_xml_text(element, "type", &type, error);
    if (status != CP_OK) {
        cp_error_prefix(error, "the collisions have no colliderType and victimType, so that ");
        return status;
    }
    track->type = strdup(type);
    return track->type != NULL ? CP_OK : cp_fail_memory(error, "ways of vehicles");
}

static cp_status take_vehicle(reading *self, const cp_xml_element *element, cp_error *error)
{
    const char *id = NULL;
    double speed_m_s = 0.0, angle_deg = 0.0;
    cp_fcd_sample sample = {.time_s = self->time_s, .lane = CP_FCD_NO_LANE};
    if (self->steps == 0)
        return cp_fail(error, CP_BAD_INPUT, "%s:%zu: <vehicle> must stand inside a <timestep>",
                       element->path, element->line);
    cp_status status = cp_xml_text(element, "id", &id, error);
    if (status == CP_OK)
        status = cp_xml_number(element, "speed", -1e3, 1e3, &speed_m_s, error);
    if (status == CP_OK)
        status = count_vehicle(self, id, error);
    if (status != CP_OK)
        return status;
    self->record->vehicle_km += speed_m_s / 1000.0; // times the step length at the end
    self->record->vehicle_h += 1.0 / 3600.0;

    // Every collision of this vehicle that is near in time.
    wanted key = {.id = id};
    size_t low = 0, high = self->wanted_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (compare_wanted(&self->wanted[middle], &key) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    for (; status == CP_OK && low < self->wanted_count && strcmp(self->wanted[low].id, id) == 0;
         low++) {
        const wanted *found = &self->wanted[low];
        const cp_listed_collision *listed = &self->list->collision[found->collision];
        if (self->time_s < listed->time_s - self->before_s ||
            self->time_s > fmax(listed->time_s, listed->last_s) + self->after_s)
            continue;
        status = cp_xml_number(element, "x", -1e9, 1e9, &sample.front_m.x, error);
        if (status == CP_OK)
            status = cp_xml_number(element, "y", -1e9, 1e9, &sample.front_m.y, error);
        if (status == CP_OK)
            status = cp_xml_number(element, "angle", -360.0, 360.0, &angle_deg, error);
        sample.lane_position_m = NAN;
        if (status == CP_OK && cp_xml_attribute(element, "pos") != NULL)
            status = cp_xml_number(element, "pos", -1e9, 1e9, &sample.lane_position_m, error);
        const char *lane = cp_xml_attribute(element, "lane");
        if (status == CP_OK && lane != NULL && lane[0] != '\0')
            status = number_lane(self->record, lane, &sample.lane, error);
        sample.yaw_rad = yaw_of(angle_deg);
        sample.speed_m_s = speed_m_s;
        cp_fcd_track *track = &self->record->track[found->collision][found->role];
        if (status == CP_OK)
            status = cp_fcd_track_append(track, sample, error);
        if (status == CP_OK && listed->type[found->role] == NULL && track->type == NULL)
            status = take_type(element, track, error);
    }
    return status;
}

static cp_status visit(void *context, const cp_xml_element *element, cp_error *error)
{
    reading *self = context;
    if (strcmp(element->name, "timestep") == 0)
        return take_step(self, element, error);
    return strcmp(element->name, "vehicle") == 0 ? take_vehicle(self, element, error) : CP_OK;
}

static cp_status begin(reading *self, cp_error *error)
{
    size_t count = self->list->count;
    self->record->track = calloc(count + 1, sizeof *self->record->track);
    self->wanted = calloc(2 * count + 1, sizeof *self->wanted);
    if (self->record->track == NULL || self->wanted == NULL)
        return cp_fail_memory(error, "ways of vehicles");
    self->record->collision_count = count;
    for (size_t k = 0; k < count; k++)
        for (int role = 0; role < 2; role++)
            self->wanted[self->wanted_count++] =
                (wanted){self->list->collision[k].id[role], k, role};
    qsort(self->wanted, self->wanted_count, sizeof *self->wanted, compare_wanted);
    return CP_OK;
}

// Whether the ways are as long as the speeds say: positions in degrees (--fcd-output.geo) are not.
static cp_status check_lengths(const char *path, const cp_fcd_record *record, cp_error *error)
{
    double way_m = 0.0, by_speed_m = 0.0;
    for (size_t k = 0; k < record->collision_count; k++)
        for (int role = 0; role < 2; role++) {
            const cp_fcd_track *track = &record->track[k][role];
            for (size_t i = 1; i < track->count; i++) {
                const cp_fcd_sample *now = &track->sample[i], *before = &track->sample[i - 1];
                way_m += cp_vec2_length(cp_vec2_sub(now->front_m, before->front_m));
                by_speed_m += fabs(now->speed_m_s) * (now->time_s - before->time_s);
            }
        }
    if (by_speed_m < 10.0 || way_m > 0.1 * by_speed_m)
        return CP_OK;
    return cp_fail(error, CP_BAD_INPUT,
                   "%s: x and y must be metres, found ways of %g where speeds make %g m (was it "
                   "written with --fcd-output.geo?)",
                   path, way_m, by_speed_m);
}

// Whether SUMO made every step that the record has, or more: collisions come at SUMO's own.
static cp_status check_period(const char *path, const cp_collision_list *list,
                              const cp_fcd_record *record, double first_s, cp_error *error)
{
    double step_s = record->step_length_s;
    for (size_t k = 0; k < list->count; k++) {
        double steps = (list->collision[k].time_s - first_s) / step_s;
        if (fabs(steps - round(steps)) * step_s < 2.0 * TIME_ROUNDING_S)
            continue;
        if (step_s > CP_FCD_COARSEST_PERIOD_S)
            return cp_fail(error, CP_BAD_INPUT,
                           "%s: must hold SUMO's own steps, or one every %g s at least, found one "
                           "every %g s and a collision at %g s in between (device.fcd.period): "
                           "between them contacts come and go",
                           path, CP_FCD_COARSEST_PERIOD_S, step_s, list->collision[k].time_s);
        cp_log_warning("%s: holds one step every %g s, SUMO made more (a collision at %g s): "
                       "contacts are between its steps as if vehicles went straight",
                       path, step_s, list->collision[k].time_s);
        return CP_OK;
    }
    return CP_OK;
}

cp_status cp_sumo_fcd_read(const char *path, const cp_collision_list *list, double before_s,
                           double after_s, cp_fcd_record *record, cp_error *error)
{
    *record = (cp_fcd_record){0};
    reading self = {.list = list, .before_s = before_s, .after_s = after_s, .record = record};
    cp_status status = begin(&self, error);
    if (status == CP_OK)
        status = cp_xml_read(path, "fcd-export", visit, &self, error);
    if (status == CP_OK && self.steps < 2)
        status = cp_fail(error, CP_BAD_INPUT, "%s: must hold at least two <timestep>, found %zu",
                         path, self.steps);
    while (self.seen != NULL) {
        char *id = *(char **)self.seen;
        tdelete(id, &self.seen, compare_texts);
        free(id);
    }
    free(self.wanted);
    if (status == CP_OK)
        status = check_lengths(path, record, error);
    if (status != CP_OK) {
        cp_fcd_record_destroy(record);
        return status;
    }
    // The mean step is free of the rounding of written times.
    record->simulated_s = self.time_s - self.first_s;
    record->step_length_s = record->simulated_s / (double)(self.steps - 1);
    record->vehicle_km *= record->step_length_s;
    record->vehicle_h *= record->step_length_s;
    status = check_period(path, list, record, self.first_s, error);
    if (status != CP_OK)
        cp_fcd_record_destroy(record);
    return status;
}

void cp_fcd_track_destroy(cp_fcd_track *track)
{
    free(track->sample);
    free(track->type);
    *track = (cp_fcd_track){0};
}

void cp_fcd_record_destroy(cp_fcd_record *record)
{
    for (size_t k = 0; k < record->collision_count; k++)
        for (int role = 0; role < 2; role++)
            cp_fcd_track_destroy(&record->track[k][role]);
    free(record->track);
    for (size_t k = 0; k < record->lane_count; k++)
        free(record->lanes[k]);
    free(record->lanes);
    *record = (cp_fcd_record){0};
}
