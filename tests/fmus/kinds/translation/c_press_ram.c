/* Ram of a press, a mass against a return spring, for a bus cycle of 1 ms: any other step is
   discarded and leaves everything as it was. */
#include <math.h>
#include <stddef.h>

enum { OK = 0, DISCARD = 2, ERROR = 3 };
enum { FORCE, POS, VEL, REALS, INPUTS = 1 };
typedef int Status;
typedef struct {
    double real[REALS];
} Model;

static void reset(Model *m) { *m = (Model){0}; }
static void evaluate(Model *m) {}
static Status step(Model *m, double t, double h) {
    double *r = m->real;
    if (fabs(h - 1e-3) > 1e-9) return DISCARD;
    for (int i = 0; i < 20; ++i) {
        r[VEL] += 5e-5 * (r[FORCE] - 4e4 * r[POS] - 800.0 * r[VEL]) / 60.0;
        r[POS] += 5e-5 * r[VEL];
    }
    return OK;
}
#include "../fmi2_shell.h"
