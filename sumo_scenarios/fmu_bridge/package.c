/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "package.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#define END_SIGNATURE 0x06054b50u
#define ENTRY_SIGNATURE 0x02014b50u
#define FILE_SIGNATURE 0x04034b50u
#define END_SIZE 22
#define ENTRY_SIZE 46
#define FILE_SIZE 30
#define COMMENT_MAX 65535

static uint32_t number(const unsigned char *at, unsigned bytes)
{
    uint32_t value = 0;
    while (bytes > 0)
        value = value << 8 | at[--bytes];
    return value;
}

const char *fmu_package_open(unsigned char *bytes, size_t size, fmu_package *package)
{
    *package = (fmu_package){.bytes = bytes, .size = size};
    size_t farthest = size > COMMENT_MAX + END_SIZE ? size - COMMENT_MAX - END_SIZE : 0;
    for (size_t at = size >= END_SIZE ? size - END_SIZE + 1 : 0; at-- > farthest;) {
        if (number(bytes + at, 4) != END_SIGNATURE)
            continue;
        package->count = number(bytes + at + 10, 2);
        package->directory = number(bytes + at + 16, 4);
        return package->directory < at ? NULL : "a zip file that is damaged";
    }
    return "neither a zip file nor XML";
}

/* An entry of the directory. */
typedef struct entry {
    const char *name;
    size_t name_size, packed, plain, file;
    unsigned method;
} entry;

// The entry at a place, which moves on; false at the end.
static bool next_entry(const fmu_package *package, size_t *at, entry *found)
{
    const unsigned char *here = package->bytes + *at;
    if (*at + ENTRY_SIZE > package->size || number(here, 4) != ENTRY_SIGNATURE)
        return false;
    *found = (entry){.name = (const char *)here + ENTRY_SIZE,
                     .name_size = number(here + 28, 2),
                     .packed = number(here + 20, 4),
                     .plain = number(here + 24, 4),
                     .file = number(here + 42, 4),
                     .method = number(here + 10, 2)};
    *at += ENTRY_SIZE + found->name_size + number(here + 30, 2) + number(here + 32, 2);
    return *at <= package->size;
}

static bool find(const fmu_package *package, const char *name, size_t length, bool is_whole,
                 entry *found)
{
    size_t at = package->directory;
    for (size_t k = 0; k < package->count && next_entry(package, &at, found); k++)
        if (found->name_size >= length && memcmp(found->name, name, length) == 0 &&
            (is_whole ? found->name_size == length : found->name_size > length))
            return true;
    return false;
}

static bool unpack(const entry *from, const unsigned char *packed, unsigned char *plain)
{
    z_stream stream = {.next_in = (unsigned char *)packed,
                       .avail_in = (unsigned)from->packed,
                       .next_out = plain,
                       .avail_out = (unsigned)from->plain};
    if (from->method == 0 && from->packed != from->plain)
        return false;
    if (from->method == 0) {
        memcpy(plain, packed, from->plain);
        return true;
    }
    if (from->method != 8 || inflateInit2(&stream, -MAX_WBITS) != Z_OK)
        return false;
    int end = inflate(&stream, Z_FINISH);
    inflateEnd(&stream);
    return end == Z_STREAM_END && stream.avail_out == 0;
}

unsigned char *fmu_package_read(const fmu_package *package, const char *name, size_t *size)
{
    entry found;
    if (!find(package, name, strlen(name), true, &found))
        return NULL;
    const unsigned char *file = package->bytes + found.file;
    if (found.file + FILE_SIZE > package->size || number(file, 4) != FILE_SIGNATURE)
        return NULL;
    size_t begin = found.file + FILE_SIZE + number(file + 26, 2) + number(file + 28, 2);
    if (begin > package->size || found.packed > package->size - begin)
        return NULL;
    unsigned char *plain = malloc(found.plain + 1);
    if (plain == NULL || !unpack(&found, package->bytes + begin, plain)) {
        free(plain);
        return NULL;
    }
    plain[found.plain] = '\0';
    *size = found.plain;
    return plain;
}

bool fmu_package_has(const fmu_package *package, const char *beginning)
{
    entry found;
    return find(package, beginning, strlen(beginning), false, &found);
}
