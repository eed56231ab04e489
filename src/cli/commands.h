/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CLI_COMMANDS_H
#define CLI_COMMANDS_H

#include "core/error.h"

/* The commands. argv[0] is the command's name. Wrong arguments and --help end the program; what
 * fails later is returned, results go to stdout. */
CP_MUST_CHECK cp_status cmd_init(int argc, char **argv, cp_error *error);
CP_MUST_CHECK cp_status cmd_doctor(int argc, char **argv, cp_error *error);
CP_MUST_CHECK cp_status cmd_reference(int argc, char **argv, cp_error *error);
CP_MUST_CHECK cp_status cmd_run(int argc, char **argv, cp_error *error);
CP_MUST_CHECK cp_status cmd_matrix(int argc, char **argv, cp_error *error);
CP_MUST_CHECK cp_status cmd_plan(int argc, char **argv, cp_error *error);
CP_MUST_CHECK cp_status cmd_background(int argc, char **argv, cp_error *error);
CP_MUST_CHECK cp_status cmd_assess(int argc, char **argv, cp_error *error);
CP_MUST_CHECK cp_status cmd_compare(int argc, char **argv, cp_error *error);
CP_MUST_CHECK cp_status cmd_report(int argc, char **argv, cp_error *error);
CP_MUST_CHECK cp_status cmd_plot(int argc, char **argv, cp_error *error);
CP_MUST_CHECK cp_status cmd_sql(int argc, char **argv, cp_error *error);
CP_MUST_CHECK cp_status cmd_status(int argc, char **argv, cp_error *error);
CP_MUST_CHECK cp_status cmd_merge(int argc, char **argv, cp_error *error);
CP_MUST_CHECK cp_status cmd_submit(int argc, char **argv, cp_error *error);
CP_MUST_CHECK cp_status cmd_export(int argc, char **argv, cp_error *error);
CP_MUST_CHECK cp_status cmd_pulse(int argc, char **argv, cp_error *error);
CP_MUST_CHECK cp_status cmd_check(int argc, char **argv, cp_error *error);
CP_MUST_CHECK cp_status cmd_crash(int argc, char **argv, cp_error *error);
CP_MUST_CHECK cp_status cmd_validate(int argc, char **argv, cp_error *error);
CP_MUST_CHECK cp_status cmd_calibrate(int argc, char **argv, cp_error *error);

#endif
