/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TRAFFIC_SUMO_OPTIONS_H
#define TRAFFIC_SUMO_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* SUMO's options: which there are, and what becomes of those that cannot be left to a scenario,
 * because they would break the pairing of seeds, keep a worker waiting, or hide what a run did. The
 * table at the head of sumo_options.c is the only place where that is decided. */

typedef enum cp_sumo_value_kind {
    CP_SUMO_INPUT,  /* files that SUMO reads, separated by commas */
    CP_SUMO_OUTPUT, /* a file that it writes */
    CP_SUMO_SWITCH, /* true or false */
    CP_SUMO_OTHER,
} cp_sumo_value_kind;

typedef struct cp_sumo_option {
    const char *name;
    const char *other_names; /* separated by blanks */
    cp_sumo_value_kind kind;
} cp_sumo_option;

/* An option by any of its names, without dashes; NULL for one that SUMO 1.15 does not have. */
const cp_sumo_option *cp_sumo_option_find(const char *name);

/* What becomes of an option that a scenario sets. */
typedef enum cp_sumo_treatment {
    CP_SUMO_REPLACED, /* every run sets it to the rule's value */
    CP_SUMO_COMPUTED, /* every run sets it from the study; refused among sumo_options */
    CP_SUMO_REFUSED,  /* the scenario does not start */
    CP_SUMO_JOINED,   /* output-prefix: follows the replication's own, without its folder */
    CP_SUMO_BOUNDED,  /* end: refused before the end of the replication */
} cp_sumo_treatment;

typedef struct cp_sumo_rule {
    const char *option;
    cp_sumo_treatment treatment;
    const char *value; /* of CP_SUMO_REPLACED */
    const char *why;   /* for whoever set it otherwise; NULL: nobody need be told */
} cp_sumo_rule;

extern const cp_sumo_rule CP_SUMO_RULE[];
extern const size_t CP_SUMO_RULE_COUNT;

/* The rule of an option by its first name; NULL: it is left to the scenario. */
const cp_sumo_rule *cp_sumo_rule_find(const char *option);

/* Whether two values of an option mean the same: words for true and false as SUMO knows them,
 * numbers, else letter by letter. */
bool cp_sumo_values_agree(const cp_sumo_option *option, const char *one, const char *other);
/* Whether the value of a switch is true. */
bool cp_sumo_value_is_true(const char *value);

#ifdef __cplusplus
}
#endif

#endif
