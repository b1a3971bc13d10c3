/* Carriage without friction: a mass moved by a force. Explicit Euler in sub-steps of 10 us. */
#include <stddef.h>

enum { OK = 0, ERROR = 3 };
enum { FORCE, POSITION, VELOCITY, MASS, REALS, INPUTS = 1 };
#define PARAMETERS MASS
typedef int Status;
typedef struct {
    double real[REALS];
} Model;

static void reset(Model *m) {
    m->real[FORCE] = m->real[POSITION] = m->real[VELOCITY] = 0.0;
    m->real[MASS] = 12.0;
}
static void evaluate(Model *m) {}
static Status step(Model *m, double t, double h) {
    double *r = m->real;
    int n = (int)(h / 1e-5 + 0.5);
    if (n < 1) n = 1;
    for (int i = 0; i < n; ++i) {
        r[POSITION] += h / n * r[VELOCITY];
        r[VELOCITY] += h / n * r[FORCE] / r[MASS];
    }
    return OK;
}
#include "../fmi2_shell.h"
