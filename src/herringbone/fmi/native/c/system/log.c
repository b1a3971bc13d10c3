#include "log.h"

#include <stdio.h>
#include <string.h>

static const char *const CATEGORIES[] = {
    [STATUS_OK] = "logAll",
    [STATUS_WARNING] = "logStatusWarning",
    [STATUS_DISCARD] = "logStatusDiscard",
    [STATUS_ERROR] = "logStatusError",
    [STATUS_FATAL] = "logStatusFatal",
};
enum { CATEGORY_COUNT = sizeof CATEGORIES / sizeof *CATEGORIES };

static const unsigned ERRORS = 1u << STATUS_DISCARD | 1u << STATUS_ERROR | 1u << STATUS_FATAL;
static const unsigned EVERYTHING = (1u << CATEGORY_COUNT) - 1u;

_Static_assert((int)STATUS_ERROR == (int)fmi2Error && (int)STATUS_ERROR == (int)fmi3Error &&
                   (int)STATUS_DISCARD == (int)fmi2Discard &&
                   (int)STATUS_DISCARD == (int)fmi3Discard,
               "one status serves both versions");

void log_switch(Log *log, bool on) {
    log->told = on ? EVERYTHING : ERRORS;
}

bool log_choose(Log *log, const char *const categories[], size_t count, const char **unknown) {
    unsigned told = 0;
    for (size_t i = 0; i < count; i++) {
        size_t k = 0;
        while (k < CATEGORY_COUNT && (!categories[i] || strcmp(categories[i], CATEGORIES[k]) != 0))
            k++;
        if (k == CATEGORY_COUNT) {
            *unknown = categories[i] ? categories[i] : "(null)";
            return false;
        }
        told |= k == STATUS_OK ? EVERYTHING : 1u << k;
    }
    log->told = told;
    return true;
}

/* FMI 2 takes the message as a printf format. */
static void double_percent(const char *text, char *doubled, size_t size) {
    size_t used = 0;
    for (; *text && used + 2 < size; text++) {
        if (*text == '%')
            doubled[used++] = '%';
        doubled[used++] = *text;
    }
    doubled[used] = '\0';
}

void log_write(const Log *log, Status status, const Message *message) {
    if (!(log->told >> status & 1u))
        return;
    const char *category = CATEGORIES[status];
    if (log->logger3)
        log->logger3(log->environment, (fmi3Status)status, category, message->text);
    if (log->logger2) {
        char doubled[2 * sizeof message->text];
        double_percent(message->text, doubled, sizeof doubled);
        log->logger2(log->environment, log->instance, (fmi2Status)status, category, doubled);
    }
}
