/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ANALYSIS_FIELD_TABLE_H
#define ANALYSIS_FIELD_TABLE_H

#include "core/error.h"
#include "stats/raking.h"

#include <stddef.h>

/* Crashes of the field that a study is laid beside: vehicles struck on their front in crashes of
 * two, with weights. The form of the table: db/field/README.md. */

/* What crashes are classed by. X(name, text, classes, ordered). */
#define CP_FIELD_MARGINS(X)                                                                        \
    X(CP_FIELD_TYPE, "crash_type", 3, false)                                                       \
    X(CP_FIELD_DELTA_V, "delta_v", 9, true)                                                        \
    X(CP_FIELD_OVERLAP, "overlap", 4, true)

typedef enum cp_field_margin {
#define CP_FIELD_MARGIN_NAME(name, text, classes, ordered) name,
    CP_FIELD_MARGINS(CP_FIELD_MARGIN_NAME)
#undef CP_FIELD_MARGIN_NAME
        CP_FIELD_MARGIN_COUNT
} cp_field_margin;

enum { CP_FIELD_CLASSES_MAX = 9, CP_FIELD_UNKNOWN = CP_RAKING_UNKNOWN };

extern const char *const CP_FIELD_MARGIN_TEXT[CP_FIELD_MARGIN_COUNT];
extern const size_t CP_FIELD_MARGIN_CLASSES[CP_FIELD_MARGIN_COUNT];

/* Class of a value: crash type by its name; delta-v in km/h, without rebound, and overlap by the
 * ends of the classes, each of which belongs to the class above; CP_FIELD_UNKNOWN of NAN or another
 * type. */
unsigned char cp_field_type_class(const char *crash_type);
unsigned char cp_field_delta_v_class(double delta_v_km_h);
unsigned char cp_field_overlap_class(double overlap_1);

/* "front-side", "20-25 km/h", "0.25-0.5". */
const char *cp_field_class_text(cp_field_margin margin, size_t of);

/* Numbers that are compared. */
typedef enum cp_field_value {
    CP_FIELD_VALUE_DELTA_V, /* km/h, without rebound */
    CP_FIELD_VALUE_PDOF,    /* degrees, 0 ... 180, without side */
    CP_FIELD_VALUE_OVERLAP, /* 1 */
    CP_FIELD_VALUE_COUNT
} cp_field_value;

typedef struct cp_field_table {
    char *name; /* of the comment "# name:", else of the file */
    char *bias; /* of the comment "# bias:" with the lines that go on with it; NULL: none */
    size_t count;
    double *weight;                      /* > 0 */
    unsigned char *type;                 /* class, or CP_FIELD_UNKNOWN */
    double *value[CP_FIELD_VALUE_COUNT]; /* NAN: unknown */
    size_t *stratum;                     /* of the sample's design, from 0 */
    size_t *cluster;                     /* numbered through; no two strata share one */
    size_t strata;
    size_t clusters; /* 0: no design given */
} cp_field_table;

/* The table of that name ("nass": the one inside the program), or of a file, plain or compressed
 * with gzip. The caller destroys, also after an error. Errors: CP_BAD_INPUT with file, line,
 * column, what was found and what is allowed; CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_field_table_read(const char *name_or_path, cp_field_table *table,
                                            cp_error *error);
void cp_field_table_destroy(cp_field_table *table);

/* Class of a row. */
unsigned char cp_field_table_class(const cp_field_table *table, size_t row, cp_field_margin margin);

/* Weighted share of each class among the rows where it is known, and its standard error from the
 * sample's design (Taylor linearisation, clusters within strata); NAN without a design. */
typedef struct cp_field_share {
    double share_1;
    double se_1;
} cp_field_share;

/* share: as many as the margin has classes. Error: CP_NO_MEMORY. */
CP_MUST_CHECK cp_status cp_field_table_shares(const cp_field_table *table, cp_field_margin margin,
                                              cp_field_share *share, cp_error *error);

#endif
