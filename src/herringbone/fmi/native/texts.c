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

static char *copy_text(const char *text) {
    size_t size = strlen(text) + 1;
    char *copy = malloc(size);
    return copy ? memcpy(copy, text, size) : NULL;
}

Texts *texts_new(const char *const values[]) {
    Texts *texts = calloc(1, sizeof *texts + hb_component.texts_count * sizeof *texts->values);
    if (!texts)
        return NULL;
    texts->users = 1;
    for (uint32_t k = 0; k < hb_component.texts_count; k++) {
        texts->values[k] = copy_text(values[k]);
        if (!texts->values[k]) {
            texts_release(texts);
            return NULL;
        }
    }
    return texts;
}

Texts *texts_start(void) {
    const char *values[hb_component.texts_count + 1];
    for (uint32_t k = 0; k < hb_component.texts_count; k++)
        values[k] = hb_component.texts[k].start;
    return texts_new(values);
}

Texts *texts_share(Texts *texts) {
    texts->users++;
    return texts;
}

Texts *texts_with(Texts *texts, size_t index, const char *value) {
    const char *values[hb_component.texts_count];
    for (uint32_t k = 0; k < hb_component.texts_count; k++)
        values[k] = k == index ? value : texts->values[k];
    Texts *changed = texts_new(values);
    if (changed)
        texts_release(texts);
    return changed;
}
