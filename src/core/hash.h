/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_HASH_H
#define CORE_HASH_H

#include "core/error.h"

#include <stddef.h>
#include <stdint.h>

/* SHA-256 of content that users can recompute with sha256sum: configuration files, networks,
 * pulses. Hex text of 64 characters and a zero. */
#define CP_HASH_TEXT_SIZE 65

void cp_hash_bytes(const void *bytes, size_t size, char hex[CP_HASH_TEXT_SIZE]);
CP_MUST_CHECK cp_status cp_hash_file(const char *path, char hex[CP_HASH_TEXT_SIZE],
                                     cp_error *error);

/* The first 42 bits of the SHA-256 of text as a positive integer: a natural key as a row id, which
 * a double holds too. */
int64_t cp_hash_row_id(const char *text);

#endif
