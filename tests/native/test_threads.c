/* Two instances in two threads give the bits of one instance alone. */
#include <pthread.h>

#include "check.h"
#include "rotor.h"

enum { STEPS_EACH = 20000 };

static const char *folder;

typedef struct {
    const char *name;
    double torque; /* the instances get different inputs, so that a shared block would show */
    double phi;
    int failed;
} Run;

static void *run(void *argument) {
    Run *self = argument;
    fmi2Component c = fmi2Instantiate(self->name, fmi2CoSimulation, "{token}", folder, &functions2,
                                      fmi2False, fmi2False);
    fmi2ValueReference tau = TAU, phi = PHI_OUT, unknown = 999;
    fmi2FMUstate state = NULL;
    self->failed |= fmi2EnterInitializationMode(c) | fmi2ExitInitializationMode(c);
    for (int n = 0; n < STEPS_EACH; n++) {
        double value = self->torque * (1 + n % 11);
        self->failed |= fmi2SetReal(c, &tau, 1, &value) | fmi2GetFMUstate(c, &state);
        self->failed |= fmi2DoStep(c, n * 1e-4, 1e-4, 1) | fmi2SetFMUstate(c, state);
        self->failed |= fmi2DoStep(c, n * 1e-4, 1e-4, 1);
        self->failed |= fmi2GetReal(c, &unknown, 1, &value) != fmi2Error;
        self->failed |= strstr(told, self->name) == NULL;
    }
    self->failed |= fmi2GetReal(c, &phi, 1, &self->phi);
    fmi2FreeInstance(c);
    return NULL;
}

int main(int count, char **arguments) {
    folder = count > 1 ? arguments[1] : ".";
    Run alone[2] = {{.name = "first", .torque = 1.0}, {.name = "second", .torque = -3.0}};
    Run together[2] = {alone[0], alone[1]};
    pthread_t threads[2];
    for (int i = 0; i < 2; i++)
        run(&alone[i]);
    for (int i = 0; i < 2; i++)
        CHECK(pthread_create(&threads[i], NULL, run, &together[i]) == 0);
    for (int i = 0; i < 2; i++)
        pthread_join(threads[i], NULL);
    for (int i = 0; i < 2; i++) {
        CHECK(!alone[i].failed && !together[i].failed);
        CHECK(alone[i].phi != 0.0 && alone[i].phi == together[i].phi);
    }
    return report();
}
