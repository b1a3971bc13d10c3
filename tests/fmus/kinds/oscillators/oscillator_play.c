/* A mass on a spring to ground, and on a second one with play to a point that moves as it is told:
   beyond GAP it takes KO. Runge-Kutta in steps of at most 20 us, inputs held. */
#include <stddef.h>

enum { OK = 0, ERROR = 3 };
enum { XO, X, V, FO, M, K, KO, GAP, X0, V0, REALS, INPUTS = 1 };
#define PARAMETERS M
typedef int Status;
typedef struct {
    double real[REALS];
    double x, v;
} Model;

static void reset(Model *m) { *m = (Model){.real = {[M] = 1.0}}; }
static void start(Model *m) {
    m->x = m->real[X0];
    m->v = m->real[V0];
}
static double force(const Model *m, double x) {
    const double *r = m->real;
    double apart = x - r[XO], side = apart > 0.0 ? 1.0 : -1.0, depth = side * apart - r[GAP];
    return depth > 0.0 ? side * r[KO] * depth : 0.0;
}
static void evaluate(Model *m) {
    m->real[X] = m->x;
    m->real[V] = m->v;
    m->real[FO] = force(m, m->x);
}
static double acceleration(const Model *m, double x) {
    return -(m->real[K] * x + force(m, x)) / m->real[M];
}
static Status step(Model *m, double t, double h) {
    int n = (int)(h / 2e-5) + 1;
    double d = h / n;
    for (int i = 0; i < n; ++i) {
        double v1 = m->v, a1 = acceleration(m, m->x);
        double v2 = m->v + d / 2 * a1, a2 = acceleration(m, m->x + d / 2 * v1);
        double v3 = m->v + d / 2 * a2, a3 = acceleration(m, m->x + d / 2 * v2);
        double v4 = m->v + d * a3, a4 = acceleration(m, m->x + d * v3);
        m->x += d / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
        m->v += d / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
    return OK;
}
#define INITIAL start
#include "../fmi2_shell.h"
