/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "control/control_types.h"

#define CP_CONTROL_ROW(symbol) &symbol,

const cp_control_type *const CP_CONTROL_TYPE[] = {CP_CONTROL_ROWS(CP_CONTROL_ROW)};
const size_t CP_CONTROL_TYPE_COUNT = sizeof CP_CONTROL_TYPE / sizeof *CP_CONTROL_TYPE;
