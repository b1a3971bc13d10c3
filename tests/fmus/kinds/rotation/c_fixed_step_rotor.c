/* Rotor with bearing friction on an internal clock of 0.1 ms, semi-implicit Euler. A communication
   step makes as many whole ticks as fit before its end. */
#include <stddef.h>

enum { OK = 0, ERROR = 3 };
enum { TAU, PHI, W, REALS, INPUTS = 1 };
#define HAS_START
typedef int Status;
typedef struct {
    double real[REALS];
    double start;
    long ticks;
} Model;

static void reset(Model *m) { *m = (Model){0}; }
static void evaluate(Model *m) {}
static Status step(Model *m, double t, double h) {
    double *r = m->real;
    while (m->start + (m->ticks + 1) * 1e-4 <= t + h + 1e-9) {
        r[W] += 1e-4 * (r[TAU] - 0.02 * r[W]) / 0.35;
        r[PHI] += 1e-4 * r[W];
        ++m->ticks;
    }
    return OK;
}
#include "../fmi2_shell.h"
