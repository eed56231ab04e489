/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/safe_text.h"

#include <ctype.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

// Bytes of the UTF-8 character at text and its number; 0: not UTF-8.
static size_t character_at(const unsigned char *text, uint32_t *number)
{
    static const uint32_t SMALLEST[5] = {0, 0, 0x80, 0x800, 0x10000};
    size_t length = text[0] < 0x80             ? 1
                    : (text[0] & 0xe0) == 0xc0 ? 2
                    : (text[0] & 0xf0) == 0xe0 ? 3
                    : (text[0] & 0xf8) == 0xf0 ? 4
                                               : 0;
    if (length < 2) {
        *number = text[0];
        return length;
    }
    *number = text[0] & (0x7fu >> length);
    for (size_t k = 1; k < length; k++) {
        if ((text[k] & 0xc0) != 0x80)
            return 0;
        *number = *number << 6 | (text[k] & 0x3fu);
    }
    bool surrogate = *number >= 0xd800 && *number < 0xe000;
    return *number < SMALLEST[length] || *number > 0x10ffff || surrogate ? 0 : length;
}

static bool is_control(uint32_t number)
{
    return number < 0x20 || (number >= 0x7f && number < 0xa0) ||
           (number >= 0x202a && number <= 0x202e) || (number >= 0x2066 && number <= 0x2069);
}

// Length of the plain character at text; 0: the byte there is none.
static size_t plain_at(const char *text, const char *keep)
{
    uint32_t number = 0;
    if (*text != '\0' && strchr(keep, *text) != NULL)
        return 1;
    size_t length = character_at((const unsigned char *)text, &number);
    return length > 0 && is_control(number) ? 0 : length;
}

bool cp_text_is_plain(const char *text)
{
    while (*text != '\0') {
        size_t length = plain_at(text, "");
        if (length == 0)
            return false;
        text += length;
    }
    return true;
}

// The next piece of a text made safe, and how much of the text it stands for.
static size_t next_piece(const char *text, const char *keep, char piece[8])
{
    size_t length = plain_at(text, keep);
    if (length > 0) {
        memcpy(piece, text, length);
        piece[length] = '\0';
        return length;
    }
    snprintf(piece, 8, "\\x%02x", (unsigned)(unsigned char)*text);
    return 1;
}

char *cp_text_for_terminal(const char *text, const char *keep, char *result, size_t size)
{
    size_t used = 0;
    while (*text != '\0') {
        char piece[8];
        text += next_piece(text, keep, piece);
        size_t length = strlen(piece);
        if (used + length + 1 > size)
            break;
        memcpy(result + used, piece, length);
        used += length;
    }
    if (size > 0)
        result[used] = '\0';
    return result;
}

char *cp_text_copy_plain(const char *text)
{
    size_t room = 4 * strlen(text) + 1;
    char *copy = malloc(room);
    return copy != NULL ? cp_text_for_terminal(text, "", copy, room) : NULL;
}

void cp_text_print(FILE *file, const char *text, const char *keep)
{
    while (*text != '\0') {
        char piece[8];
        text += next_piece(text, keep, piece);
        fputs(piece, file);
    }
}

size_t cp_text_width(const char *text)
{
    size_t width = 0;
    while (*text != '\0') {
        char piece[8];
        size_t length = next_piece(text, "", piece);
        width += piece[0] == '\\' && *text != '\\' ? 4 : 1;
        text += length;
    }
    return width;
}

// Letters, digits, blanks inside and a few marks, beginning with a letter, and no word of YAML's
// own.
static bool is_plain_yaml(const char *text)
{
    static const char *const OWN[] = {"true", "false", "yes", "no", "on", "off", "null", "y", "n"};
    for (size_t k = 0; k < sizeof OWN / sizeof *OWN; k++)
        if (strcasecmp(text, OWN[k]) == 0)
            return false;
    if (!isalpha((unsigned char)text[0]) || text[strlen(text) - 1] == ' ')
        return false;
    return strspn(text, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+./() ") ==
           strlen(text);
}

void cp_text_write_yaml(FILE *file, const char *text)
{
    if (is_plain_yaml(text)) {
        fputs(text, file);
        return;
    }
    fputc('"', file);
    for (; *text != '\0'; text++) {
        unsigned char c = (unsigned char)*text;
        if (c == '"' || c == '\\')
            fprintf(file, "\\%c", c);
        else if (c < 0x20 || c == 0x7f)
            fprintf(file, "\\x%02X", (unsigned)c);
        else
            fputc(c, file);
    }
    fputc('"', file);
}
