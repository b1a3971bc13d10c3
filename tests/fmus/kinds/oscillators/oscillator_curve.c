/* As oscillator_mass, for inputs that are polynomials up to the third degree in a step, given by
   their derivatives at its start; it also gives the rates of its outputs. Taylor series, pieces of
   at most 5 ms. */
#include <stddef.h>

enum { OK = 0, DISCARD = 2, ERROR = 3 };
enum { F, XO, VO, X, V, FO, M, K, C, KO, CO, X0, V0, REALS, INPUTS = 3 };
#define PARAMETERS M
#define DEGREE 3
#define TERMS 24
typedef int Status;
typedef struct {
    double real[REALS];
    double slope[INPUTS][DEGREE]; /* derivatives 1, 2, 3 at the start of a step */
    double now[INPUTS], rate[INPUTS];
    int stepped;
    double x, v;
} Model;

static void reset(Model *m) { *m = (Model){.real = {[M] = 1.0}}; }
static void start(Model *m) {
    m->x = m->real[X0];
    m->v = m->real[V0];
}
static double input(const Model *m, int i) { return m->stepped ? m->now[i] : m->real[i]; }
static void evaluate(Model *m) {
    double *r = m->real;
    r[X] = m->x;
    r[V] = m->v;
    r[FO] = r[KO] * (m->x - input(m, XO)) + r[CO] * (m->v - input(m, VO));
}
static double acceleration(const Model *m) {
    const double *r = m->real;
    double force = input(m, F) + r[KO] * input(m, XO) + r[CO] * input(m, VO);
    return (force - (r[K] + r[KO]) * m->x - (r[C] + r[CO]) * m->v) / r[M];
}
static Status step(Model *m, double t, double h) {
    const double *r = m->real;
    double k = (r[K] + r[KO]) / r[M], c = (r[C] + r[CO]) / r[M];
    double gain[INPUTS] = {1.0 / r[M], r[KO] / r[M], r[CO] / r[M]}, u[INPUTS][DEGREE + 1];
    for (int i = 0; i < INPUTS; ++i) {
        const double *s = m->slope[i];
        u[i][0] = r[i];
        u[i][1] = s[0];
        u[i][2] = s[1] / 2.0;
        u[i][3] = s[2] / 6.0;
    }
    int n = 1 + (int)(h * 200.0);
    double d = h / n;
    for (int piece = 0; piece < n; ++piece) {
        double x[TERMS + 2] = {m->x, m->v}, power = 1.0;
        m->x = m->v = 0.0;
        for (int j = 0; j < TERMS; ++j) {
            double force = 0.0;
            for (int i = 0; i < INPUTS && j <= DEGREE; ++i) force += gain[i] * u[i][j];
            x[j + 2] = (force - k * x[j] - c * (j + 1) * x[j + 1]) / ((j + 1.0) * (j + 2.0));
            m->x += x[j] * power;
            m->v += (j + 1) * x[j + 1] * power;
            power *= d;
        }
        for (int i = 0; i < INPUTS; ++i) {
            double *a = u[i];
            a[0] += d * (a[1] + d * (a[2] + d * a[3]));
            a[1] += d * (2.0 * a[2] + d * 3.0 * a[3]);
            a[2] += d * 3.0 * a[3];
        }
    }
    for (int i = 0; i < INPUTS; ++i) {
        m->now[i] = u[i][0];
        m->rate[i] = u[i][1];
    }
    m->stepped = 1;
    return OK;
}
#define INITIAL start
#define DERIVATIVES
#include "../fmi2_shell.h"

EXPORT Status fmi2SetRealInputDerivatives(Component c, const unsigned *vr, size_t n,
                                          const int *order, const double *value) {
    for (size_t i = 0; i < n; ++i) {
        if (vr[i] >= INPUTS || order[i] > DEGREE) return DISCARD;
        ((Model *)c)->slope[vr[i]][order[i] - 1] = value[i];
    }
    return OK;
}
EXPORT Status fmi2GetRealOutputDerivatives(Component c, const unsigned *vr, size_t n,
                                           const int *order, double *value) {
    const Model *m = c;
    const double *r = m->real;
    for (size_t i = 0; i < n; ++i) {
        if (order[i] != 1) return DISCARD;
        double a = acceleration(m);
        if (vr[i] == X) value[i] = m->v;
        else if (vr[i] == V) value[i] = a;
        else value[i] = r[KO] * (m->v - m->rate[XO]) + r[CO] * (a - m->rate[VO]);
    }
    return OK;
}
