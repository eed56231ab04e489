/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "traffic/sumo_options.h"

#include "traffic/sumo_option_list.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

const cp_sumo_rule CP_SUMO_RULE[] = {
    // The study says when, how long and with which seed.
    {"seed", CP_SUMO_COMPUTED, NULL, "the study gives every replication its seed"},
    {"step-length", CP_SUMO_COMPUTED, NULL, "it is the study's step_length_s"},
    {"thread-rngs", CP_SUMO_COMPUTED, NULL, "there is one random stream a lane"},
    {"configuration-file", CP_SUMO_REFUSED, NULL, "the scenario's sumocfg is the only one"},
    {"end", CP_SUMO_BOUNDED, NULL, "flows without an end of their own stop there"},
    // Pairing: the seed must say everything that is drawn.
    {"random", CP_SUMO_REPLACED, "false", "SUMO would seed itself by the clock"},
    {"load-state", CP_SUMO_REFUSED, NULL,
     "SUMO does not put the traffic back as it was, cars collide that otherwise do not; let it "
     "build up within warmup_s"},
    // Hanging: a worker waits for nobody, and its copies (fork) hold one thread.
    {"remote-port", CP_SUMO_REPLACED, "0", "a worker waits for no other program"},
    {"num-clients", CP_SUMO_REPLACED, "1", "a worker waits for no other program"},
    {"threads", CP_SUMO_REPLACED, "1", "checkpoints are copies of the process with one thread"},
    {"device.rerouting.threads", CP_SUMO_REPLACED, "0",
     "checkpoints are copies of the process with one thread"},
    // Motion: vehicles have places and headings everywhere, and brake as commanded.
    {"mesosim", CP_SUMO_REFUSED, NULL, "vehicles of a mesoscopic simulation have no places"},
    {"no-internal-links", CP_SUMO_REPLACED, "false",
     "vehicles would jump across junctions, where most crashes are"},
    {"step-method.ballistic", CP_SUMO_REPLACED, "true",
     "SUMO's Euler update gets speeds of braking cars wrong by up to 1.6 m/s"},
    // Collisions: crashpulse finds and handles them; SUMO's own are the cross-check.
    {"collision.action", CP_SUMO_REPLACED, "warn", "crashpulse takes crashed cars off the road"},
    {"collision.stoptime", CP_SUMO_REPLACED, "0", "crashpulse takes crashed cars off the road"},
    {"collision.check-junctions", CP_SUMO_REPLACED, "true",
     "SUMO's collisions are compared with ours"},
    {"collision.check-junctions.mingap", CP_SUMO_REPLACED, "0",
     "SUMO's collisions are compared with ours"},
    {"collision.mingap-factor", CP_SUMO_REPLACED, "0", "SUMO's collisions are compared with ours"},
    {"ignore-accidents", CP_SUMO_REPLACED, "false", "SUMO's collisions are compared with ours"},
    // Output: parallel replications write files of their own names; nothing ends without running.
    {"output-prefix", CP_SUMO_JOINED, NULL,
     "files of parallel replications need names of their own"},
    {"no-step-log", CP_SUMO_REPLACED, "true", NULL},
    {"duration-log.disable", CP_SUMO_REPLACED, "true", NULL},
    {"gui-settings-file", CP_SUMO_REPLACED, "", NULL},
    {"save-configuration", CP_SUMO_REFUSED, NULL, "SUMO would end without simulating"},
    {"save-template", CP_SUMO_REFUSED, NULL, "SUMO would end without simulating"},
    {"save-schema", CP_SUMO_REFUSED, NULL, "SUMO would end without simulating"},
    {"help", CP_SUMO_REFUSED, NULL, "SUMO would end without simulating"},
    {"version", CP_SUMO_REFUSED, NULL, "SUMO would end without simulating"},
};
const size_t CP_SUMO_RULE_COUNT = sizeof CP_SUMO_RULE / sizeof *CP_SUMO_RULE;

static const cp_sumo_option OPTION[] = {
#define SUMO_OPTION(name, other_names, kind) {name, other_names, CP_SUMO_##kind},
    SUMO_OPTION_LIST(SUMO_OPTION)
#undef SUMO_OPTION
};

// Whether a word is in a list separated by blanks.
static bool is_among(const char *list, const char *word)
{
    size_t length = strlen(word);
    for (const char *c = list; *c != '\0';) {
        size_t here = strcspn(c, " ");
        if (here == length && strncmp(c, word, length) == 0)
            return true;
        c += here + strspn(c + here, " ");
    }
    return false;
}

const cp_sumo_option *cp_sumo_option_find(const char *name)
{
    for (size_t k = 0; k < sizeof OPTION / sizeof *OPTION; k++)
        if (strcmp(OPTION[k].name, name) == 0 || is_among(OPTION[k].other_names, name))
            return &OPTION[k];
    return NULL;
}

const cp_sumo_rule *cp_sumo_rule_find(const char *option)
{
    for (size_t k = 0; k < CP_SUMO_RULE_COUNT; k++)
        if (strcmp(CP_SUMO_RULE[k].option, option) == 0)
            return &CP_SUMO_RULE[k];
    return NULL;
}

bool cp_sumo_value_is_true(const char *value)
{
    static const char *const WORD[] = {"1", "yes", "true", "on", "x", "t"};
    for (size_t k = 0; k < sizeof WORD / sizeof *WORD; k++)
        if (strcasecmp(value, WORD[k]) == 0)
            return true;
    return false;
}

bool cp_sumo_values_agree(const cp_sumo_option *option, const char *one, const char *other)
{
    char *end_one = NULL, *end_other = NULL;
    if (option->kind == CP_SUMO_SWITCH)
        return cp_sumo_value_is_true(one) == cp_sumo_value_is_true(other);
    double number_one = strtod(one, &end_one), number_other = strtod(other, &end_other);
    if (end_one != one && *end_one == '\0' && end_other != other && *end_other == '\0')
        return number_one == number_other;
    return strcmp(one, other) == 0;
}
