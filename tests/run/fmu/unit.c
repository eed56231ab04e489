/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rule.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* A small functional mock-up unit for co-simulation, of FMI version FMI (2 or 3), as somebody else
 * would write one: nothing of the bridge is used. Variables by reference: 0 ttc_s (parameter), 1
 * ... 5 inputs, 6 output brake_m_s2. BAD: it gives no number. */

enum { TTC_S, OWN_SPEED, AHEAD, LEFT, HEADING, SPEED, BRAKE, VARIABLES };

typedef struct unit {
    double value[VARIABLES];
    rule_state state;
    bool is_started;
} unit;

#define EXPORT __attribute__((visibility("default")))

static unit *create(const char *token)
{
    unit *made = strcmp(token, "{brake-1}") == 0 ? calloc(1, sizeof *made) : NULL;
    if (made != NULL)
        made->value[TTC_S] = 1.0;
    return made;
}

static int set(void *instance, const uint32_t *reference, size_t count, const double *value)
{
    unit *self = instance;
    for (size_t k = 0; k < count; k++) {
        if (reference[k] >= BRAKE || (reference[k] == TTC_S && self->is_started))
            return 3;
        self->value[reference[k]] = value[k];
    }
    return 0;
}

static int get(void *instance, const uint32_t *reference, size_t count, double *value)
{
    const unit *self = instance;
    for (size_t k = 0; k < count; k++)
        value[k] = reference[k] < VARIABLES ? self->value[reference[k]] : 0.0;
    return 0;
}

static int step(void *instance, double step_s)
{
    unit *self = instance;
    double *v = self->value;
    if (!self->is_started)
        return 3;
    v[BRAKE] = rule_brake_m_s2(&self->state, v[TTC_S], step_s, v[OWN_SPEED], v[AHEAD], v[LEFT],
                               v[HEADING], v[SPEED]);
#ifdef BAD
    v[BRAKE] = v[BRAKE] > 0.0 ? NAN : 0.0;
#endif
    return 0;
}

static int start(void *instance)
{
    ((unit *)instance)->is_started = true;
    return 0;
}

#if FMI == 2
EXPORT void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources,
                             const void *callbacks, int visible, int logging);
void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources,
                      const void *callbacks, int visible, int logging)
{
    (void)name, (void)resources, (void)visible, (void)logging;
    return type == 1 && callbacks != NULL ? create(guid) : NULL;
}
EXPORT int fmi2SetupExperiment(void *c, int a, double b, double d, int e, double f);
int fmi2SetupExperiment(void *c, int a, double b, double d, int e, double f)
{
    (void)a, (void)b, (void)d, (void)e, (void)f;
    return c == NULL;
}
EXPORT int fmi2EnterInitializationMode(void *c);
int fmi2EnterInitializationMode(void *c)
{
    return c == NULL;
}
EXPORT int fmi2ExitInitializationMode(void *c);
int fmi2ExitInitializationMode(void *c)
{
    return start(c);
}
EXPORT int fmi2SetReal(void *c, const uint32_t *r, size_t n, const double *v);
int fmi2SetReal(void *c, const uint32_t *r, size_t n, const double *v)
{
    return set(c, r, n, v);
}
EXPORT int fmi2GetReal(void *c, const uint32_t *r, size_t n, double *v);
int fmi2GetReal(void *c, const uint32_t *r, size_t n, double *v)
{
    return get(c, r, n, v);
}
EXPORT int fmi2DoStep(void *c, double at_s, double step_s, int no_return);
int fmi2DoStep(void *c, double at_s, double step_s, int no_return)
{
    (void)at_s, (void)no_return;
    return step(c, step_s);
}
EXPORT int fmi2Terminate(void *c);
int fmi2Terminate(void *c)
{
    return c == NULL;
}
EXPORT void fmi2FreeInstance(void *c);
void fmi2FreeInstance(void *c)
{
    free(c);
}
#else
EXPORT void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources,
                                         bool visible, bool logging, bool events, bool early,
                                         const uint32_t *intermediate, size_t count,
                                         void *environment, void (*log)(void),
                                         void (*update)(void));
void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources,
                                  bool visible, bool logging, bool events, bool early,
                                  const uint32_t *intermediate, size_t count, void *environment,
                                  void (*log)(void), void (*update)(void))
{
    (void)name, (void)resources, (void)visible, (void)logging, (void)events, (void)early;
    (void)intermediate, (void)environment, (void)update;
    return count == 0 && log != NULL ? create(token) : NULL;
}
EXPORT int fmi3EnterInitializationMode(void *c, bool a, double b, double d, bool e, double f);
int fmi3EnterInitializationMode(void *c, bool a, double b, double d, bool e, double f)
{
    (void)a, (void)b, (void)d, (void)e, (void)f;
    return c == NULL;
}
EXPORT int fmi3ExitInitializationMode(void *c);
int fmi3ExitInitializationMode(void *c)
{
    return start(c);
}
EXPORT int fmi3SetFloat64(void *c, const uint32_t *r, size_t n, const double *v, size_t m);
int fmi3SetFloat64(void *c, const uint32_t *r, size_t n, const double *v, size_t m)
{
    return m == n ? set(c, r, n, v) : 3;
}
EXPORT int fmi3GetFloat64(void *c, const uint32_t *r, size_t n, double *v, size_t m);
int fmi3GetFloat64(void *c, const uint32_t *r, size_t n, double *v, size_t m)
{
    return m == n ? get(c, r, n, v) : 3;
}
EXPORT int fmi3DoStep(void *c, double at_s, double step_s, bool no_return, bool *event, bool *end,
                      bool *early, double *reached_s);
int fmi3DoStep(void *c, double at_s, double step_s, bool no_return, bool *event, bool *end,
               bool *early, double *reached_s)
{
    (void)no_return;
    *event = *end = *early = false;
    *reached_s = at_s + step_s;
    return step(c, step_s);
}
EXPORT int fmi3Terminate(void *c);
int fmi3Terminate(void *c)
{
    return c == NULL;
}
EXPORT void fmi3FreeInstance(void *c);
void fmi3FreeInstance(void *c)
{
    free(c);
}
#endif
