/* A fan without inertia: torque by the square of the speed, against it. */
#include <math.h>
#include <stddef.h>

enum { OK = 0, ERROR = 3 };
enum { W, TAU, SHARE, REALS, INPUTS = 1 };
#define PARAMETERS SHARE
typedef int Status;
typedef struct {
    double real[REALS];
} Model;

static void reset(Model *m) { *m = (Model){.real = {[SHARE] = 1.0}}; }
static void evaluate(Model *m) { m->real[TAU] = -m->real[SHARE] * m->real[W] * fabs(m->real[W]); }
static Status step(Model *m, double t, double h) { return OK; }
#include "../fmi2_shell.h"
