/* A bumper between two bodies beyond a gap: FMI 2.0 co-simulation. It pushes, never pulls, and its
   damper acts at once: the force jumps by d times the speed when the gap closes. */
#include <math.h>
#include <stddef.h>

enum { OK = 0, ERROR = 3 };
enum { X1, V1, X2, V2, F1, F2, K, D, GAP, REALS, INPUTS = 4 };
#define PARAMETERS K
typedef int Status;
typedef struct {
    double real[REALS];
} Model;

static void reset(Model *m) { *m = (Model){{0.0}}; }
static void evaluate(Model *m) {
    double *r = m->real, depth = r[X1] - r[X2] - r[GAP];
    double force = depth > 0.0 ? fmax(0.0, r[K] * depth + r[D] * (r[V1] - r[V2])) : 0.0;
    r[F1] = -force;
    r[F2] = force;
}
static Status step(Model *m, double t, double h) { return OK; }
#include "kinds/fmi2_shell.h"
