/* A massless spring with a damper between two moving points. */
#include <stddef.h>

enum { OK = 0, ERROR = 3 };
enum { XA, VA, XB, VB, FA, FB, K, C, REALS, INPUTS = 4 };
#define PARAMETERS K
typedef int Status;
typedef struct {
    double real[REALS];
} Model;

static void reset(Model *m) { *m = (Model){.real = {[K] = 100.0}}; }
static void evaluate(Model *m) {
    double *r = m->real;
    r[FB] = r[K] * (r[XA] - r[XB]) + r[C] * (r[VA] - r[VB]);
    r[FA] = -r[FB];
}
static Status step(Model *m, double t, double h) { return OK; }
#include "../fmi2_shell.h"
