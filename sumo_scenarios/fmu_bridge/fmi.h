/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef FMU_BRIDGE_FMI_H
#define FMU_BRIDGE_FMI_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What the bridge calls of a functional mock-up unit for co-simulation: declarations of our own
 * after the texts of the Functional Mock-up Interface, versions 2.0 and 3.0. Types and order of
 * arguments are the standard's; names are only as needed here. */

typedef void *fmi_component;
typedef uint32_t fmi_reference; /* of a variable */

enum { FMI_OK, FMI_WARNING }; /* of the statuses those after which one goes on */

/* ---- 2.0 ---- */

typedef struct fmi2_callbacks {
    void (*logger)(void *environment, const char *instance, int status, const char *category,
                   const char *message, ...);
    void *(*allocate)(size_t count, size_t size);
    void (*release)(void *memory);
    void (*step_finished)(void *environment, int status);
    void *environment;
} fmi2_callbacks;

enum { FMI2_CO_SIMULATION = 1 };

typedef struct fmi2_calls {
    fmi_component (*instantiate)(const char *name, int type, const char *guid,
                                 const char *resources, const fmi2_callbacks *callbacks,
                                 int visible, int logging);
    int (*set_up)(fmi_component, int has_tolerance, double tolerance, double start_s, int has_stop,
                  double stop_s);
    int (*enter_initialization)(fmi_component);
    int (*exit_initialization)(fmi_component);
    int (*set)(fmi_component, const fmi_reference *, size_t, const double *);
    int (*get)(fmi_component, const fmi_reference *, size_t, double *);
    int (*step)(fmi_component, double at_s, double step_s, int no_return);
    int (*terminate)(fmi_component);
    void (*release)(fmi_component);
} fmi2_calls;

/* ---- 3.0 ---- */

typedef struct fmi3_calls {
    fmi_component (*instantiate)(const char *name, const char *token, const char *resources,
                                 bool visible, bool logging, bool event_mode, bool early_return,
                                 const fmi_reference *intermediate, size_t intermediate_count,
                                 void *environment,
                                 void (*log)(void *environment, int status, const char *category,
                                             const char *message),
                                 void (*update)(void));
    int (*enter_initialization)(fmi_component, bool has_tolerance, double tolerance, double start_s,
                                bool has_stop, double stop_s);
    int (*exit_initialization)(fmi_component);
    int (*set)(fmi_component, const fmi_reference *, size_t, const double *, size_t);
    int (*get)(fmi_component, const fmi_reference *, size_t, double *, size_t);
    int (*step)(fmi_component, double at_s, double step_s, bool no_return, bool *event,
                bool *terminate, bool *early, double *reached_s);
    int (*terminate)(fmi_component);
    void (*release)(fmi_component);
} fmi3_calls;

#endif
