/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/sumo_words.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char PREFIX_OPTION[] = "--output-prefix";

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

static bool add(cp_sumo_words *words, const char *text)
{
    words->word[words->count] = strdup(text);
    return words->word[words->count] != NULL && ++words->count > 0;
}

cp_status cp_sumo_words_create(const cp_study_scenario *scenario, const cp_study_variant *variant,
                               uint64_t seed, cp_sumo_words *words, cp_error *error)
{
    const size_t length = sizeof PREFIX_OPTION - 1;
    char prefix[512];
    *words = (cp_sumo_words){.word = calloc(scenario->sumo_option_count + 2, sizeof(char *))};
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
    if (good && add(words, PREFIX_OPTION) && add(words, prefix))
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
