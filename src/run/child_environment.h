/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_CHILD_ENVIRONMENT_H
#define RUN_CHILD_ENVIRONMENT_H

/* The environment a worker starts with: that given, with one word for the C library, to ask the
 * kernel for memory in huge pages (glibc.malloc.hugetlb of its tunables, since glibc 2.35; others
 * pass over it). SUMO's vehicles and lanes lie all over its memory, and in pages of 4 kB finding
 * them takes longer than reading them. Where GLIBC_TUNABLES says something of it already, that
 * holds; what it says of other things stays. */

/* environment: NULL-terminated "NAME=value" texts, which must outlive the result. The result is
 * freed by cp_child_environment_free; NULL when memory runs out. */
char **cp_child_environment(char *const *environment);
void cp_child_environment_free(char **environment); /* NULL is fine */

#endif
