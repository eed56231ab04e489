/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_SAFE_TEXT_H
#define CORE_SAFE_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Text from files and databases where it could act: on a terminal, in a generated file. */

/* Whether text is UTF-8 without control characters (C0, DEL, C1) and without those that turn the
 * direction of what follows (U+202A to 202E, 2066 to 2069). */
bool cp_text_is_plain(const char *text);

/* Copy of text into result[size] for a terminal or a log: every byte of what is not plain as \xNN;
 * cut at the end where there is no room. keep: characters that stay as they are, such as "\n".
 * Returns result. */
char *cp_text_for_terminal(const char *text, const char *keep, char *result, size_t size);

/* A copy of the whole of it, without keep: one line. The caller frees. NULL when memory is gone. */
char *cp_text_copy_plain(const char *text);

/* The same straight to a file, whatever its length. */
void cp_text_print(FILE *file, const char *text, const char *keep);

/* Columns that cp_text_print without keep takes: a character each, four for \xNN. */
size_t cp_text_width(const char *text);

/* A YAML scalar that reads back as text: plain where that is unmistakable, else in double quotes.
 */
void cp_text_write_yaml(FILE *file, const char *text);

#ifdef __cplusplus
}
#endif

#endif
