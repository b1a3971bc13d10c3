/* PI speed governor without limits: torque = kp e + integral of ki e, the integral by step, the
   proportional part at once. */
#include <stddef.h>

enum { OK = 0, ERROR = 3 };
enum { W_SET, W_ACT, TORQUE, KP, KI, REALS, INPUTS = 2 };
#define PARAMETERS KP
typedef int Status;
typedef struct {
    double real[REALS];
    double integral;
} Model;

static void reset(Model *m) { *m = (Model){{0.0, 0.0, 0.0, 7.5, 60.0}, 0.0}; }
static double error(const Model *m) { return m->real[W_SET] - m->real[W_ACT]; }
static void evaluate(Model *m) { m->real[TORQUE] = m->real[KP] * error(m) + m->integral; }
static Status step(Model *m, double t, double h) {
    m->integral += h * m->real[KI] * error(m);
    return OK;
}
#include "../fmi2_shell.h"
