/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CORE_LINK_PAGES_H
#define CORE_LINK_PAGES_H

#include <stddef.h>

/* Give back what starting has read of the program and its libraries and running hardly reads again:
 * tables of symbols and relocations, unwind tables, constants. libsumocpp alone has 3 MB of them,
 * in every worker. Only segments that are neither writable nor code; such a page is as its file,
 * and the kernel maps it again when something reads it. Returns the bytes of address space given
 * back, 0 where the system has none of it. Call it when no other thread loads a library. */
size_t cp_link_pages_release(void);

#endif
