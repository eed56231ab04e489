/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "traffic/sumo_bridge.h"

extern "C" const char *version_by_cpp(void);

const char *version_by_cpp(void)
{
    return sumo_bridge_version();
}
