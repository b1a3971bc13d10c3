/* A mass that turns, in units of its own: FMI 2.0 co-simulation without any header; the test writes
   the description. Value references: parameters inertia 0 (SI), size of the unit of the angle 1, of
   the speed 2 and of the torque 3 in SI units, wrap 4 (the angle stays below a turn), speed at the
   start 5 (SI); input torque 6; outputs angle 7 and speed 8; parameters: time 9 at which it ends the
   simulation, 0 never; 10: it discards the step there instead, if 1, and goes on with it behind doStep, if 2.
   Exact for a constant torque. */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#define EXPORT __attribute__((visibility("default")))
enum { OK = 0, DISCARD = 2, ERROR = 3, PENDING = 5 };
enum { DO_STEP_STATUS = 0 };
enum { LAST_SUCCESSFUL_TIME = 2, TERMINATED = 3 };
enum { INERTIA, ANGLE_UNIT, SPEED_UNIT, TORQUE_UNIT, WRAP, START, TORQUE, ANGLE, SPEED, END, REFUSES, COUNT };

typedef struct {
    double real[COUNT], phi, w, last;
    int ended, pending;
} Mass;
typedef int Status;
typedef void *Component;

EXPORT Component fmi2Instantiate(const char *name, int kind, const char *guid, const char *resources,
                                 const void *callbacks, int visible, int logging) {
    Mass *m = calloc(1, sizeof(Mass));
    m->real[INERTIA] = m->real[ANGLE_UNIT] = m->real[SPEED_UNIT] = m->real[TORQUE_UNIT] = 1.0;
    return m;
}
EXPORT void fmi2FreeInstance(Component c) {
    if (((Mass *)c)->pending) abort(); /* nothing but its status may be asked for meanwhile */
    free(c);
}
EXPORT Status fmi2SetReal(Component c, const unsigned *vr, size_t n, const double *value) {
    Mass *m = c;
    for (size_t i = 0; i < n; ++i) {
        m->real[vr[i]] = value[i];
        if (vr[i] == START) m->w = value[i];
    }
    return OK;
}
EXPORT Status fmi2GetReal(Component c, const unsigned *vr, size_t n, double *value) {
    const Mass *m = c;
    if (m->pending) abort();
    const double turn = 8.0 * atan(1.0);
    for (size_t i = 0; i < n; ++i) {
        double phi = m->real[WRAP] ? fmod(m->phi, turn) : m->phi;
        value[i] = vr[i] == ANGLE   ? phi / m->real[ANGLE_UNIT]
                   : vr[i] == SPEED ? m->w / m->real[SPEED_UNIT]
                                    : m->real[vr[i]];
    }
    return OK;
}
EXPORT Status fmi2DoStep(Component c, double t, double h, int no_rollback) {
    Mass *m = c;
    m->ended = m->real[END] > 0.0 && m->real[END] < t + h - 1e-12;
    if (m->ended) h = m->real[END] - t;
    m->last = t + h;
    double a = m->real[TORQUE] * m->real[TORQUE_UNIT] / m->real[INERTIA];
    m->phi += h * (m->w + 0.5 * h * a);
    m->w += h * a;
    if (m->ended && m->real[REFUSES] == 2.0) m->pending = 1;
    return m->pending ? PENDING : m->ended ? DISCARD : OK;
}
EXPORT Status fmi2GetStatus(Component c, int kind, Status *value) {
    *value = ((Mass *)c)->pending ? PENDING : OK;
    return kind == DO_STEP_STATUS ? OK : DISCARD;
}
EXPORT Status fmi2CancelStep(Component c) {
    Mass *m = c;
    if (!m->pending) return ERROR;
    m->pending = 0;
    return OK;
}
EXPORT Status fmi2GetBooleanStatus(Component c, int kind, int *value) {
    *value = ((Mass *)c)->ended && !((Mass *)c)->real[REFUSES];
    return kind == TERMINATED ? OK : DISCARD;
}
EXPORT Status fmi2GetRealStatus(Component c, int kind, double *value) {
    *value = ((Mass *)c)->last;
    return kind == LAST_SUCCESSFUL_TIME ? OK : DISCARD;
}
EXPORT Status fmi2GetFMUstate(Component c, void **state) {
    if (!*state) *state = malloc(sizeof(Mass));
    memcpy(*state, c, sizeof(Mass));
    return OK;
}
EXPORT Status fmi2SetFMUstate(Component c, void *state) {
    memcpy(c, state, sizeof(Mass));
    return OK;
}
EXPORT Status fmi2FreeFMUstate(Component c, void **state) {
    free(*state);
    *state = NULL;
    return OK;
}
EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORT const char *fmi2GetVersion(void) { return "2.0"; }
EXPORT Status fmi2Terminate(Component c) { return OK; }
EXPORT Status fmi2SetupExperiment(Component c, int tolerant, double tolerance, double start,
                                  int stops, double stop) {
    return OK;
}
EXPORT Status fmi2EnterInitializationMode(Component c) { return OK; }
EXPORT Status fmi2ExitInitializationMode(Component c) { return OK; }
EXPORT Status fmi2SetDebugLogging(Component c, int on, size_t n, const char *const *categories) {
    return OK;
}

/* What it has not, but fmpy wants to find. */
#define ABSENT(name) \
    EXPORT Status fmi2##name(void) { return ERROR; }
ABSENT(Reset) ABSENT(GetInteger) ABSENT(GetBoolean) ABSENT(GetString)
ABSENT(SetInteger) ABSENT(SetBoolean) ABSENT(SetString)
ABSENT(SerializedFMUstateSize) ABSENT(SerializeFMUstate) ABSENT(DeSerializeFMUstate)
ABSENT(GetDirectionalDerivative) ABSENT(SetRealInputDerivatives) ABSENT(GetRealOutputDerivatives)
ABSENT(GetIntegerStatus) ABSENT(GetStringStatus)
