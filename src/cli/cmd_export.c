/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/args.h"
#include "cli/commands.h"
#include "cli/pulse_input.h"
#include "core/log.h"
#include "core/output_files.h"
#include "exchange/crash_export.h"
#include "exchange/pulse_file.h"

#include <string.h>

typedef struct arguments {
    cp_pulse_input input;
    cp_export_options options;
    const char *format; /* as written */
    const char *scenario;
    const char *where;
} arguments;

enum { AS = 256, NETWORK, PLANE, SCENARIO };

static const struct argp_option OPTIONS[] = {
    {"as", AS, "FORMAT", 0, "iso-mme, lsdyna, csv, sumo-poi, geojson or parquet", 0},
    {"output", 'o', "PATH", 0,
     "where to: a new folder for iso-mme and for lsdyna of several crashes, else a file", 0},
    {"where", 'w', "SQL", 0,
     "only crashes of which a vehicle fits this condition on columns of crash_vehicle_list", 0},
    {"scenario", SCENARIO, "NAME", 0, "only crashes of this scenario", 0},
    {"network", NETWORK, "FILE", 0,
     "geojson: network whose projection tells where on earth its places are", 0},
    {"plane", PLANE, NULL, 0, "geojson: leave places in metres of the network", 0},
    {0},
};

// One line each, to be run behind --as csv.
static const char PARQUET[] =
    "parquet is written from the CSV export, by DuckDB or pyarrow:\n"
    "  crashpulse export DB --as csv --output pulses.csv\n"
    "  duckdb -c \"COPY (SELECT * FROM 'pulses.csv') TO 'pulses.parquet' (FORMAT parquet)\"\n"
    "  python3 -c \"import pyarrow.csv as c, pyarrow.parquet as p; "
    "p.write_table(c.read_csv('pulses.csv'), 'pulses.parquet')\"";

static void check(arguments *a, struct argp_state *state)
{
    cp_args_need(state, a->input.request.path != NULL, "export what? DB or PULSE");
    cp_args_need(state, a->format != NULL, "as what? --as FORMAT");
    cp_args_need(state, a->options.output_path != NULL, "where to? --output PATH");
    if (strcmp(a->format, "parquet") == 0)
        return;
    if (a->options.format == CP_EXPORT_FORMAT_COUNT)
        argp_error(state,
                   "--as must be iso-mme, lsdyna, csv, sumo-poi, geojson or parquet, found '%s'",
                   a->format);
    bool geojson = a->options.format == CP_EXPORT_GEOJSON;
    if (geojson && a->options.network_path == NULL && !a->options.in_plane)
        argp_error(state, "geojson is in degrees: --network FILE tells where the network lies on "
                          "earth; --plane leaves metres");
    if (!geojson && (a->options.network_path != NULL || a->options.in_plane))
        argp_error(state, "--network and --plane are about geojson");
}

static error_t parse(int key, char *argument, struct argp_state *state)
{
    arguments *a = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &a->input;
        return 0;
    case AS:
        a->format = argument;
        a->options.format = cp_export_format_find(argument);
        return 0;
    case 'o':
        a->options.output_path = argument;
        return 0;
    case 'w':
        a->where = argument;
        return 0;
    case SCENARIO:
        a->scenario = argument;
        return 0;
    case NETWORK:
        a->options.network_path = argument;
        return 0;
    case PLANE:
        a->options.in_plane = true;
        return 0;
    case ARGP_KEY_ARG:
        if (a->input.request.path != NULL)
            argp_error(state, "one database or pulse at a time, found '%s' too", argument);
        a->input.request.path = argument;
        return 0;
    case ARGP_KEY_END:
        check(a, state);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child CHILDREN[] = {{&CP_PULSE_INPUT_ARGS, 0, NULL, 2}, {0}};

static const struct argp ARGP = {
    .options = OPTIONS,
    .parser = parse,
    .args_doc = "DB --as FORMAT --output PATH\nPULSE --as FORMAT --output PATH",
    .doc = "Write crashes of a database, or one pulse, in the formats of other programs: one crash "
           "(--crash ID), those of a selection (--where, --scenario), or all; with --treatment "
           "what they became under a variant."
           "\v"
           "iso-mme    crash tests as laboratories exchange them (ISO/TS 13499), both\n"
           "           vehicles as test objects, axes of SAE J211: a folder a crash\n"
           "lsdyna     load curves (*DEFINE_CURVE) of the motion, in --units\n"
           "csv        pulses as one table\n"
           "sumo-poi   crash sites that sumo-gui draws: --additional-files PATH\n"
           "geojson    crash sites for maps\n"
           "parquet    says how to make it from csv\n\n"
           "Examples:\n"
           "  crashpulse export demo.db --as iso-mme --output tests --where \"olc_g > 30\"\n"
           "  crashpulse export demo.db --as lsdyna --crash 4711 --output pulse.k\n"
           "  crashpulse export demo.db --as sumo-poi --output crashes.add.xml\n"
           "  crashpulse export demo.db --as geojson --network town.net.xml -o sites.json\n"
           "  crashpulse export v10146/ --as lsdyna --units m-s-kg --output v10146.k\n",
    .children = CHILDREN,
};

static cp_status export_crashes(const arguments *a, cp_error *error)
{
    cp_store *store = NULL;
    cp_export_count count = {0};
    cp_crash_selection selection = {.crash_id = a->input.crash_id,
                                    .treatment = a->input.request.treatment,
                                    .scenario = a->scenario,
                                    .where = a->where};
    cp_status status = cp_store_open(a->input.request.path, CP_STORE_READ, &store, error);
    if (status == CP_OK)
        status = cp_export_crashes(store, &selection, &a->options, &count, error);
    cp_store_close(store);
    if (status == CP_OK && count.without_pulse > 0)
        cp_log_warning("%zu crashes have no pulses stored and are left out", count.without_pulse);
    if (status == CP_OK)
        cp_log_info("%s: %zu crashes", a->options.output_path, count.crashes);
    return status;
}

static cp_status export_pulse(const arguments *a, cp_error *error)
{
    cp_pulse_record record = {0};
    if (!cp_export_has_pulses(a->options.format))
        return cp_fail(error, CP_BAD_INPUT,
                       "%s: is a pulse, which has no place on a map: %s is "
                       "for the crashes of a database",
                       a->input.request.path, a->format);
    if (a->where != NULL || a->scenario != NULL)
        return cp_fail(error, CP_BAD_INPUT,
                       "%s: is a pulse; --where and --scenario choose crashes of a database",
                       a->input.request.path);
    cp_status status = cp_pulse_input_read(&a->input, &record, error);
    if (status == CP_OK)
        status = cp_export_pulse(&record, &a->options, error);
    cp_pulse_record_destroy(&record);
    return status;
}

cp_status cmd_export(int argc, char **argv, cp_error *error)
{
    arguments a = {.input = cp_pulse_input_default(),
                   .options = {.program = "crashpulse " CRASHPULSE_VERSION}};
    cp_args_parse(&ARGP, argc, argv, &a);
    if (strcmp(a.format, "parquet") == 0)
        return cp_fail(error, CP_BAD_INPUT, "%s", PARQUET);
    a.options.units =
        cp_unit_system_find(a.input.request.units != NULL ? a.input.request.units : "mm-ms-kg");
    const char *const inputs[] = {a.input.request.path, a.options.network_path};
    cp_status status = cp_output_files_check(&a.options.output_path, 1, inputs, 2, error);
    if (status != CP_OK)
        return status;
    return cp_pulse_file_is_database(a.input.request.path) ? export_crashes(&a, error)
                                                           : export_pulse(&a, error);
}
