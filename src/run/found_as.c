/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/found_as.h"

cp_found_as cp_found_as_verdict(cp_contact_verdict verdict)
{
    return (cp_found_as)((int)CP_FOUND_VERDICTS + (int)verdict);
}

const char *cp_found_as_text(cp_found_as found_as)
{
    static const char *const TEXT[] = {[CP_FOUND_CRASH] = "crash",
                                       [CP_FOUND_AFTER_CRASH] = "after_crash",
                                       [CP_FOUND_WARMUP] = "warmup",
                                       [CP_FOUND_NO_CONTACT] = "no_contact"};
    if (found_as < CP_FOUND_VERDICTS)
        return TEXT[found_as];
    return cp_contact_verdict_text((cp_contact_verdict)((int)found_as - (int)CP_FOUND_VERDICTS));
}

bool cp_found_as_is_crash(cp_found_as found_as)
{
    return found_as == CP_FOUND_CRASH || found_as == CP_FOUND_WARMUP;
}
