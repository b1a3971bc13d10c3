/* FMU states: copies of all that a step changes and of the parameters. Tables are not copied; a hash
   tells whether a state belongs to the present ones. */
#include <stdlib.h>
#include <string.h>

#include "instance.h"

struct FmuState {
    FmuState *next;
    Texts *texts;
    Moment moment;
    double saved[];
};

/* Of slopes and the block up to its tables. */
static size_t present_length(void) {
    return instance_slopes_length() + hb_component.first_table;
}

static size_t saved_length(void) {
    return instance_previous_length() + present_length();
}

static size_t saved_size(void) {
    return saved_length() * sizeof(double);
}

static FmuState *state_new(Instance *instance) {
    FmuState *state = malloc(sizeof *state + saved_size());
    if (!state)
        return NULL;
    state->texts = NULL;
    state->next = instance->states;
    instance->states = state;
    return state;
}

/* Link that points to a state, NULL if the instance has no such state (any more). */
static FmuState **find(Instance *instance, const void *state) {
    for (FmuState **link = &instance->states; *link; link = &(*link)->next)
        if (*link == state)
            return link;
    return NULL;
}

static Status refuse_unknown(Instance *instance) {
    return instance_fail(instance, STATUS_ERROR,
                         "%s: there is no such FMU state; it was freed, or another instance's",
                         instance->name);
}

static Status out_of_memory(Instance *instance) {
    return instance_fail(instance, STATUS_ERROR, "%s: out of memory", instance->name);
}

Status instance_get_state(Instance *instance, void **handle) {
    FmuState *state = *handle;
    if (state && !find(instance, state))
        return refuse_unknown(instance);
    if (!state && !(state = state_new(instance)))
        return out_of_memory(instance);
    if (state->texts != instance->texts) {
        texts_release(state->texts);
        state->texts = texts_share(instance->texts);
    }
    state->moment = instance->now;
    memcpy(state->saved, instance->previous, instance_previous_length() * sizeof(double));
    memcpy(state->saved + instance_previous_length(), instance->slopes,
           present_length() * sizeof(double));
    *handle = state;
    return STATUS_OK;
}

static Status refuse_resources(Instance *instance, const FmuState *state) {
    Message files = {""};
    for (uint32_t k = 0; k < hb_component.texts_count; k++) {
        Message before = files;
        if (hb_component.texts[k].file != k)
            continue;
        message_write(&files, "%s%s%s = '%s'", before.text, k ? ", " : "",
                      hb_component.texts[k].name, state->texts->values[k]);
    }
    return instance_fail(instance, STATUS_ERROR,
                         "%s: the FMU state was saved over other contents of %s; "
                         "restore it over the same resource files",
                         instance->name, files.text);
}

/* Take the state's files if none are read yet; otherwise they must be the same. */
static Status restore_resources(Instance *instance, const FmuState *state) {
    if (!state->moment.tables || !instance->now.tables) {
        texts_release(instance->texts);
        instance->texts = texts_share(state->texts);
        instance->now.tables = 0;
        Status status = state->moment.tables ? instance_read_resources(instance) : STATUS_OK;
        if (status != STATUS_OK)
            return status;
    }
    return state->moment.tables == instance->now.tables ? STATUS_OK
                                                        : refuse_resources(instance, state);
}

static bool has_other_parameters(const Instance *instance, const FmuState *state) {
    size_t count = hb_component.first_table - hb_component.mutable_size;
    return memcmp(state->saved + saved_length() - count,
                  instance->block + hb_component.mutable_size, count * sizeof(double)) != 0;
}

static void write_back(Instance *instance, const FmuState *state) {
    memcpy(instance->previous, state->saved, instance_previous_length() * sizeof(double));
    memcpy(instance->slopes, state->saved + instance_previous_length(),
           present_length() * sizeof(double));
}

Status instance_set_state(Instance *instance, void *handle) {
    const FmuState *state = handle;
    if (!find(instance, handle))
        return refuse_unknown(instance);
    if (state->moment.tables != instance->now.tables) {
        Status status = restore_resources(instance, state);
        if (status != STATUS_OK)
            return status;
    } else if (state->texts != instance->texts) {
        texts_release(instance->texts);
        instance->texts = texts_share(state->texts);
    }
    bool others = instance->now.phase < PHASE_STEP || has_other_parameters(instance, state);
    if (others)
        memset(instance->work, 0, hb_component.work * sizeof *instance->work);
    write_back(instance, state);
    if (others && state->moment.phase >= PHASE_STEP) { /* what no state holds follows from these */
        hb_component.out(instance->block, state->moment.time);
        write_back(instance, state);
    }
    if (hb_component.answer && instance->block[hb_component.stale] != 0.0)
        instance->block[hb_component.stale] = 2.0; /* what was asked for is another instance's */
    instance->now = state->moment;
    instance->outdated = state->moment.phase != PHASE_STEP &&
                         state->moment.phase != PHASE_INSTANTIATED &&
                         state->moment.phase != PHASE_TERMINATED;
    instance->rates_outdated = true;
    instance->steps = 0;
    return STATUS_OK;
}

Status instance_free_state(Instance *instance, void **handle) {
    if (!*handle)
        return STATUS_OK;
    FmuState **link = find(instance, *handle);
    if (!link)
        return refuse_unknown(instance);
    FmuState *state = *link;
    *link = state->next;
    texts_release(state->texts);
    free(state);
    *handle = NULL;
    return STATUS_OK;
}

/* Serialised: Head, then name of the component, hash of its sources and texts, each ended by a zero,
   then the saved part. */
typedef struct {
    char mark[8];
    uint64_t checksum; /* of all that follows it */
    Moment moment;
} Head;

static const char MARK[8] = "HBstate";

static uint64_t checksum(const char *bytes, size_t size) {
    uint64_t hash = 0xCBF29CE484222325u; /* FNV-1a */
    for (size_t i = offsetof(Head, moment); i < size; i++)
        hash = (hash ^ (unsigned char)bytes[i]) * 0x100000001B3u;
    return hash;
}

static size_t serialised_size(const FmuState *state) {
    size_t size = sizeof(Head) + strlen(hb_component.name) + strlen(hb_component.sources) + 2;
    for (uint32_t k = 0; k < hb_component.texts_count; k++)
        size += strlen(state->texts->values[k]) + 1;
    return size + saved_size();
}

Status instance_serialised_size(Instance *instance, void *state, size_t *size) {
    if (!find(instance, state))
        return refuse_unknown(instance);
    *size = serialised_size(state);
    return STATUS_OK;
}

static char *put(char *to, const char *text) {
    size_t size = strlen(text) + 1;
    memcpy(to, text, size);
    return to + size;
}

Status instance_serialise(Instance *instance, void *handle, char bytes[], size_t size) {
    const FmuState *state = handle;
    if (!find(instance, handle))
        return refuse_unknown(instance);
    if (size != serialised_size(state))
        return instance_fail(instance, STATUS_ERROR,
                             "%s: %zu bytes for an FMU state of %zu bytes", instance->name, size,
                             serialised_size(state));
    Head head = {.moment = state->moment};
    memcpy(head.mark, MARK, sizeof head.mark);
    char *to = put(put(bytes + sizeof head, hb_component.name), hb_component.sources);
    for (uint32_t k = 0; k < hb_component.texts_count; k++)
        to = put(to, state->texts->values[k]);
    memcpy(to, state->saved, saved_size());
    memcpy(bytes, &head, sizeof head);
    head.checksum = checksum(bytes, size);
    memcpy(bytes, &head, sizeof head);
    return STATUS_OK;
}

static Status refuse_owner(Instance *instance, const char *name, const char *sources) {
    return instance_fail(instance, STATUS_ERROR,
                         "%s: the FMU state belongs to '%.64s%s%.64s', not to '%s %s'; "
                         "restore states of the same component and version only",
                         instance->name, name, *sources ? " " : "", sources, hb_component.name,
                         hb_component.sources);
}

/* The text that starts at *at, which moves behind it; NULL if it does not end before `end`. */
static const char *take(const char **at, const char *end) {
    const char *text = *at, *zero = memchr(text, '\0', (size_t)(end - text));
    *at = zero ? zero + 1 : end;
    return zero ? text : NULL;
}

static Texts *take_texts(const char **at, const char *end) {
    Texts *texts = texts_new();
    for (uint32_t k = 0; texts && k < hb_component.texts_count; k++) {
        const char *text = take(at, end);
        if (!text || !texts_put(texts, k, text)) {
            texts_release(texts);
            return NULL;
        }
    }
    return texts;
}

/* An instance for co-simulation has no modes of model exchange, and the other way round. */
static bool has_phase(const Instance *instance, int32_t phase) {
    if (phase == PHASE_STEP)
        return !instance->model_exchange;
    if (phase == PHASE_EVENT || phase == PHASE_CONTINUOUS)
        return instance->model_exchange;
    return phase >= PHASE_INSTANTIATED && phase <= PHASE_TERMINATED;
}

Status instance_deserialise(Instance *instance, const char bytes[], size_t size, void **handle) {
    Head head;
    const char *at = bytes + sizeof head, *end = bytes + size;
    if (size < sizeof head || memcmp(bytes, MARK, sizeof MARK) != 0)
        return refuse_owner(instance, "something else", "");
    memcpy(&head, bytes, sizeof head);
    const char *name = take(&at, end), *sources = name ? take(&at, end) : NULL;
    if (!sources)
        return refuse_owner(instance, "something else", "");
    if (strcmp(name, hb_component.name) != 0 || strcmp(sources, hb_component.sources) != 0)
        return refuse_owner(instance, name, sources);
    Texts *texts = head.checksum == checksum(bytes, size) ? take_texts(&at, end) : NULL;
    if (!texts || (size_t)(end - at) != saved_size()) {
        texts_release(texts);
        return instance_fail(instance, STATUS_ERROR, "%s: the serialised FMU state is damaged",
                             instance->name);
    }
    if (!has_phase(instance, head.moment.phase)) {
        texts_release(texts);
        return instance_fail(instance, STATUS_ERROR,
                             "%s: the FMU state belongs to an instance for %s", instance->name,
                             instance->model_exchange ? "co-simulation" : "model exchange");
    }
    FmuState *state = state_new(instance);
    if (!state) {
        texts_release(texts);
        return out_of_memory(instance);
    }
    state->texts = texts;
    state->moment = head.moment;
    memcpy(state->saved, at, saved_size());
    *handle = state;
    return STATUS_OK;
}
