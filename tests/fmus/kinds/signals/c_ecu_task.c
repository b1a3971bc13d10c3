/* Control task of an ECU: reads its inputs at a tick of 1 ms, publishes the result at the next
   tick (logical execution time); the output is held in between. */
#include <stddef.h>

enum { OK = 0, ERROR = 3 };
enum { W_REF, W_MEAS, TORQUE, REALS, INPUTS = 2 };
#define HAS_START
typedef int Status;
typedef struct {
    double real[REALS];
    double start, integral, pending;
    long ticks;
} Model;

static void reset(Model *m) { *m = (Model){0}; }
static void evaluate(Model *m) {}
static Status step(Model *m, double t, double h) {
    while (m->start + m->ticks * 1e-3 < t + h - 1e-9) {
        double error = m->real[W_REF] - m->real[W_MEAS];
        m->real[TORQUE] = m->pending;
        m->integral += 90.0 * 1e-3 * error;
        m->pending = 12.0 * error + m->integral;
        ++m->ticks;
    }
    return OK;
}
#include "../fmi2_shell.h"
