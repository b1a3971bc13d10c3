/* FMI 2.0 co-simulation: values, states, derivatives, and every misuse gets a status and a message. */
#include <locale.h>
#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "rotor.h"

static const char *folder;

static fmi2Component make(const char *name) {
    return fmi2Instantiate(name, fmi2CoSimulation, "{token}", folder, &functions2, fmi2False,
                           fmi2False);
}

static fmi2Component started(void) {
    fmi2Component c = make("r");
    OK(fmi2SetupExperiment(c, fmi2False, 0, 0.0, fmi2False, 0));
    OK(fmi2EnterInitializationMode(c));
    OK(fmi2ExitInitializationMode(c));
    return c;
}

static fmi2Status set(fmi2Component c, fmi2ValueReference vr, double value) {
    return fmi2SetReal(c, &vr, 1, &value);
}

static double get(fmi2Component c, fmi2ValueReference vr) {
    double value = NAN;
    OK(fmi2GetReal(c, &vr, 1, &value));
    return value;
}

static fmi2Status name_file(fmi2Component c, fmi2ValueReference vr, const char *name) {
    return fmi2SetString(c, &vr, 1, &name);
}

static void test_instantiate(void) {
    told[0] = '\0';
    CHECK(!fmi2Instantiate("r", fmi2CoSimulation, "{other}", folder, &functions2, 0, 0));
    CHECK(strstr(told, "logStatusError|r: the GUID") && strstr(told, "'{other}'"));
    CHECK(!fmi2Instantiate(NULL, fmi2CoSimulation, "{token}", folder, &functions2, 0, 0));
    CHECK(strstr(told, "needs a name"));
    CHECK(!fmi2Instantiate("r", fmi2CoSimulation, NULL, NULL, NULL, 0, 0));
    fmi2FreeInstance(NULL);
    CHECK(fmi2DoStep(NULL, 0, 1, fmi2False) == fmi2Error);
}

static void test_values(void) {
    fmi2Component c = make("r");
    OK(fmi2SetupExperiment(c, fmi2False, 0, 2.0, fmi2False, 0));
    OK(set(c, W, 3.0));
    OK(set(c, INERTIA, 4.0));
    OK(fmi2EnterInitializationMode(c));
    OK(set(c, TAU, 8.0));
    CHECK(get(c, W_OUT) == 3.0);
    CHECK(get(c, A) == 8.0 / (4.0 * 0.5)); /* gain 0.5 kg at a speed in rad/s */
    OK(set(c, TAU, 4.0));
    CHECK(get(c, A) == 2.0);       /* outputs follow inputs */
    CHECK(get(c, TORQUE) == 4.75); /* offset: the sum of all shapes */
    OK(fmi2ExitInitializationMode(c));
    CHECK(get(c, W_OUT + 4) == 3.0);
    OK(fmi2DoStep(c, 2.0, 0.5, fmi2True));
    CHECK(get(c, W_OUT) == 4.0 && get(c, PHI_OUT) == 0.5 * (3.0 + 4.0) * 0.5);
    OK(fmi2DoStep(c, 2.5, 0.0, fmi2True));
    OK(fmi2DoStep(c, 2.5, 1e-16, fmi2True));
    CHECK(get(c, STEPS) == 3.0);
    CHECK(get(c, DER_PHI) == get(c, W_OUT));
    OK(fmi2DoStep(c, 2.5, 0.5, fmi2True));
    CHECK(get(c, DER_PHI) == get(c, W_OUT));
    OK(fmi2DoStep(c, 2.5, 1e-16, fmi2True));
    double last;
    OK(fmi2GetRealStatus(c, fmi2LastSuccessfulTime, &last));
    CHECK(last == 2.5 + 1e-16);
    OK(fmi2Terminate(c));
    CHECK(get(c, W_OUT) > 0.0);
    OK(fmi2Reset(c));
    OK(fmi2EnterInitializationMode(c));
    CHECK(get(c, INERTIA) == 2.0 && get(c, W) == 0.0);
    OK(fmi2ExitInitializationMode(c));
    CHECK(get(c, STEPS) == 0.0);
    fmi2FreeInstance(c);
}

static void test_refused_values(void) {
    fmi2Component c = make("r");
    double value = 0;
    fmi2ValueReference unknown[] = {W, COUNTER + 1, GAIN, 4000000000u};
    double values[4];
    OK(fmi2EnterInitializationMode(c));
    REFUSED(fmi2GetReal(c, unknown, 4, values), "no Real with value reference 4000000000");
    REFUSED(fmi2SetReal(c, unknown + 1, 1, &value), "no Real with value reference 3");
    REFUSED(set(c, TAU, NAN), "r.tau = nan N.m: it must be finite");
    REFUSED(set(c, INERTIA, INFINITY), "it must be finite");
    REFUSED(set(c, INERTIA, 0.0), "r.inertia = 0 kg.m2: it must lie between 1e-09 and 1e+09");
    REFUSED(set(c, DEGREE, 5.0), "r.interface_degree = 5: it must lie between 0 and 4");
    REFUSED(set(c, DEGREE, 1.5), "it must be a whole number");
    REFUSED(set(c, W_OUT, 1.0), "a continuous output cannot be set now");
    REFUSED(set(c, STEPS, 1.0), "a continuous local cannot be set now");
    fmi2ValueReference two[] = {INERTIA, RATIO};
    REFUSED(fmi2SetReal(c, two, 2, (double[]){-1.0, 0.5}), "it must lie between");
    CHECK(get(c, INERTIA) == 2.0 && get(c, TAU) == 0.0 && get(c, DEGREE) == 0.0);
    fmi2ValueReference zero = 0;
    fmi2Integer integer = 1;
    fmi2Boolean boolean = 1;
    fmi2String text = NULL;
    REFUSED(fmi2GetInteger(c, &zero, 1, &integer), "no Integer with value reference 0");
    REFUSED(fmi2SetBoolean(c, &zero, 1, &boolean), "no Boolean");
    REFUSED(fmi2GetString(c, &zero, 1, &text), "no String with value reference 0");
    REFUSED(fmi2SetString(c, &(fmi2ValueReference){INERTIAS}, 1, &text), "takes a file name");
    fmi2FreeInstance(c);
    c = started();
    REFUSED(set(c, INERTIA, 3.0), "a fixed parameter cannot be set now");
    REFUSED(set(c, W, 3.0), "a continuous local cannot be set now");
    REFUSED(name_file(c, INERTIAS, "x.csv"), "r.inertias = 'x.csv': it cannot be set now");
    OK(set(c, DEGREE, 2.0));
    fmi2FreeInstance(c);
}

static void test_state_machine(void) {
    fmi2Component c = make("r");
    fmi2String text;
    fmi2ValueReference reals[] = {INERTIA}, texts[] = {INERTIAS};
    double start = 0.0;
    OK(fmi2GetReal(c, reals, 1, &start));
    CHECK(start == 2.0);
    OK(fmi2GetString(c, texts, 1, &text));
    CHECK(strcmp(text, "inertias.csv") == 0);
    reals[0] = W_OUT;
    REFUSED(fmi2GetReal(c, reals, 1, &start), "it has no value before initialisation");
    CHECK(isnan(start));
    REFUSED(fmi2DoStep(c, 0, 1e-3, 1), "doStep before the end of initialisation");
    REFUSED(fmi2ExitInitializationMode(c), "exitInitializationMode before initialisation");
    REFUSED(fmi2Terminate(c), "terminate before initialisation");
    REFUSED(fmi2SetupExperiment(c, 0, 0, NAN, 0, 0), "start time nan s");
    OK(fmi2EnterInitializationMode(c));
    REFUSED(fmi2EnterInitializationMode(c), "in initialisation mode");
    REFUSED(fmi2SetupExperiment(c, 0, 0, 0, 0, 0), "setupExperiment in initialisation mode");
    REFUSED(fmi2DoStep(c, 0, 1e-3, 1), "doStep before the end of initialisation");
    OK(fmi2ExitInitializationMode(c));
    REFUSED(fmi2DoStep(c, 0, -1.0, 1), "step size -1 s");
    REFUSED(fmi2DoStep(c, 0, NAN, 1), "step size nan s");
    REFUSED(fmi2DoStep(c, 0, INFINITY, 1), "step size inf s");
    REFUSED(fmi2DoStep(c, NAN, 1e-3, 1), "communication point nan s");
    OK(set(c, TAU, 1e308));
    GIVES(fmi2Discard, fmi2DoStep(c, 0, 1e300, 1), "r.phi = inf rad after a step of 1e+300 s");
    REFUSED(fmi2CancelStep(c), "not asynchronous");
    REFUSED(fmi2GetStatus(c, fmi2DoStepStatus, NULL), "no status of this kind");
    OK(fmi2Terminate(c));
    REFUSED(fmi2DoStep(c, 0, 1e-3, 1), "doStep after terminate");
    REFUSED(set(c, TAU, 1.0), "setReal after terminate");
    REFUSED(fmi2Terminate(c), "terminate after terminate");
    fmi2FreeInstance(c);
}

static void run(fmi2Component c, int first, int count) {
    for (int n = first; n < first + count; n++) {
        OK(set(c, TAU, 1.0 + n % 7));
        OK(fmi2DoStep(c, n * 1e-3, 1e-3, 1));
    }
}

static void test_fmu_state(void) {
    fmi2Component c = started(), d = make("other");
    fmi2FMUstate saved = NULL, copy = NULL, stale;
    run(c, 0, 10);
    OK(fmi2GetFMUstate(c, &saved));
    run(c, 10, 10);
    double phi = get(c, PHI_OUT);
    OK(fmi2SetFMUstate(c, saved));
    run(c, 10, 10);
    CHECK(get(c, PHI_OUT) == phi && get(c, STEPS) == 20.0);
    size_t size;
    OK(fmi2SerializedFMUstateSize(c, saved, &size));
    char *bytes = malloc(size);
    REFUSED(fmi2SerializeFMUstate(c, saved, bytes, size - 1), "bytes for an FMU state of");
    OK(fmi2SerializeFMUstate(c, saved, bytes, size));
    OK(fmi2DeSerializeFMUstate(d, bytes, size, &copy));
    OK(fmi2SetFMUstate(d, copy)); /* reads the resources, which are not read yet */
    run(d, 10, 10);
    CHECK(get(d, PHI_OUT) == phi);
    REFUSED(fmi2SetFMUstate(c, copy), "no such FMU state");
    stale = saved;
    OK(fmi2FreeFMUstate(c, &saved));
    CHECK(saved == NULL);
    OK(fmi2FreeFMUstate(c, &saved));
    saved = stale;
    REFUSED(fmi2FreeFMUstate(c, &saved), "no such FMU state; it was freed");
    REFUSED(fmi2SetFMUstate(c, saved), "no such FMU state");
    REFUSED(fmi2GetFMUstate(c, &saved), "no such FMU state");
    REFUSED(fmi2SetFMUstate(c, NULL), "no such FMU state");
    for (size_t i = 0; i < size; i++) { /* whatever byte is damaged */
        bytes[i] ^= 0x10;
        fmi2FMUstate damaged = NULL;
        REFUSED(fmi2DeSerializeFMUstate(d, bytes, size, &damaged), "state");
        REFUSED(fmi2DeSerializeFMUstate(d, bytes, i, &damaged), "state");
        CHECK(damaged == NULL);
        bytes[i] ^= 0x10;
    }
    for (size_t i = 0; i + 8 < size; i++)
        if (memcmp(bytes + i, "version", 7) == 0)
            bytes[i] = 'V';
    REFUSED(fmi2DeSerializeFMUstate(d, bytes, size, &saved),
            "belongs to 'rotor Version1', not to 'rotor version1'");
    free(bytes);
    fmi2FMUstate other = NULL;
    OK(fmi2GetFMUstate(c, &other));
    OK(fmi2Reset(c));
    OK(name_file(c, INERTIAS, "heavy.csv"));
    OK(fmi2EnterInitializationMode(c));
    OK(fmi2ExitInitializationMode(c));
    REFUSED(fmi2SetFMUstate(c, other),
            "over other contents of inertias = 'inertias.csv', shapes = 'shapes.csv'");
    fmi2FreeInstance(c); /* frees `other`, which the host forgot */
    fmi2FreeInstance(d);
}

static void refused_file(const char *name, const char *text) {
    fmi2Component c = make("r");
    double value;
    OK(name_file(c, INERTIAS, name));
    OK(fmi2EnterInitializationMode(c));
    REFUSED(fmi2GetReal(c, &(fmi2ValueReference){A}, 1, &value), text);
    REFUSED(fmi2ExitInitializationMode(c), text);
    OK(name_file(c, INERTIAS, "inertias.csv"));
    OK(fmi2ExitInitializationMode(c));
    fmi2FreeInstance(c);
}

static void test_resources(void) {
    refused_file("missing.csv", "r.inertias = 'missing.csv': there is no file ");
    refused_file("missing.csv", "; give an absolute path or a name in ");
    refused_file("", "there is no file");
    refused_file("empty.csv", "empty.csv: the first line must be '# units: <column> <unit>, ...'");
    refused_file("no_units.csv", "the first line must be");
    refused_file("unit.csv", "column 'mass' has unit 'g' in the '# units:' line; it takes kg");
    refused_file("other_unit.csv", "column 'speed' has unit 'none'");
    refused_file("other_unit.csv", "it takes r/min or rad/s");
    refused_file("no_rows.csv", "no_rows.csv: it has no rows");
    refused_file("twice.csv", "column mass stands twice");
    refused_file("column.csv", "column mass is missing; it has side, speed, masse");
    refused_file("extra.csv", "column colour is unknown");
    refused_file("short.csv", "short.csv, line 5: 2 fields, 3 expected");
    refused_file("number.csv", "number.csv, line 4: mass = '0x10' is not a finite number");
    refused_file("nan.csv", "mass = 'nan' is not a finite number");
    refused_file("huge.csv", "mass = '1e999' is not a finite number");
    refused_file("word.csv", "word.csv: side 'top' is none of left, right");
    refused_file("binary.csv", "binary.csv: it is no UTF-8 text");
    refused_file("quote.csv", "line 4: a quote is not closed");
    refused_file("quotes.csv", "line 4: mass = '0\"5,' is not a finite number");
    refused_file("negative.csv", "negative.csv: mass -1 kg in row 2 must be positive");
    fmi2Component c = make("r");
    OK(name_file(c, INERTIAS, "excel.csv")); /* byte order mark, CRLF, quotes, another order, r/min */
    OK(fmi2EnterInitializationMode(c));
    OK(set(c, TAU, 10.0));
    CHECK(get(c, A) == 1.0);
    OK(name_file(c, INERTIAS, "inertias.csv")); /* read again at the next get */
    CHECK(get(c, A) == 10.0 && get(c, TORQUE) == 10.75);
    CHECK(get(c, DER_W) == 10.0);
    OK(set(c, TAU, 20.0));
    CHECK(get(c, DER_W) == 20.0);
    OK(name_file(c, INERTIAS, "heavy.csv"));
    CHECK(get(c, DER_W) == 2.0);
    OK(name_file(c, INERTIAS, "schwer gr\xC3\xB6\xC3\x9F" "er.csv"));
    CHECK(get(c, A) == 2.0);
    OK(name_file(c, SHAPES, "one_shape.csv"));
    REFUSED(fmi2ExitInitializationMode(c), "one_shape.csv: 1 rows, 2 expected");
    fmi2FreeInstance(c);
}

/* A URI as of FMI 2.0, with an encoded letter: the resources are found in its folder. */
static void test_location(void) {
    char uri[4096];
    snprintf(uri, sizeof uri, "file://localhost%s%.*s%%%02X", *folder == '/' ? "" : "/",
             (int)strlen(folder) - 1, folder, (unsigned)folder[strlen(folder) - 1]);
    fmi2Component c =
        fmi2Instantiate("r", fmi2CoSimulation, "{token}", uri, &functions2, fmi2False, fmi2False);
    OK(fmi2EnterInitializationMode(c));
    OK(fmi2ExitInitializationMode(c));
    fmi2FreeInstance(c);
}

static void test_long_message(void) {
    static char name[2001];
    memset(name, '\xA9', 2000);
    for (int shift = 0; shift < 2; shift++) {
        for (int i = shift; i < 2000; i += 2)
            name[i] = '\xC3';
        name[0] = shift ? '-' : name[0];
        fmi2Component c = make(name);
        GIVES(fmi2Error, fmi2DoStep(c, 0, 1, 1), "\xA9 (t = 0 s)"); /* the last letter is whole */
        fmi2FreeInstance(c);
        memset(name, '\xA9', 2000);
    }
}

static void test_derivatives(void) {
    fmi2Component c = started(), d = started();
    fmi2ValueReference tau = TAU, outputs[] = {PHI_OUT, W_OUT, TORQUE, A}, node = TAU1;
    fmi2Integer first = 1, five = 5, orders[] = {1, 1, 1, 1};
    double slope = 6.0, slopes[4];
    REFUSED(fmi2SetRealInputDerivatives(c, &node, 1, &first, &slope), "no input");
    REFUSED(fmi2SetRealInputDerivatives(c, &tau, 1, &five, &slope), "orders 1 to 4 are known");
    REFUSED(fmi2SetRealInputDerivatives(c, &tau, 1, &first, &(double){NAN}), "it must be finite");
    OK(fmi2GetRealOutputDerivatives(c, outputs, 4, orders, slopes));
    CHECK(slopes[2] == 0.0);
    OK(set(c, TAU, 2.0));
    OK(fmi2DoStep(c, 0, 0.0, 1)); /* outputs follow the input */
    OK(fmi2SetRealInputDerivatives(c, &tau, 1, &first, &slope));
    fmi2FMUstate state = NULL;
    OK(fmi2GetFMUstate(c, &state));
    OK(fmi2DoStep(c, 0, 0.5, 1));
    /* tau = 2 + 6 t, inertia 1: w = 2 t + 3 t^2, phi = t^2 + t^3 */
    CHECK(fabs(get(c, W_OUT) - 1.75) < 1e-15 && fabs(get(c, PHI_OUT) - 0.375) < 1e-15);
    OK(fmi2GetRealOutputDerivatives(c, outputs, 4, orders, slopes));
    CHECK(slopes[0] == get(c, W_OUT) && slopes[1] == 5.0 && slopes[2] == 6.0);
    OK(set(d, DEGREE, 1.0)); /* the same signal as a node */
    OK(set(d, TAU, 2.0));
    OK(set(d, TAU1, 5.0));
    OK(fmi2DoStep(d, 0, 0.5, 1));
    CHECK(get(d, PHI_OUT) == get(c, PHI_OUT) && get(c, DEGREE) == 0.0);
    double phi = get(c, PHI_OUT);
    OK(fmi2DoStep(c, 0.5, 0.5, 1)); /* a derivative ends with its step */
    CHECK(fabs(get(c, W_OUT) - 2.75) < 1e-15);
    OK(fmi2SetFMUstate(c, state)); /* with the derivative that was set */
    OK(fmi2DoStep(c, 0, 0.5, 1));
    CHECK(get(c, PHI_OUT) == phi);
    REFUSED(fmi2SetRealInputDerivatives(d, &tau, 1, &first, &slope),
            "input derivatives need interface_degree = 0, but it is 1");
    REFUSED(fmi2GetRealOutputDerivatives(c, &tau, 1, &first, slopes), "no output");
    REFUSED(fmi2GetRealOutputDerivatives(c, outputs, 1, &five, slopes), "order 1 is known");
    OK(fmi2SetRealInputDerivatives(c, &tau, 1, &first, &slope));
    OK(set(c, DEGREE, 1.0));
    REFUSED(fmi2DoStep(c, 0, 0.5, 1), "it must be 0 in a step along input derivatives");
    fmi2FreeInstance(c);
    fmi2FreeInstance(d);
    c = started();
    fmi2Integer third = 3; /* tau = 24 t^3 / 3!, w = t^4 */
    OK(fmi2SetRealInputDerivatives(c, &tau, 1, &third, &(double){24.0}));
    OK(fmi2DoStep(c, 0, 0.5, 1));
    CHECK(fabs(get(c, W_OUT) - 0.0625) < 1e-15);
    OK(fmi2GetRealOutputDerivatives(c, outputs + 2, 1, orders, slopes));
    CHECK(fabs(slopes[0] - 12.0 * 0.25) < 1e-13); /* the nodes carry the cubic exactly */
    OK(fmi2SetRealInputDerivatives(c, &tau, 1, &first, &(double){0.0}));
    double w = get(c, W_OUT);
    OK(fmi2DoStep(c, 0.5, 0.5, 1));
    CHECK(get(c, W_OUT) == w); /* the former derivative is forgotten */
    OK(set(c, DEGREE, 1.0));
    OK(fmi2DoStep(c, 1.0, 0.5, 1));
    fmi2FreeInstance(c);
}

/* The kernels cache functions of the parameters and tables. */
static void test_work_space(void) {
    fmi2Component c = make("r");
    fmi2FMUstate fresh = NULL, stepped = NULL;
    OK(set(c, TAU, 1.0));
    OK(fmi2GetFMUstate(c, &fresh));
    OK(fmi2EnterInitializationMode(c));
    OK(fmi2ExitInitializationMode(c));
    OK(fmi2DoStep(c, 0, 1.0, 1));
    OK(fmi2GetFMUstate(c, &stepped));
    CHECK(get(c, W_OUT) == 1.0);
    OK(set(c, RATIO, 2.0));
    OK(fmi2DoStep(c, 1, 1.0, 1));
    CHECK(get(c, W_OUT) == 3.0);
    OK(fmi2SetFMUstate(c, stepped)); /* with the former ratio */
    OK(fmi2DoStep(c, 1, 1.0, 1));
    CHECK(get(c, W_OUT) == 2.0);
    OK(fmi2SetFMUstate(c, fresh)); /* before the files were read */
    OK(name_file(c, INERTIAS, "heavy.csv"));
    OK(fmi2EnterInitializationMode(c));
    OK(fmi2ExitInitializationMode(c));
    OK(fmi2DoStep(c, 0, 1.0, 1));
    CHECK(fabs(get(c, W_OUT) - 0.1) < 1e-15);
    fmi2FreeInstance(c);
}

static void test_logging(void) {
    fmi2Component c = make("100%");
    double value = 0.0;
    fmi2ValueReference bad = 999;
    fmi2String warnings[] = {"logStatusWarning"}, wrong[] = {"logNothing"}, all[] = {"logAll"};
    REFUSED(fmi2SetReal(c, &bad, 1, &value), "logStatusError|100%%: there is no Real");
    REFUSED(fmi2SetDebugLogging(c, fmi2True, 1, wrong), "no log category 'logNothing'");
    OK(fmi2SetDebugLogging(c, fmi2True, 1, warnings));
    told[0] = '\0';
    CHECK(fmi2SetReal(c, &bad, 1, &value) == fmi2Error && told[0] == '\0');
    OK(fmi2SetDebugLogging(c, fmi2True, 1, all));
    OK(fmi2EnterInitializationMode(c));
    GIVES(fmi2OK, fmi2ExitInitializationMode(c), "logAll|100%%: read ");
    OK(fmi2SetDebugLogging(c, fmi2False, 0, NULL));
    REFUSED(fmi2GetReal(c, &bad, 1, &value), "no Real");
    fmi2FreeInstance(c);
}

/* Arguments: folder of the resources; decimal point of the locale in which the host runs. */
int main(int count, char **arguments) {
    folder = count > 1 ? arguments[1] : ".";
    setlocale(LC_ALL, "");
    CHECK(count < 3 || strcmp(localeconv()->decimal_point, arguments[2]) == 0);
    test_instantiate();
    test_values();
    test_refused_values();
    test_state_machine();
    test_fmu_state();
    test_resources();
    test_derivatives();
    test_work_space();
    test_location();
    test_long_message();
    test_logging();
    return report();
}
