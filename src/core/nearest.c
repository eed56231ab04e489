/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/nearest.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define LETTERS_MAX 48 /* longer words are not misspelt but something else */
#define FARTHEST 3

static int letter(char c)
{
    return c == '-' ? '_' : tolower((unsigned char)c);
}

static bool same_letters(const char *a, const char *b, size_t length)
{
    for (size_t k = 0; k < length; k++)
        if (letter(a[k]) != letter(b[k]))
            return false;
    return true;
}

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

// Optimal string alignment: rows of the table, the last two of which a swap needs.
static size_t distance(const char *a, size_t a_length, const char *b, size_t b_length)
{
    size_t row[3][LETTERS_MAX + 1];
    for (size_t j = 0; j <= b_length; j++)
        row[0][j] = j;
    for (size_t i = 1; i <= a_length; i++) {
        size_t *now = row[i % 3], *last = row[(i + 2) % 3], *before = row[(i + 1) % 3];
        now[0] = i;
        for (size_t j = 1; j <= b_length; j++) {
            size_t replaced = last[j - 1] + (letter(a[i - 1]) != letter(b[j - 1]));
            now[j] = smaller(replaced, smaller(last[j], now[j - 1]) + 1);
            bool swapped = i > 1 && j > 1 && letter(a[i - 1]) == letter(b[j - 2]) &&
                           letter(a[i - 2]) == letter(b[j - 1]);
            if (swapped)
                now[j] = smaller(now[j], before[j - 2] + 1);
        }
    }
    return row[a_length % 3][b_length];
}

// Whether one is the other's beginning up to the border of a word.
static bool begins(const char *shorter, size_t length, const char *longer)
{
    return length > 2 && letter(longer[length]) == '_' && same_letters(shorter, longer, length);
}

const char *cp_nearest(const char *word, const char *const *names, size_t count)
{
    const char *nearest = NULL;
    size_t least = FARTHEST + 1, length = strlen(word);
    if (length == 0 || length > LETTERS_MAX)
        return NULL;
    for (size_t k = 0; k < count; k++) {
        size_t other = names[k] != NULL ? strlen(names[k]) : 0;
        if (other == 0 || other > LETTERS_MAX)
            continue;
        size_t away = distance(word, length, names[k], other);
        if ((length < other && begins(word, length, names[k])) ||
            (other < length && begins(names[k], other, word)))
            away = smaller(away, 1);
        size_t longer = length > other ? length : other;
        if (away < least && 3 * away <= longer) {
            least = away;
            nearest = names[k];
        }
    }
    return nearest;
}

const char *cp_nearest_text(const char *word, const char *const *names, size_t count,
                            char text[CP_NEAREST_TEXT_SIZE])
{
    const char *name = cp_nearest(word, names, count);
    text[0] = '\0';
    if (name != NULL)
        snprintf(text, CP_NEAREST_TEXT_SIZE, "; did you mean '%s'?", name);
    return text;
}
