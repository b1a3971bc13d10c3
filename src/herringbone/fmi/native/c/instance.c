#include "instance.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "platform.h"

Status instance_fail(Instance *instance, Status status, const char *format, ...) {
    Message message;
    va_list arguments;
    va_start(arguments, format);
    message_write_list(&message, format, arguments);
    va_end(arguments);
    char when[48];
    snprintf(when, sizeof when, " (t = %g s)", instance->now.time);
    message_end(&message, when);
    log_write(&instance->log, status, &message);
    return status;
}

Status instance_refuse(Instance *instance, const char *call) {
    static const char *const when[] = {
        [PHASE_INSTANTIATED] = "before initialisation",
        [PHASE_INITIALISATION] = "in initialisation mode",
        [PHASE_STEP] = "in step mode",
        [PHASE_EVENT] = "in event mode",
        [PHASE_CONTINUOUS] = "in continuous-time mode",
        [PHASE_TERMINATED] = "after terminate",
    };
    return instance_fail(instance, STATUS_ERROR, "%s: %s %s", instance->name, call,
                         when[instance->now.phase]);
}

size_t instance_slopes_length(void) {
    return (size_t)hb_component.inputs * HIGHEST_ORDER;
}

size_t instance_previous_length(void) {
    return hb_component.mutable_size - hb_component.first_output;
}

static bool allocate(Instance *instance) {
    size_t length = 2 * (instance_slopes_length() + instance_previous_length()) + hb_component.size +
                    hb_component.work + hb_component.states + hb_component.indicators_count +
                    (JUMPS + 1) * hb_component.inputs + hb_component.first_output + 1;
    instance->slopes = calloc(length, sizeof(double));
    if (!instance->slopes)
        return false;
    instance->block = instance->slopes + instance_slopes_length();
    instance->work = instance->block + hb_component.size;
    instance->rates = instance->work + hb_component.work;
    instance->indicators = instance->rates + hb_component.states;
    instance->ahead = instance->indicators + hb_component.indicators_count;
    instance->jumps = instance->ahead + hb_component.inputs;
    instance->previous = instance->jumps + JUMPS * hb_component.inputs;
    instance->older = instance->previous + instance_previous_length();
    instance->before = instance->older + instance_previous_length();
    return true;
}

/* Everything as after instantiation. */
static bool start(Instance *instance) {
    Texts *texts = texts_start();
    if (!texts)
        return false;
    texts_release(instance->texts);
    instance->texts = texts;
    memset(instance->previous, 0, instance_previous_length() * sizeof *instance->previous);
    memset(instance->slopes, 0,
           (instance_slopes_length() + hb_component.size + hb_component.work) * sizeof *instance->slopes);
    for (uint32_t i = 0; i < hb_component.first_table; i++)
        instance->block[i] = hb_component.reals[i].start;
    instance->now = (Moment){.phase = PHASE_INSTANTIATED, .stop = INFINITY};
    instance->outdated = false;
    instance->rates_outdated = true;
    instance->not_settled = 0;
    instance->state_set = 0;
    instance->told = 0;
    instance->steps = 0;
    return true;
}

static char *copy_name(const char *name) {
    size_t size = strlen(name) + 1;
    char *copy = malloc(size);
    return copy ? memcpy(copy, name, size) : NULL;
}

Instance *instance_new(const char *name, const char *token, const char *resources,
                       bool model_exchange, const Log *log) {
    Message message;
    if (!name || !*name) {
        message_write(&message, "%s: an instance needs a name", hb_component.name);
        log_write(log, STATUS_ERROR, &message);
        return NULL;
    }
    if (!token || strcmp(token, hb_component.token) != 0) {
        message_write(&message,
                      "%s: the GUID or instantiation token is '%.64s', that of this library '%s'; "
                      "take modelDescription.xml and library from the same FMU",
                      name, token ? token : "", hb_component.token);
        log_write(log, STATUS_ERROR, &message);
        return NULL;
    }
    if (model_exchange && !hb_component.exchanged_count) {
        message_write(&message, "%s: this FMU offers co-simulation only", name);
        log_write(log, STATUS_ERROR, &message);
        return NULL;
    }
    Instance *instance = calloc(1, sizeof *instance);
    if (instance) {
        instance->log = *log;
        instance->model_exchange = model_exchange;
        instance->name = copy_name(name);
        instance->resources = platform_path(resources ? resources : "");
    }
    if (instance && instance->name && instance->resources && allocate(instance) &&
        start(instance)) {
        instance->log.instance = instance->name;
        return instance;
    }
    message_write(&message, "%s: out of memory", name);
    log_write(log, STATUS_FATAL, &message);
    instance_free(instance);
    return NULL;
}

void instance_free(Instance *instance) {
    if (!instance)
        return;
    while (instance->states) {
        void *state = instance->states;
        instance_free_state(instance, &state);
    }
    texts_release(instance->texts);
    free(instance->direction);
    free(instance->slopes);
    free(instance->resources);
    free(instance->name);
    free(instance);
}

Status instance_reset(Instance *instance) {
    if (start(instance))
        return STATUS_OK;
    return instance_fail(instance, STATUS_ERROR, "%s: out of memory", instance->name);
}

Status instance_terminate(Instance *instance) {
    if (instance->now.phase < PHASE_STEP || instance->now.phase == PHASE_TERMINATED)
        return instance_refuse(instance, "terminate");
    instance->now.phase = PHASE_TERMINATED;
    return STATUS_OK;
}

Status instance_set_logging(Instance *instance, bool on, size_t count,
                            const char *const categories[]) {
    const char *unknown;
    if (!on || count == 0) {
        log_switch(&instance->log, on);
        return STATUS_OK;
    }
    if (categories && log_choose(&instance->log, categories, count, &unknown))
        return STATUS_OK;
    return instance_fail(instance, STATUS_ERROR, "%s: there is no log category '%.64s'",
                         instance->name, categories ? unknown : "(null)");
}
