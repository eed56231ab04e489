/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef FMU_BRIDGE_UNIT_H
#define FMU_BRIDGE_UNIT_H

#include "fmi.h"

/* A functional mock-up unit: what its description says, and its calls of either version. */

typedef struct fmu_variable {
    char *name;
    fmi_reference reference;
    char causality[24]; /* "input", "output", "parameter", ... */
} fmu_variable;

typedef struct fmu_unit {
    int version;            /* 2 or 3 */
    char *identifier;       /* of its binary */
    char *token;            /* guid, instantiationToken */
    char *resources;        /* where they are, as the version wants it; NULL: it has none */
    bool only_once;         /* one instance a process */
    fmu_variable *variable; /* real numbers only */
    size_t variable_count;
    fmi2_calls fmi2;
    fmi3_calls fmi3;
} fmu_unit;

/* Open path: an .fmu file (zip), or the modelDescription.xml of one that is unpacked. The binary is
 * loaded and stays until the process ends. Returns NULL, or what is wrong; close in any case. */
const char *fmu_open(const char *path, fmu_unit *unit);
void fmu_close(fmu_unit *unit);

/* The variable of that name and causality; NULL: it has none. */
const fmu_variable *fmu_find(const fmu_unit *unit, const char *name, const char *causality);

/* One instance; calls return false when the unit says it cannot. */
fmi_component fmu_create(const fmu_unit *unit, const char *name);
bool fmu_begin(const fmu_unit *unit, fmi_component instance, double start_s);
bool fmu_started(const fmu_unit *unit, fmi_component instance); /* parameters are set */
bool fmu_set(const fmu_unit *unit, fmi_component instance, fmi_reference variable, double value);
bool fmu_get(const fmu_unit *unit, fmi_component instance, fmi_reference variable, double *value);
bool fmu_step(const fmu_unit *unit, fmi_component instance, double at_s, double step_s);
void fmu_destroy(const fmu_unit *unit, fmi_component instance);

#endif
