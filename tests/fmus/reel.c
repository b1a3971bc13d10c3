/* The mass of reel.py on the other side; its states can be saved. */
#include <math.h>
#include <stddef.h>

enum { OK = 0, ERROR = 3 };
enum { FORCE, POSITION, VELOCITY, HOLDS, REALS, INPUTS = 1 };
#define PARAMETERS HOLDS
typedef int Status;
typedef struct {
    double real[REALS];
    int steps;
} Model;

static void reset(Model *m) { *m = (Model){{0.0, -0.1, 0.0, 150.0}, 0}; }
static void evaluate(Model *m) {}
static Status step(Model *m, double t, double h) {
    double *r = m->real;
    double brake = ++m->steps > r[HOLDS] ? 2000.0 : 0.0;
    r[VELOCITY] += h * (r[FORCE] - brake * r[VELOCITY]) / 40.0;
    r[POSITION] += h * r[VELOCITY];
    return OK;
}
#include "kinds/fmi2_shell.h"
