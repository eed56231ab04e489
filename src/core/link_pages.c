/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE // dl_iterate_phdr
#include "core/link_pages.h"

#include <link.h>
#include <stdint.h>
#include <sys/mman.h>
#include <unistd.h>

// Of one program or library: its read-only segments.
static int release_object(struct dl_phdr_info *object, size_t size, void *context)
{
    (void)size;
    size_t *released = context, page = (size_t)sysconf(_SC_PAGESIZE);
    for (int k = 0; k < object->dlpi_phnum; k++) {
        const ElfW(Phdr) *segment = &object->dlpi_phdr[k];
        if (segment->p_type != PT_LOAD || (segment->p_flags & (PF_W | PF_X)) != 0)
            continue;
        uintptr_t begin = (uintptr_t)(object->dlpi_addr + segment->p_vaddr);
        uintptr_t first = begin & ~(uintptr_t)(page - 1);
        size_t length = begin - first + segment->p_filesz;
        // NOLINTNEXTLINE(performance-no-int-to-ptr): addresses are all that the linker tells
        if (madvise((void *)first, length, MADV_DONTNEED) == 0)
            *released += length;
    }
    return 0;
}

size_t cp_link_pages_release(void)
{
    size_t released = 0;
    dl_iterate_phdr(release_object, &released);
    return released;
}
