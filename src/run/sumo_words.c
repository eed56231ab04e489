/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/sumo_words.h"

#include "study/sumo_configuration.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char PREFIX_OPTION[] = "--output-prefix";
static const char TELEPORT_OPTION[] = "--time-to-teleport";

// SUMO's default time before it teleports a waiting vehicle.
#define TELEPORT_S 300.0

static bool add(cp_sumo_words *words, const char *text)
{
    words->word[words->count] = strdup(text);
    return words->word[words->count] != NULL && ++words->count > 0;
}

// The scenario's words but those that the bridge or the prefix below set: SUMO refuses an option
// that comes twice.
static bool add_scenario_words(const cp_sumo_start *start,
                               const cp_sumo_configuration *configuration, cp_sumo_words *words)
{
    bool good = true;
    for (size_t k = 0; good && k < configuration->count; k++) {
        const cp_sumo_setting *setting = &configuration->setting[k];
        const cp_sumo_rule *rule =
            setting->option != NULL ? cp_sumo_rule_find(setting->option->name) : NULL;
        bool is_ours = rule != NULL &&
                       (rule->treatment == CP_SUMO_REPLACED || rule->treatment == CP_SUMO_JOINED);
        for (size_t w = 0; good && !is_ours && w < setting->word_count; w++)
            good = add(words, start->options[setting->word + w]);
    }
    return good;
}

// Prefix of one replication: what tells it from the others, then theirs without its folder.
static void join_prefix(const cp_sumo_start *start, uint64_t seed, const char *theirs,
                        char prefix[CP_SUMO_PREFIX_SIZE])
{
    const char *slash = strrchr(theirs, '/');
    bool has_name = start->scenario != NULL;
    snprintf(prefix, CP_SUMO_PREFIX_SIZE, "%s%s%s_%" PRIu64 "_%s", has_name ? start->scenario : "",
             has_name ? "_" : "", start->variant != NULL ? start->variant : CP_SUMO_PROBE_NAME,
             seed, slash != NULL ? slash + 1 : theirs);
}

cp_status cp_sumo_words_create(const cp_sumo_start *start, uint64_t seed, double stay_s,
                               cp_sumo_words *words, cp_error *error)
{
    char prefix[CP_SUMO_PREFIX_SIZE], teleport[32];
    cp_sumo_configuration configuration = {0};
    *words = (cp_sumo_words){.word = calloc(start->option_count + 4, sizeof(char *))};
    if (words->word == NULL)
        return cp_fail_memory(error, "SUMO's options");
    cp_status status = cp_sumo_configuration_read(start->sumocfg_path, start->options,
                                                  start->option_count, &configuration, error);
    if (status == CP_OK) {
        const cp_sumo_setting *theirs = cp_sumo_configuration_find(&configuration, "output-prefix");
        const cp_sumo_setting *set = cp_sumo_configuration_find(&configuration, "time-to-teleport");
        join_prefix(start, seed, theirs != NULL ? theirs->value : "", prefix);
        snprintf(teleport, sizeof teleport, "%g", stay_s + TELEPORT_S);
        bool good = add_scenario_words(start, &configuration, words) && add(words, PREFIX_OPTION) &&
                    add(words, prefix);
        if (good && stay_s > 0.0 && (set == NULL || set->line > 0))
            good = add(words, TELEPORT_OPTION) && add(words, teleport);
        if (!good)
            status = cp_fail_memory(error, "SUMO's options");
    }
    cp_sumo_configuration_destroy(&configuration);
    if (status != CP_OK)
        cp_sumo_words_destroy(words);
    return status;
}

void cp_sumo_words_destroy(cp_sumo_words *words)
{
    for (size_t k = 0; k < words->count; k++)
        free(words->word[k]);
    free(words->word);
    *words = (cp_sumo_words){0};
}
