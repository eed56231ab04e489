/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "analysis/exceedance.h"

const char *const CP_EXCEEDED_TEXT[CP_EXCEEDED_COUNT] = {
#define CP_EXCEEDED_TEXT_OF(name, text, unit, largest, step, headline) text,
    CP_EXCEEDED(CP_EXCEEDED_TEXT_OF)
#undef CP_EXCEEDED_TEXT_OF
};

const double CP_EXCEEDED_HEADLINE[CP_EXCEEDED_COUNT] = {
#define CP_EXCEEDED_HEADLINE_OF(name, text, unit, largest, step, headline) headline,
    CP_EXCEEDED(CP_EXCEEDED_HEADLINE_OF)
#undef CP_EXCEEDED_HEADLINE_OF
};
