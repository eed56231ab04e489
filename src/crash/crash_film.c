/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crash/crash_film.h"

#include <stdlib.h>

const char *const CP_FILM_PART_TEXT[CP_FILM_PART_COUNT] = {
#define CP_FILM_PART_ROW(name, text) text,
    CP_FILM_PARTS(CP_FILM_PART_ROW)
#undef CP_FILM_PART_ROW
};

cp_crash_film cp_crash_film_default(void)
{
    return (cp_crash_film){.interval_s = 0.001};
}

void cp_crash_film_destroy(cp_crash_film *film)
{
    free(film->frame);
    *film = (cp_crash_film){.interval_s = film->interval_s};
}
