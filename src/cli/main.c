/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/commands.h"
#include "cli/log_options.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/nearest.h"

#include <errno.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct command {
    const char *name;
    cp_status (*run)(int argc, char **argv, cp_error *error);
    const char *what;
} command;

static const command COMMAND[] = {
    {"init", cmd_init, "begin a study of a network"},
    {"doctor", cmd_doctor, "see whether everything that is needed works"},
    {"reference", cmd_reference, "what every key of the input files means"},
    {"run", cmd_run, "simulate a study: traffic, crashes, pulses, into a database"},
    {"matrix", cmd_matrix, "run a function through a matrix of two-car encounters"},
    {"plan", cmd_plan, "show what a study would run"},
    {"background", cmd_background, "what contacts a network makes without driver errors"},
    {"assess", cmd_assess, "put ready collisions through the surrogate"},
    {"status", cmd_status, "how far a study has come"},
    {"merge", cmd_merge, "put databases of one study together"},
    {"submit", cmd_submit, "run a study on a cluster"},
    {"compare", cmd_compare, "compare the variants of a study"},
    {"report", cmd_report, "write the comparison as one HTML file with figures"},
    {"plot", cmd_plot, "draw one figure for a paper, as SVG or PDF"},
    {"sql", cmd_sql, "ask the database"},
    {"export", cmd_export, "write crashes and pulses in the formats of other programs"},
    {"check", cmd_check, "see whether a database is whole"},
    {"crash", cmd_crash, "simulate one crash, against a barrier or another car"},
    {"pulse", cmd_pulse, "compute OLC, delta-v and the other figures of any pulse"},
    {"validate", cmd_validate, "hold a vehicle model against reference OLC values"},
    {"calibrate", cmd_calibrate, "fit a vehicle model to reference OLC values"},
};
static const size_t COMMAND_COUNT = sizeof COMMAND / sizeof *COMMAND;

static void print_help(FILE *file)
{
    fputs("Usage: crashpulse COMMAND [ARGUMENT...]\n"
          "Virtual safety assessment at traffic scale: from SUMO traffic to frontal crashes,\n"
          "their pulses and OLC, and to a comparison of driver assistance variants.\n\n",
          file);
    for (size_t k = 0; k < COMMAND_COUNT; k++)
        fprintf(file, "  %-10s %s\n", COMMAND[k].name, COMMAND[k].what);
    fputs("\n"
          "A study from beginning to end:\n"
          "  crashpulse run study.yaml --db study.db\n"
          "  crashpulse compare study.db\n"
          "  crashpulse report study.db --output study.html\n"
          "  crashpulse sql study.db \"SELECT * FROM olc_by_variant\"\n\n"
          "'crashpulse COMMAND --help' explains a command. Results go to stdout, messages to\n"
          "stderr, without colours. Every command takes\n"
          "  --quiet              warnings and errors only\n"
          "  --verbose            details too: what is started, and how it ended\n"
          "  --log-format FORMAT  messages as text or json (an object a line)\n"
          "Exit code: 0 success, 1 failed run, 2 bad input.\n",
          file);
}

static cp_status run_command(int argc, char **argv, cp_error *error)
{
    for (size_t k = 0; k < COMMAND_COUNT; k++)
        if (strcmp(argv[1], COMMAND[k].name) == 0)
            return COMMAND[k].run(argc - 1, argv + 1, error);
    const char *names[sizeof COMMAND / sizeof *COMMAND];
    char meant[CP_NEAREST_TEXT_SIZE];
    for (size_t k = 0; k < COMMAND_COUNT; k++)
        names[k] = COMMAND[k].name;
    return cp_fail(error, CP_BAD_INPUT, "unknown %s '%s'; 'crashpulse --help' lists the commands%s",
                   argv[1][0] == '-' ? "option" : "command", argv[1],
                   cp_nearest_text(argv[1], names, COMMAND_COUNT, meant));
}

int main(int argc, char **argv)
{
    cp_error error = {0};
    cp_status status = CP_OK;
    json_set_alloc_funcs(cp_memory_for_json, free); // or fields would be missing without a word
    cp_log_options_take(&argc, argv);
    if (argc < 2) {
        print_help(stderr);
        return cp_status_exit_code(CP_BAD_INPUT);
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-?") == 0)
        print_help(stdout);
    else if (strcmp(argv[1], "--version") == 0 || strcmp(argv[1], "-V") == 0)
        puts("crashpulse " CRASHPULSE_VERSION);
    else
        status = run_command(argc, argv, &error);

    // A result that did not reach its reader is a failure.
    if ((fflush(stdout) != 0 || ferror(stdout)) && status == CP_OK)
        status = cp_fail(&error, CP_IO_FAILED, "writing the result: %s", strerror(errno));
    if (status != CP_OK)
        cp_log_error("%s", error.text[0] ? error.text : cp_status_text(status));
    return cp_status_exit_code(status);
}
