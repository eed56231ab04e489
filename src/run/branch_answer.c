/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/branch_answer.h"

#include "run/branch_process.h"

#include <stddef.h>
#include <string.h>

/* First bytes of an answer; driver errors and functions of the crash follow, samples, then texts:
 * ids, types and lanes of the crash, then for every other crash its time and two ids. */
typedef struct answer_head {
    cp_found_contact found;
    cp_sumo_type type[2];
    size_t sample_count;
    size_t other_count;
    bool has_crash;
} answer_head;

size_t cp_branch_request_size(size_t earlier_count)
{
    return offsetof(cp_branch_request, earlier) + earlier_count * sizeof(cp_earlier_crash);
}

static bool send_text(int to, const char *text)
{
    return cp_branch_write(to, text, strlen(text) + 1);
}

static bool send_participants(int to, const cp_participant_rows *rows)
{
    return (rows->error_count == 0 ||
            cp_branch_write(to, rows->error, rows->error_count * sizeof *rows->error)) &&
           (rows->function_count == 0 ||
            cp_branch_write(to, rows->function, rows->function_count * sizeof *rows->function));
}

// Who the two cars of the crash are.
static bool send_cars(int to, const cp_traffic *traffic, const cp_impact *impact)
{
    bool sent = true;
    for (int role = 0; sent && role < 2; role++)
        sent = send_text(to, cp_traffic_vehicle_id(traffic, impact->vehicle[role])) &&
               send_text(to, cp_traffic_type_id(traffic, impact->state[role].type)) &&
               send_text(to, cp_traffic_lane_id(traffic, impact->state[role].lane));
    return sent;
}

static bool send_other(int to, const cp_traffic *traffic, const cp_impact *impact)
{
    return cp_branch_write(to, &impact->time_s, sizeof impact->time_s) &&
           send_text(to, cp_traffic_vehicle_id(traffic, impact->vehicle[0])) &&
           send_text(to, cp_traffic_vehicle_id(traffic, impact->vehicle[1]));
}

cp_status cp_branch_answer_send(int to, const cp_traffic *traffic, const cp_found_contact *first,
                                const cp_sample_row *sample, size_t sample_count,
                                const cp_found_contact *const *others, size_t other_count,
                                cp_error *error)
{
    answer_head head = {
        .sample_count = sample_count, .other_count = other_count, .has_crash = first != NULL};
    cp_status status = CP_OK;
    if (first != NULL)
        head.found = *first;
    for (int role = 0; status == CP_OK && first != NULL && role < 2; role++)
        status =
            cp_traffic_type(traffic, cp_traffic_type_id(traffic, first->impact.state[role].type),
                            &head.type[role], error);
    if (status != CP_OK)
        return status;
    bool sent = cp_branch_write(to, &head, sizeof head);
    if (sent && first != NULL)
        sent = send_participants(to, &first->participants);
    if (sent && sample_count > 0)
        sent = cp_branch_write(to, sample, sample_count * sizeof *sample);
    if (sent && first != NULL)
        sent = send_cars(to, traffic, &first->impact);
    for (size_t k = 0; sent && k < other_count; k++)
        sent = send_other(to, traffic, &others[k]->impact);
    return sent ? CP_OK : cp_fail(error, CP_RUN_FAILED, "the answer could not be sent");
}

// The text at *at and past it; NULL when it does not end before end.
static const char *take_text(const char **at, const char *end)
{
    const char *text = *at;
    const char *zero = text < end ? memchr(text, '\0', (size_t)(end - text)) : NULL;
    if (zero == NULL)
        return NULL;
    *at = zero + 1;
    return text;
}

// Driver errors and functions at *at and past them; false when they do not end before end.
static bool take_participants(const char **at, const char *end, cp_participant_rows *rows)
{
    if ((size_t)(end - *at) / sizeof *rows->error < rows->error_count)
        return false;
    rows->error = (cp_driver_error_row *)(void *)*at;
    *at += rows->error_count * sizeof *rows->error;
    if ((size_t)(end - *at) / sizeof *rows->function < rows->function_count)
        return false;
    rows->function = (cp_function_row *)(void *)*at;
    *at += rows->function_count * sizeof *rows->function;
    return true;
}

bool cp_branch_answer_read(const void *bytes, size_t size, cp_branch_answer *answer)
{
    const char *at = bytes, *end = at + size;
    answer_head head;
    if (size < sizeof head)
        return false;
    memcpy(&head, at, sizeof head);
    at += sizeof head;
    if (!take_participants(&at, end, &head.found.participants))
        return false;
    if ((size_t)(end - at) / sizeof(cp_sample_row) < head.sample_count)
        return false;
    *answer = (cp_branch_answer){.has_crash = head.has_crash,
                                 .found = head.found,
                                 .sample = (const cp_sample_row *)(const void *)at,
                                 .sample_count = head.sample_count,
                                 .other_count = head.other_count};
    at += head.sample_count * sizeof(cp_sample_row);
    for (int role = 0; head.has_crash && role < 2; role++) {
        cp_branch_car *car = &answer->car[role];
        car->id = take_text(&at, end);
        car->type_id = take_text(&at, end);
        car->lane = take_text(&at, end);
        car->type = head.type[role];
        if (car->id == NULL || car->type_id == NULL || car->lane == NULL)
            return false;
    }
    answer->others = at;
    for (size_t k = 0; k < head.other_count; k++) {
        if ((size_t)(end - at) < sizeof(double))
            return false;
        at += sizeof(double);
        for (int vehicle = 0; vehicle < 2; vehicle++)
            if (take_text(&at, end) == NULL)
                return false;
    }
    return at == end;
}

void cp_branch_answer_swap_roles(cp_branch_answer *answer)
{
    const cp_found_car found = answer->found.car[0];
    const cp_branch_car car = answer->car[0];
    cp_impact_swap_roles(&answer->found.impact);
    answer->found.car[0] = answer->found.car[1];
    answer->found.car[1] = found;
    answer->car[0] = answer->car[1];
    answer->car[1] = car;
    answer->is_swapped = !answer->is_swapped;
}

cp_other_crash cp_branch_answer_other(const cp_branch_answer *answer, const char **at)
{
    cp_other_crash other;
    const char *next = *at != NULL ? *at : answer->others;
    memcpy(&other.time_s, next, sizeof other.time_s);
    other.ids[0] = next + sizeof other.time_s;
    other.ids[1] = other.ids[0] + strlen(other.ids[0]) + 1;
    *at = other.ids[1] + strlen(other.ids[1]) + 1;
    return other;
}
