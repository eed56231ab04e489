/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/hash.h"

#include "core/file.h"

#include <sha256.h>
#include <stdlib.h>
#include <sys/types.h>

void cp_hash_bytes(const void *bytes, size_t size, char hex[CP_HASH_TEXT_SIZE])
{
    SHA256_Data(bytes, size, hex);
}

cp_status cp_hash_file(const char *path, char hex[CP_HASH_TEXT_SIZE], cp_error *error)
{
    char *content = NULL;
    size_t size = 0;
    cp_status status = cp_file_read(path, &content, &size, error);
    if (status != CP_OK)
        return status;
    cp_hash_bytes(content, size, hex);
    free(content);
    return CP_OK;
}

int64_t cp_hash_row_id(const char *text)
{
    char hex[CP_HASH_TEXT_SIZE];
    size_t length = 0;
    while (text[length] != '\0')
        length++;
    cp_hash_bytes(text, length, hex);
    char head[12] = {0};
    for (int k = 0; k < 11; k++)
        head[k] = hex[k];
    return (int64_t)(strtoull(head, NULL, 16) >> 2);
}
