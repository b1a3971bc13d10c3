#include <string.h>

#include "instance.h"

static bool is_text(uint32_t reference) {
    uint32_t k = reference - hb_component.size;
    return k < hb_component.texts_count && hb_component.texts[k].file == k;
}

Status instance_get_texts(Instance *instance, const uint32_t references[], size_t count,
                          const char *values[]) {
    for (size_t i = 0; i < count; i++) {
        if (!is_text(references[i]))
            return instance_unknown(instance, "String", &references[i], 1);
        values[i] = instance->texts->values[references[i] - hb_component.size];
    }
    return STATUS_OK;
}

static Status set_text(Instance *instance, uint32_t reference, const char *value) {
    if (!is_text(reference))
        return instance_unknown(instance, "String", &reference, 1);
    uint32_t k = reference - hb_component.size;
    const char *name = hb_component.texts[k].name;
    if (!value)
        return instance_fail(instance, STATUS_ERROR, "%s.%s: it takes a file name",
                             instance->name, name);
    if (instance->now.phase >= PHASE_STEP)
        return instance_fail(instance, STATUS_ERROR, "%s.%s = '%s': it cannot be set now",
                             instance->name, name, value);
    if (strcmp(value, instance->texts->values[k]) == 0)
        return STATUS_OK;
    Texts *changed = texts_with(instance->texts, k, value);
    if (!changed)
        return instance_fail(instance, STATUS_ERROR, "%s: out of memory", instance->name);
    instance->texts = changed;
    instance->now.tables = 0;
    instance->outdated = instance->now.phase == PHASE_INITIALISATION;
    instance->rates_outdated = true;
    return STATUS_OK;
}

Status instance_set_texts(Instance *instance, const uint32_t references[], size_t count,
                          const char *const values[]) {
    Status worst = STATUS_OK;
    for (size_t i = 0; i < count; i++) {
        Status status = set_text(instance, references[i], values[i]);
        worst = status > worst ? status : worst;
    }
    return worst;
}
