/* FMI 3.0 co-simulation around a model; included at the end of its source, in place of
   kinds/fmi2_shell.h, with the same of it: `Model` with `double real[REALS]` (inputs first, INPUTS
   of them, then outputs, then parameters from PARAMETERS on), `reset`, `step` and `evaluate`.

   A model with events defines NEXT_EVENT(model), the time of the next one, `happen(model)`, and
   `piece(model, t, h)`, a step without any; its `step` takes them as they come. In event mode it
   returns early at an event, if it may, and the event happens when discrete states are updated.
   A model that asks for inputs within a step defines WITHIN, and has `Shell shell`. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#ifndef EXPORT
#define EXPORT __attribute__((visibility("default")))
#endif
#ifndef PARAMETERS
#define PARAMETERS REALS
#endif

#ifndef UPDATE
typedef void (*Update)(void *, double, bool, bool, bool, bool, bool *, double *);
#endif

typedef struct {
    Model model;
    void *environment;
    Update update;
    bool events_used, early_allowed, in_event;
} Instance;

EXPORT const char *fmi3GetVersion(void) { return "3.0"; }
EXPORT void *fmi3InstantiateCoSimulation(
    const char *name, const char *token, const char *resources, bool visible, bool logging,
    bool events_used, bool early_allowed, const unsigned *needed, size_t count, void *environment,
    void *log, Update update) {
    Instance *instance = calloc(1, sizeof(Instance));
    if (!instance) return NULL;
    instance->environment = environment;
    instance->update = update;
    instance->events_used = events_used;
    instance->early_allowed = early_allowed;
    reset(&instance->model);
    return instance;
}
EXPORT void fmi3FreeInstance(void *c) { free(c); }
EXPORT Status fmi3EnterInitializationMode(void *c, bool tolerant, double tolerance, double start,
                                          bool stops, double stop) {
    return OK;
}
EXPORT Status fmi3ExitInitializationMode(void *c) {
    Instance *instance = c;
    instance->in_event = instance->events_used;
#ifdef INITIAL
    INITIAL(&instance->model);
#endif
    return OK;
}
EXPORT Status fmi3Terminate(void *c) { return OK; }

EXPORT Status fmi3SetFloat64(void *c, const unsigned *vr, size_t n, const double *value,
                             size_t count) {
    for (size_t i = 0; i < n; ++i) {
        if (vr[i] >= REALS || (vr[i] >= INPUTS && vr[i] < PARAMETERS)) return ERROR;
        ((Instance *)c)->model.real[vr[i]] = value[i];
    }
    return n == count ? OK : ERROR;
}
EXPORT Status fmi3GetFloat64(void *c, const unsigned *vr, size_t n, double *value, size_t count) {
    Model *model = &((Instance *)c)->model;
    evaluate(model);
    for (size_t i = 0; i < n; ++i) {
        if (vr[i] >= REALS) return ERROR;
        value[i] = model->real[vr[i]];
    }
    return n == count ? OK : ERROR;
}

EXPORT Status fmi3EnterEventMode(void *c) {
    Instance *instance = c;
    if (!instance->events_used || instance->in_event) return ERROR;
    instance->in_event = true;
    return OK;
}
EXPORT Status fmi3EnterStepMode(void *c) {
    Instance *instance = c;
    if (!instance->in_event) return ERROR;
    instance->in_event = false;
    return OK;
}
EXPORT Status fmi3UpdateDiscreteStates(void *c, bool *more, bool *ends, bool *nominals,
                                       bool *states, bool *timed, double *next) {
    Instance *instance = c;
    *more = *ends = *nominals = *states = *timed = false;
    if (!instance->in_event) return ERROR;
#ifdef NEXT_EVENT
    if (instance->model.time >= NEXT_EVENT(&instance->model)) happen(&instance->model);
#endif
    return OK;
}
EXPORT Status fmi3DoStep(void *c, double t, double h, bool no_rollback, bool *event, bool *ends,
                         bool *early, double *reached) {
    Instance *instance = c;
    Model *model = &instance->model;
    *event = *ends = *early = false;
    *reached = t + h;
    if (instance->in_event) return ERROR;
#ifdef WITHIN
    model->shell = (Shell){instance->update, instance->environment};
#endif
#ifdef NEXT_EVENT
    if (instance->events_used) {
        double next = NEXT_EVENT(model);
        *event = next <= t + h;
        *early = instance->early_allowed && next < t + h;
        if (*early) *reached = next;
        return piece(model, t, *reached - t);
    }
#endif
    return step(model, t, h);
}

EXPORT Status fmi3GetFMUState(void *c, void **state) {
    if (!*state) *state = malloc(sizeof(Model));
    if (!*state) return ERROR;
    memcpy(*state, &((Instance *)c)->model, sizeof(Model));
    return OK;
}
EXPORT Status fmi3SetFMUState(void *c, void *state) {
    memcpy(&((Instance *)c)->model, state, sizeof(Model));
    return OK;
}
EXPORT Status fmi3FreeFMUState(void *c, void **state) {
    free(*state);
    *state = NULL;
    return OK;
}
EXPORT Status fmi3EnterConfigurationMode(void *c) { return ERROR; }
EXPORT Status fmi3ExitConfigurationMode(void *c) { return ERROR; }
#define NO_TYPE(Name) \
    EXPORT Status fmi3Get##Name(void) { return ERROR; } \
    EXPORT Status fmi3Set##Name(void) { return ERROR; }
NO_TYPE(Float32) NO_TYPE(Int8) NO_TYPE(UInt8) NO_TYPE(Int16) NO_TYPE(UInt16) NO_TYPE(Int32)
NO_TYPE(UInt32) NO_TYPE(Int64) NO_TYPE(UInt64) NO_TYPE(Boolean) NO_TYPE(String) NO_TYPE(Binary)
#include "absent3.h"
