/* Model exchange in FMI 2.0 and 3.0: modes, states, derivatives, event indicators. */
#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "rotor.h"

static const char *folder;

static void test_fmi2(void) {
    fmi2Component c = fmi2Instantiate("m", fmi2ModelExchange, "{token}", folder, &functions2, 0, 0);
    double x[4] = {0.0, 0.0, 0.0, 0.0}, dx[4], z[1], value;
    fmi2EventInfo info;
    fmi2Boolean event = 1, terminate = 1;
    fmi2ValueReference tau = TAU, a = A, der_w = DER_W, other = OTHER, der_other = DER_OTHER;
    REFUSED(fmi2GetDerivatives(c, dx, 4), "getDerivatives before initialisation");
    OK(fmi2SetupExperiment(c, 0, 0, 0, 0, 0));
    OK(fmi2EnterInitializationMode(c));
    OK(fmi2SetReal(c, &tau, 1, &(double){2.0}));
    OK(fmi2GetDerivatives(c, dx, 4));
    CHECK(dx[1] == 2.0);
    fmi2ValueReference inertias = INERTIAS;
    fmi2String heavy = "heavy.csv", light = "inertias.csv";
    OK(fmi2SetString(c, &inertias, 1, &heavy)); /* ten times the gain */
    OK(fmi2GetDerivatives(c, dx, 4));
    CHECK(fabs(dx[1] - 0.2) < 1e-15);
    OK(fmi2SetString(c, &inertias, 1, &light));
    REFUSED(fmi2EnterContinuousTimeMode(c), "in initialisation mode");
    OK(fmi2ExitInitializationMode(c));
    REFUSED(fmi2DoStep(c, 0, 1e-3, 1), "doStep in event mode");
    REFUSED(fmi2CompletedIntegratorStep(c, 1, &event, &terminate), "in event mode");
    OK(fmi2NewDiscreteStates(c, &info));
    CHECK(!info.newDiscreteStatesNeeded && !info.nextEventTimeDefined);
    OK(fmi2EnterContinuousTimeMode(c));
    OK(fmi2GetContinuousStates(c, x, 4));
    CHECK(x[0] == 0.0);
    double nominal[4]; /* those of state vectors, too */
    OK(fmi2GetNominalsOfContinuousStates(c, nominal, 4));
    CHECK(nominal[0] == 1.0 && nominal[1] == 100.0 && nominal[2] == 10.0 && nominal[3] == 20.0);
    REFUSED(fmi2GetContinuousStates(c, x, 2), "2 states; there are 4");
    REFUSED(fmi2GetEventIndicators(c, z, 2), "2 event indicators; there are 1");
    x[0] = 1.5, x[1] = 4.0, x[3] = 7.0; /* not side by side in the block */
    OK(fmi2SetTime(c, 0.5));
    OK(fmi2SetContinuousStates(c, x, 4));
    OK(fmi2SetReal(c, &tau, 1, &(double){6.0}));
    OK(fmi2GetDerivatives(c, dx, 4));
    CHECK(dx[0] == 4.0 && dx[1] == 6.0 && dx[3] == -7.0);
    OK(fmi2GetReal(c, &other, 1, &value));
    CHECK(value == 7.0);
    OK(fmi2GetEventIndicators(c, z, 1));
    CHECK(z[0] == 0.5);
    OK(fmi2GetReal(c, &a, 1, &value)); /* outputs follow states and inputs */
    CHECK(value == 6.0);
    OK(fmi2GetReal(c, &der_w, 1, &value));
    CHECK(value == 6.0);
    OK(fmi2SetTime(c, 0.75));
    OK(fmi2GetDerivatives(c, dx, 4));
    CHECK(dx[2] == 0.75);
    OK(fmi2SetReal(c, &tau, 1, &(double){7.0}));
    OK(fmi2GetDerivatives(c, dx, 4));
    CHECK(dx[1] == 7.0);
    OK(fmi2CompletedIntegratorStep(c, 1, &event, &terminate));
    CHECK(!event && !terminate);
    x[1] = NAN;
    GIVES(fmi2Discard, fmi2SetContinuousStates(c, x, 4), "m: w = nan; reduce the integrator's step");
    OK(fmi2GetDerivatives(c, dx, 4));
    CHECK(dx[0] == 4.0); /* the states are as before */
    x[1] = 4.0, x[3] = INFINITY;
    GIVES(fmi2Discard, fmi2SetContinuousStates(c, x, 4), "m: other[1] = inf");
    x[3] = 7.0;
    REFUSED(fmi2SetTime(c, NAN), "time nan s");
    OK(fmi2EnterEventMode(c));
    REFUSED(fmi2EnterEventMode(c), "enterEventMode in event mode");
    fmi2Integer order = 1;
    REFUSED(fmi2SetRealInputDerivatives(c, &tau, 1, &order, x), "setRealInputDerivatives in event");
    fmi2FMUstate state = NULL;
    OK(fmi2GetFMUstate(c, &state));
    OK(fmi2EnterContinuousTimeMode(c));
    x[1] = 9.0;
    OK(fmi2SetContinuousStates(c, x, 4));
    OK(fmi2SetFMUstate(c, state));
    OK(fmi2GetContinuousStates(c, x, 4));
    CHECK(x[1] == 4.0);
    REFUSED(fmi2EnterEventMode(c), "enterEventMode in event mode"); /* the mode came back, too */
    double seed = 1.0, sensitivity;
    OK(fmi2GetDirectionalDerivative(c, &der_w, 1, &tau, 1, &seed, &sensitivity));
    CHECK(sensitivity == 1.0);
    OK(fmi2GetDirectionalDerivative(c, &der_other, 1, &other, 1, &seed, &sensitivity));
    CHECK(sensitivity == -1.0);
    OK(fmi2Terminate(c));
    OK(fmi2GetContinuousStates(c, x, 4));
    REFUSED(fmi2SetTime(c, 1.0), "setTime after terminate");
    fmi2FreeInstance(c);
}

/* Files that give another number of states than those with which the FMU was built. */
static void test_other_data(void) {
    fmi2Component c = fmi2Instantiate("m", fmi2ModelExchange, "{token}", folder, &functions2, 0, 0);
    fmi2ValueReference shapes = SHAPES, a = A;
    fmi2String other = "three_shapes.csv", own = "shapes.csv";
    double value, x[4];
    OK(fmi2SetString(c, &shapes, 1, &other));
    OK(fmi2EnterInitializationMode(c));
    const char *why = "three_shapes.csv: 2 counters, but this FMU was built for 1 in model exchange; "
                      "build it again with this file, or use co-simulation (t = 0 s)";
    REFUSED(fmi2GetReal(c, &a, 1, &value), why);
    REFUSED(fmi2GetContinuousStates(c, x, 4), why);
    REFUSED(fmi2ExitInitializationMode(c), why); /* each time */
    OK(fmi2SetString(c, &shapes, 1, &own));
    OK(fmi2ExitInitializationMode(c));
    fmi2FreeInstance(c);
    c = fmi2Instantiate("c", fmi2CoSimulation, "{token}", folder, &functions2, 0, 0);
    OK(fmi2SetString(c, &shapes, 1, &other));
    OK(fmi2EnterInitializationMode(c));
    fmi2FMUstate state = NULL;
    size_t size;
    OK(fmi2GetReal(c, &a, 1, &value)); /* the files are read */
    OK(fmi2GetFMUstate(c, &state));
    OK(fmi2SerializedFMUstateSize(c, state, &size));
    fmi2Byte *bytes = malloc(size);
    OK(fmi2SerializeFMUstate(c, state, bytes, size));
    OK(fmi2ExitInitializationMode(c));
    OK(fmi2DoStep(c, 0.0, 1e-3, 1));
    fmi2FreeInstance(c);
    c = fmi2Instantiate("m", fmi2ModelExchange, "{token}", folder, &functions2, 0, 0);
    state = NULL;
    OK(fmi2DeSerializeFMUstate(c, bytes, size, &state));
    REFUSED(fmi2SetFMUstate(c, state), why);
    fmi2FreeInstance(c);
    free(bytes);
}

static void test_fmi3(void) {
    fmi3Instance c = fmi3InstantiateModelExchange("m", "{token}", folder, 0, 0, NULL, logger3);
    bool needed = true, terminate, nominals, states, defined;
    double next, x[4] = {2.0, 3.0, 0.0, 5.0}, dx[4], z[1];
    size_t count;
    OK(fmi3EnterInitializationMode(c, false, 0, 0.0, false, 0));
    OK(fmi3ExitInitializationMode(c));
    OK(fmi3UpdateDiscreteStates(c, &needed, &terminate, &nominals, &states, &defined, &next));
    CHECK(!needed && !terminate && !nominals && !states && !defined);
    OK(fmi3GetNumberOfContinuousStates(c, &count));
    CHECK(count == 4);
    OK(fmi3GetNumberOfEventIndicators(c, &count));
    CHECK(count == 1);
    OK(fmi3EnterContinuousTimeMode(c));
    OK(fmi3SetContinuousStates(c, x, 4));
    OK(fmi3GetContinuousStateDerivatives(c, dx, 4));
    CHECK(dx[0] == 3.0 && dx[1] == 0.0 && dx[3] == -5.0);
    OK(fmi3GetEventIndicators(c, z, 1));
    fmi3ValueReference indicator = INDICATOR;
    double shown = 0.0;
    OK(fmi3GetFloat64(c, &indicator, 1, &shown, 1));
    CHECK(shown == z[0]);
    CHECK(z[0] == 1.0);
    REFUSED(fmi3GetContinuousStates(c, x, 5), "5 states; there are 4");
    OK(fmi3CompletedIntegratorStep(c, true, &needed, &terminate));
    OK(fmi3EnterEventMode(c));
    OK(fmi3Terminate(c));
    fmi3FreeInstance(c);
}

int main(int count, char **arguments) {
    folder = count > 1 ? arguments[1] : ".";
    test_fmi2();
    test_other_data();
    test_fmi3();
    return report();
}
