/* A co-simulation master in C: steps FMUs 2.0 in parallel on held inputs, on any platform.
 *
 * `jacobi PLAN` prints one row per record, each value as the hexadecimal digits of its bits. The
 * plan, words without blanks; parts count from 0, numbers are given by their bits as well:
 *   part NAME LIBRARY RESOURCES GUID
 *   real PART REFERENCE BITS       start value
 *   text PART REFERENCE TEXT
 *   connect PART REFERENCE PART REFERENCE
 *   record PART REFERENCE
 *   run BITS COUNT EVERY           step size [s], macro steps, macro steps per record
 */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2FunctionTypes.h"

#ifdef _WIN32
#include <windows.h>
#define OPEN(file) ((void *)LoadLibraryA(file))
#define FIND(library, name) ((void *)GetProcAddress((HMODULE)(library), name))
#else
#include <dlfcn.h>
#define OPEN(file) dlopen(file, RTLD_NOW | RTLD_LOCAL)
#define FIND(library, name) dlsym(library, name)
#endif

enum { PARTS = 16, SIGNALS = 256, PASSES = 4 };

typedef struct {
    fmi2Component instance;
    fmi2SetRealTYPE *set_real;
    fmi2GetRealTYPE *get_real;
    fmi2SetStringTYPE *set_string;
    fmi2SetupExperimentTYPE *setup;
    fmi2EnterInitializationModeTYPE *enter;
    fmi2ExitInitializationModeTYPE *leave;
    fmi2DoStepTYPE *step;
} Part;

typedef struct {
    unsigned part, reference;
} Place;

static Part parts[PARTS];
static Place sources[SIGNALS], targets[SIGNALS], records[SIGNALS];
static double values[SIGNALS];
static unsigned part_count, signal_count, record_count;

static void fail(const char *what, const char *which)
{
    fprintf(stderr, "%s: %s\n", what, which);
    exit(1);
}

static void check(fmi2Status status, const char *what)
{
    if (status > fmi2Warning)
        fail(what, "the FMU refused");
}

static void print_message(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status,
                          fmi2String category, fmi2String message, ...)
{
    (void)environment, (void)status, (void)category;
    fprintf(stderr, "%s: %s\n", name, message);
}

static const fmi2CallbackFunctions callbacks = {print_message, calloc, free, NULL, NULL};

static Part open_part(const char *name, const char *file, const char *resources, const char *guid)
{
    void *library = OPEN(file);
    if (!library)
        fail("cannot be loaded", file);
    fmi2InstantiateTYPE *instantiate = (fmi2InstantiateTYPE *)FIND(library, "fmi2Instantiate");
    Part part = {
        instantiate(name, fmi2CoSimulation, guid, resources, &callbacks, fmi2False, fmi2False),
        (fmi2SetRealTYPE *)FIND(library, "fmi2SetReal"),
        (fmi2GetRealTYPE *)FIND(library, "fmi2GetReal"),
        (fmi2SetStringTYPE *)FIND(library, "fmi2SetString"),
        (fmi2SetupExperimentTYPE *)FIND(library, "fmi2SetupExperiment"),
        (fmi2EnterInitializationModeTYPE *)FIND(library, "fmi2EnterInitializationMode"),
        (fmi2ExitInitializationModeTYPE *)FIND(library, "fmi2ExitInitializationMode"),
        (fmi2DoStepTYPE *)FIND(library, "fmi2DoStep"),
    };
    if (!part.instance)
        fail("does not instantiate", name);
    return part;
}

static double number(const char *bits)
{
    uint64_t word = strtoull(bits, NULL, 16);
    double value;
    memcpy(&value, &word, sizeof value);
    return value;
}

static double get(Place place)
{
    double value;
    check(parts[place.part].get_real(parts[place.part].instance, &place.reference, 1, &value),
          "fmi2GetReal");
    return value;
}

static void set(Place place, double value)
{
    check(parts[place.part].set_real(parts[place.part].instance, &place.reference, 1, &value),
          "fmi2SetReal");
}

/* All outputs are read before the first input is set. */
static void exchange(void)
{
    for (unsigned i = 0; i < signal_count; i++)
        values[i] = get(sources[i]);
    for (unsigned i = 0; i < signal_count; i++)
        set(targets[i], values[i]);
}

static void print_record(void)
{
    for (unsigned i = 0; i < record_count; i++) {
        double value = get(records[i]);
        uint64_t word;
        memcpy(&word, &value, sizeof word);
        printf("%016llx ", (unsigned long long)word);
    }
    printf("\n");
}

/* Values travel from bodies to elements and back; more passes change nothing. */
static void initialise(double end)
{
    for (unsigned p = 0; p < part_count; p++) {
        check(parts[p].setup(parts[p].instance, fmi2False, 0.0, 0.0, fmi2True, end), "fmi2SetupExperiment");
        check(parts[p].enter(parts[p].instance), "fmi2EnterInitializationMode");
    }
    for (int pass = 0; pass < PASSES; pass++)
        exchange();
    for (unsigned p = 0; p < part_count; p++)
        check(parts[p].leave(parts[p].instance), "fmi2ExitInitializationMode");
}

static void run(double h, unsigned long count, unsigned long every)
{
    initialise((double)count * h);
    print_record();
    for (unsigned long n = 0; n < count; n++) {
        exchange();
        for (unsigned p = 0; p < part_count; p++)
            check(parts[p].step(parts[p].instance, (double)n * h, h, fmi2True), "fmi2DoStep");
        if ((n + 1) % every == 0)
            print_record();
    }
}

int main(int argc, char **argv)
{
    static char line[4096], a[4096], b[4096], c[4096], d[4096];
    FILE *plan = argc == 2 ? fopen(argv[1], "r") : NULL;
    unsigned part, reference, other, input;
    unsigned long count, every;
    if (!plan)
        fail("cannot be read", argc == 2 ? argv[1] : "usage: jacobi PLAN");
    while (fgets(line, sizeof line, plan)) {
        if (part_count == PARTS || signal_count == SIGNALS || record_count == SIGNALS)
            fail("too many", line);
        if (sscanf(line, "part %s %s %s %s", a, b, c, d) == 4) {
            parts[part_count++] = open_part(a, b, c, d);
        } else if (sscanf(line, "real %u %u %s", &part, &reference, a) == 3) {
            set((Place){part, reference}, number(a));
        } else if (sscanf(line, "text %u %u %s", &part, &reference, a) == 3) {
            fmi2String text = a;
            check(parts[part].set_string(parts[part].instance, &reference, 1, &text), "fmi2SetString");
        } else if (sscanf(line, "connect %u %u %u %u", &part, &reference, &other, &input) == 4) {
            sources[signal_count] = (Place){part, reference};
            targets[signal_count++] = (Place){other, input};
        } else if (sscanf(line, "record %u %u", &part, &reference) == 2) {
            records[record_count++] = (Place){part, reference};
        } else if (sscanf(line, "run %s %lu %lu", a, &count, &every) == 3) {
            run(number(a), count, every);
        } else {
            fail("is not understood", line);
        }
    }
    fclose(plan);
    return 0;
}
