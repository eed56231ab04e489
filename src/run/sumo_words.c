/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/sumo_words.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char PREFIX_OPTION[] = "--output-prefix";
static const char TELEPORT_OPTION[] = "--time-to-teleport";

// SUMO's default time before it teleports a waiting vehicle.
#define TELEPORT_S 300.0

// The prefix a scenario asks for in its options, as two words or one with '='; "" without.
static const char *prefix_of(const cp_study_scenario *scenario)
{
    const size_t length = sizeof PREFIX_OPTION - 1;
    const char *prefix = "";
    for (size_t k = 0; k < scenario->sumo_option_count; k++) {
        const char *word = scenario->sumo_options[k];
        if (strncmp(word, PREFIX_OPTION, length) != 0)
            continue;
        if (word[length] == '=')
            prefix = word + length + 1;
        else if (word[length] == '\0' && k + 1 < scenario->sumo_option_count)
            prefix = scenario->sumo_options[k + 1];
    }
    return prefix;
}

static bool has_option(const cp_study_scenario *scenario, const char *option)
{
    const size_t length = strlen(option);
    for (size_t k = 0; k < scenario->sumo_option_count; k++) {
        const char *word = scenario->sumo_options[k];
        if (strncmp(word, option, length) == 0 && (word[length] == '=' || word[length] == '\0'))
            return true;
    }
    return false;
}

static bool add(cp_sumo_words *words, const char *text)
{
    words->word[words->count] = strdup(text);
    return words->word[words->count] != NULL && ++words->count > 0;
}

cp_status cp_sumo_words_create(const cp_study_scenario *scenario, const cp_study_variant *variant,
                               uint64_t seed, double stay_s, cp_sumo_words *words, cp_error *error)
{
    const size_t length = sizeof PREFIX_OPTION - 1;
    char prefix[512], teleport[32];
    *words = (cp_sumo_words){.word = calloc(scenario->sumo_option_count + 4, sizeof(char *))};
    bool good = words->word != NULL;
    snprintf(prefix, sizeof prefix, "%s_%s_%" PRIu64 "_%.300s", scenario->name,
             variant->name != NULL ? variant->name : "probe", seed, prefix_of(scenario));

    // All words but a prefix of theirs, then the two together.
    for (size_t k = 0; good && k < scenario->sumo_option_count; k++) {
        const char *word = scenario->sumo_options[k];
        bool is_prefix = strncmp(word, PREFIX_OPTION, length) == 0;
        if (is_prefix && word[length] == '\0')
            k++;
        else if (!is_prefix || word[length] != '=')
            good = add(words, word);
    }
    good = good && add(words, PREFIX_OPTION) && add(words, prefix);
    snprintf(teleport, sizeof teleport, "%g", stay_s + TELEPORT_S);
    if (good && stay_s > 0.0 && !has_option(scenario, TELEPORT_OPTION))
        good = add(words, TELEPORT_OPTION) && add(words, teleport);
    if (good)
        return CP_OK;
    cp_sumo_words_destroy(words);
    return cp_fail_memory(error, "SUMO's options");
}

void cp_sumo_words_destroy(cp_sumo_words *words)
{
    for (size_t k = 0; k < words->count; k++)
        free(words->word[k]);
    free(words->word);
    *words = (cp_sumo_words){0};
}
