/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_NEAREST_H
#define CORE_NEAREST_H

#include <stddef.h>

/* The word that somebody probably meant: for messages about unknown keys, options and names. */

/* The one of count names with the fewest letters to insert, leave out, replace or swap with their
 * neighbour (optimal string alignment), case, '-' and '_' alike counting for nothing; of equals the
 * first. A name that one word is the beginning of, up to a '_' or '-' ("duration" of "duration_s"),
 * counts as one letter away. NULL when even the nearest is more than a third of the longer word
 * away, or 3 letters; names that are NULL do not count. */
const char *cp_nearest(const char *word, const char *const *names, size_t count);

/* "; did you mean 'name'?" into text, "" without one. Returns text. */
#define CP_NEAREST_TEXT_SIZE 128
const char *cp_nearest_text(const char *word, const char *const *names, size_t count,
                            char text[CP_NEAREST_TEXT_SIZE]);

#endif
