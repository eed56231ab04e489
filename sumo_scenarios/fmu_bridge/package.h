/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef FMU_BRIDGE_PACKAGE_H
#define FMU_BRIDGE_PACKAGE_H

#include <stdbool.h>
#include <stddef.h>

/* A zip file in memory, read by its central directory: entries stored or deflated, no more than
 * 4 GB, not encrypted. */
typedef struct fmu_package {
    unsigned char *bytes;
    size_t size;
    size_t directory; /* place of its first entry */
    size_t count;
} fmu_package;

/* Returns NULL, or what is wrong. The caller frees package->bytes. */
const char *fmu_package_open(unsigned char *bytes, size_t size, fmu_package *package);

/* The content of an entry, with a zero behind it, for the caller to free; NULL: there is none of
 * that name, or it is damaged. */
unsigned char *fmu_package_read(const fmu_package *package, const char *name, size_t *size);

/* Whether an entry's name begins like that and goes on. */
bool fmu_package_has(const fmu_package *package, const char *beginning);

#endif
