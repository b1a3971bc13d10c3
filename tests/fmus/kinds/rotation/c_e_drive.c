/* Electric drive: torque with the lag of the current, less by slip [N m s/rad] times the rotor's speed;
   rotor, elastic shaft to the flange. The angle of the flange moves on with its speed during a step.
   Semi-implicit Euler in sub-steps of 5 us. */
#include <stddef.h>

enum { OK = 0, ERROR = 3 };
enum { SET, PHI, W, TAU, ROTOR_W, SLIP, REALS, INPUTS = 3 };
#define PARAMETERS SLIP
typedef int Status;
typedef struct {
    double real[REALS];
    double torque, phi, w; /* air gap and rotor */
} Model;

static const double LAG = 2e-3, INERTIA = 0.12, STIFFNESS = 8e4, DAMPING = 15.0;

static void reset(Model *m) { *m = (Model){0}; }
static double shaft(const Model *m, double phi) {
    return STIFFNESS * (m->phi - phi) + DAMPING * (m->w - m->real[W]);
}
static void evaluate(Model *m) {
    m->real[TAU] = shaft(m, m->real[PHI]);
    m->real[ROTOR_W] = m->w;
}
static Status step(Model *m, double t, double h) {
    int n = (int)(h / 5e-6 + 0.5);
    if (n < 1) n = 1;
    double d = h / n;
    for (int i = 0; i < n; ++i) {
        double phi = m->real[PHI] + (i - n) * d * m->real[W];
        m->torque += d * (m->real[SET] - m->real[SLIP] * m->w - m->torque) / LAG;
        m->w += d * (m->torque - shaft(m, phi)) / INERTIA;
        m->phi += d * m->w;
    }
    return OK;
}
#include "../fmi2_shell.h"
