/* Parts of a drivetrain by a stranger, in C, of FMI 2.0, or 3.0 with FMI3; the test writes the
   description. PART chooses what it is:

   ROTOR     input tau, outputs phi, w, events: an inertia, exact for a torque that is held; its
             own torque is there from a time on, which is an event
   COUPLING  inputs a.phi, a.w, b.phi, b.w, outputs a.tau, b.tau: a massless spring-damper

   With WITHIN a rotor asks for its torque within a step, and is exact for parabolas of it. It
   refuses steps longer than LONGEST and shorter than SHORTEST. */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

enum { OK = 0, ERROR = 3 };
#define ROTOR 0
#define COUPLING 1
enum { TAU, PHI, W, EVENTS, INERTIA, SPEED, OWN, FROM, OF_ROTOR };
enum { A_PHI, A_W, B_PHI, B_W, A_TAU, B_TAU, STIFFNESS, DAMPING, OF_COUPLING };
#if PART == ROTOR
enum { REALS = OF_ROTOR, INPUTS = 1, PARAMETERS_AT = INERTIA };
#else
enum { REALS = OF_COUPLING, INPUTS = 4, PARAMETERS_AT = STIFFNESS };
#endif
#define PARAMETERS PARAMETERS_AT
typedef int Status;
#define UPDATE
typedef void (*Update)(void *, double, bool, bool, bool, bool, bool *, double *);
typedef struct {
    Update update;
    void *environment;
} Shell;
typedef struct {
    double real[REALS];
    double phi, w, time, own, events;
    Shell shell;
} Model;

static void reset(Model *m) {
    *m = (Model){{0.0}};
    if (PART == ROTOR) m->real[INERTIA] = 1.0;
}
static void start(Model *m) {
    if (PART == ROTOR) m->w = m->real[SPEED];
}
static void evaluate(Model *m) {
    double *r = m->real;
    if (PART == ROTOR) {
        r[PHI] = m->phi;
        r[W] = m->w;
        r[EVENTS] = m->events;
    } else {
        r[B_TAU] = r[STIFFNESS] * (r[A_PHI] - r[B_PHI]) + r[DAMPING] * (r[A_W] - r[B_W]);
        r[A_TAU] = -r[B_TAU];
    }
}
#define NEXT_EVENT(m) (PART == ROTOR && (m)->events == 0.0 ? (m)->real[FROM] : INFINITY)
static void happen(Model *m) {
    m->own = m->real[OWN];
    m->events += 1.0;
}
static double torque(Model *m, double t) {
#ifdef WITHIN
    bool early = false;
    double end = 0.0;
    m->shell.update(m->shell.environment, t, true, false, false, false, &early, &end);
#endif
    return m->real[TAU] + m->own;
}
static Status piece(Model *m, double t, double h) {
    if (PART == ROTOR) {
        double first = torque(m, t), middle = torque(m, t + 0.5 * h), last = torque(m, t + h);
        double inertia = m->real[INERTIA];
        m->phi += h * (m->w + h * (first + 2.0 * middle) / (6.0 * inertia));
        m->w += h * (first + 4.0 * middle + last) / (6.0 * inertia);
    }
    m->time = t + h;
    return OK;
}
#ifndef LONGEST
#define LONGEST INFINITY
#define SHORTEST 0.0
#endif
static Status step(Model *m, double t, double h) {
    double to = t + h;
    if (PART == ROTOR && (h > LONGEST * (1.0 + 1e-9) || h < SHORTEST * (1.0 - 1e-9))) return ERROR;
    if (NEXT_EVENT(m) < to) {
        double at = NEXT_EVENT(m);
        piece(m, t, at - t);
        happen(m);
        t = at;
    }
    piece(m, t, to - t);
    if (NEXT_EVENT(m) <= to) happen(m);
    return OK;
}
#define INITIAL start
#ifdef FMI3
#include "fmi3_shell.h"
#else
#include "kinds/fmi2_shell.h"
#endif
