/* Parts with flanges by a stranger, in C, right ones and wrong ones; the test writes the
   description. PART chooses what it is:

   ROTOR     inputs tau, drive (outputs phi, w): inertia with friction
   SHAFT     inputs phi, w, drive, brake (output tau): rotor behind a shaft; the angle is held in a
             step; the brake is described where a test wants it
   SLIDER    as SHAFT, but the angle runs on with w inside a step
   COUPLING  inputs a.phi, a.w, b.phi, b.w (outputs a.tau, b.tau): a massless spring-damper
   HUB       as COUPLING, with a hub of mass in the middle
   BODIES    inputs a.tau, b.tau (outputs a.phi, a.w, b.phi, b.w): two rotors, a shaft between
   BAR       inputs a.tau, b.phi, b.w (outputs a.phi, a.w, b.tau): a rotor behind a spring

   and FAULT what is wrong with it, 0 nothing. */
#include <math.h>
#include <stddef.h>

enum { OK = 0, DISCARD = 2, ERROR = 3 };
enum { ROTOR, SHAFT, SLIDER, COUPLING, HUB, BODIES, BAR };
enum {
    NONE,
    TORQUE_SIGN,
    RPM,       /* the speed is in r/min, rad/s is declared */
    W_NEGATED, /* against phi */
    W_FILTERED,
    DELAY,
    UNSTABLE,    /* any speed grows beyond all bounds */
    ACTIVE,      /* negative damping */
    HELD_WRONG,  /* the angle inside a step is off */
    NO_REACTION, /* the torque at b is not that at a */
    WRAPPED,     /* the angle within a turn, given or taken */
    LATE_CONTROL, /* holds its speed, by what it was 4 ms ago */
    MEAN_TORQUE, /* the mean of the step is shown */
    DIRECT,      /* a speed that the torque passes to */
    GROUNDED     /* a spring to the ground, too */
};
#ifndef PART
#define PART ROTOR
#endif
#ifndef FAULT
#define FAULT NONE
#endif
#ifndef START /* speed at the start, rad/s */
#define START 0.0
#endif
#ifndef FIXED /* the only step that is accepted, s; 0: any */
#define FIXED 0.0
#endif
enum { REALS = 8, INPUTS = 4, OLD = 2000 };
typedef int Status;
typedef struct {
    double real[REALS];
    double phi, w, far_phi, far_w, mean, seen, filtered;  /* seen: the angle at the end of the step */
    double used[INPUTS], last[INPUTS]; /* inputs of this step and of the one before, if it is late */
    double old[OLD]; /* speeds in micro steps before */
    int place;
} Model;

static const double INERTIA = 0.15, STIFFNESS = 4e4, DAMPING = 12.0, FRICTION = 0.05;
static const double MICRO = 2e-6, FILTER = 1e-3, CONTROL = 12.0, PI = 3.14159265358979323846;

static void reset(Model *m) {
    *m = (Model){0};
    m->w = START;
    if (PART == SHAFT || PART == SLIDER) m->real[1] = START;
    for (int i = 0; i < OLD; ++i) m->old[i] = START;
}
static double shaft(double phi, double w) {
    double viscous = FAULT == ACTIVE ? -DAMPING : FAULT == W_NEGATED ? -DAMPING : DAMPING;
    double torque = STIFFNESS * phi + viscous * w * (FAULT == RPM ? 30.0 / PI : 1.0);
    return FAULT == TORQUE_SIGN ? -torque : torque;
}
/* What the part sees of its inputs. */
static double given(const Model *m, int i) {
    double value = FAULT == DELAY ? m->used[i] : m->real[i];
    return FAULT == WRAPPED && PART == SHAFT && i == 0 ? remainder(value, 2.0 * PI) : value;
}

static void evaluate(Model *m) {
    double *r = m->real;
    if (PART == ROTOR) {
        double w = FAULT == W_FILTERED ? m->filtered : m->w;
        if (FAULT == RPM) w *= 30.0 / PI;
        if (FAULT == W_NEGATED) w = -w;
        if (FAULT == DIRECT) w += 1e-3 * r[0];
        r[4] = FAULT == WRAPPED ? fmod(m->phi, 2.0 * PI) : m->phi;
        r[5] = w;
    } else if (PART == SHAFT || PART == SLIDER) {
        r[4] = FAULT == MEAN_TORQUE ? m->mean : shaft(m->phi - m->seen, m->w - given(m, 1));
    } else if (PART == COUPLING) {
        double torque = shaft(given(m, 0) - given(m, 2), given(m, 1) - given(m, 3));
        r[4] = -torque - (FAULT == GROUNDED ? STIFFNESS * given(m, 0) : 0.0);
        r[5] = FAULT == NO_REACTION ? 0.9 * torque : torque;
    } else if (PART == HUB) {
        r[4] = shaft(m->phi - given(m, 0), m->w - given(m, 1));
        r[5] = shaft(m->phi - given(m, 2), m->w - given(m, 3));
        if (FAULT == NO_REACTION) r[5] *= 0.9;
    } else if (PART == BODIES) {
        r[4] = m->phi;
        r[5] = m->w;
        r[6] = m->far_phi;
        r[7] = m->far_w;
    } else {
        r[4] = m->phi;
        r[5] = m->w;
        r[6] = shaft(m->phi - given(m, 1), m->w - given(m, 2));
        if (FAULT == NO_REACTION) r[6] *= 0.9;
    }
}
static double torque_on(const Model *m, double phi) { /* on the mass inside */
    const double *r = m->real;
    switch (PART) {
    case ROTOR:
        return given(m, 0) + r[1] - (FAULT == ACTIVE ? -1.0 : 1.0) * FRICTION * m->w;
    case SHAFT:
    case SLIDER:
        return r[2] + r[3] - shaft(m->phi - phi, m->w - given(m, 1));
    case HUB:
        return -shaft(m->phi - given(m, 0), m->w - given(m, 1)) -
               shaft(m->phi - given(m, 2), m->w - given(m, 3));
    case BODIES:
        return given(m, 0) - shaft(m->phi - m->far_phi, m->w - m->far_w);
    default:
        return given(m, 0) - shaft(m->phi - given(m, 1), m->w - given(m, 2));
    }
}
static void advance(Model *m, double h, double phi) {
    double torque = torque_on(m, phi);
    if (PART == ROTOR && FAULT == TORQUE_SIGN) torque -= 2.0 * m->real[0];
    if (FAULT == UNSTABLE) torque += 2e4 * m->w;
    if (PART == ROTOR && FAULT == LATE_CONTROL) {
        torque += CONTROL * (START - m->old[m->place]);
        m->old[m->place] = m->w;
        m->place = (m->place + 1) % OLD;
    }
    double before = m->w, far = m->far_w;
    if (PART == BODIES) {
        double handed = shaft(m->phi - m->far_phi, m->w - m->far_w);
        m->far_w += h * (given(m, 1) + (FAULT == NO_REACTION ? 0.9 : 1.0) * handed) / INERTIA;
        m->far_phi += 0.5 * h * (far + m->far_w);
    }
    m->w += h * torque / INERTIA;
    m->phi += 0.5 * h * (before + m->w);
}
static Status step(Model *m, double t, double h) {
    if (FIXED > 0.0 && fabs(h - FIXED) > 1e-9) return DISCARD;
    int n = (int)ceil(h / MICRO - 1e-6);
    if (n < 1) n = 1;
    for (int i = 0; i < INPUTS; ++i) m->used[i] = m->last[i], m->last[i] = m->real[i];
    if (FAULT == HELD_WRONG && PART == ROTOR) { /* one step of Euler's rule */
        m->phi += h * m->w;
        m->w += h * torque_on(m, 0.0) / INERTIA;
    } else {
        double d = h / n, rate = PART == SLIDER ? m->real[1] : 0.0;
        if (FAULT == HELD_WRONG && PART == SHAFT) rate = 0.5 * m->real[1];
        if (FAULT == HELD_WRONG && PART == SLIDER) rate *= 0.9;
        if (FAULT == RPM && PART == SLIDER) rate *= 30.0 / PI;
        double phi = given(m, 0);
        m->mean = 0.0;
        for (int i = 0; i < n && PART != COUPLING; ++i) {
            m->mean += shaft(m->phi - phi, m->w - m->real[1]) / n;
            advance(m, d, phi);
            phi += d * rate;
            m->filtered += d * (m->w - m->filtered) / FILTER;
        }
        m->seen = phi;
    }
    return OK;
}
#ifdef FMI3
#include "fmi3_shell.h"
#else
#include "kinds/fmi2_shell.h"
#endif
