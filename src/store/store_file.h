/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef STORE_STORE_FILE_H
#define STORE_STORE_FILE_H

#include <stdbool.h>

/* What the file of a database and its surroundings allow, seen before SQLite opens it; for the
 * files of this folder only. */

/* How a reader may open a database so that it works without the right to write beside it, and
 * leaves no file there that the owner could not write. */
typedef enum cp_store_reading {
    CP_STORE_READING_PLAIN,      /* SQLite may keep what it likes, or keeps nothing */
    CP_STORE_READING_SHARED_LOG, /* log and index of a writer are there: read them, create none */
    CP_STORE_READING_UNCHANGING, /* finished, no log: nobody writes */
    CP_STORE_READING_LOST_LOG    /* a log without its index, which only its owner can take in */
} cp_store_reading;

/* path: of a database that is there. */
cp_store_reading cp_store_file_reading(const char *path);

/* Whether the file says of itself that it is kept with a log (SQLite's WAL mode: bytes 18 and 19 of
 * its header are 2). false where it cannot be read. */
bool cp_store_file_has_log_mode(const char *path);

/* Name of the network file system that path (or, where it is not there yet, its folder) lies on;
 * NULL: a local one, as far as the system tells. */
const char *cp_store_file_network(const char *path);

/* The same for a type of file system as statfs(2) tells it. */
const char *cp_network_file_system(unsigned long type);

#endif
