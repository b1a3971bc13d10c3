/* Slide moved by a hydraulic cylinder. The cylinder's force is kept in a work space of its own, to
   which the instance holds a pointer: a saved state holds the pointer only. */
#include <stddef.h>
#include <stdlib.h>

enum { OK = 0, ERROR = 3 };
enum { FORCE_CMD, STROKE, SPEED, REALS, INPUTS = 1 };
typedef int Status;
typedef struct {
    double real[REALS];
    double *cylinder_force;
} Model;

static Model *new_model(void) {
    Model *m = calloc(1, sizeof(Model));
    if (m) m->cylinder_force = calloc(1, sizeof(double));
    return m;
}
#define NEW() new_model()
#define DELETE(model) (free((model)->cylinder_force), free(model))

static void reset(Model *m) {
    for (int i = 0; i < REALS; ++i) m->real[i] = 0.0;
    *m->cylinder_force = 0.0;
}
static void evaluate(Model *m) {}
static Status step(Model *m, double t, double h) {
    double *r = m->real, *f = m->cylinder_force;
    int n = (int)(h / 2e-5 + 0.5);
    if (n < 1) n = 1;
    for (int i = 0; i < n; ++i) {
        *f += h / n * (r[FORCE_CMD] - *f) / 2e-3;
        r[SPEED] += h / n * (*f - 40.0 * r[SPEED]) / 25.0;
        r[STROKE] += h / n * r[SPEED];
    }
    return OK;
}
#include "../fmi2_shell.h"
