/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/crash_outcome.h"

const char *cp_struck_zone_text(cp_struck_zone zone)
{
    static const char *const TEXT[] = {
#define CP_STRUCK_ZONE_TEXT(name, text) text,
        CP_STRUCK_ZONES(CP_STRUCK_ZONE_TEXT)
#undef CP_STRUCK_ZONE_TEXT
    };
    return TEXT[zone];
}
