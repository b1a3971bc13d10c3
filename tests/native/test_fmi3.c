/* FMI 3.0: arrays, states, derivatives, and what is not offered. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "check.h"
#include "rotor.h"

#undef REFUSED
#define REFUSED(call, text) GIVES(fmi3Error, call, text)

static const char *folder;

static fmi3Instance make(void) {
    return fmi3InstantiateCoSimulation("r", "{token}", folder, false, false, false, false, NULL, 0,
                                       NULL, logger3, NULL);
}

static fmi3Instance started(void) {
    fmi3Instance c = make();
    OK(fmi3EnterInitializationMode(c, false, 0, 0.0, false, 0));
    OK(fmi3ExitInitializationMode(c));
    return c;
}

static fmi3Status set(fmi3Instance c, fmi3ValueReference vr, double value) {
    return fmi3SetFloat64(c, &vr, 1, &value, 1);
}

static double get(fmi3Instance c, fmi3ValueReference vr) {
    double value = NAN;
    OK(fmi3GetFloat64(c, &vr, 1, &value, 1));
    return value;
}

static fmi3Status step(fmi3Instance c, double time, double h) {
    bool event = true, terminate = true, early = true;
    double last;
    fmi3Status status = fmi3DoStep(c, time, h, true, &event, &terminate, &early, &last);
    if (status == fmi3OK)
        CHECK(!event && !terminate && !early && last == time + h);
    return status;
}

static void test_instantiate(void) {
    told[0] = '\0';
    CHECK(!fmi3InstantiateScheduledExecution("r", "{token}", "", 0, 0, NULL, logger3, NULL, NULL,
                                             NULL));
    CHECK(strstr(told, "logStatusError|r: this FMU offers no scheduled execution"));
    CHECK(!fmi3InstantiateCoSimulation("r", "{token}", "", 0, 0, true, false, NULL, 0, NULL,
                                       logger3, NULL));
    CHECK(strstr(told, "no event mode"));
    CHECK(!fmi3InstantiateCoSimulation("r", "{wrong}", "", 0, 0, false, false, NULL, 0, NULL,
                                       logger3, NULL));
    CHECK(strstr(told, "instantiation token is '{wrong}'"));
    CHECK(!fmi3InstantiateModelExchange("r", "{wrong}", "", 0, 0, NULL, NULL));
    CHECK(fmi3Reset(NULL) == fmi3Error);
}

static void test_arrays(void) {
    fmi3Instance c = started();
    fmi3ValueReference both[] = {TAU, TAU1}, odd[] = {TAU1 + 1}, zero = 0;
    double tau[] = {2.0, 5.0, 7.0, 8.0, 9.0}, back[5];
    OK(fmi3SetFloat64(c, both, 2, tau, 5));
    OK(fmi3GetFloat64(c, both, 2, back, 5));
    CHECK(memcmp(tau, back, sizeof tau) == 0);
    REFUSED(fmi3SetFloat64(c, both, 2, tau, 4), "4 values for 2 variables of 5");
    REFUSED(fmi3GetFloat64(c, both, 2, back, 2), "2 values for 2 variables of 5");
    REFUSED(fmi3GetFloat64(c, odd, 1, back, 1), "no Float64 with value reference 8");
    REFUSED(fmi3GetFloat64(c, &(fmi3ValueReference){COUNTER + 1}, 1, back, 1), "no Float64");
    REFUSED(fmi3GetFloat64(c, &(fmi3ValueReference){DER_COUNTER + 1}, 1, back, 1), "no Float64");
    CHECK(get(c, COUNTER) == 0.0 && get(c, DER_OTHER) == 0.0);
    REFUSED(set(c, COUNTER, 1.0), "r.counter[1] = 1 s: a continuous local cannot be set now");
    REFUSED(fmi3GetFloat64(c, &(fmi3ValueReference){INDICATOR + 1}, 1, back, 1), "no Float64");
    OK(fmi3GetFloat64(c, NULL, 0, NULL, 0));
    OK(set(c, DEGREE, 1.0));
    OK(step(c, 0.0, 0.5));
    CHECK(fabs(get(c, PHI_OUT) - 0.375) < 1e-15);
    CHECK(get(c, TIME) == 0.5 && get(c, DER_W) == 5.0); /* by the torque at the end */
    double nodes[4];
    OK(fmi3GetFloat64(c, &(fmi3ValueReference){W_OUT + 1}, 1, nodes, 4));
    CHECK(nodes[0] == get(c, W_OUT));
    fmi3Int8 small;
    fmi3Binary binary;
    fmi3Clock ticking;
    size_t length;
    REFUSED(fmi3GetInt8(c, &zero, 1, &small, 1), "no Int8 with value reference 0");
    OK(fmi3GetInt8(c, NULL, 0, NULL, 0));
    REFUSED(fmi3GetBinary(c, &zero, 1, &length, &binary, 1), "no Binary");
    REFUSED(fmi3GetClock(c, &zero, 1, &ticking), "no Clock");
    REFUSED(fmi3ActivateModelPartition(c, 0, 0.0), "no model partitions");
    REFUSED(fmi3EnterConfigurationMode(c), "no configuration mode");
    REFUSED(fmi3EnterStepMode(c), "no event mode in co-simulation");
    REFUSED(fmi3EnterEventMode(c), "enterEventMode in step mode");
    REFUSED(fmi3GetNumberOfVariableDependencies(c, 0, &length), "modelDescription.xml");
    REFUSED(fmi3GetAdjointDerivative(c, &zero, 1, &zero, 1, tau, 1, back, 1), "no adjoint");
    fmi3FreeInstance(c);
}

static void test_texts_and_state_machine(void) {
    fmi3Instance c = make();
    fmi3ValueReference inertias = INERTIAS;
    fmi3String name = "heavy.csv";
    REFUSED(step(c, 0, 1e-3), "doStep before the end of initialisation");
    REFUSED(fmi3SetString(c, &inertias, 1, &name, 2), "2 values for 1 Strings");
    OK(fmi3SetString(c, &inertias, 1, &name, 1));
    name = NULL;
    OK(fmi3GetString(c, &inertias, 1, &name, 1));
    CHECK(strcmp(name, "heavy.csv") == 0);
    double start = 0.0;
    OK(fmi3GetFloat64(c, &(fmi3ValueReference){INERTIA}, 1, &start, 1));
    CHECK(start == 2.0);
    REFUSED(fmi3GetFloat64(c, &(fmi3ValueReference){W_OUT}, 1, &start, 1), "no value before");
    REFUSED(fmi3EnterInitializationMode(c, false, 0, NAN, false, 0), "start time nan s");
    OK(fmi3EnterInitializationMode(c, false, 0, 1.0, false, 0));
    REFUSED(fmi3EnterInitializationMode(c, false, 0, 1.0, false, 0), "in initialisation mode");
    OK(fmi3GetString(c, &inertias, 1, &name, 1));
    CHECK(strcmp(name, "heavy.csv") == 0);
    OK(set(c, TAU, 10.0));
    CHECK(get(c, A) == 1.0);
    OK(fmi3ExitInitializationMode(c));
    REFUSED(set(c, INERTIA, 1.0), "a fixed parameter cannot be set now");
    OK(fmi3Terminate(c));
    REFUSED(step(c, 1.0, 1e-3), "doStep after terminate");
    OK(fmi3Reset(c));
    OK(fmi3EnterInitializationMode(c, false, 0, 0.0, false, 0));
    CHECK(get(c, TIME) == 0.0);
    fmi3FreeInstance(c);
}

static void test_fmu_state(void) {
    fmi3Instance c = started();
    fmi3FMUState state = NULL, copy = NULL;
    OK(set(c, TAU, 1.0));
    OK(step(c, 0.0, 0.25));
    OK(fmi3GetFMUState(c, &state));
    size_t size;
    OK(fmi3SerializedFMUStateSize(c, state, &size));
    fmi3Byte *bytes = malloc(size);
    OK(fmi3SerializeFMUState(c, state, bytes, size));
    OK(step(c, 0.25, 0.25));
    double phi = get(c, PHI_OUT);
    fmi3Instance d = make();
    OK(fmi3DeserializeFMUState(d, bytes, size, &copy));
    OK(fmi3SetFMUState(d, copy));
    OK(step(d, 0.25, 0.25));
    CHECK(get(d, PHI_OUT) == phi);
    OK(fmi3SetFMUState(c, state));
    CHECK(get(c, TIME) == 0.25);
    OK(fmi3FreeFMUState(c, &state));
    REFUSED(fmi3SetFMUState(c, copy), "no such FMU state");
    fmi3Instance e = fmi3InstantiateModelExchange("e", "{token}", folder, 0, 0, NULL, logger3);
    state = NULL;
    REFUSED(fmi3DeserializeFMUState(e, bytes, size, &state), "an instance for co-simulation");
    free(bytes);
    fmi3FreeInstance(c);
    fmi3FreeInstance(d);
    fmi3FreeInstance(e);
}

static void test_derivatives(void) {
    fmi3Instance c = started();
    fmi3ValueReference tau = TAU, of[] = {A, DER_W, PHI_OUT}, by[] = {TAU, PHI};
    fmi3Int32 order = 1;
    double slope, sensitivity[3], seed[] = {3.0, 0.5};
    OK(set(c, TAU, 4.0));
    OK(step(c, 0.0, 0.5));
    OK(set(c, TAU, 5.0));
    double before = get(c, A);
    OK(fmi3GetOutputDerivatives(c, &(fmi3ValueReference){W_OUT}, 1, &order, &slope, 1));
    CHECK(slope == 4.0);
    REFUSED(fmi3GetOutputDerivatives(c, &tau, 1, &order, &slope, 1), "no output");
    OK(fmi3GetDirectionalDerivative(c, of, 3, by, 2, seed, 2, sensitivity, 3));
    CHECK(sensitivity[0] == 3.0 && sensitivity[1] == 3.0 && sensitivity[2] == 0.5);
    CHECK(get(c, A) == before); /* outputs stay those of the last step */
    REFUSED(fmi3GetDirectionalDerivative(c, &tau, 1, by, 1, seed, 1, sensitivity, 1),
            "no output or derivative with value reference 6");
    REFUSED(fmi3GetDirectionalDerivative(c, of, 1, of, 1, seed, 1, sensitivity, 1),
            "no input or state");
    OK(fmi3GetDirectionalDerivative(c, of, 1, NULL, 0, NULL, 0, sensitivity, 1));
    CHECK(sensitivity[0] == 0.0);
    fmi3FreeInstance(c);
    c = make(); /* the first thing that is asked for: the resources are read */
    REFUSED(fmi3GetDirectionalDerivative(c, of, 1, by, 1, seed, 1, sensitivity, 1),
            "getDirectionalDerivative before initialisation");
    OK(fmi3EnterInitializationMode(c, false, 0, 0.0, false, 0));
    OK(fmi3GetDirectionalDerivative(c, of, 1, by, 1, seed, 1, sensitivity, 1));
    CHECK(sensitivity[0] == 3.0);
    fmi3FreeInstance(c);
}

int main(int count, char **arguments) {
    folder = count > 1 ? arguments[1] : ".";
    test_instantiate();
    test_arrays();
    test_texts_and_state_machine();
    test_fmu_state();
    test_derivatives();
    return report();
}
