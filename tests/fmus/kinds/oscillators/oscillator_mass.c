/* A mass on a spring to ground, and on a second one to a point that moves as it is told; exact for
   inputs that are held, by its 2 x 2 transition matrix as a series. */
#include <stddef.h>

enum { OK = 0, ERROR = 3 };
enum { F, XO, VO, X, V, FO, M, K, C, KO, CO, X0, V0, REALS, INPUTS = 3 };
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
static void evaluate(Model *m) {
    double *r = m->real;
    r[X] = m->x;
    r[V] = m->v;
    r[FO] = r[KO] * (m->x - r[XO]) + r[CO] * (m->v - r[VO]);
}
static Status step(Model *m, double t, double h) {
    const double *r = m->real;
    double k = (r[K] + r[KO]) / r[M], c = (r[C] + r[CO]) / r[M];
    double force = (r[F] + r[KO] * r[XO] + r[CO] * r[VO]) / r[M];
    int n = 1 + (int)(h * 200.0); /* pieces of at most 5 ms: terms fall by 1/4 and faster */
    double d = h / n;
    for (int i = 0; i < n; ++i) {
        double dx = m->v, dv = force - k * m->x - c * m->v, factor = d;
        for (int order = 1; order <= 24; ++order) {
            m->x += factor * dx;
            m->v += factor * dv;
            double next = -k * dx - c * dv;
            dx = dv;
            dv = next;
            factor *= d / (order + 1);
        }
    }
    return OK;
}
#define INITIAL start
#include "../fmi2_shell.h"
