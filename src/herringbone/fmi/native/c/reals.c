#include <string.h>

#include "instance.h"

/* The text of an entry; nodes share that of their signal. */
static const char *text_of(const char *texts, uint32_t reference) {
    for (uint32_t i = 1; i <= reference; i++)
        if (hb_component.reals[i].node == 0)
            texts += strlen(texts) + 1;
    return texts;
}

const char *real_name(uint32_t reference) {
    return text_of(hb_component.names, reference);
}

const char *real_unit(uint32_t reference) {
    return text_of(hb_component.units, reference);
}

const char *real_node(uint32_t reference) {
    static const char nodes[HB_STRIDE][8] = {"", ".node1", ".node2", ".node3", ".node4"};
    return nodes[hb_component.reals[reference].node];
}
