/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RUN_FOUND_AS_H
#define RUN_FOUND_AS_H

#include "impact/impact.h"

/* What became of a contact: counted as a crash or why not; and what a collision of SUMO is among
 * our contacts. */
typedef enum cp_found_as {
    CP_FOUND_CRASH,       /* confirmed and counted */
    CP_FOUND_AFTER_CRASH, /* one of the two had crashed in the same step already */
    CP_FOUND_WARMUP,      /* confirmed, but before the end of the warm-up */
    CP_FOUND_NO_CONTACT,  /* of a collision of SUMO's: in no contact of ours */
    CP_FOUND_VERDICTS,    /* the verdicts of contacts that are no crash: this plus the verdict */
    CP_FOUND_AS_COUNT = CP_FOUND_VERDICTS + CP_CONTACT_VERDICT_COUNT
} cp_found_as;

cp_found_as cp_found_as_verdict(cp_contact_verdict verdict);
/* "crash", "after_crash", "warmup", "no_contact", or the verdict's; static text. */
const char *cp_found_as_text(cp_found_as found_as);
/* Whether it is a confirmed crash, counted or not. */
bool cp_found_as_is_crash(cp_found_as found_as);

#endif
