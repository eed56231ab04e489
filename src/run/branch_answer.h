/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_BRANCH_ANSWER_H
#define RUN_BRANCH_ANSWER_H

#include "run/simulation.h"
#include "store/counterfactual_rows.h"

/* What a branch is asked and what it answers, as bytes between a process and its own copy. Ids are
 * texts: the numbers of vehicles first seen after the checkpoint mean nothing to the original. */

#define CP_BRANCH_ID_SIZE 512
#define CP_BRANCH_EARLIER_MAX 64

/* A crash that one of the two had between the checkpoint and this one; it happens again in the
 * branch and is not what the branch is about. */
typedef struct cp_earlier_crash {
    int role; /* of the vehicle that had it */
    char opponent[CP_BRANCH_ID_SIZE];
} cp_earlier_crash;

typedef struct cp_branch_request {
    double contact_s;               /* SUMO clock of the baseline's contact */
    char ids[2][CP_BRANCH_ID_SIZE]; /* of the two vehicles, role a first */
    size_t earlier_count;
    cp_earlier_crash earlier[CP_BRANCH_EARLIER_MAX]; /* only as many are sent */
} cp_branch_request;

/* Bytes of a request with that many earlier crashes. */
size_t cp_branch_request_size(size_t earlier_count);

/* Another crash in the branch, of vehicles not involved. */
typedef struct cp_other_crash {
    double time_s;
    const char *ids[2];
} cp_other_crash;

/* Who one of the two cars of the crash is. */
typedef struct cp_branch_car {
    const char *id;
    const char *type_id;
    const char *lane;
    cp_sumo_type type;
} cp_branch_car;

typedef struct cp_branch_answer {
    bool has_crash;         /* one of the two had a confirmed crash */
    cp_found_contact found; /* its first; by the branch's numbers */
    cp_branch_car car[2];   /* by role of found */
    bool is_swapped;        /* roles are not those that were sent (cp_branch_answer_swap_roles) */
    const cp_sample_row *sample;
    size_t sample_count;
    size_t other_count;
    const char *others; /* packed, see cp_branch_answer_other */
} cp_branch_answer;

/* Send the answer. others: the found contacts that are crashes without the two vehicles. Errors:
 * CP_RUN_FAILED when nobody listens, CP_TRAFFIC_FAILED. */
CP_MUST_CHECK cp_status cp_branch_answer_send(int to, const cp_traffic *traffic,
                                              const cp_found_contact *first,
                                              const cp_sample_row *sample, size_t sample_count,
                                              const cp_found_contact *const *others,
                                              size_t other_count, cp_error *error);

/* Read one; texts, samples and found.participants point into bytes, which are aligned to 16. False
 * for bytes that are no whole answer. */
bool cp_branch_answer_read(const void *bytes, size_t size, cp_branch_answer *answer);

/* Role a of the crash becomes role b and the other way round, but in found.participants: their rows
 * are swapped when they are copied, as is_swapped says. */
void cp_branch_answer_swap_roles(cp_branch_answer *answer);

/* The next of the other crashes; *at: NULL at first. */
cp_other_crash cp_branch_answer_other(const cp_branch_answer *answer, const char **at);

#endif
