/* Flywheel of an old code whose variables are all global: a second instance is the first one, and
   setting it up resets both. The description says that there may be one per process only. */
#include <stddef.h>

enum { OK = 0, ERROR = 3 };
enum { TAU, OMEGA, ANGLE, REALS, INPUTS = 1 };
typedef int Status;
typedef struct {
    double real[REALS];
} Model;

static Model THE_MODEL;
#define NEW() (&THE_MODEL)
#define DELETE(model) ((void)(model))

static void reset(Model *m) { *m = (Model){0}; }
static void evaluate(Model *m) {}
static Status step(Model *m, double t, double h) {
    double *r = m->real;
    for (int i = 0; i < 10; ++i) {
        double drag = 4e-4 * r[OMEGA] * (r[OMEGA] < 0 ? -r[OMEGA] : r[OMEGA]);
        r[OMEGA] += h / 10 * (r[TAU] - drag) / 1.8;
        r[ANGLE] += h / 10 * r[OMEGA];
    }
    return OK;
}
#include "../fmi2_shell.h"
