/* Feeds mutated resource files to a built library, in co-simulation and model exchange: each instance
   starts and steps, or is refused with one line; nothing else.

   Arguments: library, guid, number of continuous states, folder whose resource is mutated, name of
   that file, cases. */
#include <dlfcn.h>
#include <stdlib.h>

#include "check.h"
#include "mutate.h"

static fmi2InstantiateTYPE *instantiate;
static fmi2FreeInstanceTYPE *free_instance;
static fmi2EnterInitializationModeTYPE *enter;
static fmi2ExitInitializationModeTYPE *leave;
static fmi2DoStepTYPE *do_step;
static fmi2EnterContinuousTimeModeTYPE *enter_continuous;
static fmi2GetDerivativesTYPE *derivatives;
static size_t states; /* of model exchange; 0: it is not offered */

static void load(const char *path) {
    void *library = dlopen(path, RTLD_NOW);
    if (!library) {
        printf("%s\n", dlerror());
        exit(2);
    }
    *(void **)&instantiate = dlsym(library, "fmi2Instantiate");
    *(void **)&free_instance = dlsym(library, "fmi2FreeInstance");
    *(void **)&enter = dlsym(library, "fmi2EnterInitializationMode");
    *(void **)&leave = dlsym(library, "fmi2ExitInitializationMode");
    *(void **)&do_step = dlsym(library, "fmi2DoStep");
    *(void **)&enter_continuous = dlsym(library, "fmi2EnterContinuousTimeMode");
    *(void **)&derivatives = dlsym(library, "fmi2GetDerivatives");
}

/* Status of the first calls of an instance that started. */
static fmi2Status use(fmi2Component c, fmi2Type type) {
    if (type == fmi2CoSimulation) {
        fmi2Status status = fmi2OK;
        for (int n = 0; n < 3; n++) {
            status = do_step(c, n * 1e-5, 1e-5, fmi2True);
            CHECK(status == fmi2OK || status == fmi2Discard);
        }
        return status;
    }
    double *dx = calloc(states, sizeof *dx);
    CHECK(enter_continuous(c) == fmi2OK);
    fmi2Status status = derivatives(c, dx, states);
    CHECK(status == fmi2OK || status == fmi2Discard);
    free(dx);
    return status;
}

/* 1 if the instance started. */
static int run_as(fmi2Type type, const char *guid, const char *folder) {
    told[0] = '\0';
    fmi2Component c = instantiate("f", type, guid, folder, &functions2, 0, 0);
    if (!c) {
        CHECK(c);
        return 0;
    }
    CHECK(enter(c) == fmi2OK);
    fmi2Status status = leave(c);
    if (status == fmi2OK)
        status = use(c, type);
    else
        CHECK(status == fmi2Error && strstr(told, ".csv") && !strchr(told, '\n'));
    free_instance(c);
    return status == fmi2OK;
}

/* 1 if the instance for co-simulation started. */
static int run(const char *guid, const char *folder) {
    if (states)
        run_as(fmi2ModelExchange, guid, folder);
    return run_as(fmi2CoSimulation, guid, folder);
}

int main(int count, char **arguments) {
    if (count != 7)
        return 2;
    static char seed[LARGEST_SEED], text[LARGEST_SEED];
    char path[4096];
    load(arguments[1]);
    states = (size_t)atoi(arguments[3]);
    snprintf(path, sizeof path, "%s/%s", arguments[4], arguments[5]);
    size_t size = read_seed(path, seed);
    int cases = atoi(arguments[6]), started = run(arguments[2], arguments[4]);
    CHECK(size > 0 && started == 1);
    for (int n = 0; n < cases; n++) {
        memcpy(text, seed, size);
        write_mutation(path, text, mutate(text, size));
        started += run(arguments[2], arguments[4]);
    }
    write_mutation(path, seed, size);
    printf("%d of %d started\n", started, cases + 1);
    CHECK(started <= cases);
    return report();
}
