/* An FMU that ends, moves, blocks or crashes its process where it is told to: co-simulation without
   any header, FMI 2.0, or 3.0 with -DFMI3; the test writes the description. Value references:
   parameters place 0, deed 1, input 2, output 3. The environment variable HOSTILE="PLACE DEED" does
   the same for the instance called stranger, from before it is instantiated. */
#define _GNU_SOURCE
#include <fenv.h>
#include <locale.h>
#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

#define EXPORT __attribute__((visibility("default")))
enum { OK = 0, ERROR = 3 };
enum Place { STEP = 1, LATE_STEP, TERMINATE, FREE, INSTANTIATE, INITIALISE, SET, GET };
enum Deed {
    EXIT = 1, ABORT, MOVE, CRASH, SAY, OVERFLOW, LOOP, LEAVE, KILL, DIVIDE, TRAP, BUS, TWICE, STOP,
    SLEEP, TERM, DEADLOCK, FLOOD, UMASK, LOCALE, CLOSE, THREAD, ROUND, FLUSH, HANDLER, MASK,
    PRECISION
};

typedef struct {
    double real[4];
    double time;
    bool named;
} Part;
typedef int Status;
typedef void *Component;

static void nothing(int number) { (void)number; }
static void *sleeper(void *argument) {
    for (;;) pause();
    return argument;
}
static volatile int counter;
__attribute__((noinline)) static int deeper(volatile int *above) {
    volatile int own[1024];
    own[0] = above[0] + 1;
    counter = own[0];
    return deeper(own) + own[1];
}

static void end_it(enum Deed deed) {
    static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
    volatile int start[1] = {0};
    void *volatile memory;
    switch (deed) {
    case EXIT: exit(0);
    case ABORT: abort();
    case CRASH: *(volatile int *)8 = 1; break;
    case OVERFLOW: deeper(start); break;
    case LOOP: for (;;) counter++;
    case LEAVE: _exit(0);
    case KILL: raise(SIGKILL); break;
    case DIVIDE: raise(SIGFPE); break;
    case TRAP: __builtin_trap();
    case BUS: raise(SIGBUS); break;
    case TWICE: memory = malloc(64); free(memory); free(memory); abort();
    case STOP: raise(SIGSTOP); break;
    case SLEEP: for (;;) pause();
    case TERM: raise(SIGTERM); break;
    case DEADLOCK: pthread_mutex_lock(&lock); pthread_mutex_lock(&lock); break;
    default: break;
    }
}

static void upset(enum Deed deed) {
    static char line[1024];
    pthread_t thread;
    sigset_t all;
    switch (deed) {
    case MOVE: if (chdir("/")) abort(); break;
    case SAY: fputs("the hostile part was called\n", stderr); break;
    case FLOOD:
        memset(line, 'x', sizeof line - 1);
        for (int k = 0; k < 16384; ++k) puts(line);
        fflush(stdout);
        break;
    case UMASK: umask(0777); break;
    case LOCALE: if (!setlocale(LC_ALL, "C")) abort(); break;
    case CLOSE: for (int k = 0; k < 1024; ++k) close(k); break;
    case THREAD: pthread_create(&thread, NULL, sleeper, NULL); break;
    case ROUND: fesetround(FE_UPWARD); break;
#if defined(__x86_64__)
    case FLUSH: _mm_setcsr(_mm_getcsr() | 0x8040); break;
    case PRECISION: __asm__ volatile("fldcw %0" : : "m"((unsigned short){0x007f})); break;
#endif
    case HANDLER: for (int k = 1; k < 16; ++k) signal(k, nothing); break;
    case MASK: sigfillset(&all); sigprocmask(SIG_BLOCK, &all, NULL); break;
    default: break;
    }
}

/* Once only what upsets, so that a flood is one. */
static void act(const Part *part, enum Place here) {
    static bool done;
    int place = (int)part->real[0], deed = (int)part->real[1];
    const char *told = getenv("HOSTILE");
    if (told && part->named) sscanf(told, "%d %d", &place, &deed);
    if (place != (int)here) return;
    end_it((enum Deed)deed);
    if (!done) upset((enum Deed)deed);
    done = true;
}
static void act_late(const Part *part, enum Place here) {
    if (part->time > 5e-4) act(part, here);
}

static Component new_part(const char *name) {
    Part *part = calloc(1, sizeof(Part));
    part->named = name && !strcmp(name, "stranger");
    act(part, INSTANTIATE);
    return part;
}
static Status set(Part *part, const unsigned *vr, size_t n, const double *value) {
    act_late(part, SET);
    for (size_t i = 0; i < n; ++i) part->real[vr[i]] = value[i];
    return OK;
}
static Status get(Part *part, const unsigned *vr, size_t n, double *value) {
    act_late(part, GET);
    for (size_t i = 0; i < n; ++i) value[i] = part->real[vr[i]];
    return OK;
}
static Status step(Part *part, double t) {
    act(part, STEP);
    if (t > 5e-4) act(part, LATE_STEP);
    part->real[3] = part->time = t;
    return OK;
}

#ifdef FMI3
EXPORT Component fmi3InstantiateCoSimulation(
    const char *name, const char *token, const char *resources, bool visible, bool logging,
    bool events_used, bool early_allowed, const unsigned *needed, size_t count, void *environment,
    void *log, void *update) {
    return new_part(name);
}
EXPORT void fmi3FreeInstance(Component c) {
    act(c, FREE);
    free(c);
}
EXPORT Status fmi3Terminate(Component c) {
    act(c, TERMINATE);
    return OK;
}
EXPORT Status fmi3SetFloat64(Component c, const unsigned *vr, size_t n, const double *value,
                             size_t count) {
    return set(c, vr, n, value);
}
EXPORT Status fmi3GetFloat64(Component c, const unsigned *vr, size_t n, double *value,
                             size_t count) {
    return get(c, vr, n, value);
}
EXPORT Status fmi3DoStep(Component c, double t, double h, bool no_rollback, bool *event, bool *ends,
                         bool *early, double *last) {
    *event = *ends = *early = false;
    *last = t + h;
    return step(c, t);
}
EXPORT const char *fmi3GetVersion(void) { return "3.0"; }
EXPORT Status fmi3EnterInitializationMode(Component c, bool tolerant, double tolerance,
                                          double start, bool has_stop, double stop) {
    act(c, INITIALISE);
    return OK;
}
EXPORT Status fmi3ExitInitializationMode(Component c) { return OK; }
EXPORT Status fmi3EnterConfigurationMode(Component c) { return ERROR; }
EXPORT Status fmi3ExitConfigurationMode(Component c) { return ERROR; }
EXPORT Status fmi3EnterEventMode(Component c) { return ERROR; }
EXPORT Status fmi3EnterStepMode(Component c) { return ERROR; }
EXPORT Status fmi3UpdateDiscreteStates(Component c, bool *more, bool *ends, bool *nominals,
                                       bool *values, bool *defined, double *next) {
    return ERROR;
}
#define OTHER(Name)                                                \
    EXPORT Status fmi3Get##Name(Component c) { return ERROR; }     \
    EXPORT Status fmi3Set##Name(Component c) { return ERROR; }
OTHER(Float32) OTHER(Int8) OTHER(UInt8) OTHER(Int16) OTHER(UInt16) OTHER(Int32) OTHER(UInt32)
OTHER(Int64) OTHER(UInt64) OTHER(Boolean) OTHER(String) OTHER(Binary) OTHER(FMUState)
EXPORT Status fmi3FreeFMUState(Component c, void **state) { return ERROR; }

#include "absent3.h"
#else
EXPORT Component fmi2Instantiate(const char *name, int kind, const char *guid, const char *resources,
                                 const void *callbacks, int visible, int logging) {
    return new_part(name);
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
    return set(c, vr, n, value);
}
EXPORT Status fmi2GetReal(Component c, const unsigned *vr, size_t n, double *value) {
    return get(c, vr, n, value);
}
EXPORT Status fmi2DoStep(Component c, double t, double h, int no_rollback) { return step(c, t); }
EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORT const char *fmi2GetVersion(void) { return "2.0"; }
EXPORT Status fmi2SetDebugLogging(Component c, int on, size_t n, const char *const *categories) {
    return OK;
}
EXPORT Status fmi2SetupExperiment(Component c, int has_tolerance, double tolerance, double start,
                                  int has_stop, double stop) {
    return OK;
}
EXPORT Status fmi2EnterInitializationMode(Component c) {
    act(c, INITIALISE);
    return OK;
}
EXPORT Status fmi2ExitInitializationMode(Component c) { return OK; }
EXPORT Status fmi2Reset(Component c) { return OK; }

#include "absent.h"
#endif
