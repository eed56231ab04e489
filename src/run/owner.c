/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/owner.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

// Start of a process in clock ticks since boot: field 22 of /proc/<pid>/stat. The command name,
// field 2, may hold blanks and brackets: count from its last bracket.
static bool read_process_start(int64_t pid, int64_t *process_start)
{
    char path[64], line[2048];
    snprintf(path, sizeof path, "/proc/%" PRId64 "/stat", pid);
    FILE *file = fopen(path, "r");
    if (file == NULL)
        return false;
    bool read = fgets(line, sizeof line, file) != NULL;
    fclose(file);
    char *field = read ? strrchr(line, ')') : NULL;
    if (field == NULL)
        return false;
    char state = '\0';
    // NOLINTNEXTLINE(cert-err34-c): the kernel wrote these numbers
    int fields = sscanf(field,
                        ") %c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %*u %*u %*d %*d %*d "
                        "%*d %*d %*d %" SCNd64,
                        &state, process_start);
    return fields == 2 && state != 'Z' && state != 'X';
}

cp_status cp_owner_self(cp_owner *owner, cp_error *error)
{
    *owner = (cp_owner){.pid = getpid()};
    if (gethostname(owner->host, sizeof owner->host - 1) != 0 ||
        !read_process_start(owner->pid, &owner->process_start))
        return cp_fail(error, CP_IO_FAILED, "/proc does not tell about this process");
    return CP_OK;
}

bool cp_owner_is_alive(const cp_owner *owner)
{
    cp_owner self = {0};
    int64_t process_start = 0;
    if (gethostname(self.host, sizeof self.host - 1) != 0 || strcmp(self.host, owner->host) != 0)
        return true;
    return read_process_start(owner->pid, &process_start) && process_start == owner->process_start;
}
