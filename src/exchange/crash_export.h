/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef EXCHANGE_CRASH_EXPORT_H
#define EXCHANGE_CRASH_EXPORT_H

#include "exchange/crash_selection.h"
#include "exchange/lsdyna.h"

/* Crashes and pulses in the formats of other programs, one crash at a time. */

/* X(name, word, whether it carries pulses, whether the output is always a folder) */
#define CP_EXPORT_FORMATS(X)                                                                       \
    X(CP_EXPORT_ISO_MME, "iso-mme", true, true)                                                    \
    X(CP_EXPORT_LSDYNA, "lsdyna", true, false)                                                     \
    X(CP_EXPORT_CSV, "csv", true, false)                                                           \
    X(CP_EXPORT_SUMO_POI, "sumo-poi", false, false)                                                \
    X(CP_EXPORT_GEOJSON, "geojson", false, false)

typedef enum cp_export_format {
#define CP_EXPORT_NAME(name, word, pulses, folder) name,
    CP_EXPORT_FORMATS(CP_EXPORT_NAME)
#undef CP_EXPORT_NAME
        CP_EXPORT_FORMAT_COUNT
} cp_export_format;

/* CP_EXPORT_FORMAT_COUNT for any other word. */
cp_export_format cp_export_format_find(const char *word);
bool cp_export_has_pulses(cp_export_format format);

typedef struct cp_export_options {
    cp_export_format format;
    const char *output_path;
    const cp_unit_system *units; /* LSDYNA */
    const char *network_path;    /* GEOJSON: the network whose projection places crashes on earth */
    bool in_plane;               /* GEOJSON: metres of the network instead */
    const char *program;         /* "crashpulse 0.1.0", as the laboratory of ISO-MME */
} cp_export_options;

typedef struct cp_export_count {
    size_t crashes;
    size_t without_pulse; /* left out of a format that carries pulses */
} cp_export_count;

/* Write the selected crashes of a database. ISO-MME: a folder with a test a crash, crash_<id>, both
 * vehicles as test objects. LS-DYNA: a file for the one crash of selection->crash_id, else a folder
 * of files crash_<id>.k. The others: one file. Written beside and renamed when whole; progress on
 * stderr. Errors: those of the selection; CP_BAD_INPUT when no crash is selected or has a pulse,
 * for scenarios on several networks in formats that are maps, and for a network without projection;
 * CP_IO_FAILED. */
CP_MUST_CHECK cp_status cp_export_crashes(cp_store *store, const cp_crash_selection *selection,
                                          const cp_export_options *options, cp_export_count *count,
                                          cp_error *error);

/* Write one pulse, of whatever file, in a format that carries pulses. ISO-MME: test "pulse". */
CP_MUST_CHECK cp_status cp_export_pulse(const cp_pulse_record *record,
                                        const cp_export_options *options, cp_error *error);

#endif
