/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_PROBE_OUTPUTS_H
#define RUN_PROBE_OUTPUTS_H

/* A probe starts SUMO only to see whether it starts; the files that SUMO opens for output meanwhile
 * are nobody's result. */

/* Delete every file that this process has open and whose name begins as those of a probe of this
 * scenario do (run/sumo_words.h). */
void cp_probe_outputs_delete(const char *scenario);

#endif
