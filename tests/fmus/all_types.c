/* An FMU 3.0 with outputs of all types, for tests: FMI 3.0 co-simulation without any header; the
   test writes the description.

   Input k of a type is value reference 10 k, its output 10 k + 1: k = 1 Int8, 2 UInt8, 3 Int16,
   4 UInt16, 5 Int32, 6 UInt32, 7 Int64, 8 UInt64, 9 Boolean, 10 String, 11 Binary, 12 Enumeration
   (Int64), 13 Float32. An output shows what the input was in the last step, or before the first;
   that of Float32 is NaN for 13 after 0.45 s.

   Structural parameter 200: n, at most 4; setting it sets u[3] = 3, u[4] = 4. Float64: input u[n] (201), output y[n] (202), dy/dt = u;
   parameter m[2,2] (203), output of it transposed (204). Int32: input pair[2] (205), output of it
   the other way round (206).
   Events: parameter 210, every so many seconds, 0 never; output 211, Int32, counts them; they are
   handled in event mode if it is used, else in the step. Parameter 212: time of the end, 0 never;
   213: the discrete states never settle, if not 0. 214: discrete Float64 input, 215 its output.
   216: if not 0, it tells the time of the next event in event mode, and does not stop for it.
   While event mode is used, discrete inputs are refused outside; after initialisation the value 13
   of the input of UInt64. With the token "no events" it does not instantiate with event mode. */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define EXPORT __attribute__((visibility("default")))
enum { OK = 0, ERROR = 3, MOST = 4, TYPES = 14, ROOM = 64 };
enum { BOOLEAN = 9, STRING = 10, BINARY = 11, ENUMERATION = 12, FLOAT32 = 13 };

typedef int Status;
typedef unsigned Reference;
typedef void (*Log)(void *, Status, const char *, const char *);
typedef struct {
    uint64_t size;
    char data[ROOM];
} Bytes;
typedef struct {
    Bytes in[TYPES], out[TYPES];
    double u[MOST], y[MOST], m[4], every, end, restless, discrete, told;
    int32_t pair[2], events;
    uint64_t n;
} Values;
typedef struct {
    Values values;
    bool events_used, early_allowed, stepping, in_event, configuring;
    Log log;
    void *environment;
} Part;

static Status refuse(Part *part, const char *why) {
    if (part->log) part->log(part->environment, ERROR, "error", why);
    return ERROR;
}

static Status may_set_discrete(Part *part) {
    if (part->events_used && part->stepping && !part->in_event)
        return refuse(part, "a discrete input was set outside event mode");
    return OK;
}

EXPORT const char *fmi3GetVersion(void) { return "3.0"; }

EXPORT void *fmi3InstantiateCoSimulation(
    const char *name, const char *token, const char *resources, bool visible, bool logging,
    bool events_used, bool early_allowed, const Reference *needed, size_t count, void *environment,
    Log log, void *update) {
    if (events_used && !strcmp(token, "no events")) {
        if (log) log(environment, ERROR, "error", "event mode is not supported");
        return NULL;
    }
    Part *part = calloc(1, sizeof(Part));
    part->events_used = events_used;
    part->early_allowed = early_allowed;
    part->environment = environment;
    part->log = log;
    part->values.n = 2;
    for (int k = 0; k < 4; ++k) part->values.m[k] = k + 1;
    part->values.in[ENUMERATION].data[0] = 1;
    return part;
}
EXPORT void fmi3FreeInstance(void *c) { free(c); }
EXPORT Status fmi3EnterConfigurationMode(void *c) {
    ((Part *)c)->configuring = true;
    return OK;
}
EXPORT Status fmi3ExitConfigurationMode(void *c) {
    ((Part *)c)->configuring = false;
    return OK;
}
EXPORT Status fmi3EnterInitializationMode(void *c, bool tolerant, double tolerance, double start,
                                          bool stops, double stop) {
    return OK;
}
EXPORT Status fmi3ExitInitializationMode(void *c) {
    Part *part = c;
    memcpy(part->values.out, part->values.in, sizeof(part->values.in));
    part->stepping = true;
    part->in_event = part->events_used;
    return OK;
}
EXPORT Status fmi3Terminate(void *c) { return OK; }
EXPORT Status fmi3EnterEventMode(void *c) {
    Part *part = c;
    if (!part->events_used || part->in_event) return refuse(part, "no way to event mode");
    part->in_event = true;
    return OK;
}
EXPORT Status fmi3EnterStepMode(void *c) {
    Part *part = c;
    if (!part->in_event) return refuse(part, "no way to step mode");
    part->in_event = false;
    return OK;
}

static void count_event(Values *v, double t) {
    if (v->every > 0.0 && fabs(t - (v->events + 1) * v->every) < 1e-9) v->events++;
}

static double now; /* of the event; one instance only is in one at a time */

EXPORT Status fmi3UpdateDiscreteStates(void *c, bool *more, bool *ends, bool *nominals,
                                       bool *states, bool *timed, double *next) {
    Part *part = c;
    if (!part->in_event) return refuse(part, "no event mode");
    count_event(&part->values, now);
    *more = part->values.restless != 0.0;
    *ends = *nominals = *states = false;
    *timed = part->values.told != 0.0 && part->values.every > 0.0;
    *next = (part->values.events + 1) * part->values.every;
    return OK;
}

EXPORT Status fmi3DoStep(void *c, double t, double h, bool no_rollback, bool *event, bool *ends,
                         bool *early, double *reached) {
    Part *part = c;
    Values *v = &part->values;
    if (part->in_event) return refuse(part, "a step in event mode");
    double to = t + h;
    *event = *ends = *early = false;
    if (v->every > 0.0) {
        double next = (v->events + 1) * v->every;
        if (part->events_used && v->told == 0.0 && next < to + 1e-9) {
            *event = true;
            if (part->early_allowed && next < to - 1e-9) {
                *early = true;
                to = next;
            }
        }
    }
    if (v->end > 0.0 && v->end < to + 1e-9) {
        *ends = true;
        *early = part->early_allowed && v->end < t + h - 1e-9;
        to = v->end;
    }
    for (uint64_t k = 0; k < v->n; ++k) v->y[k] += v->u[k] * (to - t);
    memcpy(v->out, v->in, sizeof(v->in));
    float single;
    memcpy(&single, v->in[FLOAT32].data, sizeof(single));
    if (single == 13.0f && to > 0.45) single = NAN;
    memcpy(v->out[FLOAT32].data, &single, sizeof(single));
    if (!part->events_used)
        while (v->every > 0.0 && (v->events + 1) * v->every < to + 1e-9) v->events++;
    now = to;
    *reached = to;
    return OK;
}

/* Types of a fixed size, element by element. */
#define FIXED(Name, Type, at)                                                                   \
    EXPORT Status fmi3Set##Name(void *c, const Reference *vr, size_t n, const Type *value,      \
                                size_t count) {                                                 \
        Part *part = c;                                                                         \
        for (size_t i = 0; i < n; ++i) {                                                        \
            int k = (int)vr[i] / 10;                                                            \
            if (k != (at) && !((at) == 7 && k == ENUMERATION))                                  \
                return refuse(part, "another type");                                            \
            if (k != FLOAT32 && may_set_discrete(part) != OK) return ERROR;                     \
            memcpy(part->values.in[k].data, value + i, sizeof(Type));                           \
        }                                                                                       \
        return OK;                                                                              \
    }                                                                                           \
    EXPORT Status fmi3Get##Name(void *c, const Reference *vr, size_t n, Type *value,            \
                                size_t count) {                                                 \
        Values *v = &((Part *)c)->values;                                                       \
        for (size_t i = 0; i < n; ++i)                                                          \
            memcpy(value + i, (vr[i] % 10 ? v->out : v->in)[vr[i] / 10].data, sizeof(Type));    \
        return OK;                                                                              \
    }
FIXED(Int8, int8_t, 1)
FIXED(UInt8, uint8_t, 2)
FIXED(Int16, int16_t, 3)
FIXED(UInt16, uint16_t, 4)
FIXED(UInt32, uint32_t, 6)
FIXED(Int64, int64_t, 7)
FIXED(Boolean, bool, BOOLEAN)
FIXED(Float32, float, FLOAT32)

EXPORT Status fmi3SetUInt64(void *c, const Reference *vr, size_t n, const uint64_t *value,
                            size_t count) {
    Part *part = c;
    if (vr[0] == 200) {
        if (!part->configuring) return refuse(part, "n is set in configuration mode");
        if (value[0] > MOST) return refuse(part, "n is at most 4");
        part->values.n = value[0];
        for (int k = 2; k < MOST; ++k) part->values.u[k] = k + 1;
        return OK;
    }
    if (may_set_discrete(part) != OK) return ERROR;
    if (part->stepping && value[0] == 13) return refuse(part, "13 is refused");
    memcpy(part->values.in[8].data, value, sizeof(uint64_t));
    return OK;
}
EXPORT Status fmi3GetUInt64(void *c, const Reference *vr, size_t n, uint64_t *value, size_t count) {
    Values *v = &((Part *)c)->values;
    for (size_t i = 0; i < n; ++i)
        if (vr[i] == 200) value[i] = v->n;
        else memcpy(value + i, (vr[i] % 10 ? v->out : v->in)[8].data, sizeof(uint64_t));
    return OK;
}

EXPORT Status fmi3SetInt32(void *c, const Reference *vr, size_t n, const int32_t *value,
                           size_t count) {
    Part *part = c;
    for (size_t i = 0, at = 0; i < n; ++i) {
        if (may_set_discrete(part) != OK) return ERROR;
        size_t size = vr[i] == 205 ? 2 : 1;
        if (at + size > count) return refuse(part, "too few values");
        if (vr[i] == 205) memcpy(part->values.pair, value + at, sizeof(part->values.pair));
        else memcpy(part->values.in[5].data, value + at, sizeof(int32_t));
        at += size;
    }
    return OK;
}
EXPORT Status fmi3GetInt32(void *c, const Reference *vr, size_t n, int32_t *value, size_t count) {
    Values *v = &((Part *)c)->values;
    size_t at = 0;
    for (size_t i = 0; i < n; ++i) {
        if (vr[i] == 211) value[at++] = v->events;
        else if (vr[i] == 205 || vr[i] == 206) {
            value[at++] = v->pair[vr[i] == 206];
            value[at++] = v->pair[vr[i] == 205];
        } else memcpy(value + at++, (vr[i] % 10 ? v->out : v->in)[5].data, sizeof(int32_t));
    }
    return at == count ? OK : refuse(c, "another number of values");
}

EXPORT Status fmi3SetFloat64(void *c, const Reference *vr, size_t n, const double *value,
                             size_t count) {
    Part *part = c;
    Values *v = &part->values;
    size_t at = 0;
    for (size_t i = 0; i < n; ++i) {
        size_t size = vr[i] == 201 ? v->n : vr[i] == 203 ? 4 : 1;
        double *to = vr[i] == 201 ? v->u : vr[i] == 203 ? v->m : vr[i] == 210 ? &v->every
                   : vr[i] == 212 ? &v->end : vr[i] == 213 ? &v->restless
                   : vr[i] == 216 ? &v->told : &v->discrete;
        if (vr[i] == 214 && may_set_discrete(part) != OK) return ERROR;
        if (at + size > count) return refuse(part, "too few values");
        memcpy(to, value + at, size * sizeof(double));
        at += size;
    }
    return at == count ? OK : refuse(part, "another number of values");
}
EXPORT Status fmi3GetFloat64(void *c, const Reference *vr, size_t n, double *value, size_t count) {
    Values *v = &((Part *)c)->values;
    size_t at = 0;
    for (size_t i = 0; i < n; ++i) {
        const double turned[4] = {v->m[0], v->m[2], v->m[1], v->m[3]};
        size_t size = vr[i] == 201 || vr[i] == 202 ? v->n : vr[i] == 203 || vr[i] == 204 ? 4 : 1;
        const double *from = vr[i] == 201 ? v->u : vr[i] == 202 ? v->y : vr[i] == 203 ? v->m
                           : vr[i] == 204 ? turned : vr[i] == 210 ? &v->every
                           : vr[i] == 212 ? &v->end : vr[i] == 213 ? &v->restless
                   : vr[i] == 216 ? &v->told : &v->discrete;
        memcpy(value + at, from, size * sizeof(double));
        at += size;
    }
    return at == count ? OK : refuse(c, "another number of values");
}

EXPORT Status fmi3SetString(void *c, const Reference *vr, size_t n, const char *const *value,
                            size_t count) {
    Part *part = c;
    if (may_set_discrete(part) != OK) return ERROR;
    strncpy(part->values.in[STRING].data, value[0], ROOM - 1);
    return OK;
}
EXPORT Status fmi3GetString(void *c, const Reference *vr, size_t n, const char **value,
                            size_t count) {
    Values *v = &((Part *)c)->values;
    for (size_t i = 0; i < n; ++i) value[i] = (vr[i] % 10 ? v->out : v->in)[STRING].data;
    return OK;
}
EXPORT Status fmi3SetBinary(void *c, const Reference *vr, size_t n, const size_t *size,
                            const uint8_t *const *value, size_t count) {
    Part *part = c;
    if (may_set_discrete(part) != OK) return ERROR;
    if (size[0] > ROOM) return refuse(part, "too many bytes");
    part->values.in[BINARY].size = size[0];
    memcpy(part->values.in[BINARY].data, value[0], size[0]);
    return OK;
}
EXPORT Status fmi3GetBinary(void *c, const Reference *vr, size_t n, size_t *size,
                            const uint8_t **value, size_t count) {
    Values *v = &((Part *)c)->values;
    for (size_t i = 0; i < n; ++i) {
        const Bytes *from = &(vr[i] % 10 ? v->out : v->in)[BINARY];
        size[i] = from->size;
        value[i] = (const uint8_t *)from->data;
    }
    return OK;
}

EXPORT Status fmi3GetFMUState(void *c, void **state) {
    if (!*state) *state = malloc(sizeof(Values));
    memcpy(*state, &((Part *)c)->values, sizeof(Values));
    return OK;
}
EXPORT Status fmi3SetFMUState(void *c, void *state) {
    memcpy(&((Part *)c)->values, state, sizeof(Values));
    return OK;
}
EXPORT Status fmi3FreeFMUState(void *c, void **state) {
    free(*state);
    *state = NULL;
    return OK;
}

#include "absent3.h"
