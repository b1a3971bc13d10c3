/* A housing by a stranger, in C: twelve oscillators of which the two seats of a gear are coupled.
   FMI 2.0 co-simulation without any header, or 3.0 with FMI3; the test writes the description.
   Value references: force 0 ... 11, position 12 ... 23, velocity 24 ... 35.
   Macros make it wrong, or undamped, in one way each. */
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

enum { DOFS = 12, OK = 0, ERROR = 3 };
#ifndef FORCE /* factor of the forces */
#define FORCE 1.0
#endif
#ifndef ASYMMETRY /* share of a seat's coupling that only one of two seats feels */
#define ASYMMETRY 0.0
#endif
#ifndef CIRCULATION /* share of the stiffness that turns x to y, and y back to -x */
#define CIRCULATION 0.0
#endif
#ifndef DAMPED /* factor of the damping */
#define DAMPED 1.0
#endif
#ifndef DIRECT /* m/N that a force passes to its position at once */
#define DIRECT 0.0
#endif
#ifndef PRELOAD /* N, always there */
#define PRELOAD 0.0
#endif
#ifndef HARDENING /* N/m3 */
#define HARDENING 0.0
#endif
#ifndef MASS /* kg, at each seat and direction */
#define MASS 40.0
#endif
#ifndef SPRING /* factor of the stiffness to the ground */
#define SPRING 1.0
#endif
#ifndef LATE /* steps by which forces act late */
#define LATE 0
#endif
#ifndef SPEED /* factor of the velocities shown */
#define SPEED 1.0
#endif
#ifndef PLACE /* factor of the positions shown */
#define PLACE 1.0
#endif
#ifndef LONGEST /* s, inner step */
#define LONGEST 1e-6
#endif

static const double DAMPING_TIME = 5e-6;
/* Toward the wheel, up, along the shafts. */
static const double STIFFNESS[3] = {7e8, 7e8, 1.5e8}, COUPLING[3] = {1e8, 1e8, 8e7};

typedef struct {
    double real[3 * DOFS]; /* as shown */
    double f[LATE + 1][DOFS], s[DOFS], v[DOFS];
} Housing;

typedef int Status;
typedef void *Component;

static int partner(int i) { /* the same direction at the other seat of the gear */
    return i % 6 < 3 ? i + 3 : i - 3;
}

static void advance(Housing *housing, double h) {
    double *f = housing->f[LATE], *s = housing->s, *v = housing->v, a[DOFS];
    for (int i = 0; i < DOFS; ++i) {
        int other = partner(i);
        double k = SPRING * STIFFNESS[i % 3], c = COUPLING[i % 3];
        double elastic = k * s[i] + c * (s[i] - s[other]) + HARDENING * s[i] * s[i] * s[i];
        double viscous = k * v[i] + c * (v[i] - v[other]);
        if (i % 6 < 3) elastic -= ASYMMETRY * c * s[other];
        if (i % 3 < 2) elastic += (i % 3 ? -1.0 : 1.0) * CIRCULATION * k * s[i % 3 ? i - 1 : i + 1];
        a[i] = (FORCE * f[i] + PRELOAD - elastic - DAMPED * DAMPING_TIME * viscous) / MASS;
    }
    for (int i = 0; i < DOFS; ++i) {
        v[i] += h * a[i];
        s[i] += h * v[i];
    }
}

static void show(Housing *housing) {
    double *real = housing->real;
    for (int i = 0; i < DOFS; ++i) {
        real[DOFS + i] = PLACE * housing->s[i] + DIRECT * real[i];
        real[2 * DOFS + i] = SPEED * housing->v[i];
    }
}

static Status step(Housing *housing, double t, double h) {
    int steps = (int)(h / LONGEST) + 1;
    for (int late = LATE; late > 0; --late)
        memcpy(housing->f[late], housing->f[late - 1], sizeof housing->f[0]);
    memcpy(housing->f[0], housing->real, sizeof housing->f[0]);
    for (int n = 0; n < steps; ++n) advance(housing, h / steps);
    show(housing);
    return OK;
}

#ifdef FMI3
enum { REALS = 3 * DOFS, INPUTS = DOFS };
typedef Housing Model;
static void reset(Model *housing) { memset(housing, 0, sizeof(Housing)); }
static void evaluate(Model *housing) {}
#include "fmi3_shell.h"
#else
EXPORT Component fmi2Instantiate(const char *name, int kind, const char *guid, const char *resources,
                                 const void *callbacks, int visible, int logging) {
    return calloc(1, sizeof(Housing));
}
EXPORT void fmi2FreeInstance(Component c) { free(c); }
EXPORT Status fmi2Reset(Component c) {
    memset(c, 0, sizeof(Housing));
    return OK;
}
EXPORT Status fmi2SetReal(Component c, const unsigned *vr, size_t n, const double *value) {
    for (size_t i = 0; i < n; ++i) {
        if (vr[i] >= DOFS) return ERROR;
        ((Housing *)c)->real[vr[i]] = value[i];
    }
    return OK;
}
EXPORT Status fmi2GetReal(Component c, const unsigned *vr, size_t n, double *value) {
    for (size_t i = 0; i < n; ++i) {
        if (vr[i] >= 3 * DOFS) return ERROR;
        value[i] = ((Housing *)c)->real[vr[i]];
    }
    return OK;
}
EXPORT Status fmi2DoStep(Component c, double t, double h, int no_rollback) {
    return step(c, t, h);
}
EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORT const char *fmi2GetVersion(void) { return "2.0"; }
EXPORT Status fmi2SetDebugLogging(Component c, int on, size_t n, const char *const *categories) {
    return OK;
}
EXPORT Status fmi2SetupExperiment(Component c, int has_tolerance, double tolerance, double start,
                                  int has_stop, double stop) {
    return OK;
}
EXPORT Status fmi2EnterInitializationMode(Component c) { return OK; }
EXPORT Status fmi2ExitInitializationMode(Component c) { return OK; }
EXPORT Status fmi2Terminate(Component c) { return OK; }

#ifdef SAVES /* its states */
EXPORT Status fmi2GetFMUstate(Component c, void **state) {
    if (*state == NULL) *state = malloc(sizeof(Housing));
    memcpy(*state, c, sizeof(Housing));
    return OK;
}
EXPORT Status fmi2SetFMUstate(Component c, void *state) {
    memcpy(c, state, sizeof(Housing));
    return OK;
}
EXPORT Status fmi2FreeFMUstate(Component c, void **state) {
    free(*state);
    *state = NULL;
    return OK;
}
#define WITH_STATES
#endif
#include "absent.h"
#endif
