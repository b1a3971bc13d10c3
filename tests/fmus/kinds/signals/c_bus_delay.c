/* Signal over a bus, 5 ms late: a ring of samples with their times. The input is constant during a
   step. The ring holds 5 ms of steps down to 1 us. */
#include <math.h>
#include <stddef.h>

enum { OK = 0, ERROR = 3 };
enum { U, Y, REALS, INPUTS = 1, ROOM = 8192 };
typedef int Status;
typedef struct {
    double real[REALS];
    unsigned first, count;
    double since[ROOM], value[ROOM];
} Model;

static void reset(Model *m) {
    m->real[U] = m->real[Y] = 0.0;
    m->first = 0;
    m->count = 1;
    m->since[0] = -HUGE_VAL;
    m->value[0] = 0.0;
}
static void evaluate(Model *m) {}
static void drop(Model *m) {
    m->first = (m->first + 1) % ROOM;
    --m->count;
}
static Status step(Model *m, double t, double h) {
    double wanted = t + h - 5e-3 + 1e-9;
    if (m->count == ROOM) drop(m);
    unsigned last = (m->first + m->count++) % ROOM;
    m->since[last] = t;
    m->value[last] = m->real[U];
    while (m->count > 1 && m->since[(m->first + 1) % ROOM] <= wanted) drop(m);
    m->real[Y] = m->value[m->first];
    return OK;
}
#include "../fmi2_shell.h"
