/* Checks of a C test: what the FMU told its host, and a count of what went wrong. */
#ifndef CHECK_H
#define CHECK_H

#include <stdio.h>
#include <string.h>

#include "fmi2Functions.h"
#include "fmi3Functions.h"

static _Thread_local char told[4096];
static int failures;

static inline void logger2(fmi2ComponentEnvironment e, fmi2String name, fmi2Status status,
                    fmi2String category, fmi2String message, ...) {
    (void)e, (void)name, (void)status;
    snprintf(told, sizeof told, "%s|%s", category, message);
}

static inline void logger3(fmi3InstanceEnvironment e, fmi3Status status, fmi3String category,
                    fmi3String message) {
    (void)e, (void)status;
    snprintf(told, sizeof told, "%s|%s", category, message);
}

static const fmi2CallbackFunctions functions2 __attribute__((unused)) = {logger2, NULL, NULL, NULL, NULL};

#define CHECK(condition)                                                          \
    do {                                                                          \
        if (!(condition)) {                                                       \
            printf("%s:%d: %s (told: %s)\n", __FILE__, __LINE__, #condition, told); \
            failures++;                                                           \
        }                                                                         \
    } while (0)

/* The call succeeds and tells nothing. */
#define OK(call)                      \
    do {                              \
        told[0] = '\0';               \
        int status_ = (int)(call);    \
        CHECK(status_ == 0 && #call); \
        CHECK(told[0] == '\0');       \
    } while (0)

/* The call gives a status and tells a message that holds a text. */
#define GIVES(wanted, call, text)              \
    do {                                       \
        told[0] = '\0';                        \
        int status_ = (int)(call);             \
        CHECK(status_ == (int)(wanted) && #call); \
        CHECK(strstr(told, text) && #call);    \
    } while (0)
#define REFUSED(call, text) GIVES(fmi2Error, call, text)

static int report(void) {
    printf("%d failures\n", failures);
    return failures != 0;
}

#endif
