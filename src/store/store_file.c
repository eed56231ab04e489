/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/store_file.h"

#include <limits.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

// Path of the folder a file lies in.
static void folder_of(const char *path, char folder[PATH_MAX])
{
    const char *slash = strrchr(path, '/');
    size_t length = slash == NULL ? 0 : slash == path ? 1 : (size_t)(slash - path);
    snprintf(folder, PATH_MAX, "%.*s", slash != NULL ? (int)length : 1, slash != NULL ? path : ".");
}

// Size of a file that SQLite keeps beside a database; -1: it is not there.
static long long size_beside(const char *path, const char *suffix)
{
    char name[PATH_MAX + 8];
    struct stat entry;
    snprintf(name, sizeof name, "%s%s", path, suffix);
    return stat(name, &entry) == 0 ? (long long)entry.st_size : -1;
}

bool cp_store_file_has_log_mode(const char *path)
{
    unsigned char header[20] = {0};
    FILE *file = fopen(path, "rb");
    if (file == NULL)
        return false;
    size_t size = fread(header, 1, sizeof header, file);
    fclose(file);
    return size == sizeof header && header[18] == 2 && header[19] == 2;
}

cp_store_reading cp_store_file_reading(const char *path)
{
    char folder[PATH_MAX];
    folder_of(path, folder);
    bool can_write = access(path, W_OK) == 0 && access(folder, W_OK) == 0;
    if (can_write || !cp_store_file_has_log_mode(path))
        return CP_STORE_READING_PLAIN;
    long long log_size = size_beside(path, "-wal");
    if (log_size >= 0 && size_beside(path, "-shm") >= 0)
        return CP_STORE_READING_SHARED_LOG;
    return log_size > 0 ? CP_STORE_READING_LOST_LOG : CP_STORE_READING_UNCHANGING;
}

const char *cp_network_file_system(unsigned long type)
{
    // Numbers of statfs(2) and of the file systems' own headers.
    static const struct {
        unsigned long type;
        const char *name;
    } KNOWN[] = {{0x6969, "NFS"},        {0x517b, "SMB"},       {0xff534d42, "CIFS"},
                 {0xfe534d42, "SMB"},    {0x01021997, "9P"},    {0x65735546, "FUSE"},
                 {0x0bd00bd0, "Lustre"}, {0x47504653, "GPFS"},  {0x19830326, "BeeGFS"},
                 {0x00c36400, "CephFS"}, {0x5346414f, "AFS"},   {0x6b414653, "AFS"},
                 {0x73757245, "Coda"},   {0x564c, "NCP"},       {0x01161970, "GFS2"},
                 {0x7461636f, "OCFS2"},  {0xaad7aaea, "PanFS"}, {0x013111a8, "IBRIX"}};
    for (size_t k = 0; k < sizeof KNOWN / sizeof *KNOWN; k++)
        if (KNOWN[k].type == type)
            return KNOWN[k].name;
    return NULL;
}

const char *cp_store_file_network(const char *path)
{
    char folder[PATH_MAX];
    struct statfs disk;
    folder_of(path, folder);
    if (statfs(path, &disk) != 0 && statfs(folder, &disk) != 0)
        return NULL;
    // The type is signed on some machines.
    return cp_network_file_system((unsigned long)disk.f_type & 0xffffffffUL);
}
