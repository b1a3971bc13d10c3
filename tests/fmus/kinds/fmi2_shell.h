/* FMI 2.0 co-simulation around a model; included at the end of its source. That has defined
   `Model` with `double real[REALS]` (inputs first, INPUTS of them, then outputs, then parameters
   from PARAMETERS on), `reset`, `step` and `evaluate` (outputs that follow the inputs at once). */
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif
#ifndef PARAMETERS
#define PARAMETERS REALS
#endif
#ifndef NEW /* where an instance lives; a model may have a place of its own */
#define NEW() calloc(1, sizeof(Model))
#define DELETE(model) free(model)
#endif
typedef void *Component;

EXPORT Component fmi2Instantiate(const char *name, int kind, const char *guid, const char *resources,
                                 const void *callbacks, int visible, int logging) {
    Model *model = NEW();
    if (model) reset(model);
    return model;
}
EXPORT void fmi2FreeInstance(Component c) {
    if (c) DELETE((Model *)c);
}
EXPORT Status fmi2Reset(Component c) {
    reset(c);
    return OK;
}
EXPORT Status fmi2SetupExperiment(Component c, int has_tolerance, double tolerance, double start,
                                  int has_stop, double stop) {
#ifdef HAS_START
    ((Model *)c)->start = start;
#endif
    return OK;
}
EXPORT Status fmi2EnterInitializationMode(Component c) { return OK; }
EXPORT Status fmi2ExitInitializationMode(Component c) {
#ifdef INITIAL /* what sets outputs that only a step would set */
    INITIAL(c);
#endif
    return OK;
}
EXPORT Status fmi2Terminate(Component c) { return OK; }
EXPORT Status fmi2SetReal(Component c, const unsigned *vr, size_t n, const double *value) {
    for (size_t i = 0; i < n; ++i) {
        if (vr[i] >= REALS || (vr[i] >= INPUTS && vr[i] < PARAMETERS)) return ERROR;
        ((Model *)c)->real[vr[i]] = value[i];
    }
    return OK;
}
EXPORT Status fmi2GetReal(Component c, const unsigned *vr, size_t n, double *value) {
    evaluate(c);
    for (size_t i = 0; i < n; ++i) {
        if (vr[i] >= REALS) return ERROR;
        value[i] = ((Model *)c)->real[vr[i]];
    }
    return OK;
}
EXPORT Status fmi2DoStep(Component c, double t, double h, int no_rollback) { return step(c, t, h); }

EXPORT Status fmi2GetFMUstate(Component c, void **state) {
    if (!*state) *state = malloc(sizeof(Model));
    if (!*state) return ERROR;
    memcpy(*state, c, sizeof(Model));
    return OK;
}
EXPORT Status fmi2SetFMUstate(Component c, void *state) {
    memcpy(c, state, sizeof(Model));
    return OK;
}
EXPORT Status fmi2FreeFMUstate(Component c, void **state) {
    free(*state);
    *state = NULL;
    return OK;
}
EXPORT Status fmi2SerializedFMUstateSize(Component c, void *state, size_t *size) { return ERROR; }
EXPORT Status fmi2SerializeFMUstate(Component c, void *state, char *bytes, size_t size) {
    return ERROR;
}
EXPORT Status fmi2DeSerializeFMUstate(Component c, const char *bytes, size_t size, void **state) {
    return ERROR;
}
EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORT const char *fmi2GetVersion(void) { return "2.0"; }
EXPORT Status fmi2SetDebugLogging(Component c, int on, size_t n, const char *const *categories) {
    return OK;
}
#define ABSENT(name) \
    EXPORT Status fmi2##name(void) { return ERROR; }
ABSENT(GetInteger) ABSENT(GetBoolean) ABSENT(GetString)
ABSENT(SetInteger) ABSENT(SetBoolean) ABSENT(SetString)
ABSENT(GetDirectionalDerivative)
#ifndef DERIVATIVES
ABSENT(SetRealInputDerivatives) ABSENT(GetRealOutputDerivatives)
#endif
ABSENT(CancelStep) ABSENT(GetStatus) ABSENT(GetRealStatus) ABSENT(GetIntegerStatus)
ABSENT(GetBooleanStatus) ABSENT(GetStringStatus)
