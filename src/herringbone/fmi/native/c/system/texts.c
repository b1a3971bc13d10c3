#include "texts.h"

#include <stdlib.h>
#include <string.h>

#include "component.h"

void texts_release(Texts *texts) {
    if (!texts || --texts->users > 0)
        return;
    for (uint32_t k = 0; k < hb_component.texts_count; k++)
        free(texts->values[k]);
    free(texts);
}

Texts *texts_new(void) {
    Texts *texts = calloc(1, sizeof *texts + hb_component.texts_count * sizeof *texts->values);
    if (texts)
        texts->users = 1;
    return texts;
}

bool texts_put(Texts *texts, uint32_t index, const char *value) {
    size_t size = strlen(value) + 1;
    char *copy = malloc(size);
    if (!copy)
        return false;
    texts->values[index] = memcpy(copy, value, size);
    return true;
}

Texts *texts_start(void) {
    Texts *texts = texts_new();
    for (uint32_t k = 0; texts && k < hb_component.texts_count; k++) {
        if (!texts_put(texts, k, hb_component.texts[k].start)) {
            texts_release(texts);
            return NULL;
        }
    }
    return texts;
}

Texts *texts_share(Texts *texts) {
    texts->users++;
    return texts;
}

Texts *texts_with(Texts *texts, uint32_t index, const char *value) {
    Texts *changed = texts_new();
    for (uint32_t k = 0; changed && k < hb_component.texts_count; k++) {
        if (!texts_put(changed, k, k == index ? value : texts->values[k])) {
            texts_release(changed);
            return NULL;
        }
    }
    if (changed)
        texts_release(texts);
    return changed;
}
