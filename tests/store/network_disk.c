/* SPDX-License-Identifier: GPL-3.0-or-later */
/* To be preloaded: every file lies on NFS. */
#include <string.h>
#include <sys/vfs.h>

int statfs(const char *path, struct statfs *disk)
{
    (void)path;
    memset(disk, 0, sizeof *disk);
    disk->f_type = 0x6969;
    return 0;
}
