/* Induction motor: torque over slip by Kloss, with the lag of the flux; rotor, elastic shaft to the
   flange. Angle and speed of the flange are held. Semi-implicit Euler in sub-steps of 1 us. */
#include <stddef.h>

enum { OK = 0, ERROR = 3 };
enum { PHI, W, TAU, ROTOR_W, SYNCHRONOUS, BREAKDOWN, SLIP, W0, REALS, INPUTS = 2 };
#define PARAMETERS SYNCHRONOUS
typedef int Status;
typedef struct {
    double real[REALS];
    double torque, phi, w; /* air gap and rotor */
} Model;

static const double LAG = 5e-3, INERTIA = 0.4, STIFFNESS = 6e4, DAMPING = 40.0;

static void reset(Model *m) {
    *m = (Model){.real = {[SYNCHRONOUS] = 100.0, [BREAKDOWN] = 900.0, [SLIP] = 0.12}};
}
static double air_gap(const Model *m) {
    double s = 1.0 - m->w / m->real[SYNCHRONOUS], k = m->real[SLIP];
    return 2.0 * m->real[BREAKDOWN] * s * k / (s * s + k * k);
}
static void start(Model *m) {
    m->w = m->real[W0];
    m->torque = air_gap(m);
}
static double shaft(const Model *m) {
    return STIFFNESS * (m->phi - m->real[PHI]) + DAMPING * (m->w - m->real[W]);
}
static void evaluate(Model *m) {
    m->real[TAU] = shaft(m);
    m->real[ROTOR_W] = m->w;
}
static Status step(Model *m, double t, double h) {
    int n = (int)(h / 1e-6 + 0.5);
    if (n < 1) n = 1;
    double d = h / n;
    for (int i = 0; i < n; ++i) {
        m->torque += d * (air_gap(m) - m->torque) / LAG;
        m->w += d * (m->torque - shaft(m)) / INERTIA;
        m->phi += d * m->w;
    }
    return OK;
}
#define INITIAL(c) start(c)
#include "../fmi2_shell.h"
