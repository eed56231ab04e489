/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef EXCHANGE_ISO_MME_H
#define EXCHANGE_ISO_MME_H

#include "exchange/pulse_record.h"

#include <stddef.h>

/* ISO-MME (ISO/TS 13499, multimedia data exchange of crash tests): a folder <test> with <test>.mme,
 * Channel/<test>.chn and a file Channel/<test>.NNN a channel. Text lines "name:value", names padded
 * to 28 columns, NOVALUE where nothing is known; after the header of a channel file a value a line.
 * Axes are those of SAE J211 (x forward, y to the right, z down): lateral channels and yaw change
 * their sign on the way. Units m/s^2, m/s, m, rad, rad/s, rad/s^2.
 *
 * Channel codes: test object, position, location, three fine locations, physical dimension,
 * direction, filter class (0 none, A CFC1000, B CFC600, C CFC180, D CFC60, P prefiltered):
 * 10VEHCCG0000ACXD is the CFC60 acceleration of test object 1 along x at its centre of gravity. */

/* A vehicle of the test. */
typedef struct cp_iso_mme_object {
    const char *name; /* any text; control characters are written as \xNN */
    const cp_pulse_record *record;
    char filter; /* class that the accelerations of the record went through */
} cp_iso_mme_object;

typedef struct cp_iso_mme_test {
    const char *name;  /* of folder and files: letters, digits, '_' and '-' only */
    const char *title; /* any text */
    const char *laboratory;
    size_t object_count; /* 1 or 2 */
    cp_iso_mme_object object[2];
} cp_iso_mme_test;

/* Write the folder <test> into folder, that of a cp_output_folder under way. Of each object: the
 * known channels of its record, and the accelerations through CFC60 where its sampling allows.
 * Errors: CP_BAD_INPUT for a name with other characters; CP_IO_FAILED; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_iso_mme_write(const char *folder, const cp_iso_mme_test *test,
                                         cp_error *error);

/* How a channel of ours is coded: letters of dimension and direction, unit, and the sign it takes
 * in SAE J211's axes. */
typedef struct cp_iso_mme_code {
    char dimension[3];
    char direction;
    const char *unit;
    double sign;
} cp_iso_mme_code;
extern const cp_iso_mme_code CP_ISO_MME_CODE[CP_CHANNEL_COUNT];
/* Struck sides, in our words and in ISO's letters. */
extern const char *const CP_ISO_MME_SIDE[4][2];

/* Read the pulse that a request names: a test's folder, its .mme file or one channel file. Taken
 * are channels at VEHC of the test object (request->vehicle "1", "2", "a", "b"; default 1), the
 * least filtered one where several are there, or for the longitudinal acceleration the one whose
 * code is request->code. The caller destroys the record. Errors: CP_BAD_INPUT with file and line;
 * CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_iso_mme_read(const cp_pulse_request *request, cp_pulse_record *record,
                                        cp_error *error);

#endif
