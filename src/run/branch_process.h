/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_BRANCH_PROCESS_H
#define RUN_BRANCH_PROCESS_H

#include <stdbool.h>
#include <sys/types.h>

/* What a forked copy of a running worker does first, so that nothing it does afterwards reaches the
 * original or outlives it. None of this allocates memory: the copy's heap stays as it was, address
 * by address, and with it the order in which SUMO walks over what it keeps by address. */

/* Die with parent (the process that forked us): by signal, or now if it is gone already. All
 * signals at their defaults, none blocked; no core file. False when that cannot be had. */
bool cp_branch_follow(pid_t parent);

/* Cut off every descriptor but keep and also (-1: no other): writable files, pipes and sockets lead
 * to /dev/null, files open for reading are opened anew at the same place, since the place in a file
 * is shared by a process and its copies. False when /proc is not there. */
bool cp_branch_isolate(int keep, int also);

/* End this process after that much processor time or wall time, s. */
bool cp_branch_limit(unsigned cpu_s, unsigned wall_s);

/* The whole buffer through a pipe or socket; false when the other side is gone. */
bool cp_branch_write(int fd, const void *bytes, size_t size);
/* Exactly size bytes; false at the end of the stream. */
bool cp_branch_read(int fd, void *bytes, size_t size);

#endif
