/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/log_options.h"

#include "core/log.h"
#include "core/status.h"

#include <stdlib.h>
#include <string.h>

static void set_format(const char *format)
{
    if (format == NULL || (strcmp(format, "text") != 0 && strcmp(format, "json") != 0)) {
        cp_log_error("--log-format must be text or json, found '%s'", format != NULL ? format : "");
        exit(cp_status_exit_code(CP_BAD_INPUT));
    }
    setenv(CP_LOG_FORMAT_VARIABLE, format, 1);
}

void cp_log_options_take(int *argc, char **argv)
{
    static const char FORMAT[] = "--log-format";
    const size_t length = sizeof FORMAT - 1;
    int kept = 1, k = 1;
    for (; k < *argc && strcmp(argv[k], "--") != 0; k++) {
        if (strcmp(argv[k], "--quiet") == 0)
            setenv(CP_LOG_VARIABLE, "quiet", 1);
        else if (strcmp(argv[k], "--verbose") == 0)
            setenv(CP_LOG_VARIABLE, "verbose", 1);
        else if (strcmp(argv[k], FORMAT) == 0)
            set_format(k + 1 < *argc ? argv[++k] : NULL);
        else if (strncmp(argv[k], FORMAT, length) == 0 && argv[k][length] == '=')
            set_format(argv[k] + length + 1);
        else
            argv[kept++] = argv[k];
    }
    while (k < *argc)
        argv[kept++] = argv[k++];
    argv[kept] = NULL;
    *argc = kept;
}
