/* An FMU that ends, moves or crashes the process where it is told to: FMI 2.0 co-simulation without
   any header; the test writes the description. Value references: parameters place 0, deed 1, input
   2, output 3. */
#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define EXPORT __attribute__((visibility("default")))
enum { OK = 0, ERROR = 3 };
enum Place { STEP = 1, LATE_STEP, TERMINATE, FREE };
enum Deed { EXIT = 1, ABORT, MOVE, CRASH, SAY };

typedef struct {
    double real[4];
} Part;
typedef int Status;
typedef void *Component;

static void act(const Part *part, enum Place here) {
    if ((enum Place)part->real[0] != here) return;
    switch ((enum Deed)part->real[1]) {
    case EXIT: exit(0);
    case ABORT: abort();
    case MOVE: if (chdir("/")) abort(); break;
    case CRASH: raise(SIGSEGV); break;
    case SAY: fputs("the hostile part was called\n", stderr); break;
    }
}

EXPORT Component fmi2Instantiate(const char *name, int kind, const char *guid, const char *resources,
                                 const void *callbacks, int visible, int logging) {
    return calloc(1, sizeof(Part));
}
EXPORT void fmi2FreeInstance(Component c) {
    act(c, FREE);
    free(c);
}
EXPORT Status fmi2Terminate(Component c) {
    act(c, TERMINATE);
    return OK;
}
EXPORT Status fmi2SetReal(Component c, const unsigned *vr, size_t n, const double *value) {
    for (size_t i = 0; i < n; ++i) ((Part *)c)->real[vr[i]] = value[i];
    return OK;
}
EXPORT Status fmi2GetReal(Component c, const unsigned *vr, size_t n, double *value) {
    for (size_t i = 0; i < n; ++i) value[i] = ((Part *)c)->real[vr[i]];
    return OK;
}
EXPORT Status fmi2DoStep(Component c, double t, double h, int no_rollback) {
    act(c, STEP);
    if (t > 5e-4) act(c, LATE_STEP);
    ((Part *)c)->real[3] = t;
    return OK;
}
EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORT const char *fmi2GetVersion(void) { return "2.0"; }
EXPORT Status fmi2SetDebugLogging(Component c, int on, size_t n, const char *const *categories) {
    return OK;
}
EXPORT Status fmi2SetupExperiment(Component c, int has_tolerance, double tolerance, double start,
                                  int has_stop, double stop) {
    return OK;
}
EXPORT Status fmi2EnterInitializationMode(Component c) { return OK; }
EXPORT Status fmi2ExitInitializationMode(Component c) { return OK; }
EXPORT Status fmi2Reset(Component c) { return OK; }

#include "absent.h"
