/* Calls of FMI 2.0 and 3.0 in random orders, with wrong values too, on a component: whatever is called,
   a call succeeds, or is refused with one line. States that were saved are given to any instance, also
   after they were freed with their own one. Instances that are reset begin anew.

   Arguments: folder of the resources, number of calls. Linked with the wrapper and a component. */
#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "component.h"

extern const HbComponent hb_component;
enum { PLACES = 3, SAVED = 4, MOST = 7, STATES = 512 };

static const char *folder;
static double now[PLACES];
static void *instance[PLACES];
static int version[PLACES], exchange[PLACES];
static void *saved[SAVED];
static int saved_by[SAVED]; /* FMI version */
static char resources[4200];
static long steps;

static size_t below(size_t limit) {
    static unsigned long long state = 0x9E3779B97F4A7C15u;
    state ^= state << 13, state ^= state >> 7, state ^= state << 17;
    return (size_t)(state % limit);
}

static double some(void) {
    static const double odd[] = {0.0, -0.0, 1.0, -1.0, 1e-300, 1e300, INFINITY, -INFINITY, NAN, 1e9};
    if (below(4) == 0) return odd[below(sizeof odd / sizeof *odd)];
    return ((double)below(2000001) / 1e6 - 1.0) * pow(10.0, (double)below(12) - 8.0);
}
static double some_time(int k) {
    return below(8) ? now[k] : some();
}
static double some_step(void) {
    static const double steps[] = {1e-5, 2.5e-6, 1e-6, 1e-16, 0.0, 1e-4, -1e-5, NAN, INFINITY, 1e9};
    return steps[below(3) ? below(3) : below(sizeof steps / sizeof *steps)];
}
static unsigned some_reference(void) {
    return below(16) ? (unsigned)below(hb_component.first_table) : (unsigned)below(1u << 31);
}

/* What an instance gave back: 0 ok ... 4 fatal, and one line if it is an error. */
static void seen(int status) {
    CHECK(status >= 0 && status <= 4);
    if (status >= 3) CHECK(told[0] && !strchr(told, '\n'));
    told[0] = '\0';
}

static void make(int k) {
    char path[4300];
    const char *token = below(50) ? hb_component.token : "{wrong}";
    version[k] = 2 + (int)below(2), exchange[k] = below(3) == 0, now[k] = 0.0;
    snprintf(path, sizeof path, "%s%s%s", version[k] == 2 ? "file://" : "", folder, below(50) ? "" : "/none");
    if (version[k] == 2) {
        instance[k] = fmi2Instantiate("c", exchange[k] ? fmi2ModelExchange : fmi2CoSimulation, token,
                                      path, &functions2, 0, 0);
    } else {
        instance[k] = exchange[k] ? fmi3InstantiateModelExchange("c", token, path, 0, 0, NULL, logger3)
                                  : fmi3InstantiateCoSimulation("c", token, path, 0, 0, 0, 0, NULL, 0,
                                                                NULL, logger3, NULL);
    }
    told[0] = '\0';
}

static void drop(int k) {
    version[k] == 2 ? fmi2FreeInstance(instance[k]) : fmi3FreeInstance(instance[k]);
    instance[k] = NULL;
}

static void enter(int k, double start) {
    void *c = instance[k];
    int stops = below(2) == 0;
    double stop = start + fabs(some());
    if (version[k] == 3) {
        seen((int)fmi3EnterInitializationMode(c, below(3) == 0, some(), start, stops, stop));
    } else {
        if (below(8)) seen((int)fmi2SetupExperiment(c, below(3) == 0, some(), start, stops, stop));
        seen((int)fmi2EnterInitializationMode(c));
    }
    now[k] = isfinite(start) ? start : 0.0;
}

static void leave(int k) {
    void *c = instance[k];
    seen(version[k] == 2 ? (int)fmi2ExitInitializationMode(c) : (int)fmi3ExitInitializationMode(c));
}

static void exchange_reals(int k, int set) {
    unsigned references[MOST];
    double values[MOST];
    size_t n = below(MOST);
    void *c = instance[k];
    for (size_t i = 0; i < n; i++) references[i] = some_reference(), values[i] = some();
    if (version[k] == 2)
        seen(set ? (int)fmi2SetReal(c, references, n, values) : (int)fmi2GetReal(c, references, n, values));
    else
        seen(set ? (int)fmi3SetFloat64(c, references, n, values, n)
                 : (int)fmi3GetFloat64(c, references, n, values, n));
}

static void step(int k) {
    void *c = instance[k];
    double h = some_step(), t = some_time(k), last;
    bool event, terminate, early;
    int status = version[k] == 2 ? (int)fmi2DoStep(c, t, h, below(2) == 0)
                                 : (int)fmi3DoStep(c, t, h, below(2) == 0, &event, &terminate, &early, &last);
    if (status == 0) now[k] = t + h, steps++;
    if (status != 2) seen(status);
    told[0] = '\0';
}

static void forget(int k, int s) {
    void *c = instance[k];
    if (!saved[s]) return;
    int status = version[k] == 2 ? (int)fmi2FreeFMUstate(c, &saved[s]) : (int)fmi3FreeFMUState(c, &saved[s]);
    seen(status);
    CHECK((status == 0) == !saved[s]);
    saved[s] = NULL;
}

/* Save, restore, free; of serialised states also damaged ones. */
static void states(int k) {
    int s = (int)below(SAVED), two = version[k] == 2;
    void *c = instance[k];
    if (saved[s] && saved_by[s] != version[k]) return;
    switch (below(4)) {
    case 0: {
        int status = two ? (int)fmi2GetFMUstate(c, &saved[s]) : (int)fmi3GetFMUState(c, &saved[s]);
        seen(status);
        if (status == 0) saved_by[s] = version[k];
        break;
    }
    case 1:
        if (saved[s]) seen(two ? (int)fmi2SetFMUstate(c, saved[s]) : (int)fmi3SetFMUState(c, saved[s]));
        break;
    case 2: forget(k, s); break;
    default: {
        size_t size = 0;
        void *again = NULL;
        if (!saved[s]) return;
        seen(two ? (int)fmi2SerializedFMUstateSize(c, saved[s], &size)
                 : (int)fmi3SerializedFMUStateSize(c, saved[s], &size));
        if (size == 0) return;
        char *bytes = malloc(size);
        seen(two ? (int)fmi2SerializeFMUstate(c, saved[s], bytes, size)
                 : (int)fmi3SerializeFMUState(c, saved[s], (unsigned char *)bytes, size));
        if (below(2)) bytes[below(size)] ^= (char)(1 + below(255));
        size_t given = below(4) ? size : below(size);
        int status = two ? (int)fmi2DeSerializeFMUstate(c, bytes, given, &again)
                         : (int)fmi3DeserializeFMUState(c, (unsigned char *)bytes, given, &again);
        seen(status);
        free(bytes);
        if (status == 0) {
            seen(two ? (int)fmi2SetFMUstate(c, again) : (int)fmi3SetFMUState(c, again));
            seen(two ? (int)fmi2FreeFMUstate(c, &again) : (int)fmi3FreeFMUState(c, &again));
        }
    }
    }
}

static void words(int k) {
    static const char *const names[] = {"", "none.csv", "../none.csv", "x\ny.csv", "/"};
    const char *word = names[below(sizeof names / sizeof *names)];
    unsigned reference = hb_component.first_table + (unsigned)below(4);
    if (below(2)) reference = some_reference();
    void *c = instance[k];
    if (below(4) == 0)
        seen(version[k] == 2 ? (int)fmi2SetString(c, &reference, 1, &word)
                             : (int)fmi3SetString(c, &reference, 1, &word, 1));
    seen(version[k] == 2 ? (int)fmi2GetString(c, &reference, 1, &word)
                         : (int)fmi3GetString(c, &reference, 1, &word, 1));
}

static void continuous(int k) {
    static double x[STATES], known[1] = {1.0};
    unsigned of[1] = {some_reference()}, by[1] = {some_reference()};
    void *c = instance[k];
    size_t n = 0;
    if (fmi3GetNumberOfContinuousStates(c, &n) != fmi3OK || n > STATES) n = below(STATES);
    if (below(16) == 0) n = below(STATES);
    int two = version[k] == 2;
    told[0] = '\0';
    switch (below(8)) {
    case 0: seen(two ? (int)fmi2EnterContinuousTimeMode(c) : (int)fmi3EnterContinuousTimeMode(c)); break;
    case 1: seen(two ? (int)fmi2EnterEventMode(c) : (int)fmi3EnterEventMode(c)); break;
    case 2: seen(two ? (int)fmi2SetTime(c, some_time(k)) : (int)fmi3SetTime(c, some_time(k))); break;
    case 3: seen(two ? (int)fmi2GetContinuousStates(c, x, n) : (int)fmi3GetContinuousStates(c, x, n)); break;
    case 4:
        if (n && below(4) == 0) x[below(n)] = some();
        seen(two ? (int)fmi2SetContinuousStates(c, x, n) : (int)fmi3SetContinuousStates(c, x, n));
        break;
    case 5: {
        static double dx[STATES];
        seen(two ? (int)fmi2GetDerivatives(c, dx, n) : (int)fmi3GetContinuousStateDerivatives(c, dx, n));
        break;
    }
    case 6: {
        fmi2EventInfo info;
        bool more, end, changed, moved, next;
        double when;
        seen(two ? (int)fmi2NewDiscreteStates(c, &info)
                 : (int)fmi3UpdateDiscreteStates(c, &more, &end, &changed, &moved, &next, &when));
        break;
    }
    default:
        seen(two ? (int)fmi2GetDirectionalDerivative(c, of, 1, by, 1, known, x)
                 : (int)fmi3GetDirectionalDerivative(c, of, 1, by, 1, known, 1, x, 1));
    }
}

static void call(int k) {
    void *c = instance[k];
    switch (below(16)) {
    case 0: case 1: case 2: step(k); break;
    case 3: case 4: exchange_reals(k, 1); break;
    case 5: case 6: exchange_reals(k, 0); break;
    case 7: case 8: states(k); break;
    case 9: continuous(k); break;
    case 10: words(k); break;
    case 11:
        if (below(4) == 0) seen(version[k] == 2 ? (int)fmi2Reset(c) : (int)fmi3Reset(c));
        break;
    case 12:
        if (below(16) == 0) seen(version[k] == 2 ? (int)fmi2Terminate(c) : (int)fmi3Terminate(c));
        break;
    case 13: enter(k, below(2) ? 0.0 : some()); break;
    case 14: leave(k); break;
    default:
        if (below(8) == 0) drop(k);
    }
}

/* Values after ten steps from a start time; those that are not shown are 0. */
static void run(void *c, double start, double *found, size_t count) {
    OK(fmi2SetupExperiment(c, fmi2False, 0.0, start, fmi2False, 0.0));
    OK(fmi2EnterInitializationMode(c));
    OK(fmi2ExitInitializationMode(c));
    for (int n = 0; n < 10; n++) OK(fmi2DoStep(c, start + n * 1e-5, 1e-5, fmi2True));
    for (unsigned i = 0; i < count; i++)
        if (fmi2GetReal(c, &i, 1, found + i) != fmi2OK) found[i] = 0.0;
    told[0] = '\0';
}

/* An instance that was reset gives what a fresh one gives; it may begin at another time, too. */
static void test_reset(void) {
    size_t count = hb_component.first_table;
    double *fresh = calloc(count, sizeof *fresh), *again = calloc(count, sizeof *again);
    void *c = fmi2Instantiate("c", fmi2CoSimulation, hb_component.token, resources, &functions2, 0, 0);
    run(c, 0.0, fresh, count);
    OK(fmi2Reset(c));
    run(c, 0.0, again, count);
    CHECK(memcmp(fresh, again, count * sizeof *fresh) == 0);
    OK(fmi2Terminate(c));
    OK(fmi2Reset(c));
    run(c, 3.5, again, count);
    fmi2FreeInstance(c);
    free(fresh);
    free(again);
}

int main(int count, char **arguments) {
    if (count != 3) return 2;
    folder = arguments[1];
    snprintf(resources, sizeof resources, "file://%s", folder);
    test_reset();
    for (long n = atol(arguments[2]); n > 0 && failures < 20; n--) {
        int k = (int)below(PLACES);
        if (!instance[k]) {
            make(k);
            if (instance[k] && below(8)) { /* most begin as they should */
                enter(k, below(2) ? 0.0 : 3.5);
                if (below(8)) leave(k);
            }
        } else {
            call(k);
        }
    }
    for (int k = 0; k < PLACES; k++)
        if (instance[k]) drop(k);
    CHECK(steps > atol(arguments[2]) / 100);
    return report();
}
