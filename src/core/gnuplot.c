/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/gnuplot.h"

#include "core/file.h"
#include "core/scratch.h"

#include <stdlib.h>

static cp_status run(cp_scratch *scratch, const char *const *script, size_t parts, const char *data,
                     cp_error *error)
{
    static const char *const WORDS[] = {"gnuplot", "--default-settings", "script", NULL};
    int code = 0;
    cp_status status = cp_scratch_write(scratch, "script", script, parts, error);
    if (status == CP_OK)
        status = cp_scratch_write(scratch, "data", &data, 1, error);
    if (status == CP_OK)
        status = cp_scratch_run(scratch, WORDS, &code, error);
    if (status == CP_BAD_INPUT)
        return cp_fail(error, CP_BAD_INPUT,
                       "gnuplot is missing; on Debian: apt-get install gnuplot-nox");
    if (status == CP_OK && code != 0)
        status = cp_fail(error, CP_RUN_FAILED, "gnuplot failed, see its words above");
    return status;
}

cp_status cp_gnuplot_draw(const char *const *script, size_t parts, const char *data,
                          const char *path, cp_error *error)
{
    cp_scratch scratch;
    char *figure = NULL;
    size_t size = 0;
    cp_status status = cp_scratch_open(&scratch, error);
    if (status != CP_OK)
        return status;
    status = run(&scratch, script, parts, data, error);
    if (status == CP_OK)
        status = cp_scratch_read(&scratch, "figure", &figure, &size, error);
    if (status == CP_OK)
        status = cp_file_write(path, figure, size, error);
    free(figure);
    cp_scratch_close(&scratch);
    return status;
}
