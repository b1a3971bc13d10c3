/* Spring and damper between two points. The forces on both are computed
   by a step, with the inputs of that step. */
#include <stddef.h>

enum { OK = 0, ERROR = 3 };
enum { X1, X2, V1, V2, F1, F2, REALS, INPUTS = 4 };
typedef int Status;
typedef struct {
    double real[REALS];
} Model;

static void reset(Model *m) {
    for (int i = 0; i < REALS; ++i) m->real[i] = 0.0;
}
static void evaluate(Model *m) {}
#define INITIAL forces
static void forces(Model *m) {
    double *r = m->real;
    r[F2] = 3.0e5 * (r[X1] - r[X2]) + 900.0 * (r[V1] - r[V2]);
    r[F1] = -r[F2];
}
static Status step(Model *m, double t, double h) {
    forces(m);
    return OK;
}
#include "../fmi2_shell.h"
