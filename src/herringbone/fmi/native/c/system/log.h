/* Messages to the host, for FMI 2 and FMI 3.

   Errors are always told: without them a host sees no more than a status. Warnings and plain news
   are told if the host switched logging on. If it named categories, exactly these are told. */
#ifndef LOG_H
#define LOG_H

#include <stdbool.h>
#include <stddef.h>

#include "fmi2Functions.h"
#include "fmi3Functions.h"
#include "message.h"

/* The same numbers in FMI 2 and FMI 3. */
typedef enum { STATUS_OK, STATUS_WARNING, STATUS_DISCARD, STATUS_ERROR, STATUS_FATAL } Status;

typedef struct {
    fmi2CallbackLogger logger2;     /* one of these, or none */
    fmi3LogMessageCallback logger3;
    void *environment;
    const char *instance;
    unsigned told; /* bit per status */
} Log;

void log_switch(Log *log, bool on);

/* Tell the named categories only; false if one is unknown, whose name then is in `unknown`. */
bool log_choose(Log *log, const char *const categories[], size_t count, const char **unknown);

void log_write(const Log *log, Status status, const Message *message);

#endif
